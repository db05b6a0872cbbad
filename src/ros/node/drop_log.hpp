#pragma once

#include <chrono>
#include <cstdint>
#include <string>

namespace hybrid_sphere::ros_interface {

/// Counts the messages of a topic that are dropped and warns of them, at most once a second of steady time.
class DropLog {
 public:
  /// @param topic  as it is named in the warnings
  explicit DropLog(std::string topic) : topic_(std::move(topic)) {}

  /// @param reason  why this one is dropped
  void add(const std::string& reason);

  const std::string& topic() const { return topic_; }
  std::uint64_t count() const { return count_; }

 private:
  using Wall = std::chrono::steady_clock;

  std::string topic_;
  std::uint64_t count_ = 0;
  Wall::time_point silent_until_{};
};

}  // namespace hybrid_sphere::ros_interface

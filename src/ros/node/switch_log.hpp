#pragma once

#include <chrono>
#include <cstdint>

#include "hybrid_sphere/simulation/records.hpp"

namespace hybrid_sphere::ros_interface {

/// Says each switch on the console; of many in one second of wall time only the first ones, and how many
/// followed.
class SwitchLog {
 public:
  void add(const Switch& event);

  /// Counts a switch; says, when the next second has begun, how many were not said.
  /// @return whether it is to be said
  bool admits();

 private:
  using Wall = std::chrono::steady_clock;

  Wall::time_point second_begin_{};
  std::uint64_t in_second_ = 0;
};

}  // namespace hybrid_sphere::ros_interface

#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <utility>
#include <vector>

namespace hybrid_sphere::ros_interface {

/// Switches on their way from the thread that computes to the one that reports them. Who fills it waits where
/// it is full.
/// @tparam Kept  a switch with all that belongs to it
template <class Kept>
class SwitchQueue {
 public:
  /// @param give_up  asked while it is full; true: the switch is taken all the same
  template <class GiveUp>
  void push(Kept event, const GiveUp& give_up) {
    std::unique_lock<std::mutex> lock(mutex_);
    while (kept_.size() >= most && !give_up()) emptied_.wait_for(lock, patience);
    kept_.push_back(std::move(event));
  }

  /// Reports those that have come, in order.
  /// @param sink  called with each of them
  template <class Sink>
  void report(const Sink& sink) {
    std::vector<Kept> taken;
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      taken = std::exchange(kept_, {});
    }
    if (taken.empty()) return;
    emptied_.notify_one();
    for (Kept& event : taken) sink(event);
  }

 private:
  static constexpr std::size_t most = 10000;
  static constexpr std::chrono::milliseconds patience{10};  // between two looks whether to give up

  std::mutex mutex_;
  std::condition_variable emptied_;
  std::vector<Kept> kept_;
};

}  // namespace hybrid_sphere::ros_interface

#pragma once

#include <condition_variable>
#include <functional>
#include <mutex>
#include <string>
#include <vector>

#include "hybrid_sphere/simulation/records.hpp"

namespace hybrid_sphere::ros_interface {

/// Switches on their way from the thread that computes to the one that reports them. Who fills it waits where
/// it is full.
class SwitchQueue {
 public:
  /// @param give_up  asked while it is full; true: the switch is taken all the same
  void push(const Switch& event, const std::function<bool()>& give_up);

  /// Reports those that have come, in order.
  void report(const std::function<void(const Switch&)>& sink);

 private:
  /// With the names of the regions, which are valid only during the call that reports a switch.
  struct Kept {
    Switch event;
    std::string from;
    std::string to;
  };

  std::mutex mutex_;
  std::condition_variable emptied_;
  std::vector<Kept> kept_;
};

}  // namespace hybrid_sphere::ros_interface

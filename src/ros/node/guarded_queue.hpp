#pragma once

#include <ros/callback_queue.h>

#include <functional>
#include <string>

namespace hybrid_sphere::ros_interface {

/// A callback queue that no exception leaves: roscpp's own does not stand one.
class GuardedQueue : public ros::CallbackQueue {
 public:
  using Failed = std::function<void(const std::string& reason)>;

  /// @param failed  called with the reason for whatever a callback throws, in the thread that called it
  explicit GuardedQueue(Failed failed) : failed_(std::move(failed)) {}

  void addCallback(const ros::CallbackInterfacePtr& callback, uint64_t owner_id = 0) override;

 private:
  Failed failed_;
};

}  // namespace hybrid_sphere::ros_interface

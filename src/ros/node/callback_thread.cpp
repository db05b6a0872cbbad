#include "ros/node/callback_thread.hpp"

#include <ros/console.h>
#include <ros/init.h>

#include <utility>

#include "ros/node/callback_queue_call.hpp"

namespace hybrid_sphere::ros_interface {

CallbackThread::CallbackThread(const std::string& work, std::function<void()> between)
    : between_(std::move(between)), queue_([work](const std::string& reason) {
        ROS_ERROR("%s failed: %s", work.c_str(), reason.c_str());
      }) {}

void CallbackThread::start() {
  if (!thread_.joinable() && !ends_) thread_ = std::thread([this] { run(); });
}

void CallbackThread::stop() {
  ends_ = true;
  if (thread_.joinable()) thread_.join();
}

bool CallbackThread::ends() const { return ends_ || !ros::ok(); }

bool CallbackThread::run_in(ros::CallbackQueueInterface& other, const std::function<void()>& function) const {
  return ros_interface::run_in(other, function, [this] { return ends(); });
}

void CallbackThread::run() {
  const ros::WallDuration longest_wait(0.1);  // then whether it ends
  while (!ends_) {
    queue_.callAvailable(longest_wait);
    if (between_) between_();
  }
}

}  // namespace hybrid_sphere::ros_interface

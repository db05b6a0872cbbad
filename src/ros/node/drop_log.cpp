#include "ros/node/drop_log.hpp"

#include <ros/console.h>

namespace hybrid_sphere::ros_interface {

void DropLog::add(const std::string& reason) {
  ++count_;
  const Wall::time_point now = Wall::now();
  if (now < silent_until_) return;
  silent_until_ = now + std::chrono::seconds(1);
  ROS_WARN("%s: message dropped (%llu so far): %s", topic_.c_str(), static_cast<unsigned long long>(count_),
           reason.c_str());
}

}  // namespace hybrid_sphere::ros_interface

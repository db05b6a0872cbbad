#include "ros/node/switch_log.hpp"

#include <ros/console.h>

#include <string>

namespace hybrid_sphere::ros_interface {
namespace {

constexpr std::uint64_t max_in_second = 20;

}  // namespace

bool SwitchLog::admits() {
  const Wall::time_point now = Wall::now();
  if (now - second_begin_ >= std::chrono::seconds(1)) {
    if (in_second_ > max_in_second) {
      ROS_INFO("... and %llu more switches", static_cast<unsigned long long>(in_second_ - max_in_second));
    }
    second_begin_ = now;
    in_second_ = 0;
  }
  return ++in_second_ <= max_in_second;
}

void SwitchLog::add(const Switch& event) {
  if (!admits()) return;
  const std::string from = event.from_region.empty() ? "none" : std::string(event.from_region);
  const std::string to(event.to_region);
  ROS_INFO("switch %llu at t = %.9g s: constraint %s (%s), %s -> %s, P = (%.6g, %.6g) N s",
           static_cast<unsigned long long>(event.index), event.time, to_string(event.kind),
           to_string(event.cause), from.c_str(), to.c_str(), event.impulse.x(), event.impulse.y());
}

}  // namespace hybrid_sphere::ros_interface

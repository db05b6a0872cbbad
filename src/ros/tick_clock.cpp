#include "hybrid_sphere/ros/tick_clock.hpp"

#include <algorithm>
#include <cmath>

namespace hybrid_sphere::ros_interface {

using Seconds = std::chrono::duration<double>;

TickClock::TickClock(double rate, ros::Time epoch, Wall::time_point start)
    : rate_(rate), epoch_(epoch), start_(start) {}

TickClock::Wall::time_point TickClock::due(std::uint64_t tick) const {
  return start_ + std::chrono::round<Wall::duration>(Seconds(static_cast<double>(tick) / rate_));
}

std::uint64_t TickClock::advance(Wall::time_point now) {
  const std::uint64_t next = next_;
  tick_ = next;
  if (now > due(next + 1)) {
    tick_ = std::max(next, static_cast<std::uint64_t>(Seconds(now - start_).count() * rate_));
  }
  next_ = tick_ + 1;
  return tick_ - next;
}

void TickClock::resume(double time) {
  const double ticks = std::floor(time * rate_);
  origin_ += this->time() - ticks / rate_;
  first_ = tick_ - static_cast<std::uint64_t>(ticks);
}

ros::Time TickClock::stamp(double time, double rest) const {
  const double since_epoch = origin_ + time;
  const double whole = std::floor(since_epoch);
  return epoch_ + ros::Duration(whole) + ros::Duration((since_epoch - whole) + rest);
}

}  // namespace hybrid_sphere::ros_interface

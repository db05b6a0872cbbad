#include "hybrid_sphere/ros/tick_clock.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <stdexcept>

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
  origin_.add(this->time());
  origin_.add(-ticks / rate_);
  first_ = tick_ - static_cast<std::uint64_t>(ticks);
}

void TickClock::Origin::add(double time) {
  const double seconds = std::floor(time);
  const double sum = fraction + (time - seconds);
  const double carry = std::floor(sum);
  whole += seconds + carry;
  fraction = sum - carry;
}

ros::Time TickClock::stamp(double time, double rest) const {
  constexpr double last = std::numeric_limits<std::uint32_t>::max();  // second
  constexpr std::uint64_t nanoseconds = 1'000'000'000;                // of a second
  Origin sum = origin_;
  sum.add(time);
  sum.add(rest);
  const double seconds = sum.whole + epoch_.sec;
  const std::uint64_t below = epoch_.nsec + static_cast<std::uint64_t>(std::llround(sum.fraction * 1e9));
  if (!(seconds + static_cast<double>(below / nanoseconds) <= last)) {
    std::ostringstream message;
    message << "the stamp of t = " << time << " s is past the last time of ROS, 4294967295.999999999 s";
    throw std::out_of_range(message.str());
  }
  return {static_cast<std::uint32_t>(seconds) + static_cast<std::uint32_t>(below / nanoseconds),
          static_cast<std::uint32_t>(below % nanoseconds)};
}

}  // namespace hybrid_sphere::ros_interface

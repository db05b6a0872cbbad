#include "ros/node/tick_clock.hpp"

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <limits>
#include <sstream>

namespace hybrid_sphere::ros_interface {

using Seconds = std::chrono::duration<double>;

TickClock::TickClock(double rate, double factor, ros::Time epoch)
    : rate_(rate), factor_(factor), epoch_(epoch) {}

double TickClock::next_time() const { return static_cast<double>(next_) / rate_; }

void TickClock::anchor(Wall::time_point now, double time) {
  anchor_ = now;
  anchor_time_ = time;
}

double TickClock::passed(Wall::time_point now) const {
  if (!runs_ || factor_ == 0) return time_;
  return std::clamp(anchor_time_ + Seconds(now - anchor_).count() * factor_, time_, next_time());
}

void TickClock::run(Wall::time_point now) {
  if (runs_) return;
  anchor(now, time_);
  runs_ = true;
  lag_ = 0;
  ++starts_;
}

void TickClock::stand() { runs_ = false; }

void TickClock::set_factor(double factor, Wall::time_point now) {
  anchor(now, passed(now));
  factor_ = factor;
}

void TickClock::set_rate(double rate, Wall::time_point now, bool follows) {
  if (!follows) anchor(now, passed(now));
  rate_ = rate;
  be_at(time_, next_ == 0 ? 0 : static_cast<std::uint64_t>(std::floor(time_ * rate_)));
}

TickClock::Wall::time_point TickClock::deadline() const {
  if (!runs_) return Wall::time_point::max();
  if (factor_ == 0) return anchor_;
  return anchor_ + std::chrono::round<Wall::duration>(Seconds((next_time() - anchor_time_) / factor_));
}

/// @param next  at most the first tick after the time
void TickClock::be_at(double time, std::uint64_t next) {
  time_ = time;
  const bool begun = next_ != 0;
  next_ = next;
  if (!begun) return;
  next_ = std::max(next_, static_cast<std::uint64_t>(std::floor(time_ * rate_)));
  while (next_time() <= time_) ++next_;
}

TickClock::Lateness TickClock::advance(Wall::time_point now) {
  Lateness lateness;
  const double period = 1 / (rate_ * factor_);
  const double late = Seconds(now - deadline()).count();
  if (factor_ > 0 && late > period) {
    if (late > longest_made_up_) {
      lateness.lost = late;
      lag_ += late;
      anchor(now, next_time());
    } else {
      lateness.left_out = static_cast<std::uint64_t>(late / period);
      next_ += lateness.left_out;
    }
  }
  arrive();
  return lateness;
}

TickClock::Lateness TickClock::follow(Wall::time_point now) {
  Lateness lateness;
  const double late = Seconds(now - deadline()).count();
  if (late > longest_made_up) {
    lateness.left_out = static_cast<std::uint64_t>(late * rate_);
    next_ += lateness.left_out;
  }
  arrive();
  return lateness;
}

void TickClock::arrive() {
  keep_apart(next_time());
  time_ = next_time();
  ++next_;
}

void TickClock::wait_at(double time) { be_at(time, next_ - 1); }

std::uint64_t TickClock::hold(Wall::time_point now) {
  const double late = Seconds(now - deadline()).count() * factor_;  // of simulated time
  const double periods = 1 + std::floor(std::max(0.0, late * rate_));
  const double passed = periods / rate_;
  origin_.add(passed);
  held_ += passed;
  anchor_time_ -= passed;
  return static_cast<std::uint64_t>(periods);
}

void TickClock::hasten(Wall::time_point now) { anchor(now, next_time()); }

void TickClock::move_to(double time) {
  keep_apart(time);
  be_at(time, next_);
}

/// Makes the stamp of a later time later than the present one by least_gap, also at the end of a tiny step.
void TickClock::keep_apart(double time) {
  constexpr double rounding = 1e-9;  // of stamps [s]
  const double missing = least_gap - (time - time_);
  if (time > time_ && missing > rounding) shift(missing);
}

/// Makes stamps later; ticks are due at their stamps as before.
void TickClock::shift(double gap) {
  origin_.add(gap);
  if (runs_ && factor_ > 0) anchor_ += std::chrono::round<Wall::duration>(Seconds(gap / factor_));
}

double TickClock::end_of_step(double duration) const {
  constexpr double roundings = 16;
  const double end = time_ + duration;
  const double tick = std::round(end * rate_) / rate_;
  return tick > time_ && std::abs(tick - end) <= roundings * DBL_EPSILON * end ? tick : end;
}

void TickClock::distinguish() {
  if (!runs_) shift(least_gap);
}

void TickClock::restart() {
  shift(least_gap);
  origin_.add(time_);
  anchor_time_ -= time_;
  be_at(0, next_ == 0 ? 0 : 1);
}

void TickClock::go_to_stamp(const ros::Time& stamp) {
  const double missing = (stamp - this->stamp(time_)).toSec();
  if (missing > 0) origin_.add(missing);
}

void TickClock::rebase(const ros::Time& epoch, Wall::time_point now) {
  epoch_ = epoch;
  origin_ = {};
  be_at(0, next_ == 0 ? 0 : 1);
  anchor(now, 0);
}

void TickClock::resume(double time) {
  const double ticks = std::floor(time * rate_);
  const double tick = ticks / rate_;
  origin_.add(time_);
  origin_.add(-tick);
  anchor_time_ -= time_ - tick;
  be_at(tick, static_cast<std::uint64_t>(ticks));
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
  const std::uint64_t carry = below / nanoseconds;
  if (!(seconds + static_cast<double>(carry) <= last)) {
    std::ostringstream message;
    message << "the stamp of t = " << time << " s is past the last ROS time, 4294967295.999999999 s";
    throw StampError(message.str());
  }
  return {static_cast<std::uint32_t>(seconds) + static_cast<std::uint32_t>(carry),
          static_cast<std::uint32_t>(below % nanoseconds)};
}

}  // namespace hybrid_sphere::ros_interface

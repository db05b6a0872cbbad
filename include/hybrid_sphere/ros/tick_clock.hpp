#pragma once

#include <ros/time.h>

#include <chrono>
#include <cstdint>

namespace hybrid_sphere::ros_interface {

/// When the node computes, and what time it is then. Tick N is due N/rate after the start on the steady wall
/// clock. Output times count from the initial state, t = n/rate with an integer n; stamps count from the
/// start and never go back.
class TickClock {
 public:
  using Wall = std::chrono::steady_clock;

  /// @param rate   ticks per second [Hz]
  /// @param epoch  stamp of the start
  /// @param start  the start, when tick 0 is due
  TickClock(double rate, ros::Time epoch, Wall::time_point start);

  /// When the next tick is due.
  Wall::time_point deadline() const { return due(next_); }

  /// Goes to the next tick; when that is late by more than a period, to the last one that is due.
  /// @return  number of ticks left out
  std::uint64_t advance(Wall::time_point now);

  /// Time of the present tick since the initial state [s], n/rate rounded once.
  double time() const { return static_cast<double>(tick_ - first_) / rate_; }

  /// Makes the present tick the time of a new initial state.
  void restart() { resume(0); }

  /// Goes on from a time, after the computation had halted there: the present tick becomes the last one that
  /// is not later than it.
  /// @param time  since the initial state [s], not after time()
  void resume(double time);

  /// Stamp of a time since the initial state [s], right to the nanosecond: increases with it, and goes on
  /// where it was after restart() and resume().
  /// @param time  >= 0
  /// @param rest  what `time` leaves out (Switch::time_rest) [s]
  /// @throws std::out_of_range  past the last time that ros::Time holds, 4294967295.999999999 s (in 2106)
  ros::Time stamp(double time, double rest = 0) const;

 private:
  /// A time without the rounding of one number that grows.
  struct Origin {
    double whole = 0;     // [s]
    double fraction = 0;  // [s], from 0 to 1
    void add(double time);
  };

  Wall::time_point due(std::uint64_t tick) const;

  double rate_;
  ros::Time epoch_;
  Wall::time_point start_;
  std::uint64_t next_ = 0;
  std::uint64_t tick_ = 0;   // the present one
  std::uint64_t first_ = 0;  // that of the initial state
  Origin origin_;            // time of the initial state since the epoch
};

}  // namespace hybrid_sphere::ros_interface

#pragma once

#include <ros/time.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <limits>
#include <stdexcept>

namespace hybrid_sphere::ros_interface {

/// A stamp past the last time that ros::Time holds, 4294967295.999999999 s (in 2106).
class StampError : public std::out_of_range {
 public:
  using std::out_of_range::out_of_range;
};

/// When the node computes, and what time it is then. The outputs are at the times t = n/rate since the
/// initial state with an integer n; on the steady wall clock they follow each other by 1/(rate factor).
/// Stamps count from the epoch and never go back.
class TickClock {
 public:
  using Wall = std::chrono::steady_clock;

  /// Lateness that is made up for by leaving out ticks [s]; more than that is lost, and time has then passed
  /// more slowly than asked for.
  static constexpr double longest_made_up = 0.25;

  /// Least difference of two stamps [s]. Python's tf2 holds stamps as doubles, which are 2.4e-7 s apart
  /// today.
  static constexpr double least_gap = 1e-6;

  /// Time stands at 0 until run().
  /// @param rate    ticks per second of simulated time [Hz]
  /// @param factor  simulated seconds in one of wall time; 0: every tick is due at once
  /// @param epoch   stamp of time 0
  TickClock(double rate, double factor, ros::Time epoch);

  /// Leaves out all ticks that are over, however many, instead of losing time.
  void catch_up_always() { longest_made_up_ = std::numeric_limits<double>::infinity(); }

  /// A later stamp of time 0, before the first tick; an earlier one would be before stamps that were given,
  /// and changes nothing.
  void set_epoch(const ros::Time& epoch) { epoch_ = std::max(epoch_, epoch); }

  /// Lets time pass: the next tick is due when as much of it has passed as lies before it.
  void run(Wall::time_point now);
  /// Time stands at the present tick; no tick is due.
  void stand();
  bool runs() const { return runs_; }
  /// How many times time has begun to pass: the same number as before, and time has not stood since.
  std::uint64_t starts() const { return starts_; }

  double rate() const { return rate_; }
  double factor() const { return factor_; }
  /// Other values, from now on: nothing is made up for, nothing is left out.
  void set_factor(double factor, Wall::time_point now);
  /// @param follows  whether time is told by somebody else: no tick that is due is lost then
  void set_rate(double rate, Wall::time_point now, bool follows = false);

  /// When the next tick is due; the latest of times while time stands.
  Wall::time_point deadline() const;
  /// Time of the next tick since the initial state [s].
  double next_time() const;

  /// How many ticks a look at the wall clock has found late.
  struct Lateness {
    std::uint64_t left_out = 0;  ///< because later ones are due already
    double lost = 0;             ///< wall time that is not made up for [s]
    std::uint64_t late() const { return left_out + (lost > 0 ? 1 : 0); }
  };
  /// Goes to the next tick; when that is late by more than a period, to the last one that is due.
  Lateness advance(Wall::time_point now);

  /// The same where time is told by somebody else: late ticks are all taken; from more than longest_made_up
  /// on only the last one that is due.
  Lateness follow(Wall::time_point now);

  /// The tick that was gone to last has yet to be computed: the present time is an earlier one, from which
  /// the next tick is that one.
  /// @param time  since the initial state [s], not after that tick
  void wait_at(double time);

  /// While the next tick is being computed and is long due, time stands and stamps go on: by a period for
  /// each that has passed since that tick was due. The next one is due when the next period has passed.
  /// @return  number of periods
  std::uint64_t hold(Wall::time_point now);
  /// How much stamps have gone on while time was held, in all [s].
  double held() const { return held_; }
  /// Wall time that has been lost since time began to pass [s]: so far behind are the stamps.
  double lag() const { return lag_; }
  /// The next tick is due now.
  void hasten(Wall::time_point now);
  /// Goes to the next tick, however late it is.
  void arrive();

  /// Makes a time between the present tick and the next one the present one, for a step that ends there.
  /// @param time  since the initial state [s], from time() to next_time()
  void move_to(double time);

  /// The present time since the initial state [s]: n/rate, rounded once, or where move_to has ended.
  double time() const { return time_; }

  /// The present time plus a duration; where that is a tick but for rounding, the tick, so that steps and a
  /// free run come to the same times.
  /// @param duration  [s], > 0
  double end_of_step(double duration) const;

  /// While time stands stamps are later from now on by least_gap: two states of the sphere never have one
  /// stamp.
  void distinguish();

  /// Makes the present time that of a new initial state, with a stamp of its own.
  void restart();

  /// Makes a stamp that of the present time, if it is later.
  void go_to_stamp(const ros::Time& stamp);
  /// A new initial state with a stamp that may be an earlier one: who gives it has told its listeners.
  void rebase(const ros::Time& epoch, Wall::time_point now);

  /// Goes on from a time, after the computation had halted there: the present time becomes the last tick that
  /// is not later than it.
  /// @param time  since the initial state [s], not after time()
  void resume(double time);

  /// Stamp of a time since the initial state [s], right to the nanosecond: increases with it, and goes on
  /// where it was after restart() and resume().
  /// @param time  >= 0
  /// @param rest  what `time` leaves out (Switch::time_remainder) [s]
  /// @throws StampError  past the last time that ros::Time holds
  ros::Time stamp(double time, double rest = 0) const;

 private:
  /// A time without the rounding of one number that grows.
  struct Origin {
    double whole = 0;     // [s]
    double fraction = 0;  // [s], from 0 to 1
    void add(double time);
  };

  /// Simulated time that has passed by the wall clock, between the present tick and the next one [s].
  double passed(Wall::time_point now) const;
  void anchor(Wall::time_point now, double time);
  void be_at(double time, std::uint64_t next);
  void keep_apart(double time);
  void shift(double gap);

  double rate_;
  double factor_;
  ros::Time epoch_;
  bool runs_ = false;
  std::uint64_t starts_ = 0;
  double time_ = 0;
  std::uint64_t next_ = 0;  // tick since the initial state
  double held_ = 0;         // [s]
  double lag_ = 0;          // [s]
  double longest_made_up_ = longest_made_up;
  // A pair of times that belong together.
  Wall::time_point anchor_;
  double anchor_time_ = 0;
  Origin origin_;  // time of the initial state since the epoch
};

}  // namespace hybrid_sphere::ros_interface

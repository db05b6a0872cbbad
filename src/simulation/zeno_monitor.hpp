#pragma once

#include <algorithm>
#include <optional>
#include <vector>

#include "simulation/arrival.hpp"
#include "simulation/hybrid_state.hpp"
#include "simulation/zeno_detector.hpp"

namespace hybrid_sphere {

/// A ground with which the sphere rolled for no time, as its impulse threw it back.
struct Rebound {
  RegionId from;
  Vector2d velocity;      ///< after the impulse [m/s]
  Vector2d acceleration;  ///< with which it would roll there [m/s^2]
};

/// The last instant of an accumulation, and what the sphere does from then on.
struct ZenoLimit {
  SplitTime time;
  Vector2d position;  ///< of a corner [m]
  RegionId ground;    ///< on which it goes on or, with another one, along whose edge
  RegionId other = no_region;
  Contact edge{no_region, {}};         ///< where one ground has thrown it back
  Vector2d normal = Vector2d::Zero();  ///< of that edge there, into the ground, of length 1
};

/// Switches that come to an end in time, but not in number: whether they do, when, and whether a motion goes
/// on from there. Source: docs/theory.md 5.5.
class ZenoMonitor {
 public:
  /// @param hybrid  has to live as long as this
  explicit ZenoMonitor(HybridState& hybrid) : hybrid_(hybrid) {}

  /// Something has come from outside: what has been is no sign of what comes.
  void begin(double now);

  /// Counts an instant. @return whether they accumulate, with no motion after them
  bool count_instant(double now) { return slow_.count() && many_accumulate(now); }
  /// The place at which a ground is entered.
  /// @param stays  whether the motion before it has been there in its middle, too
  /// @return whether that has been so many times in a row
  template <class Stays>
  bool stands_still(const Vector2d& place, const Stays& stays) {
    return standstill_.count(place, stays);
  }
  /// The sphere comes to an edge.
  void note_arrival(const Arrival& arrival, RegionId entered, const SplitTime& instant, const Contact& edge);

  /// Where a ground has thrown the sphere back, at the instant that was passed last.
  const std::optional<Rebound>& rebound() const { return rebound_; }
  void forget_rebound() { rebound_.reset(); }
  void note_rebound(const Rebound& rebound) { rebound_ = rebound; }

  /// After an instant: finds the limit where it is near. @return false where none exists
  bool check(const Arrival& arrival, const Contacts& contacts, double now);

  /// What follows from a ground that would be entered again at once.
  enum class Throws {
    go_on,  ///< nothing
    end,    ///< they were the last ones: the limit is known
    halt    ///< they were not, and how many are to come is not known
  };
  /// Where a ground that throws the sphere back would be entered again at once, as far as rounding tells,
  /// though no other ground gives it a velocity: the last throws of an accumulation.
  /// @param visited  the grounds entered at this instant
  Throws end_throws(const std::vector<RegionId>& visited, const EdgeContacts& contacts,
                    const Vector2d& position, double now);

  /// The last instant of an accumulation, still to come: nothing else counts until then.
  std::optional<ZenoLimit>& limit() { return limit_; }
  /// It has come.
  void pass_limit(double now) {
    detector_.clear();
    limit_passed_at_ = now;
  }

  /// The time after which the sphere is expected back at an edge, or infinite [s].
  double expected() const { return detector_.expected(); }

 private:
  bool many_accumulate(double now);
  bool is_deep_in_cusp() const;
  bool throws_meet_in_corner() const;
  double unseen_excursion(const ZenoDetector::Arrival& arrival, double tau);
  bool find_limit(const ZenoDetector::Cycle& cycle, double now);
  bool leaves_edge_before_limit(const Contact& contact, const Vector2d& position);
  double last_throw(const Contact& contact, const Vector2d& normal, double guess);
  void find_limit_on_edge(const Contact& contact, const Vector2d& position);
  void find_limit_in_corner(const ZenoDetector::Cycle& cycle);
  double time_to_limit() const { return hybrid_.epoch.until(limit_->time.value) + limit_->time.remainder; }

  HybridState& hybrid_;
  SlowZenoDetector slow_;
  StandstillDetector standstill_;
  ZenoDetector detector_;
  bool comes_ = false;  // at the instant that is being passed, to an edge: detector_.next()
  std::optional<Rebound> rebound_;
  std::optional<ZenoLimit> limit_;
  double limit_passed_at_ = -1;  // time of the last one [s]
};

}  // namespace hybrid_sphere

#pragma once

#include <algorithm>
#include <optional>
#include <vector>

#include "simulation/arrival.hpp"
#include "simulation/hybrid_state.hpp"
#include "simulation/zeno_detector.hpp"

namespace hybrid_sphere {

/// A ground on which the sphere rolled for no time, because its impulse threw the sphere back.
struct Rebound {
  RegionId from;
  Vector2d velocity;      ///< after the impulse [m/s]
  Vector2d acceleration;  ///< with which it would roll there [m/s^2]
};

/// The last instant of an accumulation, and what the sphere does from then on.
struct ZenoLimit {
  SplitTime time;
  Vector2d position;  ///< of a corner [m]
  RegionId ground;    ///< on which the sphere continues or, together with `other`, along whose edge
  RegionId other = no_region;
  Contact edge{no_region, {}};         ///< at which one ground has thrown it back
  Vector2d normal = Vector2d::Zero();  ///< of that edge there, into the ground, of length 1
};

/// Switches without end in a finite time: whether they accumulate, when, and whether a motion continues from
/// there. Source: docs/theory.md 5.5.
class ZenoMonitor {
 public:
  /// @param hybrid  must outlive this object
  explicit ZenoMonitor(HybridState& hybrid) : hybrid_(hybrid) {}

  /// An intervention from outside: earlier instants no longer count as evidence.
  void begin(double now);

  /// Counts an instant. @return whether instants accumulate, with no motion after them
  bool count_instant(double now) { return slow_.count() && many_accumulate(now); }
  /// Notes the place at which a ground is entered.
  /// @param stays  whether the preceding motion was at this place halfway, too @return whether this has
  /// happened many times in a row
  template <class Stays>
  bool stands_still(const Vector2d& place, const Stays& stays) {
    return standstill_.count(place, stays);
  }
  /// Notes that the sphere reaches an edge.
  void note_arrival(const Arrival& arrival, RegionId entered, const SplitTime& instant, const Contact& edge);

  /// The throw by which a ground sent the sphere back at the instant passed last.
  const std::optional<Rebound>& rebound() const { return rebound_; }
  void forget_rebound() { rebound_.reset(); }
  void note_rebound(const Rebound& rebound) { rebound_ = rebound; }

  /// After an instant: finds the limit where it is near. @return false where none exists
  bool check(const Arrival& arrival, const Contacts& contacts, double now);

  /// What to do when a ground would be entered again at once.
  enum class Throws {
    go_on,  ///< nothing
    end,    ///< those were the last throws: the limit is known
    halt    ///< they were not, and the number of remaining throws is not known
  };
  /// For a ground that throws the sphere back and, to within rounding, would be entered again at once, though
  /// no other ground gives the sphere a velocity: the last throws of an accumulation.
  /// @param visited  the grounds entered at this instant
  Throws end_throws(const std::vector<RegionId>& visited, const EdgeContacts& contacts,
                    const Vector2d& position, double now);

  /// The last instant of an accumulation that lies ahead: nothing else counts until then.
  std::optional<ZenoLimit>& limit() { return limit_; }
  /// The limit has been reached.
  void pass_limit(double now) {
    detector_.clear();
    limit_passed_at_ = now;
  }

  /// p_c after a time of throws, since the beginning of the segment [m/s]. Where the present ground resists
  /// rolling it changes with the direction of rolling, which each throw sets back: as in the next of them.
  Vector2d conserved_after(double tau);

  /// The time after which the sphere is expected back at an edge, or infinite [s].
  double expected() const { return detector_.expected(); }

 private:
  bool many_accumulate(double now);
  bool is_deep_in_cusp() const;
  bool throws_meet_in_corner() const;
  double unseen_excursion(const ZenoDetector::Arrival& arrival, double tau);
  double speed_across(const ZenoDetector::Cycle& cycle, const Vector2d& normal) const;
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
  bool comes_ = false;  // reaches an edge at the instant being passed: detector_.next()
  std::optional<Rebound> rebound_;
  std::optional<ZenoLimit> limit_;
  double limit_passed_at_ = -1;  // time of the last one [s]
};

}  // namespace hybrid_sphere

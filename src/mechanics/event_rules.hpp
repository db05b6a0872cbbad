#pragma once

#include <limits>
#include <vector>

#include "mechanics/motion_step.hpp"
#include "mechanics/segment.hpp"

namespace hybrid_sphere::mechanics {

/// Decides which of the model's events occur at an instant, and which are to be located from there on.
///
/// A piece of motion from t0 to t1 contains the events in the half-open interval (t0, t1]: an event whose
/// function reaches 0 at t1 and is about to change its sign there occurs at t1. Every function has a side,
/// the sign that it had before. Start, input, restore and reset decide the sides anew, by the state after
/// them. Source: docs/theory.md 7.9.
class EventRules {
 public:
  /// @param model  must outlive this object
  explicit EventRules(const Model& model);

  /// An instant, before its resets and impulses.
  struct Instant {
    double t;  ///< [s]
    const Vector& q;
    const Vector& v;
    const Sizes& sizes;  ///< of the numbers from which q and v were computed, whose round-off they carry
    double resolution;   ///< of the clock [s]
    double ahead;        ///< how far to look ahead if a function is 0 and has no rate [s]
  };
  /// Returns the events that occur at an instant, ascending. An event occurs once at an instant, unless a
  /// reset has armed it anew.
  /// @param passed  functions that have changed their sign by the motion; others may have changed by an
  ///                impulse, or be 0
  /// @param motion  with the constraints that held until now
  /// Throws NotFinite, and what the functions throw.
  std::vector<std::size_t> occurring(const Instant& at, const std::vector<MonitoredGuard>& passed,
                                     ConstrainedMotion& motion);

  /// Returns the velocities after the resets of events, in the order of the model.
  /// Throws std::invalid_argument for a wrong number of velocities, NotFinite, and what the resets throw.
  Vector after_resets(const std::vector<std::size_t>& events, const Instant& at) const;

  /// Whether an event with a reset has occurred four times in a row, each within 1e4 resolutions of the clock
  /// after the one before. Rounding would decide the next ones (Zeno).
  bool accumulate() const;

  /// Decides the sides anew after a reset. A function that is 0 then does not occur at this instant.
  void rearm(const Instant& after);

  /// Adds the functions to be located from an instant on.
  /// @param motion  with the constraints that hold from now on
  /// Throws as occurring().
  void monitor(const Instant& at, ConstrainedMotion& motion, std::vector<MonitoredGuard>& guards);

  /// What is known of an event's function.
  struct Side {
    int sign = 0;                                               ///< before the present; 0: not known
    double crossed = -std::numeric_limits<double>::infinity();  ///< t at which it changed last [s]
    double overshoot = 0;  ///< abs(g) there, if the motion took it over 0; after an impulse 0
    int repeats = 0;       ///< crossings in a row, each soon after the one before, each with a reset
  };
  const std::vector<Side>& sides() const { return sides_; }
  /// Continues with the sides of a saved plant or after an input: only what has occurred is kept.
  void restore(const std::vector<Side>& sides);

 private:
  double value(std::size_t i, const Instant& at) const;
  double roundoff(std::size_t i, const Instant& at, double value) const;
  int sign_of_rate(std::size_t i, const Instant& at, double roundoff, ConstrainedMotion& motion) const;
  double roundoff_of_rate(std::size_t i, const Instant& at, double value,
                          const ConstrainedMotion& motion) const;
  int sign_ahead(std::size_t i, const Instant& at, double roundoff, ConstrainedMotion& motion) const;
  bool changes(std::size_t i, const Instant& at, ConstrainedMotion& motion);
  bool has_crossed(const Side& side, const Instant& at) const;
  bool is_at_crossing(const Side& side, const Instant& at, double value) const;

  const Model* model_;
  std::vector<Side> sides_;
};

/// The value of an event's function. Throws NotFinite.
double value_of(const Event& event, double t, const Vector& q, const Vector& v);

/// The change of an event's function from a time `step` before to a time `step` after, along the tangent of a
/// motion. Throws NotFinite.
/// @param motion  evaluated at (t, q, v)
double change_of(const Event& event, double t, const Vector& q, const Vector& v,
                 const ConstrainedMotion& motion, double step);

}  // namespace hybrid_sphere::mechanics

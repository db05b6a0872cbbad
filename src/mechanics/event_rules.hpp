#pragma once

#include <vector>

#include "mechanics/motion_step.hpp"
#include "mechanics/segment.hpp"

namespace hybrid_sphere::mechanics {

/// Which of the model's own events happen at an instant, and which are to be looked for. Source:
/// docs/theory.md 7.9.
class EventRules {
 public:
  /// @param model  must outlive this object
  explicit EventRules(const Model& model);

  /// The events that happen at (t, q, v), and the velocities after their resets. Throws NotFinite, and what
  /// the functions throw.
  /// @param passed  functions that have changed their sign by the motion; others may have by an impulse
  /// @param v       in: velocities before; out: after
  std::vector<std::size_t> pass(double t, const Vector& q, Vector& v,
                                const std::vector<MonitoredGuard>& passed);

  /// Adds the functions to be looked for from (t, q, v) on. Throws as pass().
  /// @param motion  with the constraints that hold
  /// @param ahead   how far to look ahead where a function is 0 and has no rate [s]
  void monitor(double t, const Vector& q, const Vector& v, double ahead, ConstrainedMotion& motion,
               std::vector<MonitoredGuard>& guards);

  /// What is known of an event's function.
  struct Side {
    int sign = 0;          // 0: not known
    bool is_left = false;  // it has just changed: its value is rounding
  };
  const std::vector<Side>& sides() const { return sides_; }
  void restore(const std::vector<Side>& sides) { sides_ = sides; }

 private:
  double value(std::size_t i, double t, const Vector& q, const Vector& v) const;
  int sign_from(std::size_t i, double t, const Vector& q, const Vector& v, double ahead,
                ConstrainedMotion& motion) const;

  const Model* model_;
  std::vector<Side> sides_;
};

/// The value of an event's function. Throws NotFinite.
double value_of(const Event& event, double t, const Vector& q, const Vector& v);

/// Its change from a time `step` before to a time `step` after, along the tangent of a motion. Throws
/// NotFinite.
/// @param motion  evaluated at (t, q, v)
double change_of(const Event& event, double t, const Vector& q, const Vector& v,
                 const ConstrainedMotion& motion, double step);

}  // namespace hybrid_sphere::mechanics

#pragma once

#include "motion/friction_limit.hpp"

namespace hybrid_sphere::numeric {

/// A sphere that rolling resistance keeps at rest relative to the ground: nu = 0, the centre moves with the
/// ground,
///   d' = u(r_0 + d) = u_0 + W J d,   d = u_0 tau phi1(i W tau),   v = u_0 e^{i W tau}
/// It breaks loose when abs(B) > A, and loses its grip when abs(v' - f) > mu N/m. Source: docs/theory.md 4.6.
class StickingMotion {
 public:
  /// @param equations  of the form `resisted_rolling`; not modified
  explicit StickingMotion(const Equations& equations);

  /// Lets limits be exceeded by a relative 2^-30 from now on.
  void loosen() { raise_ = 1 + 0x1p-30; }

  /// State of `equations` at a time, with nu = 0.
  State at(double tau) const;
  double speed() const { return ground_.norm(); }

  /// Time after which the motion repeats: a revolution of a turntable; 0 on ground that does not move [s].
  double repeats() const;
  /// End of the piece, beginning at `from`, that is searched for ends at once.
  double next_piece(double from) const;

  /// First time in [from, until] at which abs(B) > A; `never` if there is none.
  double first_breaking(double from, double until) const;
  /// First time at which the reaction is larger than mu N allows.
  double first_slipping(double friction, double from, double until) const;

 private:
  double first_excess(double force_share, double spin_share, double turn_share, double limit, double from,
                      double until) const;

  const Equations* equations_;
  Vector2d ground_;
  double raise_ = 1;  // of both limits
};

}  // namespace hybrid_sphere::numeric

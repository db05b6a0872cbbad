#pragma once

#include "motion/curve.hpp"
#include "motion/motion.hpp"
#include "motion/normal_spin.hpp"
#include "sphere/dynamics.hpp"

namespace hybrid_sphere {

/// Sliding along a straight edge between two rough grounds A and B that throw the sphere at each other:
///   sigma = alpha u_A + (1 - alpha) u_B,   v = p_c(tau) + kappa sigma   with v along the edge,
/// alpha being the share of A. Grounds at rest or belts, without drag or spring, so that alpha is linear in
/// time and the path a parabola. Source: docs/theory.md 5.4.
class EdgeSlide : public Motion {
 public:
  EdgeSlide() = default;

  /// @param first               u_A [m/s]
  /// @param second              u_B [m/s]; p_c.n + kappa u_A.n < 0 < p_c.n + kappa u_B.n
  /// @param normal              n of the edge, of length 1, into A
  /// @param position            of the centre at tau = 0, on the edge [m]
  /// @param conserved_velocity  p_c at tau = 0 [m/s]
  EdgeSlide(const Dynamics& dynamics, const Vector2d& first, const Vector2d& second, const Vector2d& normal,
            const Vector2d& position, const Vector2d& conserved_velocity, const NormalSpin& normal_spin);

  MotionState at(double tau) override;
  int expand_spin(double middle, double half, polynomials::Powers<3>& powers) override;
  double acceleration_bound(double /*from*/, double /*until*/) override;
  double acceleration_bound_along(const Vector2d& direction, double from, double until) override;
  double end_before(double horizon) override { return end_ <= horizon ? end_ : never; }
  MotionEnd end_reason() const override { return MotionEnd::edge_left; }
  SpinProfile spin_profile() const override;

  /// When one ground takes over alone; `never` without a force across the edge [s].
  double end() const { return end_; }
  /// Whether A takes over then, and not B.
  bool leaves_into_first() const { return share_rate_ > 0; }
  /// alpha.
  double share(double tau) const { return share_ + tau * share_rate_; }
  Curve curve() const override;
  /// Whether the angular velocity is constant.
  bool steady() const;

 private:
  NormalSpin normal_spin_;
  double radius_ = 1;
  Vector2d start_ = Vector2d::Zero();
  Vector2d velocity_ = Vector2d::Zero();
  Vector2d acceleration_ = Vector2d::Zero();
  Vector2d contact_velocity_ = Vector2d::Zero();
  Vector2d contact_acceleration_ = Vector2d::Zero();
  double share_ = 0;
  double share_rate_ = 0;
  double end_ = never;
};

}  // namespace hybrid_sphere

#pragma once

#include <optional>

#include "motion/dry_friction.hpp"
#include "motion/motion.hpp"
#include "motion/normal_spin.hpp"
#include "motion/state_polynomial.hpp"
#include "sphere/dynamics.hpp"

namespace hybrid_sphere {

/// Motion under dry friction on ground at rest or on a belt, without drag or spring: sliding on coulomb
/// ground, turning freely or kept from it by a rolling resistance, or rolling under such a resistance.
/// Source: docs/theory.md 4.4, 4.6.
class DryFrictionMotion : public Motion {
 public:
  DryFrictionMotion() = default;

  /// Sliding on coulomb ground: s' = slipping() - slip_decay(mu) s/abs(s), sigma = u + s,
  /// v = p_c + rolling() tau + kappa sigma. Ends when the slip is used up.
  /// @param position            of the centre at tau = 0 [m]
  /// @param conserved_velocity  p_c at tau = 0 [m/s]
  /// @param slip                s at tau = 0 [m/s]; 0 slides off if abs(slipping()) > slip_decay(mu)
  static DryFrictionMotion sliding(const Dynamics& dynamics, const scene::Material& material,
                                   const Vector2d& position, const Vector2d& conserved_velocity,
                                   const Vector2d& slip, const NormalSpin& normal_spin);

  /// Sliding without turning: v = u + s, s' = free - center_decay(mu) s/abs(s), nu = 0. Ends when the slip is
  /// used up.
  /// @param position  of the centre at tau = 0 [m]
  /// @param slip      s at tau = 0 [m/s]; 0 slides off if abs(free) > center_decay(mu)
  static DryFrictionMotion skidding(const Dynamics& dynamics, const scene::Material& material,
                                    const Vector2d& position, const Vector2d& slip,
                                    const NormalSpin& normal_spin);

  /// Rolling with resistance: v = u + nu, nu' = rolling() - roll_decay(rho) nu/abs(nu), sigma = u. Ends when
  /// the sphere is at rest relative to the ground.
  /// @param position  of the centre at tau = 0 [m]
  /// @param nu        v - u at tau = 0 [m/s]
  static DryFrictionMotion rolling(const Dynamics& dynamics, const scene::Material& material,
                                   const Vector2d& position, const Vector2d& nu,
                                   const NormalSpin& normal_spin);

  /// The velocity of the centre at tau = 0, from which the other velocities have been computed: what they
  /// give for it carries their rounding [m/s].
  void set_first_velocity(const Vector2d& velocity) { first_velocity_ = velocity; }

  MotionState at(double tau) override { return state(friction_.at(tau), tau); }
  PointState center(double tau) override { return placed(friction_.at(tau), tau); }
  int expand_spin(double middle, double half, polynomials::Powers<3>& powers) override;
  double acceleration_bound(double from, double until) override;
  Vector2d reference_velocity() override { return ground_; }
  double acceleration_bound_along(const Vector2d& direction, double from, double until) override;
  double end_before(double horizon) override { return end() <= horizon ? end() : never; }
  MotionEnd end_reason() const override {
    return law_ == Law::rolling ? MotionEnd::roll_used_up : MotionEnd::slip_used_up;
  }
  SpinProfile spin_profile() const override;
  /// Whether the direction of the friction stays.
  bool straight() const { return friction_.straight(); }

  /// Taylor polynomials of the state; where they do not converge, their coefficients do not fall.
  /// @param from  their origin, before the end of the motion [s]
  StatePolynomial expand(double from, double width);

  double end() const { return friction_.end(); }
  /// Where the friction turns fastest.
  DryFriction::Corner corner() const { return friction_.corner(); }
  /// A parabola if the slip, or the rolling, keeps its direction.
  Curve curve() const override;
  /// Whether the angular velocity is constant.
  bool steady() const;

 private:
  enum class Law : std::uint8_t { sliding, skidding, rolling };

  PointState placed(const DryFriction::Value& now, double tau) const;
  MotionState state(const DryFriction::Value& now, double tau) const;
  Vector3d spin_of(const Vector2d& nu, double normal) const;
  void set_spin(const Vector3d& now, const polynomials::Powers<2>& w, double tau, double width,
                polynomials::Powers<3>& powers) const;
  Vector2d nu_rate(const Vector2d& w_rate) const;

  DryFriction friction_;
  NormalSpin normal_spin_;
  double radius_ = 1;
  Vector2d start_ = Vector2d::Zero();
  Vector2d ground_ = Vector2d::Zero();
  // r = start + steady_velocity tau + steady_acceleration tau^2/2 + share (integral of w)
  Vector2d steady_velocity_ = Vector2d::Zero();
  Vector2d steady_acceleration_ = Vector2d::Zero();
  double share_ = 1;  // kappa while sliding
  std::optional<Vector2d> first_velocity_;
  Law law_ = Law::rolling;
  // abs(r'') <= abs(pull_) + hold_
  Vector2d pull_ = Vector2d::Zero();
  double hold_ = 0;
};

}  // namespace hybrid_sphere

#pragma once

#include <algorithm>
#include <optional>

#include "motion/curve.hpp"
#include "motion/motion.hpp"
#include "motion/normal_spin.hpp"
#include "sphere/dynamics.hpp"

namespace hybrid_sphere {

/// Sliding on coulomb ground against a rolling resistance when neither the slip s nor nu turns: forces are
/// constant and parallel to them, or both start from 0. Then
///   s' = f - g - A s/abs(s) + a nu/abs(nu),     nu' = g + (1 - kappa) A s/abs(s) - a nu/abs(nu)
/// are constant and the path is a parabola. Source: docs/theory.md 4.6.
class StraightSlide : public Motion {
 public:
  StraightSlide() = default;

  /// Empty if the forces change, the ground turns, or s or nu turns.
  /// @param position  of the centre at tau = 0 [m]
  /// @param slip      s at tau = 0 [m/s]
  /// @param nu        nu at tau = 0 [m/s]; if it is 0, it must start to grow; likewise s
  static std::optional<StraightSlide> from(const Dynamics& dynamics, const scene::Material& material,
                                           const Vector2d& position, const Vector2d& slip, const Vector2d& nu,
                                           const NormalSpin& normal_spin);

  /// The velocity of the centre at tau = 0, from which slip and nu have been computed: their sum carries the
  /// rounding of both, and of the ground's [m/s].
  void set_first_velocity(const Vector2d& velocity) { first_velocity_ = velocity; }

  MotionState at(double tau) override;
  int expand_spin(double middle, double half, polynomials::Powers<3>& powers) override;
  double acceleration_bound(double from, double until) override;
  double acceleration_bound_along(const Vector2d& direction, double from, double until) override;
  double end_before(double horizon) override { return end() <= horizon ? end() : never; }
  MotionEnd end_reason() const override {
    return roll_end_ < slip_end_ ? MotionEnd::roll_used_up : MotionEnd::slip_used_up;
  }
  SpinProfile spin_profile() const override;

  /// When the slip or nu is used up, `never` if neither is [s].
  double end() const { return std::min(slip_end_, roll_end_); }
  Curve curve() const override;
  /// Whether the angular velocity is constant.
  bool steady() const { return normal_spin_.constant() && roll_rate_.isZero(0); }

 private:
  NormalSpin normal_spin_;
  double radius_ = 1;
  Vector2d start_ = Vector2d::Zero();
  Vector2d ground_ = Vector2d::Zero();
  Vector2d slip_ = Vector2d::Zero();
  Vector2d slip_rate_ = Vector2d::Zero();
  Vector2d nu_ = Vector2d::Zero();
  Vector2d roll_rate_ = Vector2d::Zero();
  std::optional<Vector2d> first_velocity_;
  double slip_end_ = never;
  double roll_end_ = never;
};

}  // namespace hybrid_sphere

#pragma once

#include "motion/curve.hpp"
#include "motion/motion.hpp"
#include "motion/normal_spin.hpp"
#include "motion/phi.hpp"
#include "motion/polynomials.hpp"
#include "sphere/dynamics.hpp"

namespace hybrid_sphere {

/// Motion whose equations are linear: free on smooth ground, or rolling, under constant forces, linear drag,
/// a spring, on a belt or a turntable. With x = r - r_0 as a complex number
///   x'' = beta x' + gamma x + a,   x(0) = 0,   x = v_0 G + a H (LinearResponse)
/// free:     beta = -translational_drag,   gamma = -spring_rate,   a = f(r_0, 0)
/// rolling:  beta = i kappa W - (1 - kappa) translational_drag - kappa rotational_drag,
///           gamma = -(1 - kappa) spring_rate + i kappa rotational_drag W,
///           a = (1 - kappa) f(r_0, 0) + kappa (spin + rotational_drag u(r_0))
/// Without quadratic drag. Source: docs/theory.md 4.2.
class LinearMotion : public Motion {
 public:
  LinearMotion() = default;

  /// On smooth ground.
  /// @param position          of the centre at tau = 0 [m]
  /// @param twist             at tau = 0
  /// @param contact_velocity  sigma at tau = 0 [m/s]; without drag and spring sigma = that + slipping() tau
  /// exactly
  static LinearMotion free(const Dynamics& dynamics, const Vector2d& position, const Twist& twist,
                           const Vector2d& contact_velocity, const NormalSpin& normal_spin);

  /// Rolling on rough, rubber or coulomb ground without rolling resistance.
  /// @param position  of the centre at tau = 0 [m]
  /// @param velocity  of the centre at tau = 0 [m/s]
  static LinearMotion rolling(const Dynamics& dynamics, const scene::Material& material,
                              const Vector2d& position, const Vector2d& velocity,
                              const NormalSpin& normal_spin);

  MotionState at(double tau) override;
  PointState center(double tau) override { return placed(tau).center; }
  Vector3d angular_velocity(double tau) override;
  int expand_spin(double middle, double half, polynomials::Powers<3>& powers) override;
  double acceleration_bound(double from, double until) override;
  double acceleration_bound_along(const Vector2d& direction, double from, double until) override;

  /// Lets the reaction exceed mu N by a relative 2^-30: for when rounding hides whether friction holds the
  /// sphere. Call it before anything else.
  void loosen() { limit_ *= 1 + 0x1p-30; }

  /// Loss of grip on coulomb ground: the first time after 0 at which the reaction grows beyond mu N; `never`
  /// on other ground. A reaction beyond it at 0 is not detected.
  /// @param horizon  finite [s]
  double end_before(double horizon) override;
  MotionEnd end_reason() const override { return MotionEnd::grip_lost; }
  SpinProfile spin_profile() const override;

  /// A time no later than when an exponentially growing motion reaches max_speed.
  double last_time() const override;

  /// lambda/m: acceleration that the ground gives to the rolling sphere; 0 if the sphere is free [m/s^2].
  Vector2d reaction(double tau) const;
  /// Bound on the second derivative of abs(lambda/m)^2 over an interval, on which the search for the loss of
  /// grip relies [m^2/s^6].
  double reaction_bend(double from, double until) const;

  /// Taylor polynomials in (tau - from)/width.
  struct Expansion {
    double from;           ///< [s]
    double inverse_width;  ///< [1/s]
    /// Of x, x' and x'' of the centre, and of the two parts of Decay.
    polynomials::Powers<8> powers;
  };
  /// To rounding for x up to 0.7/(width fastest_rate()).
  /// @param from  where the motion is evaluated [s]
  Expansion expand(double from, double width) const;
  MotionState at(const Expansion& expansion, double tau) const;
  /// The greatest modulus of the exponents of the motion; 0 for a parabola [1/s].
  double fastest_rate() const;

  Curve curve() const override;
  /// Period of the angular velocity, `never` if it has none [s].
  double period() const;
  /// Whether the angular velocity is constant.
  bool steady() const;

 private:
  // x and x' of the centre, with the response that gave them.
  struct Shifted {
    PointState center;
    Complex shift;
  };

  // lambda/m, a linear function of x and x', and its first two derivatives.
  struct Reaction {
    Complex value;
    Complex slope;
    Complex bend;
    Complex jerk;
  };

  Shifted placed(double tau) const;
  Shifted placed_on_parabola(double tau) const;
  double modal_bound(const Complex& value, const Complex& slope, double span) const;
  Reaction reaction_at(double tau) const;
  double largest_reaction(double from) const;
  double first_loss(double from, double until) const;
  MotionState state(const PointState& center, const Vector2d& shift, const Decay& decay, double tau) const;
  Vector3d free_spin(const Decay& decay, double tau) const;

  LinearResponse response_;
  Vector2d start_ = Vector2d::Zero();
  Complex velocity_ = 0;      // v_0
  Complex drive_ = 0;         // a
  double drive_size_ = 0;     // of the terms of a
  Complex acceleration_ = 0;  // beta v_0 + a
  NormalSpin normal_spin_;
  double rotational_drag_ = 0;  // of a free sphere; of a rolling one, what slows omega_3 [1/s]
  double radius_ = 1;

  bool rolling_ = false;
  // Free.
  Vector2d contact_velocity_ = Vector2d::Zero();
  Complex slipping_ = 0;
  bool slip_is_own_ = true;                  // sigma' = slipping - rotational_drag sigma
  Vector2d planar_spin_ = Vector2d::Zero();  // (omega_1, omega_2) at the start
  Vector2d spin_rate_ = Vector2d::Zero();    // their derivatives without drag
  // Rolling: u = belt + W J (arm + x).
  Vector2d belt_ = Vector2d::Zero();
  Vector2d arm_ = Vector2d::Zero();  // from the turntable's centre to the start
  double turntable_rate_ = 0;
  // lambda/m = per_velocity v + per_shift x + constant; it may be as large as limit.
  Complex per_velocity_ = 0;
  Complex per_shift_ = 0;
  Complex constant_reaction_ = 0;
  double limit_ = never;
  double held_until_ = 0;  // grip is known to last until then
  double grip_lost_ = never;
};

}  // namespace hybrid_sphere

#pragma once

#include "integration/flow.hpp"
#include "sphere/dynamics.hpp"

namespace hybrid_sphere::numeric {

/// State of a motion that is integrated numerically, as a function of the integration variable x:
///   0, 1  v where the sphere is free or rolls [m/s]; w where dry friction acts: the slip s, or nu [m/s]
///   2, 3  d = r - r_0, displacement of the centre since the beginning of the segment [m]
///   4, 5  p_c [m/s], only while sliding with drag or a spring; nu [m/s] while turning against a resistance
///         besides
///   6     tau, time since the beginning of the segment [s]
///   7     0
using State = integration::FlowState;

/// The vector of components i and i + 1.
inline Vector2d pair(const State& y, Eigen::Index i) { return Vector2d::Map(y.data() + i); }
inline void set_pair(State& y, Eigen::Index i, const Vector2d& v) { Vector2d::Map(y.data() + i) = v; }
inline Vector2d displacement(const State& y) { return pair(y, 2); }
inline double time_of(const State& y) { return y[6]; }

/// The dry friction that the equations of a segment contain.
enum class EquationForm {
  free,              ///< nothing
  rolling,           ///< sigma = u(r), no resistance
  sliding,           ///< dry friction against the slip: w = s
  resisted_rolling,  ///< sigma = u(r), dry resistance against rolling: w = nu
  skidding,  ///< dry friction against the slip, w = s, of a sphere that a resistance keeps from turning
  resisted_sliding,  ///< dry friction against the slip, w = s, and a dry resistance against turning, w_2 = nu
};

/// Velocities and forcing that a state represents.
struct Instant {
  Vector2d velocity;  ///< v [m/s]
  Vector2d nu;        ///< nu [m/s]; 0 where the sphere is free, where nothing depends on it
  Vector2d force;     ///< f(r, v) [m/s^2]
  Vector2d spin;      ///< g(nu) [m/s^2]
  Vector2d forcing;   ///< B: v' = B where there is no dry friction, else w' = B - A w/|w| [m/s^2]
};

/// A vector that dry friction uses up: w' = drive - decay w/|w|.
struct DryVector {
  Vector2d w;      ///< [m/s]
  Vector2d e;      ///< w/|w|, or at w = 0 the direction in which it begins or is held
  Vector2d drive;  ///< [m/s^2]
  double decay;    ///< [m/s^2]
  double coupled;  ///< part of the drive that turns with the other vector [m/s^2]
};

/// Equations of motion of one segment, autonomous in x. Without dry friction x is the time. With it
/// dx = dt/|w|, so that
///   dw/dx = |w| B - A w,   dtau/dx = |w|,   dd/dx = |w| v
/// is smooth all the way to w = 0, which is reached for x to infinity. With both slip and rolling
///   s'  = f - g - W J v - A s/|s| + a nu/|nu|,     nu' = g + (1 - kappa) A s/|s| - a nu/|nu|
/// a = A_r/kappa, and dx = dt (1/|s| + 1/|nu|), or dt/|nu| where A = 0. Source: docs/theory.md 4.6, 4.8.
class Equations final : public integration::Flow {
 public:
  Equations(EquationForm form, const Dynamics& dynamics, const scene::Material& ground,
            const Vector2d& start);

  /// Initial p_c; must be set for a sliding motion.
  void set_momentum(const Vector2d& p_c) { momentum_ = p_c; }

  EquationForm form() const { return form_; }
  /// With the spring's centre relative to the start.
  const Dynamics& dynamics() const { return dynamics_; }
  double turntable_rate() const { return rate_; }
  /// Whether w/|w| appears in the equations.
  bool is_dry() const { return form_ != EquationForm::free && form_ != EquationForm::rolling; }
  /// A, the rate at which dry friction uses up w; 0 without it [m/s^2].
  double decay() const { return decay_; }
  /// a, the rate at which the resistance uses up nu beside a slip; 0 in any other form [m/s^2].
  double roll_decay() const { return roll_decay_; }
  /// Bound on the acceleration by all dry friction [m/s^2].
  double decays() const override { return decay_ + roll_decay_; }
  /// Deceleration of the centre by dry friction, |v' part along w| [m/s^2].
  double center_decay() const {
    const bool turns = form_ == EquationForm::sliding || form_ == EquationForm::resisted_sliding;
    return turns ? dynamics_.kappa * decay_ : decay_;
  }
  /// Whether friction acts against the slip.
  bool slides() const {
    return form_ == EquationForm::sliding || form_ == EquationForm::skidding ||
           form_ == EquationForm::resisted_sliding;
  }
  /// Whether dry friction acts against the velocity of the centre itself, w = v: rolling or skidding on
  /// ground at rest.
  bool holds_velocity() const {
    const bool held = form_ == EquationForm::resisted_rolling || form_ == EquationForm::skidding;
    return held && rate_ == 0 && ground_.isZero(0);
  }
  /// Whether p_c is affine in time, so that it is not an unknown.
  bool momentum_is_affine() const { return affine_; }

  /// State at x = 0 with the given v or w.
  State start(const Vector2d& rate) const;
  /// The same with both slip and rolling.
  State start(const Vector2d& slip, const Vector2d& nu) const;
  State derivative(const State& y) const override;
  double first_step(const State& y, double tolerance, double longest) const override;
  double step_of_time(const State& y, double duration) const override;
  double max_step(const State& y, double allowed_speed_error) const override;
  double max_explicit_step(const State& y, double allowed_speed_error) const override;
  bool is_stiff_by_drag(const State& y, double step) const override;
  bool is_stiff_by_friction(const State& y, double step) const override;
  Instant instant(const State& y) const;

  /// u(r_0 + d)
  Vector2d ground(const Vector2d& d) const { return ground_ + rate_ * turned(d); }
  /// Unit vector w/|w|. At w = 0 that of the motion that begins there, or B/A where friction holds w at 0.
  Vector2d direction(const State& y, const Instant& now) const;
  /// The vectors that dry friction can use up: slip or nu, or both.
  int dry_vectors() const { return form_ == EquationForm::resisted_sliding ? 2 : is_dry() ? 1 : 0; }
  DryVector dry_vector(int i, const State& y, const Instant& now) const;
  /// v' [m/s^2]
  Vector2d acceleration(const State& y, const Instant& now) const;
  /// dtau/dx
  double pace(const State& y) const {
    if (form_ == EquationForm::resisted_sliding) return resisted_sliding_pace(y);
    return is_dry() ? pair(y, 0).norm() : 1;
  }
  /// d^2tau/dx^2 over dtau/dx
  double pace_rate(const State& y, const State& rate) const;

 private:
  Instant sliding(const State& y) const;
  Instant rolling(const Vector2d& d, const Vector2d& velocity, const Vector2d& nu) const;
  Instant resisted_sliding(const Vector2d& d, const Vector2d& slip, const Vector2d& nu) const;
  State resisted_sliding_derivative(const State& y, const Instant& now) const;
  double resisted_sliding_pace(const State& y) const;
  /// s/|s| and nu/|nu|, or at 0 the directions in which they begin or are held.
  struct Directions {
    Vector2d slip;
    Vector2d nu;
  };
  Directions directions(const State& y, const Instant& now) const;

  EquationForm form_;
  Dynamics dynamics_;
  double rate_;
  Vector2d ground_;
  double decay_;
  double roll_decay_;
  bool affine_;
  Vector2d momentum_ = Vector2d::Zero();
};

/// Direction in which friction acts at w = 0: that of B, in which w begins to grow, or B/A as long as
/// friction holds.
inline Vector2d direction_at_rest(const Vector2d& forcing, double decay) {
  const double length = std::max(forcing.norm(), decay);
  return length == 0 ? Vector2d(Vector2d::Zero()) : Vector2d(forcing / length);
}

}  // namespace hybrid_sphere::numeric

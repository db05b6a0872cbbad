#include "motion/dry_friction_motion.hpp"

#include <cmath>

namespace hybrid_sphere {
namespace {

// More than the rounding of a bound that is a few sums and products.
constexpr double slip_bound_margin = 1 + 0x1p-48;

}  // namespace

DryFrictionMotion DryFrictionMotion::sliding(const Dynamics& dynamics, const scene::Material& material,
                                             const Vector2d& position, const Vector2d& conserved_velocity,
                                             const Vector2d& slip, const NormalSpin& normal_spin) {
  const double decay = dynamics.slip_decay(material.friction);
  DryFrictionMotion motion;
  motion.friction_ = DryFriction(slip, dynamics.slipping(), decay);
  motion.normal_spin_ = normal_spin;
  motion.radius_ = dynamics.radius;
  motion.start_ = position;
  motion.ground_ = material.belt;
  motion.steady_velocity_ = conserved_velocity + dynamics.kappa * material.belt;
  motion.steady_acceleration_ = dynamics.rolling();
  motion.share_ = dynamics.kappa;
  motion.law_ = Law::sliding;
  motion.pull_ = dynamics.free;
  motion.hold_ = dynamics.kappa * decay;
  return motion;
}

DryFrictionMotion DryFrictionMotion::skidding(const Dynamics& dynamics, const scene::Material& material,
                                              const Vector2d& position, const Vector2d& slip,
                                              const NormalSpin& normal_spin) {
  const double decay = dynamics.center_decay(material.friction);
  DryFrictionMotion motion;
  motion.friction_ = DryFriction(slip, dynamics.free, decay);
  motion.normal_spin_ = normal_spin;
  motion.radius_ = dynamics.radius;
  motion.start_ = position;
  motion.ground_ = material.belt;
  motion.steady_velocity_ = material.belt;
  motion.law_ = Law::skidding;
  motion.pull_ = dynamics.free;
  motion.hold_ = decay;
  return motion;
}

DryFrictionMotion DryFrictionMotion::rolling(const Dynamics& dynamics, const scene::Material& material,
                                             const Vector2d& position, const Vector2d& nu,
                                             const NormalSpin& normal_spin) {
  const double decay = dynamics.roll_decay(material.rolling_resistance);
  DryFrictionMotion motion;
  motion.friction_ = DryFriction(nu, dynamics.rolling(), decay);
  motion.normal_spin_ = normal_spin;
  motion.radius_ = dynamics.radius;
  motion.start_ = position;
  motion.ground_ = material.belt;
  motion.steady_velocity_ = material.belt;
  motion.pull_ = dynamics.rolling();
  motion.hold_ = decay;
  return motion;
}

PointState DryFrictionMotion::placed(const DryFriction::Value& now, double tau) const {
  return {start_ + (tau * (steady_velocity_ + 0.5 * tau * steady_acceleration_) + share_ * now.integral),
          steady_velocity_ + tau * steady_acceleration_ + share_ * now.value,
          steady_acceleration_ + share_ * now.derivative};
}

MotionState DryFrictionMotion::state(const DryFriction::Value& now, double tau) const {
  MotionState state{placed(now, tau), ground_, Vector3d::Zero()};
  Vector2d nu = now.value;
  if (law_ != Law::rolling) {
    state.contact_velocity += now.value;
    nu = law_ == Law::skidding ? Vector2d(0, 0) : Vector2d(state.center.velocity - state.contact_velocity);
  }
  state.angular_velocity = {(0 - nu.y()) / radius_, nu.x() / radius_, normal_spin_.at(tau)};
  return state;
}

/// nu' where w' is that.
Vector2d DryFrictionMotion::nu_rate(const Vector2d& w_rate) const {
  if (law_ == Law::skidding) return Vector2d::Zero();
  return law_ == Law::rolling ? w_rate : Vector2d(steady_acceleration_ - (1 - share_) * w_rate);
}

Vector3d DryFrictionMotion::spin_of(const Vector2d& nu, double normal) const {
  return {-nu.y() / radius_, nu.x() / radius_, normal};
}

int DryFrictionMotion::expand_spin(double middle, double half, polynomials::Powers<3>& powers) {
  const DryFriction::Value now = friction_.at(middle);
  const Vector3d spin = state(now, middle).angular_velocity;
  if (friction_.straight() || law_ == Law::skidding) {
    const Vector2d rate = nu_rate(friction_.start_derivative());
    return expand_linear_spin(spin, spin_of(rate, normal_spin_.derivative(middle)), half, powers);
  }
  set_spin(spin, friction_.expand(now, half), middle, half, powers);
  return polynomials::size;
}

/// The powers of the angular velocity from those of w.
/// @param now  at tau
void DryFrictionMotion::set_spin(const Vector3d& now, const polynomials::Powers<2>& w, double tau,
                                 double width, polynomials::Powers<3>& powers) const {
  const double part = law_ == Law::rolling ? 1 : share_ - 1;
  powers.setZero();
  powers.col(0) = now;
  for (int k = 1; k < polynomials::size && law_ != Law::skidding; ++k)
    powers.col(k) = spin_of(part * Vector2d(w(0, k), w(1, k)), 0);
  powers.col(1) += width * spin_of(nu_rate(Vector2d::Zero()), normal_spin_.derivative(tau));
}

StatePolynomial DryFrictionMotion::expand(double from, double width) {
  const DryFriction::Value value = friction_.at(from);
  const MotionState now = state(value, from);
  const polynomials::Powers<2> w = friction_.expand(value, width);
  StatePolynomial expansion{from, width, now.center.position};
  polynomials::Powers<12>& powers = expansion.powers;
  polynomials::Powers<3> spin;
  set_spin(now.angular_velocity, w, from, width, spin);
  for (int i = 0; i < 2; ++i) {
    for (int k = 0; k < polynomials::size; ++k) powers(2 + i, k) = share_ * w(i, k);
    powers(2 + i, 0) = now.center.velocity[i];
    powers(2 + i, 1) += width * steady_acceleration_[i];
    for (int k = 1; k < polynomials::size; ++k) {
      powers(i, k) = width / k * powers(2 + i, k - 1);
      powers(4 + i, k - 1) = k / width * powers(2 + i, k);
      if (law_ != Law::rolling) powers(6 + i, k) = w(i, k);
    }
    powers(6 + i, 0) = now.contact_velocity[i];
  }
  for (int k = 0; k < polynomials::size; ++k) {
    for (int i = 0; i < 3; ++i) powers(8 + i, k) = spin(i, k);
  }
  return expansion;
}

double DryFrictionMotion::acceleration_bound(double /*from*/, double /*until*/) {
  if (friction_.straight()) return curve().acceleration.norm() * slip_bound_margin;
  return (pull_.norm() + hold_) * slip_bound_margin;
}

double DryFrictionMotion::acceleration_bound_along(const Vector2d& direction, double /*from*/,
                                                   double /*until*/) {
  const double size = direction.norm();
  const double rounding = 0x1p-48 * (pull_.norm() + hold_) * size;
  if (friction_.straight()) return std::abs(curve().acceleration.dot(direction)) + rounding;
  return std::abs(pull_.dot(direction)) + hold_ * size + rounding;
}

Curve DryFrictionMotion::curve() const {
  Curve curve;
  const PointState begin = placed(friction_.at(0), 0);
  curve.form = friction_.straight() ? CurveForm::parabola : CurveForm::general;
  curve.start = start_;
  // A slope that just needs the friction that there is pulls the sphere over no edge.
  curve.acceleration =
      friction_.straight() ? without_rounding(begin.acceleration, pull_.norm() + hold_) : begin.acceleration;
  // Straight to rounding, too: w then turns only where it is lost against all else.
  const Vector2d& drive = friction_.drive();
  const double speed = steady_velocity_.norm() + friction_.start().norm();
  curve.velocity = without_rounding(first_velocity_.value_or(begin.velocity), speed);
  const Vector2d line = line_of(curve.velocity, curve.acceleration, pull_.norm() + hold_);
  const bool straight = parallel(line, friction_.start(), speed) && parallel(line, steady_velocity_, speed) &&
                        parallel(line, drive, drive.norm() + pull_.norm()) &&
                        parallel(line, steady_acceleration_, drive.norm() + pull_.norm());
  if (straight) curve.line = line;
  if (curve.velocity.isZero(0)) curve.line_size = pull_.norm() + hold_;
  return curve;
}

bool DryFrictionMotion::steady() const {
  if (!normal_spin_.constant()) return false;
  if (law_ == Law::skidding) return true;
  if (!friction_.straight()) return false;
  const Vector2d& change = friction_.start_derivative();
  return law_ == Law::sliding ? steady_acceleration_ == (1 - share_) * change : change.isZero(0);
}

SpinProfile DryFrictionMotion::spin_profile() const {
  const DryFriction::Corner corner = friction_.corner();
  SpinProfile profile;
  profile.kink = normal_spin_.kink();
  profile.end = end();
  profile.constant = steady();
  profile.linear = friction_.straight() || law_ == Law::skidding;
  profile.corner = corner.time;
  profile.corner_width = corner.width;
  return profile;
}

}  // namespace hybrid_sphere

#include "motion/straight_slide.hpp"

#include <cfloat>
#include <cmath>

#include "sphere/contact_mode.hpp"

namespace hybrid_sphere {
namespace {

// More than the rounding of a bound that is a few sums and products.
constexpr double speed_bound_margin = 1 + 0x1p-48;

/// A vector under a constant rate that does not turn it.
class Line {
 public:
  /// @param noise  of the rate [m/s^2]
  Line(const Vector2d& start, const Vector2d& rate, double noise) : rate_(rate) {
    const double size = stable_norm(start);
    if (size == 0) return;
    const Vector2d along = start / size;
    turns_ = std::abs(turned(along).dot(rate)) > noise;
    const double growth = along.dot(rate);
    rate_ = growth * along;
    if (growth < 0) end_ = size / -growth;
  }
  bool turns() const { return turns_; }
  const Vector2d& rate() const { return rate_; }
  double end() const { return end_; }

 private:
  Vector2d rate_;
  bool turns_ = false;
  double end_ = never;
};

}  // namespace

std::optional<StraightSlide> StraightSlide::from(const Dynamics& dynamics, const scene::Material& material,
                                                 const Vector2d& position, const Vector2d& slip,
                                                 const Vector2d& nu, const NormalSpin& normal_spin) {
  const bool changes = dynamics.has_drag() || dynamics.quadratic_drag != 0 || dynamics.spring_rate != 0;
  if (changes || material.turntable_rate != 0) return std::nullopt;
  const ContactForces forces(dynamics, material, position, slip + nu + material.belt, nu);
  const ContactResponse response = contact_response(forces, slip, nu);
  if (response.mode != ContactMode::sliding) return std::nullopt;
  const double decays =
      dynamics.slip_decay(material.friction) + dynamics.spinning_decay(material.rolling_resistance);
  const double noise = 8 * DBL_EPSILON * (forces.drive_size + forces.spin.norm() + decays);
  const Line roll(nu, response.roll_rate, noise);
  // Without friction the slip is a vector as any other.
  const bool rubs = material.friction > 0;
  const Line slide(rubs ? slip : Vector2d(Vector2d::Zero()), response.slip_rate, noise);
  if (roll.turns() || slide.turns()) return std::nullopt;
  StraightSlide motion;
  motion.normal_spin_ = normal_spin;
  motion.radius_ = dynamics.radius;
  motion.start_ = position;
  motion.ground_ = material.belt;
  motion.slip_ = slip;
  motion.slip_rate_ = slide.rate();
  motion.slip_end_ = slide.end();
  motion.nu_ = nu;
  motion.roll_rate_ = roll.rate();
  motion.roll_end_ = roll.end();
  return motion;
}

MotionState StraightSlide::at(double tau) {
  const Vector2d slip = tau >= slip_end_ ? Vector2d(0, 0) : Vector2d(slip_ + tau * slip_rate_);
  const Vector2d nu = tau >= roll_end_ ? Vector2d(0, 0) : Vector2d(nu_ + tau * roll_rate_);
  const Vector2d velocity = ground_ + slip_ + nu_;
  const Vector2d acceleration = slip_rate_ + roll_rate_;
  MotionState state;
  state.center = {start_ + tau * (velocity + 0.5 * tau * acceleration), ground_ + slip + nu, acceleration};
  state.contact_velocity = ground_ + slip;
  state.angular_velocity = {(0 - nu.y()) / radius_, nu.x() / radius_, normal_spin_.at(tau)};
  return state;
}

int StraightSlide::expand_spin(double middle, double half, polynomials::Powers<3>& powers) {
  const Vector2d rate = middle >= roll_end_ ? Vector2d(0, 0) : roll_rate_;
  const double normal = normal_spin_.derivative(middle);
  return expand_linear_spin(at(middle).angular_velocity, {-rate.y() / radius_, rate.x() / radius_, normal},
                            half, powers);
}

double StraightSlide::acceleration_bound(double /*from*/, double /*until*/) {
  return (slip_rate_ + roll_rate_).norm() * speed_bound_margin;
}

double StraightSlide::acceleration_bound_along(const Vector2d& direction, double /*from*/, double /*until*/) {
  const Vector2d acceleration = slip_rate_ + roll_rate_;
  return std::abs(acceleration.dot(direction)) + 0x1p-48 * acceleration.norm() * direction.norm();
}

Curve StraightSlide::curve() const {
  Curve curve;
  curve.form = CurveForm::parabola;
  curve.start = start_;
  curve.velocity = without_rounding(first_velocity_.value_or(ground_ + slip_ + nu_),
                                    ground_.norm() + slip_.norm() + nu_.norm());
  curve.acceleration = without_rounding(slip_rate_ + roll_rate_, slip_rate_.norm() + roll_rate_.norm());
  const double size = slip_rate_.norm() + roll_rate_.norm();
  curve.line = line_of(curve.velocity, curve.acceleration, size);
  if (curve.velocity.isZero(0)) curve.line_size = size;
  return curve;
}

SpinProfile StraightSlide::spin_profile() const {
  SpinProfile profile;
  profile.kink = normal_spin_.kink();
  profile.end = end();
  profile.constant = steady();
  profile.linear = true;
  return profile;
}

}  // namespace hybrid_sphere

#include "motion/linear_motion.hpp"

#include <algorithm>

namespace hybrid_sphere {
namespace {

constexpr double two_pi = 6.283185307179586;

// More than the rounding of a bound that is a few sums and products.
constexpr double bound_margin = 1 + 0x1p-45;

double growth_over(double rate, double span) { return rate > 0 ? std::exp(rate * span) : 1; }

/// Of the terms of f(r, 0); of a spring's, as far away as it lets the sphere come, where its place was
/// rounded.
double drive_size(const Dynamics& dynamics, const Vector2d& position, double speed) {
  return dynamics.free.norm() + dynamics.spring_rate * (position.norm() + dynamics.spring_center.norm()) +
         std::sqrt(dynamics.spring_rate) * speed;
}

}  // namespace

LinearMotion LinearMotion::free(const Dynamics& dynamics, const Vector2d& position, const Twist& twist,
                                const Vector2d& contact_velocity, const NormalSpin& normal_spin) {
  LinearMotion motion;
  motion.response_ = LinearResponse(-dynamics.translational_drag, -dynamics.spring_rate);
  motion.start_ = position;
  motion.velocity_ = to_complex(twist.velocity);
  motion.drive_ = to_complex(dynamics.acceleration(position, Vector2d::Zero()));
  motion.drive_size_ = drive_size(dynamics, position, twist.velocity.norm());
  motion.acceleration_ = motion.response_.beta() * motion.velocity_ + motion.drive_;
  motion.normal_spin_ = normal_spin;
  motion.radius_ = dynamics.radius;
  motion.contact_velocity_ = contact_velocity;
  motion.slip_is_own_ = dynamics.spring_rate == 0 && dynamics.translational_drag == dynamics.rotational_drag;
  motion.slipping_ = to_complex(dynamics.slipping());
  motion.planar_spin_ = twist.angular_velocity.head<2>();
  motion.spin_rate_ = turned(dynamics.spin) / dynamics.radius;
  motion.rotational_drag_ = dynamics.rotational_drag;
  return motion;
}

LinearMotion LinearMotion::rolling(const Dynamics& dynamics, const scene::Material& material,
                                   const Vector2d& position, const Vector2d& velocity,
                                   const NormalSpin& normal_spin) {
  const double kappa = dynamics.kappa;
  const double rate = material.turntable_rate;
  const double translational = dynamics.translational_drag;
  const double rotational = dynamics.rotational_drag;
  const Complex force = to_complex(dynamics.acceleration(position, Vector2d::Zero()));
  const Complex torque =
      to_complex(dynamics.spin + rotational * ground_velocity(material, position));  // g where v = 0
  LinearMotion motion;
  motion.response_ = LinearResponse(Complex(-(1 - kappa) * translational - kappa * rotational, kappa * rate),
                                    Complex(-(1 - kappa) * dynamics.spring_rate, kappa * rotational * rate));
  motion.start_ = position;
  motion.velocity_ = to_complex(velocity);
  motion.drive_ = (1 - kappa) * force + kappa * torque;
  motion.drive_size_ = drive_size(dynamics, position, velocity.norm()) + kappa * std::abs(torque);
  motion.acceleration_ = motion.response_.beta() * motion.velocity_ + motion.drive_;
  motion.normal_spin_ = normal_spin;
  motion.radius_ = dynamics.radius;
  motion.rolling_ = true;
  motion.rotational_drag_ = normal_spin.drag();
  motion.belt_ = material.belt;
  motion.arm_ = position - material.turntable_center;
  motion.turntable_rate_ = rate;
  // lambda/m = r'' - f = kappa (W J v + g - f)
  motion.per_velocity_ = kappa * Complex(translational - rotational, rate);
  motion.per_shift_ = kappa * Complex(dynamics.spring_rate, rotational * rate);
  motion.constant_reaction_ = kappa * (torque - force);
  if (material.law == scene::Law::coulomb) {
    motion.limit_ = material.friction * (dynamics.normal_force / dynamics.mass);
  }
  return motion;
}

/// The same numbers as from the response (1, tau, tau^2/2), without complex products.
LinearMotion::Shifted LinearMotion::placed_on_parabola(double tau) const {
  const double half_square = 0.5 * tau * tau;
  const Complex shift(velocity_.real() * tau + drive_.real() * half_square,
                      velocity_.imag() * tau + drive_.imag() * half_square);
  const Vector2d velocity(velocity_.real() + drive_.real() * tau, velocity_.imag() + drive_.imag() * tau);
  return {{start_ + to_vector(shift), velocity, to_vector(acceleration_)}, shift};
}

LinearMotion::Shifted LinearMotion::placed(double tau) const {
  if (response_.beta() == 0.0 && response_.gamma() == 0.0) return placed_on_parabola(tau);
  const Response response = response_.at(tau);
  const Complex shift = times(velocity_, response.impulse) + times(drive_, response.step);
  const Complex velocity = times(velocity_, response.rate) + times(drive_, response.impulse);
  const Complex acceleration =
      times(acceleration_, response.rate) + times(times(response_.gamma(), velocity_), response.impulse);
  return {{start_ + to_vector(shift), to_vector(velocity), to_vector(acceleration)}, shift};
}

double LinearMotion::fastest_rate() const {
  return std::max(std::abs(response_.larger_root()), rotational_drag_);
}

// Bound on a solution of y'' = beta y' + gamma y over a time, the sum of its two modes; infinite or NaN where
// the roots coincide.
double LinearMotion::modal_bound(const Complex& value, const Complex& slope, double span) const {
  const Complex& larger = response_.larger_root();
  const Complex& smaller = response_.smaller_root();
  const double apart = std::abs(larger - smaller);
  return growth_over(response_.growth(), span) *
         (std::abs(slope - smaller * value) + std::abs(slope - larger * value)) / apart * bound_margin;
}

double LinearMotion::acceleration_bound(double from, double until) {
  const Complex& beta = response_.beta();
  const Complex& gamma = response_.gamma();
  if (gamma == 0.0) return std::abs(acceleration_) * std::exp(beta.real() * from) * bound_margin;
  const double span = until - from;
  const PointState now = center(from);
  const Complex velocity = to_complex(now.velocity);
  const Complex acceleration = to_complex(now.acceleration);
  const double modal = modal_bound(acceleration, beta * acceleration + gamma * velocity, span);
  const double near = growth_over(response_.growth(), span) *
                      ((1 + std::abs(response_.smaller_root()) * span) * std::abs(acceleration) +
                       std::abs(gamma) * std::abs(velocity) * span) *
                      bound_margin;
  const double bound = near < modal ? near : modal;
  return std::isnan(bound) ? near : bound;
}

double LinearMotion::acceleration_bound_along(const Vector2d& direction, double from, double until) {
  const Complex& beta = response_.beta();
  const Complex& gamma = response_.gamma();
  const bool turns = beta.imag() != 0 || gamma.imag() != 0;
  if (turns) return direction.norm() * acceleration_bound(from, until);
  // Each component obeys the equation by itself. The margin is for the rounding of the scalar products.
  const auto along = [&](const Vector2d& v) {
    return std::abs(v.dot(direction)) + 0x1p-51 * v.cwiseAbs().dot(direction.cwiseAbs());
  };
  if (gamma == 0.0) return along(to_vector(acceleration_)) * std::exp(beta.real() * from);
  const double span = until - from;
  const PointState now = center(from);
  return growth_over(response_.growth(), span) *
         ((1 + std::abs(response_.smaller_root()) * span) * along(now.acceleration) +
          std::abs(gamma) * along(now.velocity) * span) *
         bound_margin;
}

Curve LinearMotion::curve() const {
  Curve curve;
  curve.start = start_;
  curve.velocity = to_vector(velocity_);
  curve.acceleration = to_vector(acceleration_);
  const Complex& beta = response_.beta();
  const bool turns = beta.imag() != 0 || response_.gamma().imag() != 0;
  if (!turns) curve.line = line_of(curve.velocity, to_vector(drive_), drive_size_);
  if (curve.velocity.isZero(0)) curve.line_size = drive_size_;
  if (response_.gamma() != 0.0) return curve;
  if (beta == 0.0) {
    curve.form = CurveForm::parabola;
  } else if (beta.real() == 0 && drive_ == 0.0) {
    curve.form = CurveForm::arc;
    curve.rate = beta.imag();
    curve.arm = -turned(curve.velocity) / curve.rate;
    curve.orbit_center = start_ - curve.arm;
  }
  return curve;
}

double LinearMotion::period() const {
  const bool circles = curve().form == CurveForm::arc && normal_spin_.constant();
  return circles ? two_pi / std::abs(response_.beta().imag()) : never;
}

// v = c_1 e^(l_1 tau) + c_2 e^(l_2 tau), both less than `most` to begin with.
double LinearMotion::last_time() const {
  const double growth = response_.growth();
  if (growth == 0) return never;
  const Complex& larger = response_.larger_root();
  const double apart = std::abs(larger - response_.smaller_root());
  const double most = 2 * (std::abs(velocity_) * std::abs(larger) + std::abs(acceleration_)) / apart;
  return most > 0 ? std::max(0.0, std::log(max_speed / most)) / growth : never;
}

bool LinearMotion::steady() const {
  if (!normal_spin_.constant()) return false;
  if (!rolling_) return spin_rate_ == rotational_drag_ * planar_spin_;
  const bool uniform = acceleration_ == 0.0 && response_.gamma() * velocity_ == 0.0;
  return uniform && (turntable_rate_ == 0 || velocity_ == 0.0);
}

SpinProfile LinearMotion::spin_profile() const {
  SpinProfile profile;
  profile.kink = normal_spin_.kink();
  profile.period = period();
  profile.constant = steady();
  profile.linear = (rolling_ ? fastest_rate() : rotational_drag_) == 0;
  profile.end = last_time();
  if (rolling_) {
    profile.frequency =
        std::max(std::abs(response_.larger_root().imag()), std::abs(response_.smaller_root().imag()));
  }
  return profile;
}

}  // namespace hybrid_sphere

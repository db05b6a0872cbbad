// The state of a linear motion at a time, directly and by Taylor polynomials.
#include "motion/linear_motion.hpp"

namespace hybrid_sphere {

inline Vector3d LinearMotion::free_spin(const Decay& decay, double tau) const {
  const Vector2d planar = decay.part * planar_spin_ + decay.time * spin_rate_;
  return {planar.x(), planar.y(), normal_spin_.at(tau, decay)};
}

inline MotionState LinearMotion::state(const PointState& center, const Vector2d& shift, const Decay& decay,
                                       double tau) const {
  if (rolling_) {
    Vector2d contact_velocity = belt_;
    if (turntable_rate_ != 0) contact_velocity += turntable_rate_ * turned(arm_ + shift);
    const Vector2d nu = center.velocity - contact_velocity;
    return {
        center, contact_velocity, {(0 - nu.y()) / radius_, nu.x() / radius_, normal_spin_.at(tau, decay)}};
  }
  const Vector3d omega = free_spin(decay, tau);
  if (slip_is_own_) {
    return {center, decay.part * contact_velocity_ + decay.time * to_vector(slipping_), omega};
  }
  return {center, center.velocity - radius_ * Vector2d(omega.y(), -omega.x()), omega};
}

MotionState LinearMotion::at(double tau) {
  const Shifted now = placed(tau);
  return state(now.center, to_vector(now.shift), decay_at(rotational_drag_, tau), tau);
}

Vector3d LinearMotion::angular_velocity(double tau) {
  return rolling_ ? at(tau).angular_velocity : free_spin(decay_at(rotational_drag_, tau), tau);
}

/// With x' = v and v' = beta v + gamma x + a, each coefficient follows from the one before it. The
/// acceleration at the beginning is not that sum, in which all may cancel.
LinearMotion::Expansion LinearMotion::expand(double from, double width) const {
  const Shifted start = placed(from);
  const Complex& beta = response_.beta();
  const Complex& gamma = response_.gamma();
  const bool turns = beta.imag() != 0 || gamma.imag() != 0;
  Vector2d shift = to_vector(start.shift);
  Vector2d velocity = start.center.velocity;
  Vector2d acceleration = start.center.acceleration;
  Decay decay = decay_at(rotational_drag_, from);
  Expansion expansion{from, 1 / width, {}};
  for (int n = 0;;) {
    auto now = expansion.powers.col(n);
    now.segment<2>(0) = shift;
    now.segment<2>(2) = velocity;
    now.segment<2>(4) = acceleration;
    now[6] = decay.part;
    now[7] = decay.time;
    if (++n == polynomials::size) return expansion;
    const double step = width / n;
    shift = step * velocity;
    velocity = step * acceleration;
    acceleration = beta.real() * velocity + gamma.real() * shift;
    if (turns) acceleration += beta.imag() * turned(velocity) + gamma.imag() * turned(shift);
    decay = {-rotational_drag_ * (step * decay.part), step * decay.part};
  }
}

MotionState LinearMotion::at(const Expansion& expansion, double tau) const {
  const auto now = polynomials::values<8>(expansion.powers, (tau - expansion.from) * expansion.inverse_width);
  const Vector2d shift = now.head<2>();
  return state({start_ + shift, now.segment<2>(2), now.segment<2>(4)}, shift, {now[6], now[7]}, tau);
}

int LinearMotion::expand_spin(double middle, double half, polynomials::Powers<3>& powers) {
  const double rate = rolling_ ? fastest_rate() : rotational_drag_;
  if (rate == 0) {
    const Vector2d nu_rate = to_vector(drive_);
    const Vector2d planar = rolling_ ? Vector2d(Vector2d(-nu_rate.y(), nu_rate.x()) / radius_) : spin_rate_;
    return expand_linear_spin(angular_velocity(middle),
                              {planar.x(), planar.y(), normal_spin_.derivative(middle)}, half, powers);
  }
  if (rate * half > 1) return 0;
  const Expansion expansion = expand(middle, half);
  double spin = normal_spin_.at(middle);
  for (int n = 0; n < polynomials::size; ++n) {
    const auto now = expansion.powers.col(n);
    if (rolling_) {
      Vector2d nu = now.segment<2>(2) - turntable_rate_ * turned(now.head<2>());
      if (n == 0) nu -= belt_ + turntable_rate_ * turned(arm_);
      powers.col(n) = Vector3d(-nu.y() / radius_, nu.x() / radius_, spin);
    } else {
      powers.col(n).head<2>() = now[6] * planar_spin_ + now[7] * spin_rate_;
      powers(2, n) = spin;
    }
    spin = n == 0 ? half * normal_spin_.derivative(middle) : normal_spin_.next_power(n, spin, half);
  }
  return polynomials::size;
}

}  // namespace hybrid_sphere

#include "own_motion.hpp"

#include <algorithm>
#include <cmath>

namespace hybrid_sphere::fuzz::own {
namespace {

Vec2 wide(const Vector2d& v) { return v.cast<Real>(); }

Vec2 quarter_turn(const Vec2& v) { return {-v.y(), v.x()}; }

/// Minimiser of abs(x - a)^2/2 + limit abs(x).
Vec2 shrunk(const Vec2& a, Real limit) {
  const Real length = a.norm();
  if (!(length > limit)) return Vec2::Zero();
  return (1 - limit / length) * a;
}

Vec2 unit(const Vec2& v) {
  const Real length = v.norm();
  return length > 0 ? Vec2(v / length) : Vec2(Vec2::Zero());
}

Vec4 rate_of(const Vec4& q, const Vec3& w) {
  const Vec3 u = q.head<3>();
  Vec4 rate;
  rate.head<3>() = (q.w() * w + w.cross(u)) / 2;
  rate.w() = -w.dot(u) / 2;
  return rate;
}

}  // namespace

Mechanics::Mechanics(const scene::SphereBody& sphere, const scene::Forces& forces)
    : mass_(sphere.mass),
      radius_(sphere.radius),
      inertia_(mass_ * sphere.gyration_radius * sphere.gyration_radius),
      rolling_mass_(inertia_ / (radius_ * radius_)),
      normal_force_(-mass_ * forces.gravity.z()),
      forces_(forces) {}

void Mechanics::stand_on(const scene::Material& material) {
  material_ = material;
  slip_limit_ = material.law == scene::Law::smooth    ? 0
                : material.law == scene::Law::coulomb ? material.friction * normal_force_
                                                      : infinite;
  const bool touches = slip_limit_ > 0;
  roll_limit_ = touches ? material.rolling_resistance * normal_force_ : 0;
  spin_limit_ = touches ? material.spin_friction * radius_ * normal_force_ : 0;
}

Vec2 Mechanics::ground_velocity(const Vec2& r) const {
  return wide(material_.belt) + material_.turntable_rate * quarter_turn(r - wide(material_.turntable_center));
}

Vec2 Mechanics::turning(const Vec2& v) const { return material_.turntable_rate * quarter_turn(v); }

Vec2 Mechanics::slip(const Body& body) const { return body.v - nu(body) - ground_velocity(body.r); }

Vec2 Mechanics::force(const Body& body) const {
  const Vec2 gravity = wide(Vector2d(forces_.gravity.head<2>()));
  const Real speed = body.v.norm();
  return mass_ * gravity + wide(forces_.wrench.force) -
         (forces_.drag.translational + forces_.drag.quadratic * speed) * body.v -
         forces_.spring.stiffness * (body.r - wide(forces_.spring.center));
}

Vec3 Mechanics::torque(const Body& body) const {
  return forces_.wrench.torque.cast<Real>() - forces_.drag.rotational * body.w;
}

Real Mechanics::acceleration_scale(const Body& body) const {
  const Real friction = is_ideal() ? 0 : slip_limit_ / mass_ + slip_limit_ / rolling_mass_;
  return force(body).norm() / mass_ + radius_ * torque(body).norm() / inertia_ + friction +
         roll_limit_ / rolling_mass_ + turning(body.v).norm();
}

void Mechanics::strike(Body& body) const {
  const Vec2 impulse = -slip(body) / (1 / mass_ + 1 / rolling_mass_);
  body.v += impulse / mass_;
  body.w.x() += radius_ * impulse.y() / inertia_;
  body.w.y() -= radius_ * impulse.x() / inertia_;
  if (material_.law == scene::Law::rubber) body.w.z() = material_.turntable_rate;
}

// In the plane's vectors: m v' = F + lambda, i nu' = i g - lambda + c, with i g = (tau_2, -tau_1)/R.
Vec2 Mechanics::contact_force(const Body& body, const Hold& hold, const Vec2& resistance) const {
  if (!grips()) return Vec2::Zero();
  const Vec2 carried = mass_ * turning(body.v) - force(body);  // keeps v' = W J v
  if (!hold.slip) return -slip_limit_ * unit(slip(body));
  if (hold.roll) return carried;
  const Vec3 tau = torque(body);
  const Vec2 drive = Vec2(tau.y(), -tau.x()) / radius_ + resistance;
  return (drive / rolling_mass_ + carried / mass_) / (1 / mass_ + 1 / rolling_mass_);
}

Mechanics::Rates Mechanics::rates(const Body& body, const Hold& hold) const {
  const Vec2 resistance = hold.roll ? Vec2(Vec2::Zero()) : Vec2(-roll_limit_ * unit(nu(body)));
  const Vec2 lambda = contact_force(body, hold, resistance);
  const Vec3 tau = torque(body);
  const Vec2 turn = (Vec2(tau.y(), -tau.x()) / radius_ - lambda + resistance) / rolling_mass_;
  Rates rates;
  rates.v = (force(body) + lambda) / mass_;
  rates.w.setZero();
  if (!hold.roll) rates.w = {-turn.y() / radius_, turn.x() / radius_, 0};
  rates.w.z() = spin_rate(body, hold);
  return rates;
}

// Friction keeps its sign within a step: the instant at which the spin comes to 0 is looked for.
Real Mechanics::spin_rate(const Body& body, const Hold& hold) const {
  return hold.spin ? 0 : (torque(body).z() - hold.spin_sign * spin_limit_) / inertia_;
}

int Mechanics::sign_of_spin(const Body& body) const {
  const Real spin = body.w.z() - material_.turntable_rate;
  const Real towards = spin != 0 ? spin : torque(body).z();
  return towards > 0 ? 1 : towards < 0 ? -1 : 0;
}

bool Mechanics::spin_has_passed(const Body& body, const Hold& hold) const {
  return !hold.spin && spin_limit_ > 0 && hold.spin_sign * (body.w.z() - material_.turntable_rate) < 0;
}

// By its dual, whose unknown is the force l with s + n = a - l/m: least where l is free is s = 0, and on the
// circle abs(l) = limit it is found by Newton's method for the angle, downhill.
void Mechanics::least(const Vec2& a, const Vec2& b, Real factor, Vec2& s, Vec2& n) const {
  const Real i = rolling_mass_;
  const Real arm = factor * roll_limit_ / i;
  const Vec2 c = a + i / mass_ * b;
  Vec2 y = mass_ / i * c;
  if (y.norm() > arm) y = (c.norm() + arm) / (1 + i / mass_) * unit(c);
  n = shrunk(y, arm);
  s.setZero();
  const Vec2 free = i * (y - b);
  const Real limit = factor * slip_limit_;
  if (free.norm() <= limit) return;
  const auto dual = [&](const Vec2& e) {
    return limit * limit / (2 * mass_) - limit * e.dot(a) +
           i / 2 * shrunk(b + limit / i * e, arm).squaredNorm();
  };
  Vec2 e = unit(free);
  Real last = 1;
  for (int count = 0; count < 100; ++count) {
    const Vec2 across = quarter_turn(e);
    const Vec2 z = b + limit / i * e;
    n = shrunk(z, arm);
    s = a - limit / mass_ * e - n;
    const Real share = z.norm() > arm ? 1 - arm / z.norm() : 0;
    const Real along = across.dot(unit(z));
    const Real rate =
        limit / mass_ + limit / i * (share > 0 ? share + (1 - share) * along * along : 0) + s.dot(e);
    Real turn = rate > 0 ? s.dot(across) / rate : std::copysign(Real(0.5), s.dot(across));
    turn = std::clamp(turn, Real(-0.5), Real(0.5));
    const auto turned = [&] { return Vec2(std::cos(turn) * e + std::sin(turn) * across); };
    for (int j = 0; j < 30 && std::abs(turn) > 1e-9L && dual(turned()) > dual(e); ++j) turn /= 2;
    // Rounding turns it to and fro in the end.
    if (std::abs(turn) < 1e-19L || (std::abs(turn) < 1e-3L && std::abs(turn) > last / 2)) return;
    last = std::abs(turn);
    e = turned().normalized();
  }
}

Hold Mechanics::decide(const Body& body, const Hold& may) const {
  Hold hold;
  if (!grips()) return hold;
  const Vec3 tau = torque(body);
  const Vec2 g = Vec2(tau.y(), -tau.x()) / (radius_ * rolling_mass_);
  const Vec2 f = force(body) / mass_ - turning(body.v);
  const bool resists = roll_limit_ > 0;
  hold.spin_sign = sign_of_spin(body);
  hold.spin = material_.law == scene::Law::rubber ||
              (may.spin && spin_limit_ > 0 && std::abs(tau.z()) <= spin_limit_);
  if (may.slip && may.roll) {
    Vec2 s;
    Vec2 n;
    least(f, g, 1, s, n);
    hold.slip = s.isZero(0);
    hold.roll = resists && n.isZero(0);
  } else if (may.slip) {
    hold.slip =
        is_ideal() ||
        contact_force(body, {true, false, false}, -roll_limit_ * unit(nu(body))).norm() <= slip_limit_;
  } else if (may.roll) {
    const Vec2 lambda = -slip_limit_ * unit(slip(body));
    hold.roll = resists && (rolling_mass_ * g - lambda).norm() <= roll_limit_;
  }
  return hold;
}

bool Mechanics::can_hold(const Body& body, const Hold& hold) const {
  if (!hold.slip && !hold.roll) return true;
  const Hold still = decide(body, {hold.slip, hold.roll, hold.spin});
  return still.slip == hold.slip && still.roll == hold.roll;
}

bool Mechanics::hardly_holds(const Body& body, const Hold& hold) const {
  Mechanics weaker = *this;
  weaker.slip_limit_ *= 0.99L;
  weaker.roll_limit_ *= 0.99L;
  return !weaker.can_hold(body, hold);
}

Body Mechanics::moved(const Body& from, const Body& slope, const Rates& rates, Real h) const {
  Body to = from;
  to.r += h * slope.v;
  to.v += h * rates.v;
  to.w += h * rates.w;
  to.q += h * rate_of(slope.q, slope.w);
  return to;
}

Body Mechanics::step(const Body& body, const Hold& hold, Real h) const {
  const Rates k1 = rates(body, hold);
  const Body b2 = moved(body, body, k1, h / 2);
  const Rates k2 = rates(b2, hold);
  const Body b3 = moved(body, b2, k2, h / 2);
  const Rates k3 = rates(b3, hold);
  const Body b4 = moved(body, b3, k3, h);
  const Rates k4 = rates(b4, hold);
  Body to = body;
  to.r += h / 6 * (body.v + 2 * b2.v + 2 * b3.v + b4.v);
  to.v += h / 6 * (k1.v + 2 * k2.v + 2 * k3.v + k4.v);
  to.w += h / 6 * (k1.w + 2 * k2.w + 2 * k3.w + k4.w);
  to.q += h / 6 *
          (rate_of(body.q, body.w) + 2 * rate_of(b2.q, b2.w) + 2 * rate_of(b3.q, b3.w) + rate_of(b4.q, b4.w));
  to.q.normalize();
  return to;
}

Body Mechanics::implicit_step(const Body& body, Real h, Real none, Hold& hold) const {
  const Vec3 tau = torque(body);
  const Vec2 f = force(body) / mass_;
  const Vec2 g = Vec2(tau.y(), -tau.x()) / (radius_ * rolling_mass_);
  const Vec2 u = ground_velocity(body.r + h * body.v);
  Vec2 s;
  Vec2 n;
  least(body.v + h * f - u, nu(body) + h * g, h, s, n);
  Body to = body;
  to.r += h / 2 * (body.v + s + n + u);
  to.v = s + n + ground_velocity(to.r);
  to.w.x() = -n.y() / radius_;
  to.w.y() = n.x() / radius_;
  Body half = body;
  half.w.z() += h / 2 * spin_rate(body, hold);
  to.w.z() += h * spin_rate(half, hold);
  hold.slip = s.isZero(0) && (hold.slip || slip(body).norm() > none);
  hold.roll = roll_limit_ > 0 && n.isZero(0) && (hold.roll || nu(body).norm() > none);
  const Vec3 mean = (body.w + to.w) / 2;
  to.q += h * rate_of(Vec4(body.q + h / 2 * rate_of(body.q, mean)), mean);
  to.q.normalize();
  return to;
}

Real Mechanics::time_left(const Body& body, const Hold& hold) const {
  Real left = infinite;
  if (!grips()) return left;
  const Real by_slip = is_ideal() ? 0 : slip_limit_ * (1 / mass_ + 1 / rolling_mass_);
  if (!hold.slip) left = std::min(left, slip(body).norm() / (by_slip + roll_limit_ / rolling_mass_));
  if (!hold.roll && roll_limit_ > 0) {
    left = std::min(left, nu(body).norm() /
                              (roll_limit_ / rolling_mass_ + (is_ideal() ? 0 : slip_limit_ / rolling_mass_)));
  }
  return left;
}

}  // namespace hybrid_sphere::fuzz::own

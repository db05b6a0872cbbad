#include <algorithm>
#include <cmath>

#include "catalogue/classical.hpp"
#include "catalogue/elementary.hpp"
#include "catalogue/entry_helpers.hpp"
#include "hybrid_sphere/mechanics/by_hand.hpp"
#include "hybrid_sphere/mechanics/system.hpp"

namespace hybrid_sphere::mechanics::catalogue {
namespace chaplygin_sleigh_parts {
namespace {

constexpr const char* description =
    R"(A rigid body glides on a plane without friction. At t_switch a knife edge below its point (x, y) is put down:
from then on this point moves along the blade only.

coordinates  x, y          the point of the blade [m]; the mass centre lies a ahead of it
             theta         direction of the blade [rad]
L            m ((x' - a theta' sin theta)^2 + (y' + a theta' cos theta)^2)/2 + I theta'^2/2
Q            none
constraint   "blade", linear: f = -x' sin theta + y' cos theta = 0, from t_switch on

Watch the switch: the blade takes its own sideways velocity away and changes the rotation, while the velocity of the
mass centre along the blade stays. Afterwards the energy is conserved, and yet the motion forgets how it began: the
sleigh turns until it runs straight, mass centre ahead. Volumes in phase space shrink without any friction.

known        all of it, x and y by a quadrature to rounding. f1: the blade's sideways velocity before the impulse,
             Lambda = -f1/(1/m + a^2/I), theta' changes by -a Lambda/I. Then, with u the velocity along the blade,
             w = theta', kappa^2 = I/m + a^2 and u = c cos psi, kappa w = c sin psi:
               u' = a w^2,  kappa^2 w' = -a u w,  c constant,  tan(psi/2) = tan(psi1/2) exp(-a c t/kappa^2),
               a theta + kappa psi constant,  lambda = I u w/kappa^2
source       S. A. Chaplygin, Matematicheskii Sbornik 28 (1911); Neimark and Fufaev, Dynamics of Nonholonomic
             Systems (1972); Bloch, Nonholonomic Mechanics and Control, chapter 1
limits       a < 0 turns the sleigh round, a = 0 leaves circles. Running backwards without rotation is an equilibrium
             that the least rotation ends. The quadrature is given up after some 40,000 rad.
)";

Model automatic(const Values& values) {
  const double m = values["m"], I = values["I"], a = values["a"];
  System<3> sleigh({"x", "y", "theta"}, [=](auto /*t*/, const auto& q, const auto& v) {
    using std::cos, std::sin;
    const auto V_x = v[0] - a * v[2] * sin(q[2]);
    const auto V_y = v[1] + a * v[2] * cos(q[2]);
    return m / 2 * (V_x * V_x + V_y * V_y) + I / 2 * v[2] * v[2];
  });
  const auto blade = [](auto /*t*/, const auto& q, const auto& v) {
    using std::cos, std::sin;
    return v[1] * cos(q[2]) - v[0] * sin(q[2]);
  };
  return sleigh.constrain("blade", blade, from(values["t_switch"]));
}

Model by_hand(const Values& values) {
  const double m = values["m"], I = values["I"], a = values["a"];
  const auto fill = [=](double, const Vector& q, const Vector& v, MotionTerms& terms) {
    const double c = std::cos(q[2]), s = std::sin(q[2]), w = v[2];
    const double sideways = v[1] * c - v[0] * s;
    terms.lagrangian =
        m / 2 * (v[0] * v[0] + v[1] * v[1]) + m * a * w * sideways + (I + m * a * a) / 2 * w * w;
    terms.rate = v;
    terms.momentum << m * (v[0] - a * w * s), m * (v[1] + a * w * c), m * a * sideways + (I + m * a * a) * w;
    terms.mass << m, 0, -m * a * s, 0, m, m * a * c, -m * a * s, m * a * c, I + m * a * a;
    terms.force << m * a * w * w * c, m * a * w * w * s, 0;
  };
  const auto blade = [](double, const Vector& q, const Vector& v, const Vector& rate,
                        ConstraintTerms& terms) {
    const double c = std::cos(q[2]), s = std::sin(q[2]);
    terms.value << v[1] * c - v[0] * s;
    terms.gradient << -s, c, 0;
    terms.gamma << (v[0] * c + v[1] * s) * rate[2];
  };
  return System<3>({"x", "y", "theta"}, {"x_dot", "y_dot", "theta_dot"}, equations_by_hand(3, 3, fill))
      .constrain("blade", constraint_by_hand(1, blade), from(values["t_switch"]));
}

Eigen::Vector2d velocity_of_center(double a, const Vector& q, const Vector& v) {
  return {v[0] - a * v[2] * std::sin(q[2]), v[1] + a * v[2] * std::cos(q[2])};
}

Known free(double a, const Initial& start, double t) {
  const Vector &q = start.q, &v = start.v;
  const Eigen::Vector2d V = velocity_of_center(a, q, v);
  const double theta = q[2] + v[2] * t, middle = (q[2] + theta) / 2;
  const double chord = 2 * a * std::sin(v[2] * t / 2);
  return {
      vector({q[0] + V[0] * t + chord * std::sin(middle), q[1] + V[1] * t - chord * std::cos(middle), theta}),
      vector({V[0] + a * v[2] * std::sin(theta), V[1] - a * v[2] * std::cos(theta), v[2]}), vector({0})};
}

std::optional<Known> held(double m, double I, double a, const Known& before, double time) {
  const Eigen::Vector2d V = velocity_of_center(a, before.q, before.v);
  const double theta1 = before.q[2], c1 = std::cos(theta1), s1 = std::sin(theta1);
  const double impulse = (before.v[0] * s1 - before.v[1] * c1) / (1 / m + a * a / I);
  const double kappa = std::sqrt(I / m + a * a);
  const double u1 = V[0] * c1 + V[1] * s1, w1 = before.v[2] - a / I * impulse;
  const double c = std::hypot(u1, kappa * w1), rate = a * c / (kappa * kappa);
  const auto relaxed = [=](double t) { return Relaxation::from(u1, kappa * w1, rate, t); };
  const auto angle = [=](const Relaxation& then) { return theta1 + c / kappa * then.sine_integral; };
  const auto velocity = [&](double t) {
    const Relaxation then = relaxed(t);
    return c * then.cosine * std::polar(1.0, angle(then));
  };
  const auto way = path(velocity, time, 1 / std::max(std::abs(rate) / 2, c / kappa / 4));
  if (!way) return std::nullopt;
  const Relaxation now = relaxed(time);
  const double u = c * now.cosine, w = c / kappa * now.sine, theta = angle(now);
  return Known{vector({before.q[0] + way->real(), before.q[1] + way->imag(), theta}),
               vector({u * std::cos(theta), u * std::sin(theta), w}), vector({I / (kappa * kappa) * u * w})};
}

Example build(const Values& values) {
  const double m = values["m"], I = values["I"], a = values["a"], kappa = std::sqrt(I / m + a * a);
  Example example{automatic(values), by_hand(values), {}, {}, {}};
  example.initial = initial_state(example.model, values);
  example.known = applied_at(
      values["t_switch"], [a, initial = example.initial](double t) { return free(a, initial, t); },
      [m, I, a](const Known& before, double time) { return held(m, I, a, before, time); });
  const auto along = [](const State& s) { return s.v[0] * std::cos(s.q[2]) + s.v[1] * std::sin(s.q[2]); };
  example.invariants = {
      energy(),
      {"c^2", [=](const State& s) { return along(s) * along(s) + kappa * kappa * s.v[2] * s.v[2]; }},
      {"a theta + kappa psi",
       [=](const State& s) { return a * s.q[2] + kappa * std::atan2(kappa * s.v[2], along(s)); }}};
  return example;
}

}  // namespace
}  // namespace chaplygin_sleigh_parts

Entry chaplygin_sleigh() {
  using namespace chaplygin_sleigh_parts;
  return {
      "chaplygin_sleigh",
      "Chaplygin's sleigh: a knife edge is put down under a gliding body",
      description,
      {positive("m", 2, "mass [kg]"), positive("I", 0.75, "moment of inertia about the mass centre [kg m^2]"),
       number("a", 0.4, "how far the mass centre is ahead of the blade [m]"), switch_time(0.5),
       number("x", 0.1, "place of the blade [m]"), number("y", -0.2, "place of the blade [m]"),
       number("theta", 0.3, "direction of the blade [rad]"), number("x_dot", 1, "velocity [m/s]"),
       number("y_dot", 0.8, "velocity [m/s]"), number("theta_dot", 1.5, "rate of turn [rad/s]")},
      4,
      0.75,
      build};
}

}  // namespace hybrid_sphere::mechanics::catalogue

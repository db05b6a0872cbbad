#include <cmath>

#include "catalogue/classical.hpp"
#include "catalogue/elementary.hpp"
#include "catalogue/entry_helpers.hpp"
#include "hybrid_sphere/mechanics/by_hand.hpp"
#include "hybrid_sphere/mechanics/system.hpp"

namespace hybrid_sphere::mechanics::catalogue {
namespace explicit_time_parts {
namespace {

constexpr const char* description =
    R"(A particle moves on a slope through a medium that resists it. At t_switch a blade is put down whose direction
a drive turns at a steady rate. L and f depend on the time; there is no other system here that does.

coordinates  x, y          place of the particle [m]; x points down the slope
L            exp(gamma t) (m (x'^2 + y'^2)/2 + m gx x)   (Caldirola and Kanai: the resistance is m gamma v)
Q            none
constraint   "blade", linear: f = x' sin alpha - y' cos alpha = 0,  alpha = theta + Omega t,  from t_switch on

Watch the multiplier grow as exp(gamma t) while the motion becomes periodic: lambda belongs to this L, whose momenta
p = exp(gamma t) m v grow alike. The energy v.p - L is not conserved.

known        all of it. Stage 1: v = v0 exp(-gamma t) + gx (1 - exp(-gamma t))/gamma along x. The blade takes the
             velocity across it away, Lambda = -m exp(gamma t) f1. Then with v the velocity along the blade
               v' = -gamma v + gx cos alpha,  lambda = -m exp(gamma t) (v Omega + gx sin alpha),
             v = (v1 - p(t1)) exp(-gamma (t - t1)) + p(t),  p = gx (gamma cos alpha + Omega sin alpha)/(gamma^2 +
             Omega^2); x and y from divided differences of exp, which stay accurate at gamma, Omega -> 0
source       Caldirola, Nuovo Cimento 18 (1941), and Kanai, Progress of Theoretical Physics 3 (1948), for L;
             elementary for the rest
limits       L overflows near gamma t = 700: the engine stops there and says so.
)";

Model automatic(const Values& values) {
  const double m = values["m"], gamma = values["gamma"], gx = values["gx"];
  const double theta = values["theta"], Omega = values["Omega"];
  System<2> particle({"x", "y"}, [=](auto t, const auto& q, const auto& v) {
    using std::exp;
    return exp(gamma * t) * (m / 2 * (v[0] * v[0] + v[1] * v[1]) + m * gx * q[0]);
  });
  const auto blade = [=](auto t, const auto& /*q*/, const auto& v) {
    using std::cos, std::sin;
    const auto alpha = theta + Omega * t;
    return v[0] * sin(alpha) - v[1] * cos(alpha);
  };
  return particle.constrain("blade", blade, from(values["t_switch"]));
}

Model by_hand(const Values& values) {
  const double m = values["m"], gamma = values["gamma"], gx = values["gx"];
  const double theta = values["theta"], Omega = values["Omega"];
  const auto fill = [=](double t, const Vector& q, const Vector& v, MotionTerms& terms) {
    const double mass = m * std::exp(gamma * t);
    terms.mass = vector({mass, mass}).asDiagonal();
    terms.momentum = mass * v;
    terms.lagrangian = mass * (v.squaredNorm() / 2 + gx * q[0]);
    terms.rate = v;
    terms.force = mass * (vector({gx, 0}) - gamma * v);
  };
  const auto blade = [=](double t, const Vector&, const Vector& v, const Vector&, ConstraintTerms& terms) {
    const double c = std::cos(theta + Omega * t), s = std::sin(theta + Omega * t);
    terms.value << v[0] * s - v[1] * c;
    terms.gradient << s, -c;
    terms.gamma << -(v[0] * c + v[1] * s) * Omega;
  };
  return System<2>({"x", "y"}, {"x_dot", "y_dot"}, equations_by_hand(2, 2, fill))
      .constrain("blade", constraint_by_hand(1, blade), from(values["t_switch"]));
}

// Under the resistance gamma and the force per mass (gx, 0).
Known free(double gamma, double gx, const Initial& initial, double t) {
  const double first = exp_difference(-gamma * t).real();
  const double second = exp_difference(-gamma * t, 0).real();
  const Vector force = vector({gx, 0});
  return {initial.q + t * (first * initial.v + t * second * force),
          std::exp(-gamma * t) * initial.v + t * first * force, vector({0})};
}

Known held(const Values& values, const Known& before, double time) {
  const double gamma = values["gamma"], gx = values["gx"], Omega = values["Omega"];
  const double t1 = values["t_switch"];
  const double alpha1 = values["theta"] + Omega * t1, alpha = values["theta"] + Omega * (t1 + time);
  const double v1 = before.v[0] * std::cos(alpha1) + before.v[1] * std::sin(alpha1);
  const Complex begin = std::polar(1.0, alpha1);
  const Complex turn = {0, Omega * time}, rate = {-gamma * time, Omega * time};
  const Complex response = std::exp(turn) * time * exp_difference({-gamma * time, -Omega * time});
  const double v = v1 * std::exp(-gamma * time) + gx * (begin * response).real();
  const Complex pushed = begin * begin * exp_difference(2.0 * turn, rate) + exp_difference(rate, 0);
  const Complex way = time * (v1 * begin * exp_difference(rate) + time * gx / 2 * pushed);
  const double c = std::cos(alpha), s = std::sin(alpha);
  return {vector({before.q[0] + way.real(), before.q[1] + way.imag()}), vector({v * c, v * s}),
          vector({-values["m"] * std::exp(gamma * (t1 + time)) * (v * Omega + gx * s)})};
}

Example build(const Values& values) {
  const double gamma = values["gamma"], gx = values["gx"];
  Example example{automatic(values), by_hand(values), {}, {}, {}};
  example.initial = initial_state(example.model, values);
  example.known = applied_at(
      values["t_switch"],
      [gamma, gx, initial = example.initial](double t) { return free(gamma, gx, initial, t); },
      [values](const Known& before, double time) { return held(values, before, time); });
  if (gamma == 0) example.invariants = {energy()};
  return example;
}

}  // namespace
}  // namespace explicit_time_parts

Entry explicit_time() {
  using namespace explicit_time_parts;
  return {"explicit_time",
          "a particle in a resisting medium on a blade that a drive turns: L and f depend on the time",
          description,
          {positive("m", 1.5, "mass [kg]"), number("gamma", 0.25, "resistance per mass [1/s]"),
           number("gx", 2, "gravity down the slope [m/s^2]"),
           number("theta", 0.2, "direction of the blade at t = 0 [rad]"),
           number("Omega", 1.5, "rate at which the blade turns [rad/s]"), switch_time(0.5),
           number("x", 0, "place [m]"), number("y", 0, "place [m]"), number("x_dot", 0.5, "velocity [m/s]"),
           number("y_dot", 1, "velocity [m/s]")},
          6,
          1 / 1.5,
          build};
}

}  // namespace hybrid_sphere::mechanics::catalogue

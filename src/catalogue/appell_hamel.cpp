#include <cmath>

#include "catalogue/classical.hpp"
#include "catalogue/entry_helpers.hpp"
#include "hybrid_sphere/mechanics/by_hand.hpp"
#include "hybrid_sphere/mechanics/system.hpp"

namespace hybrid_sphere::mechanics::catalogue {
namespace appell_hamel_parts {
namespace {

constexpr const char* description =
    R"(A particle falls freely. From t_switch on the slope of its path is prescribed: it sinks or rises 1/a times as
fast as it goes. The simplest constraint that is not linear in the velocities.

coordinates  x, y, z       place of the particle [m]; z points up
L            m (x'^2 + y'^2 + z'^2)/2 - m g z
Q            none
constraint   "slope", nonlinear and homogeneous: f = x'^2 + y'^2 - a^2 z'^2 = 0, from t_switch on

Watch the impulse. It needs an iteration, because its direction, df/dv, is taken at the velocity that it leads to.
Being homogeneous the constraint does no work: energy is conserved, and Carnot's theorem holds. The reaction is that
of Chetaev's rule; that a mechanism with such a constraint exists in the limit of vanishing wheels only is an old
dispute. A rising particle comes to rest at its summit, where df/dv = 0 and f does not say where to go: the motion
ends just before it (try --set z_dot=3).

known        up to the summit. u: horizontal speed. u2 = a (a u1 + abs(z1'))/(1 + a^2), in its old direction;
             abs(z2') = u2/a with its old sign; Lambda = m (1 - u1/u2)/2. Then a straight line with
             u' = -sign(z') g a/(1 + a^2),  lambda = m u'/(2 u)
             Not known where the particle meets t_switch with u = 0 or z' = 0: its direction is not prescribed.
source       Appell, Rendiconti del Circolo Matematico di Palermo 32 (1911); Hamel, Theoretische Mechanik (1949);
             Neimark and Fufaev, Dynamics of Nonholonomic Systems (1972), chapter 4
limits       At rest f is 0 without a direction. An impulse along a path of intermediate velocities would
             give another v2: the definition of an impulse is a decision where f is nonlinear.
)";

Model automatic(const Values& values) {
  const double m = values["m"], a = values["a"], g = values["g"];
  System<3> particle({"x", "y", "z"}, [=](auto /*t*/, const auto& q, const auto& v) {
    return m / 2 * (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]) - m * g * q[2];
  });
  const auto slope = [=](auto /*t*/, const auto& /*q*/, const auto& v) {
    return v[0] * v[0] + v[1] * v[1] - a * a * v[2] * v[2];
  };
  return particle.constrain("slope", slope, from(values["t_switch"]));
}

Model by_hand(const Values& values) {
  const double m = values["m"], a = values["a"], g = values["g"];
  const auto fill = [=](double, const Vector& q, const Vector& v, MotionTerms& terms) {
    terms.mass = vector({m, m, m}).asDiagonal();
    terms.momentum = m * v;
    terms.lagrangian = m / 2 * v.squaredNorm() - m * g * q[2];
    terms.rate = v;
    terms.force << 0, 0, -m * g;
  };
  const auto slope = [=](double, const Vector&, const Vector& v, const Vector&, ConstraintTerms& terms) {
    terms.value << v[0] * v[0] + v[1] * v[1] - a * a * v[2] * v[2];
    terms.gradient << 2 * v[0], 2 * v[1], -2 * a * a * v[2];
    terms.gamma << 0;
  };
  const auto curvature = [=](double, const Vector&, const Vector&, const Vector& multipliers, Matrix& sum) {
    sum.diagonal() += 2 * multipliers[0] * vector({1, 1, -a * a});
  };
  return System<3>({"x", "y", "z"}, {"x_dot", "y_dot", "z_dot"}, equations_by_hand(3, 3, fill))
      .constrain("slope", constraint_by_hand(1, slope, curvature), from(values["t_switch"]));
}

std::optional<Known> held(double m, double a, double g, const Known& before, double time) {
  const double u1 = std::hypot(before.v[0], before.v[1]), w1 = std::abs(before.v[2]);
  if (u1 == 0 || w1 == 0) return std::nullopt;
  const double u2 = a * (a * u1 + w1) / (1 + a * a);
  const double up = std::copysign(1, before.v[2]);
  const double acceleration = -up * g * a / (1 + a * a);
  const double u = u2 + acceleration * time;
  if (u <= 0) return std::nullopt;
  const Vector direction = vector({before.v[0] / u1, before.v[1] / u1, up / a});
  return Known{before.q + time * (u2 + acceleration / 2 * time) * direction, u * direction,
               vector({m * acceleration / (2 * u)})};
}

Example build(const Values& values) {
  const double m = values["m"], a = values["a"], g = values["g"];
  Example example{automatic(values), by_hand(values), {}, {}, {}};
  example.initial = initial_state(example.model, values);
  example.known = applied_at(
      values["t_switch"],
      [g, initial = example.initial](double t) {
        return flight(initial, vector({0, 0, -g}), 1, t);
      },
      [m, a, g](const Known& before, double time) { return held(m, a, g, before, time); });
  example.invariants = {
      energy(), {"x_dot/y_dot as an angle", [](const State& s) { return std::atan2(s.v[1], s.v[0]); }}};
  return example;
}

}  // namespace
}  // namespace appell_hamel_parts

Entry appell_hamel() {
  using namespace appell_hamel_parts;
  return {"appell_hamel",
          "Appell and Hamel's particle: a nonlinear constraint prescribes the slope of its path",
          description,
          {positive("m", 1, "mass [kg]"), positive("a", 0.75, "horizontal speed over vertical speed [1]"),
           number("g", 2.5, "gravity [m/s^2]"), switch_time(0.5), number("x", 0, "place [m]"),
           number("y", 0, "place [m]"), number("z", 1, "height [m]"), number("x_dot", 0.6, "velocity [m/s]"),
           number("y_dot", 0.8, "velocity [m/s]"), number("z_dot", -0.5, "velocity [m/s]")},
          3,
          1,
          build};
}

}  // namespace hybrid_sphere::mechanics::catalogue

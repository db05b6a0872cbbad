#include <cmath>

#include "catalogue/classical.hpp"
#include "catalogue/elementary.hpp"
#include "catalogue/entry_helpers.hpp"
#include "hybrid_sphere/mechanics/by_hand.hpp"
#include "hybrid_sphere/mechanics/system.hpp"

namespace hybrid_sphere::mechanics::catalogue {
namespace constant_speed_parts {
namespace {

constexpr const char* description =
    R"(A particle flies in a vertical plane. From t_switch on a regulator keeps its speed at c.

coordinates  x, y          place of the particle [m]; y points up
L            m (x'^2 + y'^2)/2 - m g y
Q            none
constraint   "speed", nonlinear and inhomogeneous: f = x'^2 + y'^2 - c^2 = 0, from t_switch on

Watch the energy. The impulse feeds energy in where the particle was slower than c: Carnot's theorem does not hold,
because f is not homogeneous and the constraint does work. Afterwards it takes out what gravity gives. The path is
the catenary of equal strength, and ends in a vertical line: the particle sinks at the speed c.

known        all of it. v2 = c v1/abs(v1), Lambda = m (1 - abs(v1)/c)/2. Then with psi the angle of the velocity
             from straight down, x' = c sin psi, y' = -c cos psi:
               psi' = -(g/c) sin psi,  tan(psi/2) = tan(psi1/2) exp(-g t/c),
               x + c^2 psi/g constant,  y - (c^2/g) ln sin psi constant,  lambda = m g y'/(2 c^2)
             Not known where the particle is at rest at t_switch: df/dv = 0 there, no direction is prescribed.
source       an isokinetic (Gaussian) thermostat of one particle; nonlinear constraints by Chetaev's rule as in
             Neimark and Fufaev, Dynamics of Nonholonomic Systems (1972), chapter 4
limits       Flying straight up is an equilibrium that the least deviation ends.
)";

Model automatic(const Values& values) {
  const double m = values["m"], g = values["g"], c = values["c"];
  System<2> particle({"x", "y"}, [=](auto /*t*/, const auto& q, const auto& v) {
    return m / 2 * (v[0] * v[0] + v[1] * v[1]) - m * g * q[1];
  });
  const auto speed = [=](auto /*t*/, const auto& /*q*/, const auto& v) {
    return v[0] * v[0] + v[1] * v[1] - c * c;
  };
  return particle.constrain("speed", speed, from(values["t_switch"]));
}

Model by_hand(const Values& values) {
  const double m = values["m"], g = values["g"], c = values["c"];
  const auto fill = [=](double, const Vector& q, const Vector& v, MotionTerms& terms) {
    terms.mass = vector({m, m}).asDiagonal();
    terms.momentum = m * v;
    terms.lagrangian = m / 2 * v.squaredNorm() - m * g * q[1];
    terms.rate = v;
    terms.force << 0, -m * g;
  };
  const auto speed = [=](double, const Vector&, const Vector& v, const Vector&, ConstraintTerms& terms) {
    terms.value << v.squaredNorm() - c * c;
    terms.gradient = 2 * v.transpose();
    terms.gamma << 0;
  };
  const auto curvature = [](double, const Vector&, const Vector&, const Vector& multipliers, Matrix& sum) {
    sum.diagonal().array() += 2 * multipliers[0];
  };
  return System<2>({"x", "y"}, {"x_dot", "y_dot"}, equations_by_hand(2, 2, fill))
      .constrain("speed", constraint_by_hand(1, speed, curvature), from(values["t_switch"]));
}

std::optional<Known> held(double m, double g, double c, const Known& before, double time) {
  if (before.v.norm() == 0) return std::nullopt;
  const Relaxation now = Relaxation::from(-before.v[1], before.v[0], g / c, time);
  return Known{before.q + c * vector({now.sine_integral, -now.cosine_integral}),
               c * vector({now.sine, -now.cosine}), vector({-m * g * now.cosine / (2 * c)})};
}

Example build(const Values& values) {
  const double m = values["m"], g = values["g"], c = values["c"];
  Example example{automatic(values), by_hand(values), {}, {}, {}};
  example.initial = initial_state(example.model, values);
  example.known = applied_at(
      values["t_switch"],
      [g, initial = example.initial](double t) {
        return flight(initial, vector({0, -g}), 1, t);
      },
      [m, g, c](const Known& before, double time) { return held(m, g, c, before, time); });
  example.invariants = {
      {"speed", [](const State& s) { return s.v.norm(); }},
      {"g x + c^2 psi", [=](const State& s) { return g * s.q[0] + c * c * std::atan2(s.v[0], -s.v[1]); }}};
  return example;
}

}  // namespace
}  // namespace constant_speed_parts

Entry constant_speed() {
  using namespace constant_speed_parts;
  return {"constant_speed",
          "a particle whose speed is suddenly prescribed: a nonlinear constraint that does work",
          description,
          {positive("m", 2, "mass [kg]"), number("g", 5, "gravity [m/s^2]"),
           positive("c", 3, "the speed prescribed [m/s]"), switch_time(0.5), number("x", 0, "place [m]"),
           number("y", 1, "height [m]"), number("x_dot", 1.5, "velocity [m/s]"),
           number("y_dot", 1, "velocity [m/s]")},
          3,
          0.6,
          build};
}

}  // namespace hybrid_sphere::mechanics::catalogue

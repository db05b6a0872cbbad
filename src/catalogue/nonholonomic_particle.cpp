#include "catalogue/classical.hpp"
#include "catalogue/entry_helpers.hpp"
#include "catalogue/particle_formulas.hpp"
#include "hybrid_sphere/mechanics/system.hpp"

namespace hybrid_sphere::mechanics::catalogue {
namespace nonholonomic_particle_parts {
namespace {

constexpr const char* description =
    R"(A free particle on which the simplest nonholonomic constraint is imposed at t_switch.

coordinates  x, y, z       place of the particle [m]
L            m (x'^2 + y'^2 + z'^2)/2
Q            none
constraint   "slope", linear: f = z' - y x' = 0, from t_switch on: the path's slope is its place y (in metres)

Watch that every place can still be reached, although the velocity is confined: dz - y dx = 0 is not the derivative
of any function of the coordinates. The momentum along x is not conserved, though neither L nor f depends on x.

known        all of it. Lambda = -m f1/(1 + y^2); x2' = (x1' + y z1')/(1 + y^2). Then y' is constant,
             x' = C/sqrt(1 + y^2),  x = x1 + (C/y') (asinh y - asinh y1),
             z = z1 + (C/y') (sqrt(1 + y^2) - sqrt(1 + y1^2)),  lambda = m x' y'/(1 + y^2); y' = 0: a straight line
source       Rosenberg, Analytical Dynamics of Discrete Systems (1977); Bates and Sniatycki, Reports on Mathematical
             Physics 32 (1993); Bloch, Nonholonomic Mechanics and Control, chapter 5
)";

Model automatic(const Values& values) {
  const double m = values["m"];
  System<3> particle({"x", "y", "z"}, [m](auto /*t*/, const auto& /*q*/, const auto& v) {
    return m / 2 * (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
  });
  const auto slope = [](auto /*t*/, const auto& q, const auto& v) { return v[2] - q[1] * v[0]; };
  return particle.constrain("slope", slope, from(values["t_switch"]));
}

Model by_hand(const Values& values) {
  return System<3>({"x", "y", "z"}, {"x_dot", "y_dot", "z_dot"}, particle::equations_by_hand(values["m"]))
      .constrain("slope", particle::constraint_by_hand(), from(values["t_switch"]));
}

Example build(const Values& values) {
  const double m = values["m"];
  Example example{automatic(values), by_hand(values), {}, {}, {}};
  example.initial = initial_state(example.model, values);
  example.known = applied_at(
      values["t_switch"],
      [initial = example.initial](double t) { return flight(initial, Vector::Zero(3), 1, t); },
      [m](const Known& before, double time) {
        return particle::held(m, {before.q, particle::after_impulse(before.q, before.v), {}}, time);
      });
  example.invariants = {
      energy(), {"y_dot", [](const State& s) { return s.v[1]; }}, {"x_dot^2 + z_dot^2", [](const State& s) {
                                                                     return s.v[0] * s.v[0] + s.v[2] * s.v[2];
                                                                   }}};
  return example;
}

}  // namespace
}  // namespace nonholonomic_particle_parts

Entry nonholonomic_particle() {
  using namespace nonholonomic_particle_parts;
  const Initial as_a_rule{0, vector({0, -0.5, 0.25}), vector({1, 0.75, 0.5})};
  return {"nonholonomic_particle",
          "a free particle on which z' = y x' is imposed",
          description,
          particle::parameters(switch_time(1), as_a_rule),
          4,
          1 / 0.75,
          build};
}

}  // namespace hybrid_sphere::mechanics::catalogue

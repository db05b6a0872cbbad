#include <cmath>

#include "catalogue/classical.hpp"
#include "catalogue/elementary.hpp"
#include "catalogue/entry_helpers.hpp"
#include "hybrid_sphere/mechanics/by_hand.hpp"
#include "hybrid_sphere/mechanics/system.hpp"

namespace hybrid_sphere::mechanics::catalogue {
namespace knife_edge_incline_parts {
namespace {

constexpr const char* description =
    R"(A skate slides down a smooth slope and turns. At t_switch its blade, below the mass centre, is put down.

coordinates  x, y          place of the skate [m]; x points down the slope
             theta         direction of the blade [rad]
L            m (x'^2 + y'^2)/2 + I theta'^2/2 + m gs x,  gs = g sin(slope)
Q            none
constraint   "blade", linear: f = x' sin theta - y' cos theta = 0, from t_switch on

Watch x: with the blade down the skate no longer descends. It runs sideways along the slope on loops, for good,
though nothing but the blade holds it, and the energy is conserved.

known        all of it. The blade takes the velocity across it away, Lambda = -m f1; theta' = w stays. Then with
             v the velocity along the blade, A and B the integrals of cos theta and sin theta over the time since:
               v = v1 + gs A,  x = x1 + v1 A + gs A^2/2,  y = y1 + v1 B + gs (A B + (w t - sin w t)/w^2)/2,
               lambda = -m (v w + gs sin theta)
             At w <> 0 these are trochoids, v - (gs/w) sin theta constant; at w = 0 parabolas in the time.
source       Neimark and Fufaev, Dynamics of Nonholonomic Systems (1972); Bloch, Nonholonomic Mechanics and Control,
             chapter 1 (the knife edge)
)";

Model automatic(const Values& values) {
  const double m = values["m"], I = values["I"], gs = values["gs"];
  System<3> skate({"x", "y", "theta"}, [=](auto /*t*/, const auto& q, const auto& v) {
    return m / 2 * (v[0] * v[0] + v[1] * v[1]) + I / 2 * v[2] * v[2] + m * gs * q[0];
  });
  const auto blade = [](auto /*t*/, const auto& q, const auto& v) {
    using std::cos, std::sin;
    return v[0] * sin(q[2]) - v[1] * cos(q[2]);
  };
  return skate.constrain("blade", blade, from(values["t_switch"]));
}

Model by_hand(const Values& values) {
  const double m = values["m"], I = values["I"], gs = values["gs"];
  const auto fill = [=](double, const Vector& q, const Vector& v, MotionTerms& terms) {
    terms.mass = vector({m, m, I}).asDiagonal();
    terms.momentum = terms.mass * v;
    terms.lagrangian = v.dot(terms.momentum) / 2 + m * gs * q[0];
    terms.rate = v;
    terms.force << m * gs, 0, 0;
  };
  const auto blade = [](double, const Vector& q, const Vector& v, const Vector& rate,
                        ConstraintTerms& terms) {
    const double c = std::cos(q[2]), s = std::sin(q[2]);
    terms.value << v[0] * s - v[1] * c;
    terms.gradient << s, -c, 0;
    terms.gamma << -(v[0] * c + v[1] * s) * rate[2];
  };
  return System<3>({"x", "y", "theta"}, {"x_dot", "y_dot", "theta_dot"}, equations_by_hand(3, 3, fill))
      .constrain("blade", constraint_by_hand(1, blade), from(values["t_switch"]));
}

Known held(double m, double gs, const Known& before, double time) {
  const double theta1 = before.q[2], w = before.v[2];
  const double v1 = before.v[0] * std::cos(theta1) + before.v[1] * std::sin(theta1);
  const Complex way = arc(theta1, w, time);
  const double A = way.real(), B = way.imag();
  const double theta = theta1 + w * time, c = std::cos(theta), s = std::sin(theta);
  const double v = v1 + gs * A;
  const double area = time * time * sine_gap(w * time);
  return {
      vector({before.q[0] + (v1 + gs / 2 * A) * A, before.q[1] + v1 * B + gs / 2 * (A * B + area), theta}),
      vector({v * c, v * s, w}), vector({-m * (v * w + gs * s)})};
}

Example build(const Values& values) {
  const double m = values["m"], gs = values["gs"];
  Example example{automatic(values), by_hand(values), {}, {}, {}};
  example.initial = initial_state(example.model, values);
  example.known = applied_at(
      values["t_switch"],
      [gs, initial = example.initial](double t) {
        return flight(initial, vector({gs, 0, 0}), 1, t);
      },
      [m, gs](const Known& before, double time) { return held(m, gs, before, time); });
  example.invariants = {energy(),
                        {"theta_dot", [](const State& s) { return s.v[2]; }},
                        {"v theta_dot - gs sin theta", [gs](const State& s) {
                           const double c = std::cos(s.q[2]), sine = std::sin(s.q[2]);
                           return (s.v[0] * c + s.v[1] * sine) * s.v[2] - gs * sine;
                         }}};
  return example;
}

}  // namespace
}  // namespace knife_edge_incline_parts

Entry knife_edge_incline() {
  using namespace knife_edge_incline_parts;
  return {"knife_edge_incline",
          "a skate on a slope, its blade suddenly put down",
          description,
          {positive("m", 1.25, "mass [kg]"), positive("I", 0.3, "moment of inertia [kg m^2]"),
           number("gs", 4, "gravity down the slope [m/s^2]"), switch_time(0.5),
           number("x", 0, "place down the slope [m]"), number("y", 0, "place across the slope [m]"),
           number("theta", 0.2, "direction of the blade [rad]"), number("x_dot", 0.5, "velocity [m/s]"),
           number("y_dot", -0.3, "velocity [m/s]"), number("theta_dot", 1.2, "rate of turn [rad/s]")},
          8,
          1 / 1.2,
          build};
}

}  // namespace hybrid_sphere::mechanics::catalogue

#include <cmath>

#include "catalogue/classical.hpp"
#include "catalogue/elementary.hpp"
#include "catalogue/entry_helpers.hpp"
#include "hybrid_sphere/mechanics/by_hand.hpp"
#include "hybrid_sphere/mechanics/system.hpp"

namespace hybrid_sphere::mechanics::catalogue {
namespace rolling_disk_parts {
namespace {

constexpr const char* description =
    R"(A disk that stands upright glides over smooth ground, spinning about its axis and turning about the vertical.
At t_switch the ground becomes rough: the disk rolls without slipping.

coordinates  x, y          centre of the disk [m]
             theta         direction in which it rolls [rad]
             phi           angle of rolling [rad]
L            m (x'^2 + y'^2)/2 + J theta'^2/2 + I phi'^2/2
Q            none
constraint   "rolling", two linear functions: f = (x' - R phi' cos theta, y' - R phi' sin theta) = 0, from t_switch on

Watch the switch: sliding and spin share what they have, m R v + I phi', and the rest is lost; the sideways velocity
goes at once. Afterwards the disk runs on a circle at a constant rate, and the multipliers are its centripetal force.

known        all of it. v_e: velocity in the direction theta. phi2' = (I phi1' + m R v_e)/(I + m R^2),
             Lambda = m (v2 - v1), theta' stays. Then a circle of radius R phi'/theta' (a straight line at theta' = 0),
             lambda = m R phi' theta' (-sin theta, cos theta)
source       Neimark and Fufaev, Dynamics of Nonholonomic Systems (1972); Bloch, Nonholonomic Mechanics and Control,
             chapter 1 (the vertical rolling disk)
)";

Model automatic(const Values& values) {
  const double m = values["m"], R = values["R"], I = values["I"], J = values["J"];
  System<4> disk({"x", "y", "theta", "phi"}, [=](auto /*t*/, const auto& /*q*/, const auto& v) {
    return m / 2 * (v[0] * v[0] + v[1] * v[1]) + J / 2 * v[2] * v[2] + I / 2 * v[3] * v[3];
  });
  const auto slip = [=](auto t, const auto& q, const auto& v) {
    using std::cos, std::sin;
    Eigen::Matrix<decltype(t), 2, 1> f;
    f[0] = v[0] - R * v[3] * cos(q[2]);
    f[1] = v[1] - R * v[3] * sin(q[2]);
    return f;
  };
  return disk.constrain("rolling", slip, from(values["t_switch"]));
}

Model by_hand(const Values& values) {
  const double m = values["m"], R = values["R"], I = values["I"], J = values["J"];
  const auto fill = [=](double, const Vector&, const Vector& v, MotionTerms& terms) {
    terms.mass = vector({m, m, J, I}).asDiagonal();
    terms.momentum = terms.mass * v;
    terms.lagrangian = v.dot(terms.momentum) / 2;
    terms.rate = v;
    terms.force.setZero();
  };
  const auto slip = [=](double, const Vector& q, const Vector& v, const Vector& rate,
                        ConstraintTerms& terms) {
    const double c = R * std::cos(q[2]), s = R * std::sin(q[2]);
    terms.value << v[0] - c * v[3], v[1] - s * v[3];
    terms.gradient << 1, 0, 0, -c, 0, 1, 0, -s;
    terms.gamma << -s * v[3] * rate[2], c * v[3] * rate[2];
  };
  return System<4>({"x", "y", "theta", "phi"}, {"x_dot", "y_dot", "theta_dot", "phi_dot"},
                   equations_by_hand(4, 4, fill))
      .constrain("rolling", constraint_by_hand(2, slip), from(values["t_switch"]));
}

Known rolling(const Values& values, const Known& before, double time) {
  const double m = values["m"], R = values["R"], I = values["I"];
  const Vector& q = before.q;
  const double along = before.v[0] * std::cos(q[2]) + before.v[1] * std::sin(q[2]);
  const double turn = before.v[2];
  const double spin = (I * before.v[3] + m * R * along) / (I + m * R * R);
  const Complex way = R * spin * arc(q[2], turn, time);
  const double theta = q[2] + turn * time;
  const double c = R * spin * std::cos(theta), s = R * spin * std::sin(theta);
  return {vector({q[0] + way.real(), q[1] + way.imag(), theta, q[3] + spin * time}),
          vector({c, s, turn, spin}), vector({-m * turn * s, m * turn * c})};
}

Example build(const Values& values) {
  const double R = values["R"];
  Example example{automatic(values), by_hand(values), {}, {}, {}};
  example.initial = initial_state(example.model, values);
  example.known = applied_at(
      values["t_switch"],
      [initial = example.initial](double t) { return flight(initial, Vector::Zero(4), 2, t); },
      [values](const Known& before, double time) { return rolling(values, before, time); });
  example.invariants = {energy(),
                        {"theta_dot", [](const State& s) { return s.v[2]; }},
                        {"phi_dot", [](const State& s) { return s.v[3]; }},
                        {"theta_dot times x of the circle's centre",
                         [=](const State& s) { return s.v[2] * s.q[0] - R * s.v[3] * std::sin(s.q[2]); }}};
  return example;
}

}  // namespace
}  // namespace rolling_disk_parts

Entry rolling_disk() {
  using namespace rolling_disk_parts;
  return {"rolling_disk",
          "an upright disk that slips, and suddenly rolls",
          description,
          {positive("m", 2, "mass [kg]"), positive("R", 0.5, "radius [m]"),
           positive("I", 0.25, "moment of inertia about the axis [kg m^2]"),
           positive("J", 0.125, "moment of inertia about a diameter [kg m^2]"), switch_time(0.5),
           number("x", 0, "place of the centre [m]"), number("y", 0, "place of the centre [m]"),
           number("theta", 0.4, "direction of rolling [rad]"), number("phi", 0, "angle of rolling [rad]"),
           number("x_dot", 1, "velocity [m/s]"), number("y_dot", -0.5, "velocity [m/s]"),
           number("theta_dot", 1.25, "rate of turn [rad/s]"), number("phi_dot", 3, "spin [rad/s]")},
          4,
          0.8,
          build};
}

}  // namespace hybrid_sphere::mechanics::catalogue

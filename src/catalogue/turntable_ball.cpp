#include <cmath>

#include "catalogue/elementary.hpp"
#include "catalogue/entry_helpers.hpp"
#include "catalogue/sphere_formulas.hpp"
#include "catalogue/sphere_systems.hpp"
#include "hybrid_sphere/mechanics/system.hpp"

namespace hybrid_sphere::mechanics::catalogue {
namespace turntable_ball_parts {
namespace {

constexpr const char* description = R"(A ball glides over a turntable, which suddenly grips it; Euler angles.

coordinates  x, y             centre of the ball; the table turns about the origin [m]
             psi, theta, phi  z-x-z Euler angles, from the body's axes to the fixed ones [rad]
L            that of paper_sphere, (12)
Q            none
constraint   rolling, from t_switch on: the point of contact has the velocity of the table, two functions,
               f = (x' - R w2 + W y, y' + R w1 - W x),    w by (13)
             They are affine in the velocities: the table's drive does work, and the energy may grow, by the
             impulse as well.

Watch the centre run on a circle, far slower than the table, about a centre of its own. lambda is its centripetal
force.

known        kappa = k^2/(R^2 + k^2), slip s = f:
               impulse P = -m kappa s, velocities as those of paper_sphere with the slip relative to the table
               the velocity turns at the constant rate kappa W (2/7 of W for a homogeneous ball), w3 is constant
               w1 = (W x - y')/R,  w2 = (x' + W y)/R,  lambda = m kappa W (-y', x')
             The angular velocity is a constant vector and one that turns. Unless the circle is about the table's
             own centre the orientation is no elementary function: it is a product integral of the known omega, to
             rounding, and so are the angles. They are not known from where sin theta = 0 on.
             Constant: x'^2 + y'^2, w3, p_c = (R^2 x' + R k^2 w2, R^2 y' - R k^2 w1)/(R^2 + k^2), and the moving
             energy T - W (m (x y' - y x') + m k^2 w3).
source       docs/theory.md 3, 4.2; S. Earnshaw (1844), J. A. Burns, Am. J. Phys. 49 (1981) 56.
limits       sin theta = 0, as in paper_sphere.
)";

// Free up to the switch; then the centre's velocity turns steadily.
struct Course {
  double m, R, k, W, t_switch;
  Vector2d start;      // of the centre, at t = 0
  Vector3d angles;     // at t = 0
  Velocities free;     // stage 1
  Vector2d place;      // of the switch
  Velocities gripped;  // after the impulse
  double rate;         // kappa W

  Course(const Values& p, const Initial& initial)
      : m(p["m"]), R(p["R"]), k(p["k"]), W(p["W"]), t_switch(p["t_switch"]) {
    start = initial.q.head<2>();
    angles = initial.q.tail<3>();
    free = {initial.v.head<2>(), euler::spin(initial.q, initial.v)};
    place = start + t_switch * free.center;
    gripped = after_impulse(R, k, free, W * Vector2d(-place.y(), place.x()));
    rate = k * k / (R * R + k * k) * W;
  }

  Vector2d center(double since) const {
    const Vector2d& v = gripped.center;
    const Complex way = v.norm() * arc(std::atan2(v.y(), v.x()), rate, since);
    return place + Vector2d(way.real(), way.imag());
  }
  Velocities velocities(double since) const {
    const Vector2d v = Eigen::Rotation2Dd(rate * since) * gripped.center;
    const Vector2d r = center(since);
    return {v, {(W * r.x() - v.y()) / R, (v.x() + W * r.y()) / R, gripped.spin.z()}};
  }
  std::optional<Vector3d> orientation(double since) const {
    const std::optional<Vector3d> at_switch = euler::continued(angles, free.spin, t_switch);
    if (!at_switch) return std::nullopt;
    const double speed = gripped.center.norm();
    double way = speed * since;
    if (way * std::abs(rate) > 2 * speed) way = 2 * speed / std::abs(rate);
    const double fastest = gripped.spin.norm() + std::abs(W - rate) * way / R + std::abs(rate);
    const double step = fastest > 0 ? 0.02 / fastest : std::max(since, 1.0);
    return euler::continued(
        *at_switch, [this](double time) { return velocities(time).spin; }, 0, since, step);
  }

  std::optional<Known> at(double t) const {
    const bool is_free = t < t_switch;
    const double since = t - t_switch;
    const auto now = is_free ? euler::continued(angles, free.spin, t) : orientation(since);
    if (!now) return std::nullopt;
    const Velocities v = is_free ? free : velocities(since);
    Known result{Vector(5), Vector(5), Vector::Zero(2)};
    result.q << (is_free ? Vector2d(start + t * free.center) : center(since)), *now;
    result.v << v.center, euler::rates(*now, v.spin);
    if (!is_free) *result.multipliers << -m * rate * v.center.y(), m * rate * v.center.x();
    return result;
  }
};

std::vector<Invariant> invariants(double m, double R, double k, double W) {
  const double D = R * R + k * k;
  const auto spin = [](const State& s) { return euler::spin(s.q, s.v); };
  return {{"moving energy",
           [=](const State& s) {
             return s.energy - W * m * (s.q[0] * s.v[1] - s.q[1] * s.v[0] + k * k * spin(s)[2]);
           }},
          {"speed", [](const State& s) { return std::hypot(s.v[0], s.v[1]); }},
          {"w3", [=](const State& s) { return spin(s)[2]; }},
          {"p_c along x", [=](const State& s) { return R * (R * s.v[0] + k * k * spin(s)[1]) / D; }},
          {"p_c along y", [=](const State& s) { return R * (R * s.v[1] - k * k * spin(s)[0]) / D; }}};
}

Example build(const Values& p) {
  const double m = p["m"], R = p["R"], k = p["k"], W = p["W"];
  check_gyration_radius(R, k);
  const System<5>::CoordinateNames names = {"x", "y", "psi", "theta", "phi"};
  System<5> ball(names,
                 [=](auto /*t*/, const auto& q, const auto& v) { return euler::lagrangian(m, k, q, v); });
  ball.constrain(
      "rolling", [=](auto /*t*/, const auto& q, const auto& v) { return euler::slip(R, W, q, v); },
      from(p["t_switch"]));

  System<5> by_hand(names, {"x_dot", "y_dot", "psi_dot", "theta_dot", "phi_dot"},
                    euler::equations_by_hand(m, k));
  by_hand.constrain("rolling", euler::slip_by_hand(R, W), from(p["t_switch"]));

  const Initial initial = initial_state(ball, p);
  const Course course(p, initial);
  return {ball, by_hand, initial, [course](double t) { return course.at(t); }, invariants(m, R, k, W)};
}

}  // namespace
}  // namespace turntable_ball_parts

Entry turntable_ball() {
  using namespace turntable_ball_parts;
  const Initial as_a_rule{0, vector({0.25, 0, 0.5, 1.5, -0.5}), vector({-0.5, -0.75, -0.5, 0.5, 1.75})};
  return {"turntable_ball",
          "a ball on a turntable that suddenly grips it: affine constraints",
          description,
          euler::with_initial_values(
              {positive("m", 1, "mass [kg]"), positive("R", 0.5, "radius [m]"), gyration_radius(0.25),
               number("W", 2, "rate of the turntable [rad/s]"), switch_time(0.5)},
              as_a_rule),
          2,
          0.5,
          build};
}

}  // namespace hybrid_sphere::mechanics::catalogue

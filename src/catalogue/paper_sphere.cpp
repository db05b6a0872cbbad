#include <cmath>

#include "catalogue/entry_helpers.hpp"
#include "catalogue/sphere_formulas.hpp"
#include "catalogue/sphere_systems.hpp"
#include "hybrid_sphere/mechanics/system.hpp"

namespace hybrid_sphere::mechanics::catalogue {
namespace paper_sphere_parts {
namespace {

constexpr const char* description =
    R"(A homogeneous sphere slides over smooth ground onto a perfectly rough half-plane.

coordinates  x, y             centre of the sphere [m]
             psi, theta, phi  z-x-z Euler angles, from the body's axes to the fixed ones [rad]
L (12)       m (x'^2 + y'^2)/2 + m k^2 (psi'^2 + theta'^2 + phi'^2 + 2 phi' psi' cos theta)/2
Q            none
constraint   rolling (21): the point of the sphere that touches the ground is at rest, two functions,
               f = (x' - R w2, y' + R w1),       by (13)
               w1 = theta' cos psi + phi' sin theta sin psi,  w2 = theta' sin psi - phi' sin theta cos psi
             It holds while g = x - edge > 0.

Watch the switch at x = edge: the slip f vanishes at once, by the impulse in the place of contact. With strong
backspin, k^2 w2 < -R x', it throws the sphere back (try --set theta_dot=-30): the constraint is applied and
released at one instant. As a rule omega = (4, 1.5, -2), as in config/paper.yaml.

known        all of it. Stage 1, (18): x', y' and omega are constant. Stage 2, (20) with (22), D = R^2 + k^2:
               x' = (R^2 x0' + R k^2 w20)/D,  y' = (R^2 y0' - R k^2 w10)/D,  w1 = -y'/R,  w2 = x'/R,  w3 = w30
             which is (23) with its three misprints corrected (docs/theory.md 2). Stage 3, (27) corrected alike:
             constant again, lambda = 0 (24). The angles follow from turns about fixed axes.
             Not known where the sphere starts on the rough side, and from where sin theta = 0 on.
source       Mei (2005), (12), (13), (16) to (27).
limits       Euler angles are singular at sin theta = 0: the mass matrix is, and close by the angles turn fast
             though the sphere does not. paper_sphere_quasi has no such place.
)";

std::optional<Known> known(const HalfPlaneMotion& motion, const Vector3d& angles, double t) {
  std::optional<Vector3d> now = euler::continued(angles, motion.before.spin, motion.before_edge(t));
  if (now) now = euler::continued(*now, motion.after.spin, motion.behind_edge(t));
  if (!now) return std::nullopt;
  const Velocities& velocities = motion.velocities(t);
  Known result{Vector(5), Vector(5), Vector::Zero(2)};
  result.q << motion.center(t), *now;
  result.v << velocities.center, euler::rates(*now, velocities.spin);
  return result;
}

Example build(const Values& p) {
  const double m = p["m"], R = p["R"], k = p["k"], edge = p["edge"];
  check_gyration_radius(R, k);
  const System<5>::CoordinateNames names = {"x", "y", "psi", "theta", "phi"};
  const auto rough = while_positive([=](auto /*t*/, const auto& q) { return q[0] - edge; });

  System<5> sphere(names,
                   [=](auto /*t*/, const auto& q, const auto& v) { return euler::lagrangian(m, k, q, v); });
  sphere.constrain(
      "rolling", [=](auto /*t*/, const auto& q, const auto& v) { return euler::slip(R, 0, q, v); }, rough);

  System<5> by_hand(names, {"x_dot", "y_dot", "psi_dot", "theta_dot", "phi_dot"},
                    euler::equations_by_hand(m, k));
  by_hand.constrain("rolling", euler::slip_by_hand(R, 0), rough);

  const Initial initial = initial_state(sphere, p);
  const Vector3d angles = initial.q.tail<3>();
  const HalfPlaneMotion motion(R, k, edge, initial.q.head<2>(),
                               {initial.v.head<2>(), euler::spin(initial.q, initial.v)});
  Example example{sphere, by_hand, initial, {}, {}};
  if (side_at_start(sphere, initial) <= 0) {
    example.known = [=](double t) { return known(motion, angles, t); };
  }
  example.invariants = {energy(),
                        {"x_dot", [](const State& s) { return s.v[0]; }},
                        {"y_dot", [](const State& s) { return s.v[1]; }},
                        {"w3", [](const State& s) { return euler::spin(s.q, s.v)[2]; }}};
  return example;
}

}  // namespace
}  // namespace paper_sphere_parts

Entry paper_sphere() {
  using namespace paper_sphere_parts;
  const Initial as_a_rule{0, vector({-2, 0.5, M_PI / 2, M_PI / 2, 0}), vector({1, -0.375, -2, 1.5, 4})};
  return {"paper_sphere",
          "the paper's sphere: from smooth to rough ground, in Euler angles",
          description,
          euler::with_initial_values({positive("m", 2, "mass [kg]"), positive("R", 0.25, "radius [m]"),
                                      gyration_radius(0.25 * std::sqrt(0.4)), rough_edge(0)},
                                     as_a_rule),
          4,
          0.25,
          build};
}

}  // namespace hybrid_sphere::mechanics::catalogue

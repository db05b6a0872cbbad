#include <cmath>

#include "catalogue/entry_helpers.hpp"
#include "catalogue/quaternion.hpp"
#include "catalogue/sphere_formulas.hpp"
#include "catalogue/sphere_systems.hpp"
#include "hybrid_sphere/mechanics/by_hand.hpp"
#include "hybrid_sphere/mechanics/system.hpp"

namespace hybrid_sphere::mechanics::catalogue {
namespace paper_sphere_quasi_parts {
namespace {

constexpr const char* description = R"(The sphere of paper_sphere in quasi-velocities.

coordinates  x, y            centre of the sphere [m]
             qw, qx, qy, qz  unit quaternion, from the body's axes to the fixed ones
velocities   x', y', and w1, w2, w3: angular velocity on the fixed axes [rad/s]
             q' = (0, w1, w2, w3) q / 2
L (14)       m (x'^2 + y'^2)/2 + m k^2 (w1^2 + w2^2 + w3^2)/2
Q            none
constraint   rolling (21): f = (x' - R w2, y' + R w1), while g = x - edge > 0

Watch that the equations of Boltzmann and Hamel (15) have no singular orientation, and that M and the gradient of
f are constant. f is a linear first integral of stage 3 here: any method of integration keeps it.

known        all of it: x', y' and omega are constant before the edge and behind it, see paper_sphere; the
             orientation is a turn about a fixed axis in each stage.
             Not known where the sphere starts on the rough side.
source       Mei (2005), (14) to (27); the misprints of (23) and (27) corrected (docs/theory.md 2).
limits       none; the quaternion is kept at unit length.
)";

std::shared_ptr<const EquationsOfMotion> equations(double m, double k) {
  return equations_by_hand(6, 5, [=](double /*t*/, const Vector& q, const Vector& v, MotionTerms& terms) {
    terms.rate << v.head<2>(), space_rate(q.tail<4>(), v.tail<3>());
    terms.mass.setZero();
    terms.mass.diagonal() << m, m, m * k * k, m * k * k, m * k * k;
    terms.momentum = terms.mass * v;
    terms.lagrangian = v.dot(terms.momentum) / 2;
    terms.force.setZero();
  });
}

std::shared_ptr<const ConstraintFunction> rolling(double R) {
  return constraint_by_hand(2, [R](double /*t*/, const Vector& /*q*/, const Vector& v, const Vector& /*rate*/,
                                   ConstraintTerms& terms) {
    terms.gradient << 1, 0, 0, -R, 0, 0, 1, R, 0, 0;
    terms.value = terms.gradient * v;
    terms.gamma.setZero();
  });
}

Known known(const HalfPlaneMotion& motion, const Quaterniond& start, double t) {
  const Velocities& velocities = motion.velocities(t);
  const Quaterniond q = turn(motion.behind_edge(t) * motion.after.spin) *
                        turn(motion.before_edge(t) * motion.before.spin) * start;
  Known result{Vector(6), Vector(5), Vector::Zero(2)};
  result.q << motion.center(t), q.w(), q.vec();
  result.v << velocities.center, velocities.spin;
  return result;
}

Example build(const Values& p) {
  const double m = p["m"], R = p["R"], k = p["k"], edge = p["edge"];
  check_gyration_radius(R, k);
  using Sphere = System<5, 6>;
  const Sphere::CoordinateNames coordinates = {"x", "y", "qw", "qx", "qy", "qz"};
  const Sphere::VelocityNames velocities = {"x_dot", "y_dot", "w1", "w2", "w3"};
  const auto rough = while_positive([=](auto /*t*/, const auto& q) { return q[0] - edge; });

  Sphere sphere(
      coordinates, velocities,
      [](const auto& q, const auto& v) {
        Eigen::Matrix<typename std::decay_t<decltype(q)>::Scalar, 6, 1> rate;
        rate << v[0], v[1], space_rate(q.template tail<4>(), v.template tail<3>());
        return rate;
      },
      [=](auto /*t*/, const auto& /*q*/, const auto& v) {
        return m / 2 * (v[0] * v[0] + v[1] * v[1] + k * k * (v[2] * v[2] + v[3] * v[3] + v[4] * v[4]));
      },
      NoForces());
  sphere.constrain(
      "rolling",
      [=](auto /*t*/, const auto& /*q*/, const auto& v) {
        return Eigen::Matrix<typename std::decay_t<decltype(v)>::Scalar, 2, 1>(v[0] - R * v[3],
                                                                               v[1] + R * v[2]);
      },
      rough);
  sphere.normalize = normalize_orientation;

  Sphere by_hand(coordinates, velocities, equations(m, k));
  by_hand.constrain("rolling", rolling(R), rough);
  by_hand.normalize = normalize_orientation;

  const Initial initial = initial_state_of_unit_length(sphere, p);
  const Quaterniond start = orientation(initial.q);
  const HalfPlaneMotion motion(R, k, edge, initial.q.head<2>(), {initial.v.head<2>(), initial.v.tail<3>()});
  Example example{sphere, by_hand, initial, {}, {}};
  if (side_at_start(sphere, initial) <= 0) {
    example.known = [=](double t) { return known(motion, start, t); };
  }
  example.invariants = {energy(),
                        {"x_dot", [](const State& s) { return s.v[0]; }},
                        {"y_dot", [](const State& s) { return s.v[1]; }},
                        {"w3", [](const State& s) { return s.v[4]; }},
                        {"abs(q)", [](const State& s) { return s.q.tail<4>().norm(); }}};
  return example;
}

}  // namespace
}  // namespace paper_sphere_quasi_parts

Entry paper_sphere_quasi() {
  using namespace paper_sphere_quasi_parts;
  const Initial as_a_rule{0, vector({-2, 0.5, 1, 0, 0, 0}), vector({1, -0.375, 4, 1.5, -2})};
  return {"paper_sphere_quasi",
          "the paper's sphere in quasi-velocities: no singular orientation",
          description,
          with_initial_values({positive("m", 2, "mass [kg]"), positive("R", 0.25, "radius [m]"),
                               gyration_radius(0.25 * std::sqrt(0.4)), rough_edge(0)},
                              as_a_rule, {"x", "y", "z"}),
          4,
          0.25,
          build};
}

}  // namespace hybrid_sphere::mechanics::catalogue

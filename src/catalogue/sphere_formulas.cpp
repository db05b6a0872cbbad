#include "catalogue/sphere_formulas.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "catalogue/entry_helpers.hpp"
#include "hybrid_sphere/mechanics/by_hand.hpp"

namespace hybrid_sphere::mechanics::catalogue {

void check_gyration_radius(double R, double k) {
  const double largest = R * std::sqrt(2.0 / 3);
  if (k > 0 && k <= largest) return;
  refuse("k", k, "> 0, at most R sqrt(2/3) = " + shortest(largest));
}

Parameter gyration_radius(double value) {
  return positive("k", value, "radius of gyration, at most R sqrt(2/3) [m]");
}

Parameter rough_edge(double value) { return number("edge", value, "the ground is rough where x > edge [m]"); }

Velocities after_impulse(double R, double k, const Velocities& before, const Vector2d& u) {
  const double D = R * R + k * k;
  const Vector2d slip = before.center + R * Vector2d(-before.spin.y(), before.spin.x()) - u;
  return {before.center - (k * k / D) * slip, before.spin + (R / D) * Vector3d(-slip.y(), slip.x(), 0)};
}

HalfPlaneMotion::HalfPlaneMotion(double R, double k, double edge, const Vector2d& at,
                                 const Velocities& initial)
    : start(at), before(initial), after(after_impulse(R, k, initial, Vector2d::Zero())) {
  const double speed = before.center.x();
  edge_time = speed > 0 ? std::max(0.0, (edge - start.x()) / speed) : std::numeric_limits<double>::infinity();
}

Quaterniond turn(const Vector3d& rotation) {
  const double angle = rotation.stableNorm();
  if (angle == 0) return Quaterniond::Identity();
  const double sine = std::sin(0.5 * angle) / angle;
  return {std::cos(0.5 * angle), sine * rotation.x(), sine * rotation.y(), sine * rotation.z()};
}

namespace euler {
namespace {

// One step of the product integral, Gauss points at h (1/2 -+ sqrt(15)/10).
Quaterniond step_over(const std::function<Vector3d(double)>& spin, double t, double h) {
  const double middle = t + 0.5 * h;
  const double offset = std::sqrt(15.0) / 10 * h;
  const Vector3d first = spin(middle - offset);
  const Vector3d second = spin(middle);
  const Vector3d third = spin(middle + offset);
  const Vector3d a1 = h * second;
  const Vector3d a2 = (std::sqrt(15.0) / 3 * h) * (third - first);
  const Vector3d a3 = (10.0 / 3 * h) * ((third - second) - (second - first));
  const Vector3d c1 = a1.cross(a2);
  const Vector3d c2 = (-1.0 / 60) * a1.cross(2 * a3 + c1);
  return turn(a1 + a3 / 12 + (1.0 / 240) * (c1 - 20 * a1 - a3).cross(a2 + c2));
}

Quaterniond orientation(const Vector3d& angles) {
  const double sum = (angles[0] + angles[2]) / 2;
  const double difference = (angles[0] - angles[2]) / 2;
  const double c = std::cos(angles[1] / 2);
  const double s = std::sin(angles[1] / 2);
  return {c * std::cos(sum), s * std::cos(difference), s * std::sin(difference), c * std::sin(sum)};
}

// The angles of an orientation that are nearest to those before it.
Vector3d nearest(const Quaterniond& q, const Vector3d& before) {
  const auto unwrapped = [](double angle, double near) {
    const double round = 2 * M_PI;
    return angle + round * std::round((near - angle) / round);
  };
  const double sum = unwrapped(std::atan2(q.z(), q.w()), (before[0] + before[2]) / 2);
  const double difference = unwrapped(std::atan2(q.y(), q.x()), (before[0] - before[2]) / 2);
  const double theta = 2 * std::atan2(std::hypot(q.x(), q.y()), std::hypot(q.z(), q.w()));
  return {sum + difference, theta, sum - difference};
}

}  // namespace

std::vector<Parameter> with_initial_values(std::vector<Parameter> constants, const Initial& as_a_rule) {
  const Vector &q = as_a_rule.q, &v = as_a_rule.v;
  std::vector<Parameter> all = std::move(constants);
  all.push_back(number("x", q[0], "centre at t = 0 [m]"));
  all.push_back(number("y", q[1], "centre at t = 0 [m]"));
  all.push_back(number("psi", q[2], "precession angle [rad]"));
  all.push_back({"theta", q[3], 0, M_PI, "nutation angle [rad]"});
  all.push_back(number("phi", q[4], "angle of the body's own rotation [rad]"));
  all.push_back(number("x_dot", v[0], "velocity of the centre [m/s]"));
  all.push_back(number("y_dot", v[1], "velocity of the centre [m/s]"));
  all.push_back(number("psi_dot", v[2], "rate of psi [rad/s]"));
  all.push_back(number("theta_dot", v[3], "rate of theta [rad/s]"));
  all.push_back(number("phi_dot", v[4], "rate of phi [rad/s]"));
  return all;
}

std::shared_ptr<const EquationsOfMotion> equations_by_hand(double m, double k) {
  const double J = m * k * k;
  return mechanics::equations_by_hand(
      5, 5, [m, J](double /*t*/, const Vector& q, const Vector& v, MotionTerms& terms) {
        const double c = std::cos(q[3]);
        const double s = std::sin(q[3]);
        const double psid = v[2], thetad = v[3], phid = v[4];
        terms.rate = v;
        terms.momentum << m * v[0], m * v[1], J * (psid + c * phid), J * thetad, J * (phid + c * psid);
        terms.lagrangian = v.dot(terms.momentum) / 2;
        terms.mass.setZero();
        terms.mass.diagonal() << m, m, J, J, J;
        terms.mass(2, 4) = terms.mass(4, 2) = J * c;
        terms.force << 0, 0, J * s * thetad * phid, -J * s * phid * psid, J * s * thetad * psid;
      });
}

std::shared_ptr<const ConstraintFunction> slip_by_hand(double R, double W) {
  return constraint_by_hand(
      2, [R, W](double /*t*/, const Vector& q, const Vector& v, const Vector& rate, ConstraintTerms& terms) {
        const double c = std::cos(q[3]), s = std::sin(q[3]);
        const double cp = std::cos(q[2]), sp = std::sin(q[2]);
        terms.gradient << 1, 0, 0, -R * sp, R * s * cp,  //
            0, 1, 0, R * cp, R * s * sp;
        terms.value = terms.gradient * v + W * Vector2d(q[1], -q[0]);
        terms.gamma << R * ((v[3] * cp + v[4] * s * sp) * rate[2] - v[4] * c * cp * rate[3]) - W * rate[1],
            R * ((v[3] * sp - v[4] * s * cp) * rate[2] - v[4] * c * sp * rate[3]) + W * rate[0];
      });
}

Vector3d rates(const Vector3d& angles, const Vector3d& spin) {
  const double cp = std::cos(angles[0]), sp = std::sin(angles[0]);
  const double phid = (spin.x() * sp - spin.y() * cp) / std::sin(angles[1]);
  return {spin.z() - phid * std::cos(angles[1]), spin.x() * cp + spin.y() * sp, phid};
}

std::optional<Vector3d> continued(const Vector3d& angles, const std::function<Vector3d(double)>& spin,
                                  double begin, double end, double step) {
  constexpr double max_steps = 1e5;
  if (std::sin(angles[1]) == 0 || end < begin || end - begin > max_steps * step) return std::nullopt;
  Quaterniond q = orientation(angles);
  Vector3d now = angles;
  double h = step;
  for (double t = begin; t < end;) {
    const double next = t + h < end ? t + h : end;
    if (!(next > t)) return std::nullopt;
    const Quaterniond there = step_over(spin, t, next - t) * q;
    const Vector3d candidate = nearest(there, now);
    // A path past the pole turns psi and phi by up to pi; halved until none of them can be told wrongly.
    if ((candidate - now).cwiseAbs().maxCoeff() > 1) {
      h /= 2;
      if (h < 1e-9 * step) return std::nullopt;
      continue;
    }
    q = there.normalized();
    now = candidate;
    t = next;
    h = std::min(step, 2 * h);
  }
  return now;
}

std::optional<Vector3d> continued(const Vector3d& angles, const Vector3d& spin, double time) {
  const double speed = spin.norm();
  const double step = speed > 0 ? 0.25 / speed : std::max(time, 1.0);
  return continued(
      angles, [&spin](double) { return spin; }, 0, time, step);
}

}  // namespace euler
}  // namespace hybrid_sphere::mechanics::catalogue

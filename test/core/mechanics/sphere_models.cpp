#include "core/mechanics/sphere_models.hpp"

#include <cmath>

#include "catalogue/quaternion.hpp"
#include "catalogue/sphere_formulas.hpp"
#include "hybrid_sphere/mechanics/system.hpp"

namespace hybrid_sphere::testing {
namespace {

using mechanics::Index;
using mechanics::Model;
using mechanics::Vector;
namespace euler = mechanics::catalogue::euler;

template <int N>
std::shared_ptr<const mechanics::Guard> guard_of(const RoughGround& ground) {
  return mechanics::automatic_guard<N>("guard of " + ground.region, [ground](auto /*t*/, const auto& q) {
    using std::sin;
    using T = typename std::decay_t<decltype(q)>::Scalar;
    if (ground.period > 0) return T(sin(2 * M_PI / ground.period * q[0]));
    if (ground.radius > 0) {
      const T x = q[0] - ground.center.x(), y = q[1] - ground.center.y();
      return T(ground.radius * ground.radius - x * x - y * y);
    }
    T product = ground.edges.size() % 2 == 1 ? 1 : -1;
    for (const double edge : ground.edges) product = product * (q[0] - edge);
    return product;
  });
}

const scene::Material& material_of(const scene::Scene& scene, const std::string& region) {
  for (const scene::Region& candidate : scene.surface.regions) {
    if (candidate.name == region) return candidate.material;
  }
  throw std::invalid_argument("the scene has no region " + region);
}

// (21) on moving ground: sigma - u, with the angular velocity `spin`.
template <class Q, class V, class W>
auto slip_on(const scene::Material& ground, double R, const Q& q, const V& v, const W& spin) {
  Eigen::Matrix<typename V::Scalar, 2, 1> slip;
  const double rate = ground.turntable_rate;
  slip[0] = v[0] - R * spin[1] - ground.belt.x() + rate * (q[1] - ground.turntable_center.y());
  slip[1] = v[1] + R * spin[0] - ground.belt.y() - rate * (q[0] - ground.turntable_center.x());
  return slip;
}

}  // namespace

Model sphere_in_angles(const scene::Scene& scene, const std::vector<RoughGround>& grounds) {
  const double m = scene.sphere.mass, R = scene.sphere.radius, k = scene.sphere.gyration_radius;
  const Vector3d gravity = scene.forces.gravity;
  mechanics::System<5> sphere(
      {"x", "y", "psi", "theta", "phi"}, [=](auto /*t*/, const auto& q, const auto& v) {
        return euler::lagrangian(m, k, q, v) + m * (gravity.x() * q[0] + gravity.y() * q[1]);
      });
  for (const RoughGround& ground : grounds) {
    const scene::Material material = material_of(scene, ground.region);
    const auto rolling = [=](auto /*t*/, const auto& q, const auto& v) {
      return slip_on(material, R, q, v, euler::spin(q, v));
    };
    sphere.constraints.push_back(
        {ground.region, mechanics::automatic_constraint<5, 5>(ground.region, rolling), {}});
    sphere.constraints.back().schedule.guard = guard_of<5>(ground);
  }
  return sphere;
}

Model sphere_in_quasi_velocities(const scene::Scene& scene, const std::vector<RoughGround>& grounds) {
  const double m = scene.sphere.mass, R = scene.sphere.radius, k = scene.sphere.gyration_radius;
  const Vector3d gravity = scene.forces.gravity;
  mechanics::System<5, 6> sphere(
      {"x", "y", "qw", "qx", "qy", "qz"}, {"x_dot", "y_dot", "w1", "w2", "w3"},
      [](const auto& q, const auto& v) {
        Eigen::Matrix<typename std::decay_t<decltype(q)>::Scalar, 6, 1> rate;
        rate << v[0], v[1], mechanics::catalogue::space_rate(q.template tail<4>(), v.template tail<3>());
        return rate;
      },
      [=](auto /*t*/, const auto& q, const auto& v) {
        return m / 2 * (v[0] * v[0] + v[1] * v[1] + k * k * (v[2] * v[2] + v[3] * v[3] + v[4] * v[4])) +
               m * (gravity.x() * q[0] + gravity.y() * q[1]);
      },
      mechanics::NoForces());
  for (const RoughGround& ground : grounds) {
    const scene::Material material = material_of(scene, ground.region);
    const auto rolling = [=](auto /*t*/, const auto& q, const auto& v) {
      return slip_on(material, R, q, v, v.template tail<3>());
    };
    sphere.constraints.push_back(
        {ground.region, mechanics::automatic_constraint<5, 6>(ground.region, rolling), {}});
    sphere.constraints.back().schedule.guard = guard_of<6>(ground);
  }
  sphere.normalize = mechanics::catalogue::normalize_orientation;
  return sphere;
}

mechanics::Initial initial_in_angles(const scene::Scene& scene) {
  const Quaterniond& o = scene.initial_state.orientation;
  const double sum = std::atan2(o.z(), o.w()), difference = std::atan2(o.y(), o.x());
  const double theta = 2 * std::atan2(std::hypot(o.x(), o.y()), std::hypot(o.w(), o.z()));
  const Vector3d angles(sum + difference, theta, sum - difference);
  mechanics::Initial initial{0, Vector(5), Vector(5)};
  initial.q << scene.initial_state.position, angles;
  initial.v << scene.initial_state.velocity, euler::rates(angles, scene.initial_state.angular_velocity);
  return initial;
}

mechanics::Initial initial_in_quasi_velocities(const scene::Scene& scene) {
  const scene::InitialState& state = scene.initial_state;
  mechanics::Initial initial{0, Vector(6), Vector(5)};
  initial.q << state.position, state.orientation.w(), state.orientation.vec();
  initial.v << state.velocity, state.angular_velocity;
  return initial;
}

SphereState sphere_of_angles(const Vector& q, const Vector& v) {
  const Quaterniond orientation(Eigen::AngleAxisd(q[2], Vector3d::UnitZ()) *
                                Eigen::AngleAxisd(q[3], Vector3d::UnitX()) *
                                Eigen::AngleAxisd(q[4], Vector3d::UnitZ()));
  return {q.head<2>(), v.head<2>(), euler::spin(q, v), orientation};
}

SphereState sphere_of_quasi_velocities(const Vector& q, const Vector& v) {
  return {q.head<2>(), v.head<2>(), v.tail<3>(), mechanics::catalogue::orientation(q)};
}

}  // namespace hybrid_sphere::testing

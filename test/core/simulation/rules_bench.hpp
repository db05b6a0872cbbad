#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "simulation/switching_rules.hpp"

/// The rules by which stages switch, without a simulation: a sphere, its forces, and how it arrives.
namespace hybrid_sphere::testing {

using scene::Law;
using scene::Material;

inline constexpr double unit = 0x1p-53;      ///< a rounding
inline constexpr double rounding = 0x1p-40;  ///< of the speeds, where a case has any [m/s]
inline const Vector2d still(0, 0);
inline const Vector2d belt_velocity(1, 0.5);

inline Material ground_of(Law law, double friction = 0, double resistance = 0,
                          const Vector2d& velocity = still) {
  Material material(law);
  material.friction = friction;
  material.rolling_resistance = resistance;
  material.belt = velocity;
  return material;
}

/// At (0.5, -0.25), where the sphere is, u = 2 J (0.5, -1.25) = (2.5, 1).
inline Material turntable(Law law) {
  Material material(law);
  material.turntable_rate = 2;
  material.turntable_center = {0, 1};
  return material;
}

/// Homogeneous, a thin shell, and heavy inside.
inline std::vector<scene::SphereBody> bodies() {
  return {{1, 0.5, 0.5 * std::sqrt(0.4)}, {0.003, 0.02, 0.02 * std::sqrt(2. / 3)}, {1000, 30, 5}};
}

/// The sphere and its rules: as a rule kappa = 1/5, N/m = 8 m/s^2 and a slope that pulls along x.
struct Bench {
  explicit Bench(double rounded = 0, double pull = 0, const scene::SphereBody& of = {2, 0.5, 0.25})
      : body(of), sphere(body), dynamics(sphere, forces(pull)), rules(sphere, dynamics, rounded) {}
  explicit Bench(const scene::SphereBody& of) : Bench(0, 0, of) {}
  Bench(const Bench&) = delete;  // the rules point to the others
  Bench& operator=(const Bench&) = delete;
  static scene::Forces forces(double pull) {
    scene::Forces forces;
    forces.gravity = {pull, 0, -8};
    return forces;
  }
  /// With v, nu = R (omega_2, -omega_1) and R omega_3.
  Arrival arrival(const Vector2d& v, const Vector2d& nu, double spin = 0.75) const {
    Arrival arrival;
    const Vector3d omega = Vector3d(0 - nu.y(), nu.x(), spin) / body.radius;
    arrival.state = {{0.5, -0.25}, Quaterniond::Identity(), {v, omega}, v - nu};
    return arrival;
  }
  Arrival moving() const { return arrival({1.5, -0.5}, {-0.75, -1}); }  // sigma = (2.25, 0.5)
  Reset apply_reset(const Material& ground, Arrival& arrival) const {
    return rules.apply_reset(ground, {true, ContactMode::free, Law::smooth, {}}, arrival);
  }
  Vector2d nu(const Twist& twist) const {
    return body.radius * Vector2d(twist.angular_velocity.y(), -twist.angular_velocity.x());
  }
  double size(const Twist& twist) const {
    return twist.velocity.norm() + body.radius * twist.angular_velocity.norm();
  }

  const scene::SphereBody body;
  const Sphere sphere;
  const Dynamics dynamics;
  const SwitchingRules rules;
};

inline void expect_unchanged(const Segment::Start& state, const Segment::Start& before) {
  EXPECT_EQ(state.twist.velocity, before.twist.velocity);
  EXPECT_EQ(state.twist.angular_velocity, before.twist.angular_velocity);
  EXPECT_EQ(state.contact_velocity, before.contact_velocity);
}

/// At rest relative to ground that moves with u, but for the spin.
inline void expect_rest(const Segment::Start& state, const Vector2d& u) {
  EXPECT_EQ(state.twist.velocity, u);
  EXPECT_EQ(state.twist.angular_velocity.head<2>(), still);
  EXPECT_EQ(state.contact_velocity, u);
}

}  // namespace hybrid_sphere::testing

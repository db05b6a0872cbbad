// The orientation where another part of the motion is far faster than the spin, or the spin begins suddenly.

#include <gtest/gtest.h>

#include <cmath>

#include "hybrid_sphere/simulation/simulation.hpp"

namespace hybrid_sphere::testing::fast_and_slow_spin_test {
namespace {

const Vector3d axis = Vector3d(1, 2, 3) / std::sqrt(14.0);

scene::Scene smooth(double radius) {
  scene::Scene scene{};
  scene.sphere = {1, radius, 0.6 * radius};
  scene.forces.gravity = {0, 0, -9.8};
  scene.surface.base = scene::Law::smooth;
  scene.initial_state.velocity = {1, 0};
  return scene;
}

double distance(const Quaterniond& q, double angle) {
  const Vector3d sine = std::sin(0.5 * angle) * axis;
  const Quaterniond expected(std::cos(0.5 * angle), sine.x(), sine.y(), sine.z());
  return (q.coeffs() - expected.coeffs()).norm();
}

// The rate of the drag is no frequency whose phase would be uncertain.
TEST(FreeSpin, IsExactBesideAStrongDragOfTheCentre) {
  constexpr double growth = 0.004;  // of the spin [rad/s^2]
  scene::Scene scene = smooth(1);
  scene.forces.drag.translational = 1e6;
  scene.forces.wrench.torque = 0.36 * growth * axis;
  Simulation simulation(scene);
  for (const double time : {1.0, 10.0, 100.0}) {
    simulation.advance_to(time);
    EXPECT_LE(distance(simulation.state().orientation, 0.5 * growth * time * time), 1e-13) << time;
  }
}

// Nor is its spin the difference of velocities, whose rounding would be large against the radius.
TEST(FreeSpin, IsExactBesideAGreatSpeedOfASmallSphere) {
  constexpr double radius = 1e-3;
  constexpr double inertia = 0.36 * radius * radius;
  constexpr double rate = 1e-3;    // of the drag [1/s]
  constexpr double spin = 0.05;    // [rad/s]
  constexpr double growth = 2e-4;  // [rad/s^2]
  scene::Scene scene = smooth(radius);
  scene.initial_state.velocity = {100, 0};
  scene.initial_state.angular_velocity = spin * axis;
  scene.forces.drag.rotational = rate * inertia;
  scene.forces.wrench.torque = inertia * growth * axis;
  Simulation simulation(scene);
  for (const double time : {1.0, 100.0, 1000.0}) {
    simulation.advance_to(time);
    const double decayed = -std::expm1(-rate * time) / rate;
    const double angle = spin * decayed + growth / rate * (time - decayed);
    EXPECT_LE(distance(simulation.state().orientation, angle), 1e-13) << time;
  }
}

// The first steps that are tried turn the sphere by far too much, and their errors tell nothing but that.
TEST(RollingSpin, IsThatOfTheWayWhereItBeginsSuddenly) {
  scene::Scene scene{};
  scene.sphere = {1.25, 1, 0.5};
  scene.forces.gravity = {0, 0, -8};
  scene.forces.drag.quadratic = 0.0625;
  scene.forces.spring = {{3, 4}, 0.125};
  scene.surface.base = scene::Law::rough;
  scene.initial_state.position = {1e10, 4};
  Simulation simulation(scene);
  for (const double time : {1e-300, 1e-9, 1e-5}) {
    simulation.advance_to(time);
    const State& now = simulation.state();
    const double angle = now.position.x() - 1e10;  // over the radius, about the y-axis
    const Eigen::Vector4d expected(0, std::sin(0.5 * angle), 0, std::cos(0.5 * angle));
    EXPECT_LE((now.orientation.coeffs() - expected).norm(), 2e-6) << time;  // places there are 2e-6 m apart
  }
}

}  // namespace
}  // namespace hybrid_sphere::testing::fast_and_slow_spin_test

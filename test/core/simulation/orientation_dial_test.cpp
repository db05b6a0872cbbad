// The orientation along closed forms follows the dial: within the accuracy, relative to the angle turned, at
// every output, and nothing else depends on it.

#include <gtest/gtest.h>

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <cstring>
#include <string>
#include <vector>

#include "hybrid_sphere/simulation/simulation.hpp"
#include "support/case_count.hpp"

namespace hybrid_sphere::testing::orientation_dial_test {
namespace {

using scene::Law;
using scene::Material;

struct Case {
  std::string name;
  scene::Scene scene;
};

Case on(const std::string& name, const Material& ground, const Vector2d& gravity = {0, 0}) {
  Case one{name, {}};
  one.scene.sphere = {2, 0.25, 0.25 * std::sqrt(0.4)};
  one.scene.initial_state.position = {-3, 0.5};
  one.scene.initial_state.velocity = {1, -0.375};
  one.scene.initial_state.angular_velocity = {4, 1.5, -2};
  one.scene.forces.gravity.head<2>() = gravity;
  one.scene.surface.base = ground;
  return one;
}

Material turning() {
  Material material(Law::rough);
  material.turntable_rate = 3;
  return material;
}

Material coulomb(double friction) {
  Material material(Law::coulomb);
  material.friction = friction;
  return material;
}

Case between_belts() {
  Material right(Law::rough);
  right.belt = {-1, 0.5};
  Material left(Law::rough);
  left.belt = {1, 0.25};
  Case one = on("edge slide", right);
  one.scene.surface.regions = {{"left", scene::HalfPlane{{0, 0}, {-1, 0}}, left}};
  one.scene.initial_state.position = {-0.01, 1};
  one.scene.initial_state.velocity = {0.125, 0};
  one.scene.forces.wrench.force = {0.01, 2};
  return one;
}

// The slip is thrown up the slope and misses 0 by a millionth: the friction turns round within microseconds.
Case sharp_corner() {
  Case one = on("slide with a corner", coulomb(0.2), {2, 0});
  one.scene.initial_state.velocity = {-4, 4e-6};
  one.scene.initial_state.angular_velocity = {0, 0, 0.02};
  return one;
}

std::vector<Case> cases() {
  std::vector<Case> all{on("turntable circle", turning()),
                        on("cycloid", turning(), {1, 0}),
                        on("spring", Law::rough),
                        on("incline", Law::rough, {1, 0}),
                        on("slide on a slope", coulomb(0.05), {3, 0}),
                        on("drag", Law::rough)};
  all[2].scene.forces.spring.stiffness = 3;
  all[5].scene.forces.drag = {0.5, 0.01, 0};
  all.push_back(between_belts());
  all.push_back(sharp_corner());
  return all;
}

struct Output {
  State state;
  double angle;  ///< turned so far, by the trapezoidal rule
};

std::vector<Output> outputs(scene::Scene scene, double accuracy) {
  scene.solver.accuracy = accuracy;
  Simulation simulation(scene);
  std::vector<Output> all;
  double speed = 0;
  for (int i = 0; i <= 400; ++i) {
    simulation.advance_to(i / 64., [](const Switch&) {});
    const double last = speed;
    speed = simulation.state().twist.angular_velocity.norm();
    const double angle = all.empty() ? 0 : all.back().angle + 0.5 * (last + speed) / 64;
    all.push_back({simulation.state(), angle});
    all.back().state.region = {};  // the name does not outlive the simulation
  }
  return all;
}

/// Largest error of a rotation, in units of what is asked for and what rounding adds.
double worst(const std::vector<Output>& found, const std::vector<Output>& reference, double accuracy) {
  double ratio = 0;
  for (std::size_t i = 0; i < found.size(); ++i) {
    const auto& q = found[i].state.orientation.coeffs();
    const auto& expected = reference[i].state.orientation.coeffs();
    const double error = 2 * std::min((q - expected).norm(), (q + expected).norm());
    const double angle = reference[i].angle;
    const double allowed = accuracy * angle + 16 * DBL_EPSILON * (1 + angle);
    ratio = std::max(ratio, std::isnan(error) ? HUGE_VAL : error / allowed);
  }
  return ratio;
}

// The steps are chosen for a fiftieth. The first output is not the reference's own step; a tenth of what is
// asked for leaves the estimate of a step wrong by a factor of five, and the angle by the trapezoidal rule.
TEST(OrientationDial, TheOrientationOfAClosedFormIsWithinATenthOfTheAccuracyAskedFor) {
  for (const Case& one : cases()) {
    const auto reference = outputs(one.scene, 1e-14);
    for (const double accuracy : {1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9}) {
      EXPECT_LE(worst(outputs(one.scene, accuracy), reference, 0.1 * accuracy), 1)
          << one.name << " at " << accuracy;
    }
  }
}

TEST(OrientationDial,
     TheOrientationOfAClosedFormIsFollowedToRoundingByDefaultAndNoFurtherWhereLessIsAskedFor) {
  for (const Case& one : cases()) {
    const auto reference = outputs(one.scene, 1e-14);
    EXPECT_LE(worst(outputs(one.scene, 1e-9), reference, 0), 0) << one.name << ": the same steps";
    // Rounding is 1e-16; the steps of a motion that turns much use some of 2e-4.
    if (one.name != "slide with a corner") {
      EXPECT_GE(worst(outputs(one.scene, 1e-2), reference, 0), 100) << one.name;
    }
  }
}

/// By Euler's exponential method at the middles of many short steps, on the velocities that are told.
Quaterniond turned_bit_by_bit(const scene::Scene& scene, double time) {
  constexpr int steps = 100000;
  Simulation simulation(scene);
  Quaterniond q = scene.initial_state.orientation;
  for (int i = 0; i < steps; ++i) {
    simulation.advance_to(time * (i + 0.5) / steps, [](const Switch&) {});
    const Vector3d turn = time / steps * simulation.state().twist.angular_velocity;
    const double angle = turn.norm();
    const Vector3d axis = std::sin(0.5 * angle) / angle * turn;
    q = Quaterniond(std::cos(0.5 * angle), axis.x(), axis.y(), axis.z()) * q;
  }
  return q.normalized();
}

// The slip is used up after 6 ms, and its direction turns with a power of the time that is left. The method
// of comparison errs by the square of its steps of 9e-8 s: 1e-12. The angle is about 0.01 rad.
TEST(OrientationDial, TheOrientationOfAnIntegratedSlideIsWithinTheAccuracyAskedForAtTheEndOfTheSlip) {
  Case one = on("slide with drag", coulomb(0.40743122590986058));
  one.scene.sphere = {1, 0.60507682807148344, 0.22018957642180814};
  one.scene.forces.gravity.z() = -9.81;
  one.scene.forces.drag = {0.99461664261431304, 0.00020231260147309983, 0.72337419616414844};
  one.scene.forces.wrench.force = {-1.1234244688115913, 1.4223057197359972};
  one.scene.initial_state.velocity = {0.75854353571327193, -0.67916722237045102};
  one.scene.initial_state.angular_velocity = {0.84284409935559346, 1.0327875862320042, -0.057453763268232462};
  const double end = 0.009;
  const Quaterniond expected = turned_bit_by_bit(one.scene, end);
  for (const double accuracy : {1e-3, 1e-6, 1e-9}) {
    one.scene.solver.accuracy = accuracy;
    Simulation simulation(one.scene);
    simulation.advance_to(end, [](const Switch&) {});
    ASSERT_GT(simulation.evaluations(), 0U);
    const double error = 2 * (simulation.state().orientation.coeffs() - expected.coeffs()).norm();
    EXPECT_LE(error, 0.01 * accuracy + 1e-12) << accuracy;
  }
}

// Straight up a slope and back again: quadratic drag has a kink where the sphere turns back. The angle is the
// way over the radius. Where in a step the kink lies decides what the difference of two rules tells of it.
TEST(OrientationDial, TheOrientationOfAnIntegratedMotionIsThatOfTheWayWhereQuadraticDragChangesItsSign) {
  Case one = on("drag", Law::rough, {-2, 0});
  one.scene.forces.drag.quadratic = 4;
  one.scene.initial_state.angular_velocity.setZero();
  double greatest = 0;
  const int cases = case_count(500);
  for (int i = 0; i < cases; ++i) {
    one.scene.initial_state.velocity = {2 + static_cast<double>(i) / cases, 0};
    one.scene.initial_state.angular_velocity.y() = one.scene.initial_state.velocity.x() / 0.25;
    Simulation simulation(one.scene);
    simulation.advance_to(2.5, [](const Switch&) {});
    const State& state = simulation.state();
    ASSERT_LT(state.twist.velocity.x(), -0.1);
    const double half = 0.5 * (state.position.x() + 3) / 0.25;
    const Quaterniond expected(std::cos(half), 0, std::sin(half), 0);
    const auto& q = state.orientation.coeffs();
    greatest =
        std::max(greatest, 2 * std::min((q - expected.coeffs()).norm(), (q + expected.coeffs()).norm()));
  }
  EXPECT_LE(greatest, 1e-9);
}

// The time at which the edge is met is told by two sums that round differently: no orientation must be taken
// from a motion that has been forgotten.
TEST(OrientationDial, TheOrientationOfAnIntegratedMotionIsKeptAcrossAnEdgeAtAnyAccuracy) {
  Case one = on("spring and drag", Law::smooth);
  one.scene.sphere = {1, 1, std::sqrt(0.4)};
  one.scene.initial_state.position = {-0.3, 0};
  one.scene.initial_state.velocity = {2.654, 0.3};
  one.scene.initial_state.angular_velocity = {1, 3, 0};
  Material belt = coulomb(0.007);
  belt.belt = {0.5, 0.2};
  one.scene.surface.regions = {{"right", scene::HalfPlane{{0, 0}, {1, 0}}, belt}};
  one.scene.forces.gravity.z() = -9.81;
  one.scene.forces.drag = {0, 2, 35};
  one.scene.forces.spring = {{1, 0.2}, 600};
  const auto orientation = [&one](double accuracy) {
    one.scene.solver.accuracy = accuracy;
    Simulation simulation(one.scene);
    simulation.advance_to(1.2, [](const Switch&) {});
    return simulation.state().orientation.coeffs().eval();
  };
  const auto reference = orientation(1e-13);
  for (int i = 0; i < 160; ++i) {  // the angle is about 1 rad
    const double accuracy = std::pow(10, -9 - 3 * i / 160.0);
    EXPECT_LE(2 * (orientation(accuracy) - reference).norm(), accuracy) << accuracy;
  }
}

bool same_but_for_the_orientation(const State& a, const State& b) {
  const auto same = [](const auto& x, const auto& y) { return std::memcmp(&x, &y, sizeof x) == 0; };
  return same(a.position, b.position) && same(a.slip, b.slip) && same(a.twist.velocity, b.twist.velocity) &&
         same(a.twist.angular_velocity, b.twist.angular_velocity) && a.mode == b.mode;
}

TEST(OrientationDial, TheOrientationOfAClosedFormIsAllThatDependsOnTheAccuracy) {
  for (const Case& one : cases()) {
    const auto reference = outputs(one.scene, 1e-14);
    for (const double accuracy : {1.0, 1e-3, 1e-6}) {
      const auto found = outputs(one.scene, accuracy);
      for (std::size_t i = 0; i < found.size(); ++i) {
        ASSERT_TRUE(same_but_for_the_orientation(found[i].state, reference[i].state))
            << one.name << " at " << accuracy << ", t = " << found[i].state.time;
      }
    }
  }
}

}  // namespace
}  // namespace hybrid_sphere::testing::orientation_dial_test

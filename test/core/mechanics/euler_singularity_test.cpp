// Near sin(theta) = 0, where Euler angles degenerate: the general engine keeps the accuracy of the body, says
// how near it came, and stops where it cannot go on.

#include <gtest/gtest.h>

#include <cmath>

#include "catalogue/sphere_systems.hpp"
#include "core/catalogue/own_references.hpp"
#include "core/mechanics/sphere_cases.hpp"
#include "core/mechanics/sphere_models.hpp"
#include "support/recorded.hpp"

namespace hybrid_sphere::testing::euler_singularity_test {
namespace {

using mechanics::Options;
using mechanics::Solution;
using mechanics::Stop;
using mechanics::catalogue::testing::own_reference;
using mechanics::catalogue::testing::ReferenceState;
using mechanics::catalogue::testing::ReferenceSystem;

Options accurate(double accuracy) {
  Options options;
  options.accuracy = accuracy;
  options.max_steps = 20000;
  return options;
}

/// The paper's sphere, whose body axis comes to within `miss` [rad] of the vertical at t = 1.
scene::Scene passing_the_pole(double miss) {
  scene::Scene scene = paper().scene;
  const Vector3d spin(2, 1, 2);  // of length 3
  scene.initial_state.angular_velocity = spin;
  scene.initial_state.orientation =
      Eigen::AngleAxisd(-3, spin / 3) * Quaterniond(Eigen::AngleAxisd(miss, Vector3d(1, -2, 0).normalized()));
  return scene;
}

TEST(EulerAngles, KeepTheAccuracyOfTheBodyNearTheirSingularity) {
  const ReferenceSystem system = own_reference("turntable_ball_near_pole", "turntable_ball");
  for (const double accuracy : {1e-6, 1e-10}) {
    const Solution solution =
        solve(system.example.model, system.example.initial, system.duration(), accurate(accuracy));
    ASSERT_EQ(solution.status().stop, Stop::reached_end) << solution.status().message;
    for (const ReferenceState& state : system.states) {
      const mechanics::State at = solution.at(state.time);
      const SphereState found = sphere_of_angles(at.q, at.v), expected = sphere_of_angles(state.q, state.v);
      // The ball covers 2 m at 1 m/s and turns by 6 rad at 3 rad/s, and all of them count as 1.
      EXPECT_LE((found.position - expected.position).norm(), accuracy) << "t = " << state.time;
      EXPECT_LE((found.velocity - expected.velocity).norm(), accuracy) << "t = " << state.time;
      EXPECT_LE((found.spin - expected.spin).norm(), accuracy) << "t = " << state.time;
      EXPECT_LE((found.orientation * expected.orientation.conjugate()).vec().norm(), accuracy)
          << "t = " << state.time;
    }
  }
}

// The pivots of M are 1, 1, 1, 1 and sin(theta)^2.
TEST(EulerAngles, SayHowNearTheirSingularityTheyCame) {
  for (const double miss : {0.1, 0.01}) {
    const scene::Scene scene = passing_the_pole(miss);
    const Solution solution =
        solve(sphere_in_angles(scene, paper().grounds), initial_in_angles(scene), 1.5, accurate(1e-8));
    ASSERT_EQ(solution.status().stop, Stop::reached_end) << solution.status().message;
    // At a step next to the place, which the steps become short for: at most as far from it as that is off.
    EXPECT_GE(solution.regularity(), 0.999 * std::pow(std::sin(miss), 2));
    EXPECT_LE(solution.regularity(), 2 * std::pow(std::sin(miss), 2));
    // It passes at 3 rad/s, at most.
    EXPECT_NEAR(solution.least_regular_time(), 1, miss);
  }
}

TEST(EulerAngles, CannotStartWhereTheyAreSingular) {
  const mechanics::catalogue::Entry entry = mechanics::catalogue::paper_sphere();
  mechanics::catalogue::Values values(entry.parameters);
  values.set("theta", 0);
  const mechanics::catalogue::Example example = entry.build(values);
  for (const mechanics::Model& model : {example.model, example.by_hand}) {
    const Solution solution = solve(model, example.initial, 1, accurate(1e-6));
    EXPECT_EQ(solution.status().stop, Stop::singular);
    EXPECT_EQ(solution.status().time, 0);
    EXPECT_NE(solution.status().message.find("theta = 0"), std::string::npos) << solution.status().message;
  }
}

TEST(EulerAngles, StopAtTheirSingularityAndQuasiVelocitiesGoOn) {
  const scene::Scene scene = passing_the_pole(1e-8);
  const Record record = testing::record(scene, 4, 16);
  for (const double accuracy : {1e-6, 1e-10}) {
    const Solution in_angles =
        solve(sphere_in_angles(scene, paper().grounds), initial_in_angles(scene), 4, accurate(accuracy));
    EXPECT_EQ(in_angles.status().stop, Stop::singular) << in_angles.status().message;
    EXPECT_NEAR(in_angles.end(), 1, 1e-6);
    EXPECT_LE(in_angles.regularity(), 1e-12);

    const Solution solution = solve(sphere_in_quasi_velocities(scene, paper().grounds),
                                    initial_in_quasi_velocities(scene), 4, accurate(accuracy));
    ASSERT_EQ(solution.status().stop, Stop::reached_end) << solution.status().message;
    EXPECT_GT(solution.regularity(), 0.999);
    for (const RecordedState& state : record.states) {
      const mechanics::State at = solution.at(state.time);
      const SphereState found = sphere_of_quasi_velocities(at.q, at.v);
      // In 4 s the sphere covers 4 m and turns by 12 rad.
      EXPECT_LE((found.position - state.position).norm(), 4 * accuracy) << "t = " << state.time;
      EXPECT_LE(2 * (found.orientation * state.orientation.conjugate()).vec().norm(), 12 * accuracy)
          << "t = " << state.time;
    }
  }
}

}  // namespace
}  // namespace hybrid_sphere::testing::euler_singularity_test

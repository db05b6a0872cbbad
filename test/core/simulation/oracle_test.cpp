// Scenes with a solution in a hundred digits: every state within the tolerance that the solution gives for a
// fair binary64 program, every change of the constraint, and no other.

#include <gtest/gtest.h>

#include "hybrid_sphere/scene/read_scene.hpp"
#include "hybrid_sphere/scene/yaml.hpp"
#include "support/expected.hpp"
#include "support/files.hpp"
#include "support/recorded.hpp"

namespace hybrid_sphere::testing {
namespace {

constexpr double unit = 0x1p-53;  // rounding of one operation, relative

double largest(const Eigen::MatrixXd& difference) { return difference.cwiseAbs().maxCoeff(); }

// Up to sign: q and -q are one attitude.
double largest(const Quaterniond& a, const Quaterniond& b) {
  return std::min(largest(a.coeffs() - b.coeffs()), largest(a.coeffs() + b.coeffs()));
}

double size_of(const Twist& twist, double radius) {
  return twist.velocity.norm() + radius * twist.angular_velocity.norm();
}

class OracleScene : public ::testing::TestWithParam<std::string> {
 protected:
  OracleScene()
      : path_(std::string(TEST_DATA_DIR) + "/oracle/" + GetParam()),
        scene_(scene::read_scene(scene::tree_from_yaml_file(path_ + ".yaml"))),
        expected_(read_expected(path_ + ".expected.yaml")),
        simulation_(scene_) {}

  void check(double deviation, double tolerance, const std::string& what) {
    EXPECT_LE(deviation, tolerance) << what;
    if (tolerance > 0) worst_ = std::max(worst_, deviation / tolerance);
  }

  void check_state(const State& state, const ExpectedState& expected) {
    const std::string at = " at t = " + std::to_string(expected.time);
    check(largest(state.position - expected.position), expected.position_tolerance, "position" + at);
    check(largest(state.twist.velocity - expected.twist.velocity), expected.velocity_tolerance,
          "velocity" + at);
    check(largest(state.twist.angular_velocity - expected.twist.angular_velocity), expected.spin_tolerance,
          "angular velocity" + at);
    if (expected.orientation) {
      check(largest(state.orientation, *expected.orientation), expected.orientation_tolerance,
            "orientation" + at);
    }
  }

  // The slip is rounded once, kappa and the product with it a few times: relative, component by component.
  // Velocities are sums of terms of the size |v| + R |omega|, rounded a few times.
  void check_impulse(const RecordedSwitch& event, const ExpectedImpulse& expected) {
    for (int i = 0; i < 2; ++i) {
      check(std::abs(event.impulse[i] - expected.impulse[i]), 16 * unit * std::abs(expected.impulse[i]),
            "impulse");
    }
    const double radius = scene_.sphere.radius;
    const double rounding = 8 * unit * size_of(expected.before, radius);
    const auto check_twist = [&](const Twist& twist, const Twist& reference, const std::string& when) {
      check(largest(twist.velocity - reference.velocity), rounding, "velocity " + when);
      check(radius * largest(twist.angular_velocity - reference.angular_velocity), rounding, "spin " + when);
    };
    check_twist(event.before, expected.before, "before");
    check_twist(event.after, expected.after, "after");
  }

  void check_switch(const RecordedSwitch& event, const ExpectedSwitch& expected) {
    EXPECT_EQ(event.kind, expected.kind);
    EXPECT_EQ(event.from, expected.from);
    EXPECT_EQ(event.to, expected.to);
    const double time_tolerance = 16 * (expected_.event_time_tolerance + 2 * unit * std::abs(expected.time));
    check(std::abs(event.time - expected.time), time_tolerance, "time");
    const double travelled = expected.position.norm() + scene_.initial_state.position.norm();
    check(largest(event.position - expected.position),
          event.before.velocity.norm() * time_tolerance + 8 * unit * travelled, "position");
    if (expected.impulse) {
      check_impulse(event, *expected.impulse);
    } else {
      EXPECT_EQ(event.impulse, Vector2d::Zero());
      EXPECT_EQ(event.before.velocity, event.after.velocity);
      EXPECT_EQ(event.before.angular_velocity, event.after.angular_velocity);
    }
  }

  std::string path_;
  scene::Scene scene_;
  Expected expected_;
  Simulation simulation_;
  double worst_ = 0;
};

TEST_P(OracleScene, StatesAndSwitchesAreThoseOfAHundredDigits) {
  std::vector<RecordedSwitch> switches;
  for (const ExpectedState& expected : expected_.states) {
    simulation_.advance_to(expected.time, recorder(switches));
    check_state(simulation_.state(), expected);
  }
  ASSERT_EQ(switches.size(), expected_.switches.size());
  for (std::size_t i = 0; i < switches.size(); ++i) {
    SCOPED_TRACE("switch " + std::to_string(i));
    EXPECT_EQ(switches[i].index, i);
    check_switch(switches[i], expected_.switches[i]);
  }
  RecordProperty("worst_ratio_to_tolerance", std::to_string(worst_));
}

INSTANTIATE_TEST_SUITE_P(Reference, OracleScene, ::testing::ValuesIn(yaml_files("oracle")),
                         [](const auto& info) { return as_test_name(info.param); });

}  // namespace
}  // namespace hybrid_sphere::testing

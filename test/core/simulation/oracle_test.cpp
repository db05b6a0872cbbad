// Scenes with a solution in high precision: every state within the tolerance that the solution gives for a
// fair binary64 program, every change of the constraint, and no other. oracle/ holds solutions of closed
// forms in a hundred digits, reference/ those of an integrator in thirty.

#include <gtest/gtest.h>

#include <algorithm>

#include "scene/read_tree.hpp"
#include "scene/yaml.hpp"
#include "sphere/dynamics.hpp"
#include "support/expected.hpp"
#include "support/files.hpp"
#include "support/recorded.hpp"

namespace hybrid_sphere::testing::oracle_test {
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

std::vector<scene::Material> materials(const scene::Surface& surface) {
  std::vector<scene::Material> all{surface.base};
  for (const scene::Region& region : surface.regions) all.push_back(region.material);
  return all;
}

// Nothing but straight lines, with the slip at a switch that the initial state has.
bool is_unforced_and_still(const scene::Scene& scene, const Dynamics& dynamics) {
  const auto moves_or_slides = [](const scene::Material& ground) {
    return ground.law == scene::Law::coulomb || !ground.belt.isZero(0) || ground.turntable_rate != 0 ||
           ground.rolling_resistance != 0 || ground.spin_friction != 0;
  };
  const std::vector<scene::Material> grounds = materials(scene.surface);
  return !dynamics.forced() && dynamics.normal_spin == 0 && !dynamics.has_drag() &&
         dynamics.quadratic_drag == 0 && dynamics.spring_rate == 0 &&
         std::none_of(grounds.begin(), grounds.end(), moves_or_slides);
}

// How far binary64 may be from the solution at an instant between two outputs.
struct Uncertainty {
  double time = 0;
  double position = 0;
  double velocity = 0;
  double spin = 0;
};

class OracleScene : public ::testing::TestWithParam<std::string> {
 protected:
  OracleScene()
      : path_(std::string(TEST_DATA_DIR) + "/" + GetParam()),
        scene_(scene::read_scene(scene::tree_from_yaml_file(path_ + ".yaml"))),
        expected_(read_expected(path_ + ".expected.yaml")),
        simulation_(scene_),
        dynamics_(simulation_.sphere(), scene_.forces),
        strict_(is_unforced_and_still(scene_, dynamics_)) {
    for (const scene::Material& ground : materials(scene_.surface)) {
      rate_ = std::max(rate_, std::abs(ground.turntable_rate));
      friction_ = std::max({friction_, ground.friction, ground.rolling_resistance});
      spin_friction_ = std::max(spin_friction_, ground.spin_friction);
    }
  }

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
    if (!expected.mode.empty() && !is_at_switch(expected.time)) {
      EXPECT_EQ(to_string(state.mode), expected.mode) << at;
      EXPECT_EQ(state.region, expected.region) << at;
      EXPECT_EQ(state.stage == Stage::holonomic, state.mode == Mode::free || state.mode == Mode::sliding)
          << at;
    }
  }

  // Whether rounding decides on which side of a switch an output is.
  bool is_at_switch(double time) const {
    const double tolerance = uncertainty_at(time).time;
    return std::any_of(
        expected_.switches.begin(), expected_.switches.end(),
        [&](const ExpectedSwitch& event) { return time > 0 && std::abs(event.time - time) <= tolerance; });
  }

  // The tolerances of the outputs around the instant: the errors of the state that comes there. Event times:
  // 16 times what inputs moved by one ulp make of them, as for the positions that are given with the
  // solutions.
  Uncertainty uncertainty_at(double time) const {
    Uncertainty most;
    most.time = 16 * (expected_.event_time_tolerance + 2 * unit * std::abs(time));
    const auto add = [&most](const ExpectedState& state) {
      most.position = std::max(most.position, state.position_tolerance);
      most.velocity = std::max(most.velocity, state.velocity_tolerance);
      most.spin = std::max(most.spin, state.spin_tolerance);
    };
    const auto after = std::find_if(expected_.states.begin(), expected_.states.end(),
                                    [time](const ExpectedState& state) { return state.time >= time; });
    if (after != expected_.states.end()) add(*after);
    if (after != expected_.states.begin()) add(*(after - 1));
    return most;
  }

  // Adds what the velocities change within the uncertainty of the instant: the acceleration that no ground of
  // the scene exceeds, from the equations of motion in dynamics.hpp, with the reaction either that of rolling
  // or friction's largest.
  void add_accelerations(const Vector2d& position, const Twist& twist, Uncertainty& at) const {
    const double radius = scene_.sphere.radius;
    const double kappa = dynamics_.kappa;
    const double speed = twist.velocity.norm();
    const Vector2d nu = radius * Vector2d(twist.angular_velocity.y(), -twist.angular_velocity.x());
    const double free = dynamics_.acceleration(position, twist.velocity).norm();
    const double spin = dynamics_.spin_acceleration(nu).norm();
    const double grip = friction_ * dynamics_.normal_force / dynamics_.mass;
    const double reaction = std::max(kappa * (free + spin + rate_ * speed) + grip, grip);
    at.velocity += at.time * (free + reaction);
    at.spin += at.time * ((spin + (1 - kappa) / kappa * (reaction + grip)) / radius +
                          std::abs(dynamics_.normal_spin) + dynamics_.spin_decay(spin_friction_) +
                          dynamics_.rotational_drag * twist.angular_velocity.norm());
  }

  void check_twist(const Twist& twist, const Twist& reference, const Uncertainty& allowed,
                   const std::string& when) {
    check(largest(twist.velocity - reference.velocity), allowed.velocity, "velocity " + when);
    check(largest(twist.angular_velocity - reference.angular_velocity), allowed.spin, "spin " + when);
  }

  // Without forces on still ground the slip is rounded once, kappa and the product with it a few times:
  // relative, component by component. Elsewhere the slip has the errors of the velocities and of the ground's
  // velocity where the sphere is.
  void check_impulse(const RecordedSwitch& event, const ExpectedImpulse& expected, const Uncertainty& at) {
    const double radius = scene_.sphere.radius;
    const double mass = scene_.sphere.mass;
    const double k = scene_.sphere.gyration_radius;
    const double ground = rate_ * (at.position + event.before.velocity.norm() * at.time);
    for (int i = 0; i < 2; ++i) {
      double tolerance = 16 * unit * std::abs(expected.impulse[i]);
      if (!strict_) tolerance += mass * dynamics_.kappa * (at.velocity + radius * at.spin + ground);
      check(std::abs(event.impulse[i] - expected.impulse[i]), tolerance, "impulse");
    }
    check(std::abs(event.angular_impulse.z() - expected.normal),
          16 * unit * std::abs(expected.normal) + (strict_ ? 0 : mass * k * k * at.spin), "L_z");
    check_twist(event.before, expected.before, at, "before");
    check_twist(event.after, expected.after, at, "after");
  }

  // Velocities are sums of terms of the size |v| + R |omega|, rounded a few times.
  Uncertainty uncertainty_of(const RecordedSwitch& event, const ExpectedSwitch& expected) const {
    const Twist& twist = expected.impulse ? expected.impulse->before : event.before;
    const double rounding = 8 * unit * size_of(twist, scene_.sphere.radius);
    Uncertainty at = uncertainty_at(expected.time);
    if (strict_) {
      at.position = at.velocity = at.spin = 0;
    } else {
      add_accelerations(expected.position, twist, at);
    }
    at.velocity += rounding;
    at.spin += rounding / scene_.sphere.radius;
    return at;
  }

  void check_switch(const RecordedSwitch& event, const ExpectedSwitch& expected) {
    EXPECT_EQ(to_string(event.kind), std::string(to_string(expected.kind)));
    EXPECT_EQ(to_string(event.cause), std::string(to_string(expected.cause)));
    EXPECT_EQ(event.from, expected.from);
    EXPECT_EQ(event.to, expected.to);
    const Uncertainty at = uncertainty_of(event, expected);
    check(std::abs(event.time - expected.time), at.time, "time");
    const double travelled = expected.position.norm() + scene_.initial_state.position.norm();
    check(largest(event.position - expected.position),
          event.before.velocity.norm() * at.time + 8 * unit * travelled + at.position, "position");
    if (expected.impulse) {
      check_impulse(event, *expected.impulse, at);
    } else if (strict_ || expected.kind == SwitchKind::released || expected.cause == Cause::slip_ended ||
               expected.cause == Cause::livelock_ended) {
      EXPECT_EQ(event.impulse, Vector2d::Zero());
      EXPECT_EQ(event.before.velocity, event.after.velocity);
      EXPECT_EQ(event.before.angular_velocity, event.after.angular_velocity);
    } else {
      check_impulse(event, {Vector2d::Zero(), 0, event.before, event.before}, at);
    }
  }

  void check_halt(const Simulation::SwitchSink& sink) {
    const double halt = *expected_.halted_at;
    try {
      simulation_.advance_to(2 * halt + 1, sink);
      ADD_FAILURE() << "does not halt";
    } catch (const HaltedError& error) {
      const double tolerance = uncertainty_at(halt).time;
      check(std::abs(error.time() - halt), tolerance, "time of the halt");
      EXPECT_EQ(simulation_.time(), error.time());
      EXPECT_TRUE(simulation_.state().position.allFinite());
    }
  }

  std::string path_;
  scene::Scene scene_;
  Expected expected_;
  Simulation simulation_;
  Dynamics dynamics_;
  bool strict_;
  double rate_ = 0;           // fastest turntable of the scene [rad/s]
  double friction_ = 0;       // largest coefficient of friction or rolling resistance
  double spin_friction_ = 0;  // largest
  double worst_ = 0;
};

TEST_P(OracleScene, StatesAndSwitchesAreThoseOfTheReference) {
  Switches switches;
  for (const ExpectedState& expected : expected_.states) {
    simulation_.advance_to(expected.time, recorder(switches));
    check_state(simulation_.state(), expected);
  }
  if (expected_.halted_at) check_halt(recorder(switches));
  ASSERT_EQ(switches.size(), expected_.switches.size());
  for (std::size_t i = 0; i < switches.size(); ++i) {
    SCOPED_TRACE("switch " + std::to_string(i));
    EXPECT_EQ(switches[i].index, i);
    check_switch(switches[i], expected_.switches[i]);
  }
  RecordProperty("worst_ratio_to_tolerance", std::to_string(worst_));
}

std::vector<std::string> scenes_of(const std::string& folder) {
  std::vector<std::string> names = yaml_files(folder);
  for (std::string& name : names) name.insert(0, folder + "/");
  return names;
}

std::string test_name(const ::testing::TestParamInfo<std::string>& info) {
  return as_test_name(info.param.substr(info.param.find('/') + 1));
}

INSTANTIATE_TEST_SUITE_P(Oracle, OracleScene, ::testing::ValuesIn(scenes_of("oracle")), test_name);
INSTANTIATE_TEST_SUITE_P(Integrated, OracleScene, ::testing::ValuesIn(scenes_of("reference")), test_name);

}  // namespace
}  // namespace hybrid_sphere::testing::oracle_test

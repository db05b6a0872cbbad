// Indices, values and states that have no meaning: each is refused, or ends the motion, by name.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

#include "hybrid_sphere/mechanics/impulse.hpp"
#include "hybrid_sphere/mechanics/linearization.hpp"
#include "hybrid_sphere/mechanics/multibody_system.hpp"
#include "hybrid_sphere/mechanics/plant.hpp"
#include "hybrid_sphere/mechanics/solve.hpp"
#include "hybrid_sphere/mechanics/system.hpp"

namespace hybrid_sphere::mechanics::bad_input_test {
namespace {

using Eigen::Vector3d;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

template <class Error, class Call>
std::string message_of(Call call) {
  try {
    call();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

Model particle() {
  System<1> model({"x"}, [](auto, const auto&, const auto& v) { return v[0] * v[0] / 2; });
  model.constrain(
      "stop", [](auto, const auto&, const auto& v) { return v[0]; }, from(1));
  return model;
}

State state_of_particle() {
  State state;
  state.q = state.v = Vector{0.0};
  return state;
}

TEST(BadInput, ANameOfNoConstraintIsRefusedWithTheNames) {
  const Model model = particle();
  EXPECT_EQ(message_of<std::invalid_argument>([&] { model.index_of_constraint("go"); }),
            "constraint \"go\" is refused; allowed: stop");
  EXPECT_EQ(message_of<std::invalid_argument>([&] { Model().index_of_constraint("go"); }),
            "constraint \"go\" is refused; allowed: none");
  EXPECT_EQ(message_of<std::invalid_argument>([&] { model.multipliers_of("go", {1.0}); }),
            "constraint \"go\" is refused; allowed: stop");
  EXPECT_EQ(message_of<std::invalid_argument>([&] {
              model.multipliers_of("stop", {1.0, 2.0});
            }),
            "2 multipliers is refused; allowed: 1");
}

TEST(BadInput, AnIndexOfAConstraintIsRefusedWithTheRange) {
  const Model model = particle();
  EXPECT_EQ(model.multiplier_of(1), 1);
  EXPECT_EQ(message_of<std::out_of_range>([&] { model.multiplier_of(99); }),
            "multiplier_of: constraint 99 is refused; allowed: 0 to 1");
  EXPECT_EQ(message_of<std::out_of_range>([&] {
              names(model, {0, 3});
            }),
            "names: constraint 3 is refused; allowed: 0 to 0");
  Impulse impulse;
  const Vector zero{0.0};
  EXPECT_EQ(message_of<std::out_of_range>([&] { ImpulseSolver(model).solve({7}, 0, zero, zero, impulse); }),
            "active: constraint 7 is refused; allowed: 0 to 0");
  EXPECT_NE(
      message_of<std::out_of_range>([&] { ImpulseSolver(model).relative_residual({7}, 0, zero, zero); }), "");
}

TEST(BadInput, AStateIsRefusedByLinearize) {
  const Model model = particle();
  const auto of = [&](auto change) {
    State state = state_of_particle();
    change(state);
    return [&model, state] { linearize(model, state); };
  };
  EXPECT_EQ(message_of<std::out_of_range>(of([](State& s) { s.active = {3}; })),
            "active: constraint 3 is refused; allowed: 0 to 0");
  EXPECT_EQ(message_of<std::out_of_range>(of([](State& s) {
              s.sliding = {{3, 1}};
            })),
            "sliding: constraint 3 is refused; allowed: 0 to 0");
  EXPECT_EQ(message_of<std::invalid_argument>(of([](State& s) {
              s.sliding = {{0, 1}};
            })),
            "sliding: constraint stop is refused; allowed: those with friction");
  EXPECT_EQ(message_of<std::invalid_argument>(of([](State& s) { s.q[0] = nan; })),
            "x = nan is refused; allowed: a finite number");
  EXPECT_NE(message_of<std::invalid_argument>(of([](State& s) { s.v = {1, 2}; })), "");
  EXPECT_NE(message_of<std::invalid_argument>(of([](State& s) { s.time = nan; })), "");
  EXPECT_NE(message_of<std::invalid_argument>(
                [&] { linearize([&](const Vector&) { return model; }, {nan}, state_of_particle()); }),
            "");
}

MultibodySystem ball() {
  MultibodySystem system;
  system.body("ball", 1, {1, 1, 1}, Vector3d(0, 0, 1));
  return system;
}

TEST(BadInput, AnOrientationWithoutLengthIsRefused) {
  const MultibodySystem system = ball();
  Initial initial = system.initial();
  initial.q.tail(4).setZero();
  EXPECT_EQ(
      message_of<std::invalid_argument>([&] { solve(system, initial, 1); }),
      "ball.qw = 0 is refused; allowed: coordinates that can be normalized: a quaternion has a length > 0");
  EXPECT_NE(message_of<std::invalid_argument>([&] { Plant(system, initial); }), "");
  initial.q.tail(4) << 1e-200, 0, 0, 0;
  EXPECT_EQ(solve(system, initial, 1).at(0).q[3], 1);
}

std::string refusal_of_placement(const Eigen::Matrix3d& axes) {
  Eigen::Isometry3d placement = Eigen::Isometry3d::Identity();
  placement.linear() = axes;
  return message_of<std::invalid_argument>([&] { MultibodySystem().body("b", 1, {1, 1, 1}, placement); });
}

TEST(BadInput, APlacementIsRefusedWithTheReason) {
  const Eigen::Matrix3d mirror = Vector3d(1, 1, -1).asDiagonal();
  EXPECT_EQ(
      refusal_of_placement(mirror),
      "body \"b\": placement with left-handed axes, of determinant -1 is refused; allowed: a rotation, of "
      "determinant 1");
  EXPECT_NE(refusal_of_placement(nan * mirror).find("not finite"), std::string::npos);
  EXPECT_NE(refusal_of_placement(2 * Eigen::Matrix3d::Identity()).find("by 3"), std::string::npos);
}

MultibodySystem coin(double tilt) {
  MultibodySystem system;
  Eigen::Isometry3d placement = Eigen::Isometry3d::Identity();
  placement.linear() = Eigen::AngleAxisd(tilt, Vector3d::UnitX()).toRotationMatrix();
  placement.translation().z() = 0.1 * std::sin(tilt);
  system.body("coin", 1, {0.0025, 0.0025, 0.005}, placement);
  return system;
}

TEST(BadInput, ADiskThatLiesFlatIsRefused) {
  MultibodySystem flat = coin(0);
  const ContactShape shape = ContactShape::disk(0.1, {0, 0, 2});
  for (const std::string& message :
       {message_of<std::invalid_argument>([&] { flat.rolling("roll", "coin", shape); }),
        message_of<std::invalid_argument>([&] { flat.contact("touch", "coin", shape); })}) {
    EXPECT_NE(message.find("a disk that lies flat"), std::string::npos) << message;
  }
}

// A coin without spin falls onto its side within 1 s: the motion ends there, with the reason.
TEST(BadInput, ADiskThatFallsFlatEndsTheMotion) {
  MultibodySystem system = coin(0.5);
  const Vector3d axle(0, -std::sin(0.5), std::cos(0.5));
  system.rolling("roll", "coin", ContactShape::disk(0.1, axle));
  const Solution motion = solve(system, system.initial(), 5);
  EXPECT_EQ(motion.status().stop, Stop::undefined) << motion.status().message;
  EXPECT_NE(motion.status().message.find("lies flat"), std::string::npos) << motion.status().message;
  EXPECT_LE(motion.evaluations(), 5000U);
  const Eigen::Matrix3d axes = system.pose(motion.at(motion.end()).q, "coin").linear();
  EXPECT_NEAR(axes(2, 2), 1, 1e-9);
}

Model block(double load) {
  System<1> model({"x"}, [](auto, const auto&, const auto& v) { return v[0] * v[0] / 2; });
  model.friction(
      "pad", [](auto, const auto&, const auto& v) { return v[0]; }, 0.2,
      [load](double t, const auto&, const auto&) { return load * (1 - t); });
  return model;
}

TEST(BadInput, ANegativeLoadEndsTheMotion) {
  const Solution at_once = solve(block(-2), {0, {0.0}, {1.0}}, 1);
  EXPECT_EQ(at_once.status().stop, Stop::undefined);
  EXPECT_NE(at_once.status().message.find("load of pad = -2 is refused; allowed: a number >= 0"),
            std::string::npos)
      << at_once.status().message;
  const Solution later = solve(block(1), {0, {0.0}, {1.0}}, 2);
  EXPECT_EQ(later.status().stop, Stop::undefined) << later.status().message;
  EXPECT_NEAR(later.end(), 1, 1e-9);
}

/// A particle that is pushed by the root of the input: NaN for a negative one.
Model pushed(const Vector& input) {
  const double u = input[0];
  return System<1>(
      {"x"}, [](auto, const auto&, const auto& v) { return v[0] * v[0] / 2; },
      [u](double, const auto&, const auto&) { return Eigen::Matrix<double, 1, 1>(std::sqrt(u)); });
}

TEST(BadInput, APlantContinuesAfterAnInputThatStoppedIt) {
  Plant plant(pushed, {1}, {0, {0.0}, {0.0}});
  plant.advance(1);
  plant.set_input({-1});
  const Status stopped = plant.advance(2);
  EXPECT_EQ(stopped.stop, Stop::not_finite);
  EXPECT_EQ(stopped.time, 1);
  EXPECT_EQ(plant.advance(3).stop, Stop::not_finite);
  plant.set_input({4});
  EXPECT_EQ(plant.advance(2).stop, Stop::reached_end);
  EXPECT_NEAR(plant.state().q[0], 0.5 + 1 + 1, 1e-9);
  EXPECT_NEAR(plant.state().v[0], 1 + 2, 1e-9);
}

TEST(BadInput, APlantThatCouldNotStartRefusesAnInput) {
  const auto model = [](const Vector& input) -> Model {
    System<1> held({"x"}, [](auto, const auto&, const auto& v) { return v[0] * v[0] / 2; });
    const double speed = input[0];
    held.constrain(
        "still", [](auto, const auto&, const auto& v) { return v[0]; }, always());
    held.constrain(
        "moving", [speed](auto, const auto&, const auto& v) { return v[0] - speed; }, always());
    return held;
  };
  Options options;
  options.project_initial = true;
  Plant plant(model, {1}, {0, {0.0}, {0.0}}, options);
  EXPECT_EQ(plant.advance(1).stop, Stop::inconsistent);
  const std::string message = message_of<std::invalid_argument>([&] { plant.set_input({0}); });
  EXPECT_NE(message.find("has not started"), std::string::npos) << message;
}

// Constraints whose directions differ by 1e-10 are still two: together they leave no velocity.
TEST(BadInput, NearlyParallelConstraintsAreBothKept) {
  for (int k = 0; k <= 90; ++k) {
    const double d = std::pow(10, -1 - k * 0.1);
    System<2> model({"x", "y"}, [](auto, const auto&, const auto& v) { return v.squaredNorm() / 2; });
    model.constrain(
        "a", [](auto, const auto&, const auto& v) { return v[1]; }, from(0.5));
    model.constrain(
        "b", [d](auto, const auto&, const auto& v) { return v[1] + d * v[0]; }, from(0.5));
    const Solution motion = solve(model, {0, {0, 0}, {1, 1}}, 2);
    ASSERT_EQ(motion.status().stop, Stop::reached_end) << d << ": " << motion.status().message;
    EXPECT_LE(std::abs(motion.at(2).v[1]), 1e-15) << d;
    EXPECT_LE(std::abs(motion.at(2).v[0]), 1e-15 / d) << d;
  }
}

}  // namespace
}  // namespace hybrid_sphere::mechanics::bad_input_test

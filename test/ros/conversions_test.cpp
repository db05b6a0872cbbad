#include "ros/conversions/conversions.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "ros/conversions/initial_state_message.hpp"

namespace hybrid_sphere::ros_interface::conversions_test {
namespace {

constexpr double radius = 0.5;

State some_state() {
  State state;
  state.time = 1.25;
  state.position = {1, 2};
  state.orientation = Quaterniond(0.5, 0.5, 0.5, 0.5);  // x -> y -> z -> x
  state.twist = {{3, 4}, {5, 6, 7}};
  state.slip = {8, 9};
  state.stage = Stage::nonholonomic;
  state.mode = Mode::rolling;
  state.region = "region";
  return state;
}

TEST(RecordMessages, PoseHasTheRadiusAsHeight) {
  geometry_msgs::Pose pose;
  fill(some_state(), radius, pose);
  EXPECT_EQ(pose.position.x, 1);
  EXPECT_EQ(pose.position.y, 2);
  EXPECT_EQ(pose.position.z, radius);
  EXPECT_EQ(pose.orientation.w, 0.5);
}

TEST(RecordMessages, TwistInTheSphereFrameIsTurnedBack) {
  geometry_msgs::Twist twist;
  fill_in_sphere_frame(some_state(), twist);
  // The sphere's x axis lies along the world's y, its y along z, its z along x.
  EXPECT_DOUBLE_EQ(twist.linear.x, 4);
  EXPECT_DOUBLE_EQ(twist.linear.y, 0);
  EXPECT_DOUBLE_EQ(twist.linear.z, 3);
  EXPECT_DOUBLE_EQ(twist.angular.x, 6);
  EXPECT_DOUBLE_EQ(twist.angular.y, 7);
  EXPECT_DOUBLE_EQ(twist.angular.z, 5);
}

// Numbers of all sizes: drag lets velocities decay below the least one that a state may have.
TEST(RecordMessages, EveryStateThatIsSentMayBeSet) {
  std::mt19937 random(4);
  const auto number = [&](double exponent) {
    const double mantissa = std::uniform_real_distribution<>(-9, 9)(random);
    return mantissa * std::pow(10, std::uniform_real_distribution<>(-320, exponent)(random));
  };
  for (int i = 0; i < 10000; ++i) {
    State state = some_state();
    state.position = {number(14), number(14)};
    state.orientation = Quaterniond(number(0), number(0), number(0), number(0));
    state.orientation.coeffs()[i % 4] += 10;
    state.orientation.normalize();
    state.twist = {{number(14), number(14)}, {number(14), number(14), number(14)}};
    SetInitialState::Request request;
    fill(state, radius, request.pose);
    fill(state.twist, request.twist);
    const scene::InitialState set =
        initial_state_from_message(request, Eigen::Isometry3d::Identity(), radius);
    const auto sent = [](double x) { return std::abs(x) < 1e-60 ? 0. : x; };
    ASSERT_EQ(set.position, state.position.unaryExpr(sent));
    ASSERT_EQ(set.velocity, state.twist.velocity.unaryExpr(sent));
    ASSERT_EQ(set.angular_velocity, state.twist.angular_velocity.unaryExpr(sent));
    ASSERT_LT((set.orientation.coeffs() - state.orientation.coeffs()).norm(), 1e-15);
  }
}

TEST(RecordMessages, StateCarriesEverything) {
  const Sphere sphere({2, radius, 0.25});
  SphereState message;
  fill(some_state(), Vector3d(10, 11, 12), sphere, message);
  EXPECT_EQ(message.time, 1.25);
  EXPECT_EQ(message.stage, SphereState::NONHOLONOMIC);
  EXPECT_EQ(message.mode, "rolling");
  EXPECT_EQ(message.region, "region");
  EXPECT_EQ(message.twist.linear.y, 4);
  EXPECT_EQ(message.twist.angular.z, 7);
  EXPECT_EQ(message.slip.x, 8);
  EXPECT_EQ(message.reaction.x, 10);
  EXPECT_EQ(message.reaction.y, 11);
  EXPECT_EQ(message.reaction.z, 12);
  EXPECT_DOUBLE_EQ(message.kinetic_energy, 25 + 0.0625 * 110);
}

TEST(RecordMessages, SwitchCarriesEverything) {
  Switch event;
  event.index = 3;
  event.time = 0.5;
  event.kind = SwitchKind::released;
  event.cause = Cause::grip_lost;
  event.from_stage = Stage::nonholonomic;
  event.to_stage = Stage::holonomic;
  event.from_region = "a";
  event.to_region = "b";
  event.position = {1, 2};
  event.slip_before = {3, 4};
  event.impulse = {5, 6};
  event.angular_impulse = {7, 8, 9};
  event.before = {{1, 0}, {0, 0, 1}};
  event.after = {{2, 0}, {0, 0, 2}};
  event.energy_before = 11;
  event.energy_after = 12;
  ConstraintSwitch message;
  fill(event, radius, message);
  EXPECT_EQ(message.index, 3U);
  EXPECT_EQ(message.time, 0.5);
  EXPECT_EQ(message.kind, ConstraintSwitch::RELEASED);
  EXPECT_EQ(message.cause, ConstraintSwitch::GRIP_LOST);
  EXPECT_EQ(message.from_stage, ConstraintSwitch::NONHOLONOMIC);
  EXPECT_EQ(message.to_stage, ConstraintSwitch::HOLONOMIC);
  EXPECT_EQ(message.from_region + message.to_region, "ab");
  EXPECT_EQ(message.position.z, radius);
  EXPECT_EQ(message.slip_before.y, 4);
  EXPECT_EQ(message.impulse.x, 5);
  EXPECT_EQ(message.angular_impulse.z, 9);
  EXPECT_EQ(message.twist_before.angular.z, 1);
  EXPECT_EQ(message.twist_after.linear.x, 2);
  EXPECT_EQ(message.energy_before, 11);
  EXPECT_EQ(message.energy_after, 12);
}

TEST(RecordMessages, ModesAndCausesAreThoseOfTheSimulation) {
  EXPECT_STREQ(to_string(Mode::sliding), "sliding");
  EXPECT_STREQ(to_string(Mode::edge_sliding), "edge_sliding");
  const std::vector<std::pair<Cause, std::uint8_t>> causes{
      {Cause::edge, ConstraintSwitch::EDGE},
      {Cause::placed, ConstraintSwitch::PLACED},
      {Cause::slip_ended, ConstraintSwitch::SLIP_ENDED},
      {Cause::grip_lost, ConstraintSwitch::GRIP_LOST},
      {Cause::livelock, ConstraintSwitch::LIVELOCK},
      {Cause::livelock_ended, ConstraintSwitch::LIVELOCK_ENDED},
      {Cause::kicked, ConstraintSwitch::KICKED},
      {Cause::accumulation, ConstraintSwitch::ACCUMULATION}};
  for (const auto& [cause, constant] : causes) EXPECT_EQ(static_cast<std::uint8_t>(cause), constant);
}

}  // namespace
}  // namespace hybrid_sphere::ros_interface::conversions_test

#include "ros/conversions/initial_state_message.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "scene/tree.hpp"

namespace hybrid_sphere::ros_interface::initial_state_message_test {
namespace {

constexpr double radius = 0.3;
const Eigen::Isometry3d here = Eigen::Isometry3d::Identity();

std::string refusal(const SetInitialState::Request& request) {
  try {
    initial_state_from_message(request, here, radius);
  } catch (const scene::SceneError& error) {
    return error.what();
  }
  return "";
}

TEST(InitialStateMessage, IsTakenAsItIs) {
  SetInitialState::Request request;
  request.pose.position.x = 1;
  request.pose.position.y = -2;
  request.pose.position.z = radius;
  request.pose.orientation.y = 0.6;
  request.pose.orientation.w = -0.8;
  request.twist.linear.x = 3;
  request.twist.angular.z = 4;
  const scene::InitialState state = initial_state_from_message(request, here, radius);
  EXPECT_EQ(state.position, Vector2d(1, -2));
  EXPECT_EQ(state.velocity, Vector2d(3, 0));
  EXPECT_EQ(state.angular_velocity, Vector3d(0, 0, 4));
  EXPECT_NEAR(state.orientation.y(), 0.6, 1e-15);
  EXPECT_NEAR(state.orientation.w(), -0.8, 1e-15);
}

TEST(InitialStateMessage, WithoutAnOrientationHasTheIdentity) {
  const scene::InitialState state = initial_state_from_message(SetInitialState::Request(), here, radius);
  EXPECT_EQ(state.orientation.coeffs(), Quaterniond::Identity().coeffs());
}

TEST(InitialStateMessage, IsTakenFromItsFrame) {
  Eigen::Isometry3d quarter(Eigen::AngleAxisd(0.5 * M_PI, Vector3d::UnitZ()));
  quarter.pretranslate(Vector3d(10, 20, -radius));
  SetInitialState::Request request;
  request.pose.position.x = 1;
  request.pose.position.z = 2 * radius;
  request.twist.linear.x = 3;
  request.twist.angular.x = 4;
  request.twist.angular.z = 5;
  const scene::InitialState state = initial_state_from_message(request, quarter, radius);
  EXPECT_LT((state.position - Vector2d(10, 21)).norm(), 1e-14);
  EXPECT_LT((state.velocity - Vector2d(0, 3)).norm(), 1e-14);
  EXPECT_LT((state.angular_velocity - Vector3d(0, 4, 5)).norm(), 1e-14);
  EXPECT_NEAR(state.orientation.z(), std::sqrt(0.5), 1e-15);
  const Eigen::Isometry3d upright(Eigen::AngleAxisd(0.5 * M_PI, Vector3d::UnitY()));
  EXPECT_THROW(initial_state_from_message(request, upright, radius), scene::SceneError);
}

TEST(InitialStateMessage, IsRefusedWithThePath) {
  SetInitialState::Request request;
  request.pose.position.z = 0.1;
  EXPECT_EQ(refusal(request), "initial_state.position[2]: 0.1 is refused; allowed: 0, or the radius 0.3 [m]");
  request = {};
  request.twist.linear.z = 1;
  EXPECT_EQ(refusal(request).find("initial_state.velocity[2]: 1 is refused"), 0U);
  request = {};
  request.pose.orientation.w = std::nan("");
  EXPECT_EQ(refusal(request).find("initial_state.orientation[3]: "), 0U);
  request = {};
  request.pose.position.z = std::nan("");
  EXPECT_EQ(refusal(request).find("initial_state.position[2]: "), 0U);
  request = {};
  request.twist.angular.x = HUGE_VAL;
  EXPECT_EQ(refusal(request).find("initial_state.angular_velocity[0]: inf is refused"), 0U);
}

}  // namespace
}  // namespace hybrid_sphere::ros_interface::initial_state_message_test

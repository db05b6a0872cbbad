#include "ros/conversions/tool_messages.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "scene/tree.hpp"

namespace hybrid_sphere::ros_interface::tool_messages_test {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
const Eigen::Isometry3d here = Eigen::Isometry3d::Identity();

/// Of a frame that is turned by a quarter to the left, with its origin at (10, 20, 0.5).
Eigen::Isometry3d quarter() {
  Eigen::Isometry3d transform = here;
  transform.linear() = Eigen::AngleAxisd(M_PI / 2, Vector3d::UnitZ()).toRotationMatrix();
  transform.translation() = Vector3d(10, 20, 0.5);
  return transform;
}

geometry_msgs::PoseWithCovarianceStamped pose(double x, double y) {
  geometry_msgs::PoseWithCovarianceStamped message;
  message.pose.pose.position.x = x;
  message.pose.pose.position.y = y;
  message.pose.pose.orientation.w = 1;
  return message;
}

geometry_msgs::PointStamped point(double x, double y, double z = 0) {
  geometry_msgs::PointStamped message;
  message.point.x = x;
  message.point.y = y;
  message.point.z = z;
  return message;
}

template <class Function>
std::string refusal(Function function) {
  try {
    function();
  } catch (const scene::SceneError& error) {
    return error.what();
  }
  return "";
}

TEST(PoseEstimate, IsAnInitialStateAtRest) {
  auto message = pose(1, -2);
  message.pose.pose.orientation.z = 0.6;
  message.pose.pose.orientation.w = 0.8;
  const scene::InitialState state = initial_state_from_pose(message, here, 0.5);
  EXPECT_EQ(state.position, Vector2d(1, -2));
  EXPECT_EQ(state.orientation.z(), 0.6);
  EXPECT_TRUE(state.velocity.isZero(0));
  EXPECT_TRUE(state.angular_velocity.isZero(0));
}

TEST(PoseEstimate, OutOfRangeIsRefused) {
  EXPECT_NE(refusal([] { initial_state_from_pose(pose(nan, 2), here, 0.5); }).find("nan is refused"),
            std::string::npos);
}

TEST(PoseEstimate, InAnotherFrameIsThePlaceAndOrientationInTheWorldFrame) {
  auto message = pose(1, -2);
  message.pose.pose.orientation.z = 0.6;
  message.pose.pose.orientation.w = 0.8;
  const scene::InitialState state = initial_state_from_pose(message, quarter(), 0.5);
  EXPECT_LT((state.position - Vector2d(12, 21)).norm(), 1e-14);
  const Quaterniond expected =
      Quaterniond(Eigen::AngleAxisd(M_PI / 2, Vector3d::UnitZ())) * Quaterniond(0.8, 0, 0, 0.6);
  EXPECT_LT(state.orientation.angularDistance(expected), 1e-15);
  Eigen::Isometry3d high = quarter();
  high.translation().z() = 3;
  EXPECT_EQ(
      refusal([&] { initial_state_from_pose(message, high, 0.5); }).find("initial_state.position[2]: 3"), 0U);
}

TEST(Drag, KeepsTheOrientationAndLooksAtTheHeightOfNoMarker) {
  visualization_msgs::InteractiveMarkerFeedback message;
  message.pose.position.x = 3;
  message.pose.position.y = 4;
  message.pose.position.z = 0.50000001;
  const Quaterniond orientation(0.8, 0, 0.6, 0);
  const scene::InitialState state = initial_state_from_drag(message, here, orientation);
  EXPECT_EQ(state.position, Vector2d(3, 4));
  EXPECT_EQ(state.orientation.coeffs(), orientation.coeffs());
  EXPECT_TRUE(state.velocity.isZero(0));
  message.pose.position.y = -nan;
  EXPECT_THROW(initial_state_from_drag(message, here, orientation), scene::SceneError);
  message.pose.position.y = 4;
  const scene::InitialState turned = initial_state_from_drag(message, quarter(), orientation);
  EXPECT_LT((turned.position - Vector2d(6, 23)).norm(), 1e-14);
  EXPECT_EQ(turned.orientation.coeffs(), orientation.coeffs());
}

TEST(ClickedPoint, IsADirectionOfLengthOne) {
  EXPECT_EQ(direction_to_point(point(4, 6, 0.3), here, {1, 2}), Vector2d(0.6, 0.8));
  // Squares of these would leave the range of binary64 or vanish.
  EXPECT_EQ(direction_to_point(point(0, -1e-300), here, {0, 0}), Vector2d(0, -1));
  EXPECT_EQ(direction_to_point(point(1e15, 0), here, {0, 0}), Vector2d(1, 0));
  EXPECT_LT((direction_to_point(point(4, 3), quarter(), {7, 20}) - Vector2d(0, 1)).norm(), 1e-15);
}

TEST(ClickedPoint, WithoutADirectionIsRefused) {
  EXPECT_NE(refusal([] {
              direction_to_point(point(1, 2), here, {1, 2});
            }).find("[1, 2] is refused"),
            std::string::npos);
  for (const auto& message : {point(nan, 0), point(0, nan), point(1, 0, nan), point(1e300, 0),
                              point(0, -std::numeric_limits<double>::infinity())}) {
    EXPECT_NE(refusal([&] {
                direction_to_point(message, here, {0, 0});
              }).find(" is refused"),
              std::string::npos);
  }
}

}  // namespace
}  // namespace hybrid_sphere::ros_interface::tool_messages_test

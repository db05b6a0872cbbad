#include "ros/conversions/tool_messages.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "scene/tree.hpp"

namespace hybrid_sphere::ros_interface {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

geometry_msgs::PoseWithCovarianceStamped pose(double x, double y, const std::string& frame = "world") {
  geometry_msgs::PoseWithCovarianceStamped message;
  message.header.frame_id = frame;
  message.pose.pose.position.x = x;
  message.pose.pose.position.y = y;
  message.pose.pose.orientation.w = 1;
  return message;
}

geometry_msgs::PointStamped point(double x, double y, double z = 0, const std::string& frame = "world") {
  geometry_msgs::PointStamped message;
  message.header.frame_id = frame;
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
  const scene::InitialState state = initial_state_from_pose(message, "world", 0.5);
  EXPECT_EQ(state.position, Vector2d(1, -2));
  EXPECT_EQ(state.orientation.z(), 0.6);
  EXPECT_TRUE(state.velocity.isZero(0));
  EXPECT_TRUE(state.angular_velocity.isZero(0));
}

TEST(PoseEstimate, InAnotherFrameOrOutOfRangeIsRefused) {
  EXPECT_NO_THROW(initial_state_from_pose(pose(1, 2, ""), "world", 0.5));
  EXPECT_EQ(refusal([] { initial_state_from_pose(pose(1, 2, "map"), "world", 0.5); }),
            "initialpose.header.frame_id: \"map\" is refused; allowed: \"world\", or empty");
  EXPECT_NE(refusal([] { initial_state_from_pose(pose(nan, 2), "world", 0.5); }).find("nan is refused"),
            std::string::npos);
}

TEST(Drag, KeepsTheOrientationAndLooksAtTheHeightOfNoMarker) {
  visualization_msgs::InteractiveMarkerFeedback message;
  message.header.frame_id = "world";
  message.pose.position.x = 3;
  message.pose.position.y = 4;
  message.pose.position.z = 0.50000001;
  const Quaterniond orientation(0.8, 0, 0.6, 0);
  const scene::InitialState state = initial_state_from_drag(message, "world", orientation);
  EXPECT_EQ(state.position, Vector2d(3, 4));
  EXPECT_EQ(state.orientation.coeffs(), orientation.coeffs());
  EXPECT_TRUE(state.velocity.isZero(0));
  message.pose.position.y = -nan;
  EXPECT_THROW(initial_state_from_drag(message, "world", orientation), scene::SceneError);
}

TEST(ClickedPoint, IsADirectionOfLengthOne) {
  EXPECT_EQ(direction_to_point(point(4, 6, 0.3), "world", {1, 2}), Vector2d(0.6, 0.8));
  // Squares of these would leave the range of binary64 or vanish.
  EXPECT_EQ(direction_to_point(point(0, -1e-300), "world", {0, 0}), Vector2d(0, -1));
  EXPECT_EQ(direction_to_point(point(1e15, 0), "world", {0, 0}), Vector2d(1, 0));
}

TEST(ClickedPoint, WithoutADirectionIsRefused) {
  EXPECT_NE(refusal([] {
              direction_to_point(point(1, 2), "world", {1, 2});
            }).find("[1, 2] is refused"),
            std::string::npos);
  for (const auto& message : {point(nan, 0), point(0, nan), point(1, 0, nan), point(1e300, 0),
                              point(0, -std::numeric_limits<double>::infinity()), point(1, 0, 0, "map")}) {
    EXPECT_NE(refusal([&] {
                direction_to_point(message, "world", {0, 0});
              }).find(" is refused"),
              std::string::npos);
  }
}

}  // namespace
}  // namespace hybrid_sphere::ros_interface

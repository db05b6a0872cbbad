#include "ros/node/command.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "scene/tree.hpp"

namespace hybrid_sphere::ros_interface::command_test {
namespace {

const scene::SphereBody body{2, 0.5, 0.25};
const Eigen::Isometry3d here = Eigen::Isometry3d::Identity();

geometry_msgs::WrenchStamped some_wrench() {
  geometry_msgs::WrenchStamped message;
  message.header.frame_id = "world";
  message.wrench.force.x = 1;
  message.wrench.force.y = -2;
  message.wrench.torque.x = 3;
  message.wrench.torque.y = 4;
  message.wrench.torque.z = -5;
  return message;
}

TEST(CommandMessage, IsForceInThePlaneAndTorque) {
  const scene::Wrench wrench = wrench_from_message(some_wrench(), here, body);
  EXPECT_EQ(wrench.force, Vector2d(1, -2));
  EXPECT_EQ(wrench.torque, Vector3d(3, 4, -5));
}

TEST(CommandMessage, IsTurnedIntoTheWorldFrame) {
  Eigen::Isometry3d quarter = here;
  quarter.linear() = Eigen::AngleAxisd(M_PI / 2, Vector3d::UnitZ()).toRotationMatrix();
  quarter.translation() = Vector3d(5, 6, 7);
  const scene::Wrench wrench = wrench_from_message(some_wrench(), quarter, body);
  EXPECT_LT((wrench.force - Vector2d(2, 1)).norm(), 1e-15);
  EXPECT_LT((wrench.torque - Vector3d(-4, 3, -5)).norm(), 2e-15);
  geometry_msgs::WrenchStamped upright = some_wrench();  // its x axis is the world's z axis
  upright.wrench.force.x = 0;
  upright.wrench.force.z = 3;
  Eigen::Isometry3d rolled = here;
  rolled.linear() = Eigen::AngleAxisd(-M_PI / 2, Vector3d::UnitY()).toRotationMatrix();
  EXPECT_LT((wrench_from_message(upright, rolled, body).force - Vector2d(-3, -2)).norm(), 1e-15);
  EXPECT_THROW(wrench_from_message(some_wrench(), rolled, body), scene::SceneError) << "its x points upwards";
}

TEST(CommandMessage, IsRefusedWithThePath) {
  using Spoil = std::function<void(geometry_msgs::WrenchStamped&)>;
  const std::vector<std::pair<std::string, Spoil>> cases{
      {"cmd_wrench.force[2]: 1e-300 is refused", [](auto& message) { message.wrench.force.z = 1e-300; }},
      {"cmd_wrench.force[2]: nan is refused", [](auto& message) { message.wrench.force.z = std::nan(""); }},
      {"cmd_wrench.force[0]: nan is refused", [](auto& message) { message.wrench.force.x = std::nan(""); }},
      {"cmd_wrench.force[1]: -inf is refused", [](auto& message) { message.wrench.force.y = -HUGE_VAL; }},
      {"cmd_wrench.force[0]: 1e+300 is refused", [](auto& message) { message.wrench.force.x = 1e300; }},
      {"cmd_wrench.torque[2]: nan is refused", [](auto& message) { message.wrench.torque.z = std::nan(""); }},
      {"cmd_wrench.torque[0]: 1e+16 is refused", [](auto& message) { message.wrench.torque.x = 1e16; }},
  };
  for (const auto& [words, spoil] : cases) {
    geometry_msgs::WrenchStamped message = some_wrench();
    spoil(message);
    try {
      wrench_from_message(message, here, body);
      ADD_FAILURE() << "taken: " << words;
    } catch (const scene::SceneError& error) {
      EXPECT_EQ(std::string(error.what()).find(words), 0U) << error.what();
    }
  }
}

TEST(KickRequest, IsAChangeOfVelocityInTheWorldFrame) {
  Kick::Request request;
  request.impulse.x = 3;
  request.impulse.y = -4;
  EXPECT_EQ(kick_from_message(request, here, 2), Vector2d(1.5, -2));
  const Eigen::Isometry3d quarter(Eigen::AngleAxisd(M_PI / 2, Vector3d::UnitZ()));
  EXPECT_LT((kick_from_message(request, quarter, 2) - Vector2d(2, 1.5)).norm(), 1e-15);
}

TEST(KickRequest, IsRefusedWhereItIsNotHorizontalInTheWorldOrTooLarge) {
  const Eigen::Isometry3d rolled(Eigen::AngleAxisd(M_PI / 2, Vector3d::UnitY()));
  Kick::Request upwards;
  upwards.impulse.z = 1;
  EXPECT_THROW(kick_from_message(upwards, here, 2), scene::SceneError);
  EXPECT_LT((kick_from_message(upwards, rolled, 2) - Vector2d(0.5, 0)).norm(), 1e-15);
  for (const double x : {1e300, HUGE_VAL, -HUGE_VAL, std::nan("")}) {
    Kick::Request request;
    request.impulse.x = x;
    EXPECT_THROW(kick_from_message(request, here, 2), scene::SceneError) << x;
    EXPECT_THROW(kick_from_message(request, rolled, 2), scene::SceneError) << x;
  }
}

TEST(Command, IsNoneBeforeTheFirstOne) {
  Command command(0.5);
  EXPECT_FALSE(command.drop_if_too_old(0));
  EXPECT_EQ(command.wrench().force, Vector2d::Zero());
}

TEST(Command, IsHeldUntilItIsTooOld) {
  Command command(0.5);
  command.take({{1, 2}, {3, 4, 5}});
  for (const double t : {10.0, 10.25, 10.5}) EXPECT_FALSE(command.drop_if_too_old(t));
  EXPECT_EQ(command.wrench().force, Vector2d(1, 2));
  EXPECT_EQ(command.wrench().torque, Vector3d(3, 4, 5));
  EXPECT_TRUE(command.drop_if_too_old(10.75));
  EXPECT_EQ(command.wrench().force, Vector2d::Zero());
  EXPECT_EQ(command.wrench().torque, Vector3d::Zero());
  EXPECT_FALSE(command.drop_if_too_old(11)) << "it is dropped once";
}

TEST(Command, ActsForATickThatIsLongerThanTheTimeout) {
  Command command(0.5);
  for (int n = 0; n < 5; ++n) {
    command.take({{1, 2}, {}});
    EXPECT_FALSE(command.drop_if_too_old(n));
    EXPECT_EQ(command.wrench().force, Vector2d(1, 2));
  }
  EXPECT_TRUE(command.drop_if_too_old(5));
}

TEST(Command, DoesNotAgeWhileTheClockStands) {
  Command command(0.5);
  command.take({{1, 2}, {}});
  for (int n = 0; n < 1000; ++n) EXPECT_FALSE(command.drop_if_too_old(7));
}

TEST(Command, ANewOneIsHeldFromThenOn) {
  Command command(0.5);
  command.take({{1, 2}, {}});
  EXPECT_FALSE(command.drop_if_too_old(1));
  command.take({{3, 4}, {}});
  EXPECT_FALSE(command.drop_if_too_old(1.5));
  EXPECT_FALSE(command.drop_if_too_old(2));
  EXPECT_EQ(command.wrench().force, Vector2d(3, 4));
  EXPECT_TRUE(command.drop_if_too_old(2.25));
}

TEST(Command, WithoutATimeoutIsHeldUntilItIsDropped) {
  Command command(0);
  command.take({{1, 2}, {}});
  EXPECT_FALSE(command.drop_if_too_old(0));
  EXPECT_FALSE(command.drop_if_too_old(1e9));
  EXPECT_EQ(command.wrench().force, Vector2d(1, 2));
  command.drop();
  EXPECT_EQ(command.wrench().force, Vector2d::Zero());
}

}  // namespace
}  // namespace hybrid_sphere::ros_interface::command_test

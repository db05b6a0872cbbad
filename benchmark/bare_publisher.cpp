// The least that a roscpp node can do to send the node's five topics: the same types, names and rate, values
// that never change but for the stamp, no simulation, no services, no callbacks. benchmark/node_cpu compares
// the two.
//   bare_publisher RATE [broadcaster]     broadcaster: transforms by that of tf2_ros instead of a publisher

#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/TwistStamped.h>
#include <hybrid_sphere/SphereState.h>
#include <nav_msgs/Odometry.h>
#include <ros/ros.h>
#include <tf2_msgs/TFMessage.h>
#include <tf2_ros/transform_broadcaster.h>

#include <chrono>
#include <cstdlib>
#include <optional>
#include <string>
#include <thread>

int main(int argc, char** argv) {
  ros::init(argc, argv, "hybrid_sphere");
  const std::chrono::duration<double> period(1 / std::atof(argc > 1 ? argv[1] : "1000"));
  ros::NodeHandle node("~");
  const auto pose_publisher = node.advertise<geometry_msgs::PoseStamped>("pose", 1000);
  const auto twist_publisher = node.advertise<geometry_msgs::TwistStamped>("twist", 1000);
  const auto odom_publisher = node.advertise<nav_msgs::Odometry>("odom", 1000);
  const auto state_publisher = node.advertise<hybrid_sphere::SphereState>("state", 1000);
  ros::Publisher tf_publisher;
  std::optional<tf2_ros::TransformBroadcaster> broadcaster;
  if (argc > 2 && std::string(argv[2]) == "broadcaster") {
    broadcaster.emplace();
  } else {
    tf_publisher = node.advertise<tf2_msgs::TFMessage>("/tf", 1000);
  }
  geometry_msgs::PoseStamped pose;
  geometry_msgs::TwistStamped twist;
  nav_msgs::Odometry odom;
  hybrid_sphere::SphereState state;
  tf2_msgs::TFMessage tf;
  tf.transforms.resize(2);
  for (auto& transform : tf.transforms) transform.header.frame_id = "world";
  tf.transforms[1].child_frame_id = "sphere_contact";
  tf.transforms[0].child_frame_id = odom.child_frame_id = "sphere";
  pose.header.frame_id = twist.header.frame_id = odom.header.frame_id = state.header.frame_id = "world";
  state.mode = "rolling";
  state.region = "rough_half";
  const auto start = std::chrono::steady_clock::now();
  for (std::uint64_t n = 0; ros::ok(); ++n) {
    std::this_thread::sleep_until(start + n * period);
    const ros::Time stamp = ros::Time::now();
    pose.header.stamp = twist.header.stamp = odom.header.stamp = state.header.stamp = stamp;
    for (auto& transform : tf.transforms) transform.header.stamp = stamp;
    pose_publisher.publish(pose);
    twist_publisher.publish(twist);
    odom_publisher.publish(odom);
    state_publisher.publish(state);
    if (broadcaster) {
      broadcaster->sendTransform(tf.transforms);
    } else {
      tf_publisher.publish(tf);
    }
  }
  return 0;
}

// Listens to the five topics of every tick of /hybrid_sphere and does nothing with them; prints how many
// messages came when it ends. For benchmark/node_cpu.

#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/TwistStamped.h>
#include <hybrid_sphere/SphereState.h>
#include <nav_msgs/Odometry.h>
#include <ros/ros.h>
#include <tf2_msgs/TFMessage.h>

#include <cstdio>

namespace {

std::uint64_t received = 0;

template <class Message>
void count(const boost::shared_ptr<const Message>&) {
  ++received;
}

}  // namespace

int main(int argc, char** argv) {
  ros::init(argc, argv, "bare_listener");
  ros::NodeHandle node("/hybrid_sphere");
  const std::vector<ros::Subscriber> subscribers{
      node.subscribe("pose", 1000, count<geometry_msgs::PoseStamped>),
      node.subscribe("twist", 1000, count<geometry_msgs::TwistStamped>),
      node.subscribe("odom", 1000, count<nav_msgs::Odometry>),
      node.subscribe("state", 1000, count<hybrid_sphere::SphereState>),
      node.subscribe("/tf", 1000, count<tf2_msgs::TFMessage>)};
  ros::spin();
  std::printf("%llu\n", static_cast<unsigned long long>(received));
  return 0;
}

#include "hybrid_sphere/ros/state_publisher.hpp"

#include "hybrid_sphere/ros/record_messages.hpp"

namespace hybrid_sphere::ros_interface {
namespace {

constexpr std::uint32_t queue_size = 1000;  // a second at 1 kHz for a listener that hangs

}  // namespace

StatePublisher::StatePublisher(ros::NodeHandle& node, const Frames& frames, const Sphere& sphere)
    : sphere_(sphere),
      pose_publisher_(node.advertise<geometry_msgs::PoseStamped>("pose", queue_size)),
      twist_publisher_(node.advertise<geometry_msgs::TwistStamped>("twist", queue_size)),
      odom_publisher_(node.advertise<nav_msgs::Odometry>("odom", queue_size)),
      state_publisher_(node.advertise<SphereState>("state", queue_size)),
      tf_publisher_(node.advertise<tf2_msgs::TFMessage>("/tf", queue_size)) {
  pose_.header.frame_id = frames.world;
  twist_.header.frame_id = frames.world;
  odom_.header.frame_id = frames.world;
  odom_.child_frame_id = frames.sphere;
  state_.header.frame_id = frames.world;
  tf_.transforms.resize(1);
  tf_.transforms[0].header.frame_id = frames.world;
  tf_.transforms[0].child_frame_id = frames.sphere;
}

bool StatePublisher::has_listeners() const {
  return pose_publisher_.getNumSubscribers() != 0 || twist_publisher_.getNumSubscribers() != 0 ||
         odom_publisher_.getNumSubscribers() != 0 || state_publisher_.getNumSubscribers() != 0 ||
         tf_publisher_.getNumSubscribers() != 0;
}

void StatePublisher::publish(Simulation& simulation, const ros::Time& stamp) {
  const State& state = simulation.state();
  const double radius = sphere_.radius();
  if (pose_publisher_.getNumSubscribers() != 0) {
    pose_.header.stamp = stamp;
    fill(state, radius, pose_.pose);
    pose_publisher_.publish(pose_);
  }
  if (twist_publisher_.getNumSubscribers() != 0) {
    twist_.header.stamp = stamp;
    fill(state.twist, twist_.twist);
    twist_publisher_.publish(twist_);
  }
  if (odom_publisher_.getNumSubscribers() != 0) {
    odom_.header.stamp = stamp;
    fill(state, radius, odom_.pose.pose);
    fill_in_sphere_frame(state, odom_.twist.twist);
    odom_publisher_.publish(odom_);
  }
  if (state_publisher_.getNumSubscribers() != 0) {
    state_.header.stamp = stamp;
    fill(state, simulation.reaction(), sphere_, state_);
    state_publisher_.publish(state_);
  }
  if (tf_publisher_.getNumSubscribers() != 0) {
    tf_.transforms[0].header.stamp = stamp;
    fill(state, radius, tf_.transforms[0].transform);
    tf_publisher_.publish(tf_);
  }
}

}  // namespace hybrid_sphere::ros_interface

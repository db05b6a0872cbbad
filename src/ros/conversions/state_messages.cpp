#include "ros/conversions/state_messages.hpp"

#include "ros/conversions/conversions.hpp"

namespace hybrid_sphere::ros_interface {

StateMessages::StateMessages(const Frames& frames, const Sphere& sphere) : sphere_(sphere) {
  pose_.header.frame_id = frames.world;
  twist_.header.frame_id = frames.world;
  odom_.header.frame_id = frames.world;
  odom_.child_frame_id = frames.sphere;
  state_.header.frame_id = frames.world;
  tf_.transforms.resize(frames.view.empty() ? 2 : 3);
  for (auto& transform : tf_.transforms) transform.header.frame_id = frames.world;
  tf_.transforms[0].child_frame_id = frames.sphere;
  tf_.transforms[1].child_frame_id = frames.contact();
  tf_.transforms[1].transform.rotation.w = 1;
  if (!frames.view.empty()) tf_.transforms[2].child_frame_id = frames.view;
}

const geometry_msgs::PoseStamped& StateMessages::pose(const State& state, const ros::Time& stamp) {
  pose_.header.stamp = stamp;
  fill(state, sphere_.radius(), pose_.pose);
  return pose_;
}

const geometry_msgs::TwistStamped& StateMessages::twist(const State& state, const ros::Time& stamp) {
  twist_.header.stamp = stamp;
  fill(state.twist, twist_.twist);
  return twist_;
}

const nav_msgs::Odometry& StateMessages::odom(const State& state, const ros::Time& stamp) {
  odom_.header.stamp = stamp;
  fill(state, sphere_.radius(), odom_.pose.pose);
  fill_in_sphere_frame(state, odom_.twist.twist);
  return odom_;
}

const tf2_msgs::TFMessage& StateMessages::transform(const State& state, const ros::Time& stamp,
                                                    const Vector3d& view_center) {
  tf_.transforms[0].header.stamp = stamp;
  fill(state, sphere_.radius(), tf_.transforms[0].transform);
  tf_.transforms[1].header.stamp = stamp;
  tf_.transforms[1].transform.translation.x = state.position.x();
  tf_.transforms[1].transform.translation.y = state.position.y();
  if (tf_.transforms.size() > 2) {
    tf_.transforms[2].header.stamp = stamp;
    fill(view_center, tf_.transforms[2].transform);
  }
  return tf_;
}

const SphereState& StateMessages::state(const State& state, const Vector3d& reaction,
                                        const ros::Time& stamp) {
  state_.header.stamp = stamp;
  fill(state, reaction, sphere_, state_);
  return state_;
}

}  // namespace hybrid_sphere::ros_interface

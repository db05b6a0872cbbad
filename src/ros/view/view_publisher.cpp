#include "ros/view/view_publisher.hpp"

#include <hybrid_sphere/SceneView.h>

#include "ros/node/publish_latched.hpp"
#include "ros/view/camera.hpp"

namespace hybrid_sphere::ros_interface {

std::string view_frame_of(const ros::NodeHandle& node) { return node.getNamespace().substr(1) + "_view"; }

ViewPublisher::ViewPublisher(ros::NodeHandle& node, const std::string& world_frame,
                             const std::string& view_frame, const Eigen::AlignedBox3d& map,
                             const FramedBody& body)
    : first_(first_framing(map, body)), view_(first_.distance, first_.center, body.position) {
  const Framing whole = whole_framing(map, body, first_);
  SceneView message;
  message.header.frame_id = world_frame;
  message.view_frame = view_frame;
  message.distance = first_.distance;
  message.yaw = camera::yaw;
  message.pitch = camera::pitch;
  message.whole_center.x = whole.center.x();
  message.whole_center.y = whole.center.y();
  message.whole_center.z = whole.center.z();
  message.whole_distance = whole.distance;
  publisher_ = node.advertise<SceneView>("view", 1, true);
  publish_latched(publisher_, message);
}

void ViewPublisher::restart(const Eigen::Vector3d& body) {
  const Eigen::Vector3d outer = first_.distance * DeadZone::outer();
  const bool is_inside = ((body - first_.center).cwiseAbs().array() <= outer.array()).all();
  view_ = FollowedView(first_.distance, is_inside ? first_.center : body, body);
}

}  // namespace hybrid_sphere::ros_interface

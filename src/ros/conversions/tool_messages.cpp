#include "ros/conversions/tool_messages.hpp"

#include "ros/conversions/initial_state_message.hpp"
#include "scene/map_reader.hpp"

namespace hybrid_sphere::ros_interface {
namespace {

using scene::SceneError;
using scene::Tree;

constexpr scene::Range point_range{-1e15, 1e15, "[m]", 0};

void check_frame(const std::string& name, const std_msgs::Header& header, const std::string& world_frame) {
  if (header.frame_id.empty() || header.frame_id == world_frame) return;
  throw SceneError(name + ".header.frame_id", Tree(header.frame_id).describe(),
                   Tree(world_frame).describe() + ", or empty");
}

}  // namespace

scene::InitialState initial_state_from_pose(const geometry_msgs::PoseWithCovarianceStamped& message,
                                            const std::string& world_frame, double radius) {
  check_frame("initialpose", message.header, world_frame);
  SetInitialState::Request request;
  request.pose = message.pose.pose;
  return initial_state_from_message(request, radius);
}

scene::InitialState initial_state_from_drag(const visualization_msgs::InteractiveMarkerFeedback& message,
                                            const std::string& world_frame, const Quaterniond& orientation) {
  check_frame("handle", message.header, world_frame);
  SetInitialState::Request request;
  request.pose.position.x = message.pose.position.x;
  request.pose.position.y = message.pose.position.y;
  scene::InitialState state = initial_state_from_message(request, 0);
  state.orientation = orientation;
  return state;
}

Vector2d direction_to_point(const geometry_msgs::PointStamped& message, const std::string& world_frame,
                            const Vector2d& center) {
  check_frame("clicked_point", message.header, world_frame);
  const std::string path = "clicked_point.point";
  scene::read_number(Tree(message.point.z), path + ".z", point_range);
  const Vector2d point(scene::read_number(Tree(message.point.x), path + ".x", point_range),
                       scene::read_number(Tree(message.point.y), path + ".y", point_range));
  const Vector2d way = point - center;
  if (way.isZero(0)) {
    throw SceneError(path, Tree(Tree::List{point.x(), point.y()}).describe(),
                     "a point other than the centre of the sphere, to give a direction");
  }
  return way.stableNormalized();
}

}  // namespace hybrid_sphere::ros_interface

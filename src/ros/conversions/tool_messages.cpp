#include "ros/conversions/tool_messages.hpp"

#include "ros/conversions/initial_state_message.hpp"
#include "ros/conversions/world_coordinates.hpp"
#include "scene/check.hpp"
#include "scene/map_reader.hpp"

namespace hybrid_sphere::ros_interface {
namespace {

using scene::SceneError;
using scene::Tree;

constexpr scene::Range point_range{-1e15, 1e15, "[m]", 0};

}  // namespace

scene::InitialState initial_state_from_pose(const geometry_msgs::PoseWithCovarianceStamped& message,
                                            const Eigen::Isometry3d& to_world, double radius) {
  SetInitialState::Request request;
  request.pose = message.pose.pose;
  return initial_state_from_message(request, to_world, radius);
}

scene::InitialState initial_state_from_drag(const visualization_msgs::InteractiveMarkerFeedback& message,
                                            const Eigen::Isometry3d& to_world,
                                            const Quaterniond& orientation) {
  scene::InitialState state;
  state.position = point_in_world(message.pose.position, to_world).head<2>();
  scene::check_initial_state(state, "initial_state");
  state.orientation = orientation;
  return state;
}

Vector2d direction_to_point(const geometry_msgs::PointStamped& message, const Eigen::Isometry3d& to_world,
                            const Vector2d& center) {
  const std::string path = "clicked_point.point";
  const Vector3d clicked = point_in_world(message.point, to_world);
  scene::read_number(Tree(clicked.z()), path + ".z", point_range);
  const Vector2d point(scene::read_number(Tree(clicked.x()), path + ".x", point_range),
                       scene::read_number(Tree(clicked.y()), path + ".y", point_range));
  const Vector2d way = point - center;
  if (way.isZero(0)) {
    throw SceneError(path, Tree(Tree::List{point.x(), point.y()}).describe(),
                     "a point other than the centre of the sphere, to give a direction");
  }
  return way.stableNormalized();
}

}  // namespace hybrid_sphere::ros_interface

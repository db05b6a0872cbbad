#include "ros/conversions/tool_messages.hpp"

#include <cmath>

#include "ros/conversions/initial_state_message.hpp"
#include "scene/map_reader.hpp"

namespace hybrid_sphere::ros_interface {
namespace {

using scene::SceneError;
using scene::Tree;

constexpr scene::Range point_range{-1e15, 1e15, "[m]", 0};

Vector3d in_world(const geometry_msgs::Point& p, const Eigen::Isometry3d& to_world) {
  const Vector3d point(p.x, p.y, p.z);
  return to_world.isApprox(Eigen::Isometry3d::Identity(), 0) ? point : Vector3d(to_world * point);
}

/// A height that others have computed is 0 or the radius but for their rounding.
double told_height(double z, double radius) {
  constexpr double slack = 1e-9;  // [m]
  if (std::abs(z) <= slack) return 0;
  return std::abs(z - radius) <= slack ? radius : z;
}

}  // namespace

scene::InitialState initial_state_from_pose(const geometry_msgs::PoseWithCovarianceStamped& message,
                                            const Eigen::Isometry3d& to_world, double radius) {
  SetInitialState::Request request;
  request.pose = message.pose.pose;
  if (!to_world.isApprox(Eigen::Isometry3d::Identity(), 0)) {
    const Vector3d center = in_world(message.pose.pose.position, to_world);
    auto& q = request.pose.orientation;
    const bool is_given = q.x != 0 || q.y != 0 || q.z != 0 || q.w != 0;
    const Quaterniond given = is_given ? Quaterniond(q.w, q.x, q.y, q.z) : Quaterniond::Identity();
    const Quaterniond orientation = Quaterniond(to_world.linear()) * given;
    request.pose.position.x = center.x();
    request.pose.position.y = center.y();
    request.pose.position.z = told_height(center.z(), radius);
    q.x = orientation.x();
    q.y = orientation.y();
    q.z = orientation.z();
    q.w = orientation.w();
  }
  return initial_state_from_message(request, radius);
}

scene::InitialState initial_state_from_drag(const visualization_msgs::InteractiveMarkerFeedback& message,
                                            const Eigen::Isometry3d& to_world,
                                            const Quaterniond& orientation) {
  const Vector3d center = in_world(message.pose.position, to_world);
  SetInitialState::Request request;
  request.pose.position.x = center.x();
  request.pose.position.y = center.y();
  scene::InitialState state = initial_state_from_message(request, 0);
  state.orientation = orientation;
  return state;
}

Vector2d direction_to_point(const geometry_msgs::PointStamped& message, const Eigen::Isometry3d& to_world,
                            const Vector2d& center) {
  const std::string path = "clicked_point.point";
  const Vector3d clicked = in_world(message.point, to_world);
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

// Whatever a topic, a service or the parameter server sends is taken or refused with a SceneError; no
// roscore.

#include <hybrid_sphere/SetSurfaceMap.h>
#include <ros/serialization.h>
#include <cmath>

#include "draw_bytes.hpp"
#include "ros/conversions/initial_state_message.hpp"
#include "ros/conversions/surface_grid.hpp"
#include "ros/conversions/surface_message.hpp"
#include "ros/conversions/tool_messages.hpp"
#include "ros/markers/surface_outline.hpp"
#include "ros/node/command.hpp"
#include "ros/node/parameters.hpp"
#include "support/random_scenes.hpp"
#include "target.hpp"

namespace {

using namespace hybrid_sphere;
using namespace hybrid_sphere::ros_interface;
using fuzz::draw_double;
using testing::integer;

std::string draw_text() {
  std::string text;
  for (int i = integer(0, 12); i > 0; --i) text += static_cast<char>(integer(0, 255));
  return text;
}

std::string draw_frame() { return integer(0, 3) == 0 ? draw_text() : integer(0, 1) == 0 ? "world" : ""; }

template <class Point>
void draw(Point& point) {
  point.x = draw_double();
  point.y = draw_double();
  point.z = integer(0, 1) == 0 ? 0 : draw_double();
}

void draw(geometry_msgs::Pose& pose) {
  draw(pose.position);
  draw(pose.orientation);
  pose.orientation.w = integer(0, 1) == 0 ? 1 : draw_double();
}

void draw(geometry_msgs::Twist& twist) {
  draw(twist.linear);
  draw(twist.angular);
}

SurfaceRegion draw_region() {
  SurfaceRegion region;
  region.name = draw_text();
  region.shape = static_cast<std::uint8_t>(integer(0, 4));
  region.points.resize(static_cast<std::size_t>(integer(0, 9)));
  for (auto& point : region.points) draw(point);
  draw(region.normal);
  region.radius = draw_double();
  region.law = static_cast<std::uint8_t>(integer(0, 4));
  if (integer(0, 1) == 0) region.friction = draw_double();
  if (integer(0, 1) == 0) region.rolling_resistance = draw_double();
  if (integer(0, 1) == 0) region.spin_friction = draw_double();
  region.outside = integer(0, 1) != 0;
  if (integer(0, 1) == 0) draw(region.belt);
  if (integer(0, 1) == 0) region.turntable_rate = draw_double();
  if (integer(0, 1) == 0) draw(region.turntable_center);
  return region;
}

/// As it comes over a wire.
template <class Message>
Message sent(const Message& message) {
  const ros::SerializedMessage bytes = ros::serialization::serializeMessage(message);
  Message received;
  ros::serialization::deserializeMessage(bytes, received);
  return received;
}

/// From a frame to the world's: the same one, or one that is shifted and turned.
Eigen::Isometry3d draw_transform() {
  Eigen::Isometry3d transform = Eigen::Isometry3d::Identity();
  if (integer(0, 1) == 0) return transform;
  const auto number = [] { return 0x1p-8 * integer(-4096, 4096); };
  transform.translation() = Vector3d(number(), number(), number());
  const Eigen::Quaterniond turn(number(), number(), number(), number());
  if (turn.squaredNorm() > 0) transform.linear() = turn.normalized().toRotationMatrix();
  return transform;
}

PlanarTransform draw_planar_transform() {
  if (integer(0, 1) == 0) return {};
  const double angle = 0x1p-8 * integer(-1024, 1024);
  return {std::cos(angle), std::sin(angle), Vector2d(0x1p-8 * integer(-4096, 4096), 0x1p-8)};
}

void take_map() {
  SetSurfaceMap::Request request;
  request.map.header.frame_id = draw_frame();
  request.map.base = draw_region();
  for (int i = integer(0, 4); i > 0; --i) request.map.regions.push_back(draw_region());
  request.map.livelock = static_cast<std::uint8_t>(integer(0, 2));
  const scene::Surface surface = surface_from_message(sent(request).map, draw_planar_transform(), {});
  const scene::Surface again = surface_from_message(message_from_surface(surface), {}, {});
  if (again.regions.size() != surface.regions.size()) fuzz::found("a map comes back as it went");
  const ViewSquare view = view_around(surface, {Vector2d(0, 0)}, 0.1);
  for (const scene::Region& region : surface.regions) {
    const Outline outline = outline_of(region.shape, view);
    for (const auto* points : {&outline.triangles, &outline.edges}) {
      for (const Vector2d& point : *points)
        if (!point.allFinite()) fuzz::found("markers are finite");
    }
  }
}

void take_grid() {
  nav_msgs::OccupancyGrid grid;
  grid.header.frame_id = draw_frame();
  grid.info.resolution = static_cast<float>(draw_double());
  grid.info.width = static_cast<std::uint32_t>(integer(0, 3) == 0 ? integer(0, 1 << 30) : integer(0, 8));
  grid.info.height = static_cast<std::uint32_t>(integer(0, 3) == 0 ? integer(0, 1 << 30) : integer(0, 8));
  draw(grid.info.origin);
  const auto cells = static_cast<std::size_t>(grid.info.width) * grid.info.height;
  grid.data.resize(integer(0, 3) == 0 || cells > 4096 ? static_cast<std::size_t>(integer(0, 64)) : cells);
  for (auto& cell : grid.data) cell = static_cast<std::int8_t>(integer(-128, 127));
  surface_from_grid(sent(grid), draw_planar_transform(), 65, {});
}

void take_tools() {
  geometry_msgs::PoseWithCovarianceStamped pose;
  pose.header.frame_id = draw_frame();
  draw(pose.pose.pose);
  geometry_msgs::PointStamped point;
  point.header.frame_id = draw_frame();
  draw(point.point);
  visualization_msgs::InteractiveMarkerFeedback feedback;
  feedback.header.frame_id = draw_frame();
  draw(feedback.pose);
  switch (integer(0, 2)) {
    case 0: initial_state_from_pose(sent(pose), draw_transform(), 0.1); break;
    case 1: direction_to_point(sent(point), draw_transform(), Vector2d(0, 0)); break;
    default: initial_state_from_drag(sent(feedback), draw_transform(), Quaterniond::Identity());
  }
}

void take_state_wrench_or_kick() {
  SetInitialState::Request state;
  state.header.frame_id = draw_frame();
  draw(state.pose);
  draw(state.twist);
  geometry_msgs::WrenchStamped wrench;
  wrench.header.frame_id = draw_frame();
  draw(wrench.wrench.force);
  draw(wrench.wrench.torque);
  Kick::Request kick;
  kick.header.frame_id = draw_frame();
  draw(kick.impulse);
  switch (integer(0, 2)) {
    case 0: initial_state_from_message(sent(state), draw_transform(), 0.1); break;
    case 1: wrench_from_message(sent(wrench), draw_transform(), {1, 0.1, 0.05}); break;
    default: kick_from_message(sent(kick), draw_transform(), 2);
  }
}

void take_parameters(const std::uint8_t* data, std::size_t size) {
  const std::string xml(reinterpret_cast<const char*>(data), size);
  XmlRpc::XmlRpcValue value;
  int offset = 0;
  if (value.fromXml(xml, &offset) && value.valid()) read_configuration(tree_from_parameters(value));
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  fuzz::draw_from(data + 1, size - 1);
  try {
    switch (data[0] % 5) {
      case 0: take_map(); break;
      case 1: take_grid(); break;
      case 2: take_tools(); break;
      case 3: take_state_wrench_or_kick(); break;
      default: take_parameters(data + 1, size - 1);
    }
  } catch (const scene::SceneError&) {
  }
  return 0;
}

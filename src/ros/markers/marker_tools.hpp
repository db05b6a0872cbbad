#pragma once

#include <geometry_msgs/Point.h>
#include <std_msgs/ColorRGBA.h>
#include <visualization_msgs/Marker.h>

#include <algorithm>
#include <string>

namespace hybrid_sphere::ros_interface {

/// @param red, green, blue, alpha  0 to 1
inline std_msgs::ColorRGBA color(double red, double green, double blue, double alpha = 1) {
  std_msgs::ColorRGBA color;
  color.r = static_cast<float>(red);
  color.g = static_cast<float>(green);
  color.b = static_cast<float>(blue);
  color.a = static_cast<float>(alpha);
  return color;
}

inline geometry_msgs::Point point(double x, double y, double z) {
  geometry_msgs::Point point;
  point.x = x;
  point.y = y;
  point.z = z;
  return point;
}

/// Width of a text over its height, about: rviz has one for every letter.
/// @param text  UTF-8
inline double width_of(const std::string& text) {
  constexpr double letter_width = 0.55;
  const auto begins_letter = [](char c) { return (static_cast<unsigned char>(c) & 0xc0U) != 0x80U; };
  return letter_width * static_cast<double>(std::count_if(text.begin(), text.end(), begins_letter));
}

/// A marker at the origin of its frame that stays until it is replaced. A stamp of 0 is left: rviz then takes
/// the newest transform.
inline visualization_msgs::Marker make_marker(const std::string& frame, const std::string& name,
                                              std::int32_t id, std::int32_t type) {
  visualization_msgs::Marker marker;
  marker.header.frame_id = frame;
  marker.ns = name;
  marker.id = id;
  marker.type = type;
  marker.action = visualization_msgs::Marker::ADD;
  marker.pose.orientation.w = 1;
  return marker;
}

}  // namespace hybrid_sphere::ros_interface

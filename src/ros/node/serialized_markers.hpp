#pragma once

#include <ros/message_traits.h>
#include <ros/serialization.h>
#include <visualization_msgs/MarkerArray.h>

namespace hybrid_sphere::ros_interface {

/// A MarkerArray that was turned into bytes beforehand. A publisher does that under a lock that all
/// publishers of the process share: with a large message it would hold up the topics of every tick.
struct SerializedMarkers {
  explicit SerializedMarkers(const visualization_msgs::MarkerArray& markers)
      : bytes(ros::serialization::serializeMessage(markers)) {}

  ros::SerializedMessage bytes;  ///< never changed, and shared by the copies
};

}  // namespace hybrid_sphere::ros_interface

namespace ros::message_traits {

template <>
struct MD5Sum<hybrid_sphere::ros_interface::SerializedMarkers> : MD5Sum<visualization_msgs::MarkerArray> {
  using MD5Sum<visualization_msgs::MarkerArray>::value;
  static const char* value(const hybrid_sphere::ros_interface::SerializedMarkers&) { return value(); }
};

template <>
struct DataType<hybrid_sphere::ros_interface::SerializedMarkers> : DataType<visualization_msgs::MarkerArray> {
  using DataType<visualization_msgs::MarkerArray>::value;
  static const char* value(const hybrid_sphere::ros_interface::SerializedMarkers&) { return value(); }
};

}  // namespace ros::message_traits

namespace ros::serialization {

/// What a publisher calls under that lock.
template <>
inline SerializedMessage serializeMessage(const hybrid_sphere::ros_interface::SerializedMarkers& markers) {
  return markers.bytes;
}

}  // namespace ros::serialization

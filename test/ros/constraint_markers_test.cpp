#include "ros/system/constraint_markers.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace hybrid_sphere::ros_interface::constraint_markers_test {
namespace {

using visualization_msgs::Marker;
using visualization_msgs::MarkerArray;

constexpr double unit = 10;
constexpr double half_width = 0.25;

MarkerArray drawn(ConstraintMarkers& markers, const Eigen::Vector3d& body,
                  const std::string& active = "blade") {
  MarkerArray array;
  markers.append_to(array, body, active, unit);
  return array;
}

const Marker* find(const MarkerArray& array, const std::string& name) {
  const auto found = std::find_if(array.markers.begin(), array.markers.end(),
                                  [&name](const Marker& marker) { return marker.ns == name; });
  return found == array.markers.end() ? nullptr : &*found;
}

TEST(ConstraintMarkers, NameTheConstraintsBesideTheBody) {
  ConstraintMarkers markers("world", half_width);
  const MarkerArray array = drawn(markers, {1, 2, 0});
  const Marker* name = find(array, "constraints");
  ASSERT_NE(name, nullptr);
  EXPECT_EQ(name->text, "blade");
  EXPECT_EQ(name->pose.position.x, 1);
  EXPECT_GT(name->pose.position.y, 2 + half_width);
  EXPECT_EQ(array.markers.size(), 1U);
}

TEST(ConstraintMarkers, HaveAnArrowAlongTheChangeOfVelocity) {
  ConstraintMarkers markers("world", half_width);
  markers.add({"blade", {1, 2, 0}, {3, 0, 0}, {3, 4, 0}});
  const MarkerArray array = drawn(markers, {9, 9, 0});
  const Marker* arrow = find(array, "impulses");
  ASSERT_NE(arrow, nullptr);
  ASSERT_EQ(arrow->points.size(), 2U);
  EXPECT_EQ(arrow->points[0].x, 1);
  EXPECT_EQ(arrow->points[0].y, 2);
  EXPECT_EQ(arrow->points[1].x, 1);
  EXPECT_GT(arrow->points[1].y, 2);
  const Marker* label = find(array, "impulse_constraints");
  ASSERT_NE(label, nullptr);
  EXPECT_EQ(label->text, "blade: 4 m/s");
}

TEST(ConstraintMarkers, DeleteTheImpulsesOfTheMotionBefore) {
  ConstraintMarkers markers("world", half_width);
  for (int i = 0; i < 3; ++i) markers.add({"blade", {2. * i, 0, 0}, {1, 0, 0}, {0, 1, 0}});
  drawn(markers, {9, 9, 0});
  markers.clear();
  const MarkerArray array = drawn(markers, {9, 9, 0});
  EXPECT_EQ(std::count_if(array.markers.begin(), array.markers.end(),
                          [](const Marker& marker) { return marker.action == Marker::DELETE; }),
            6);
  EXPECT_EQ(drawn(markers, {9, 9, 0}).markers.size(), 1U);
}

TEST(ConstraintMarkers, LabelsOfOnePlaceDoNotOverlap) {
  ConstraintMarkers markers("world", half_width);
  for (int i = 0; i < 4; ++i) markers.add({"blade", {0, 0, 0}, {1, 0, 0}, {2. + i, 0, 0}});
  std::vector<PictureBox> boxes;
  for (const Marker& marker : drawn(markers, {1, 0, 0}).markers) {
    if (marker.ns != "impulse_constraints" || marker.action == Marker::DELETE) continue;
    const auto& p = marker.pose.position;
    const Vector2d half = 0.5 * marker.scale.z * Vector2d(0.5 * static_cast<double>(marker.text.size()), 1);
    const PictureBox box{in_picture(Vector2d(p.x, p.y), p.z), half};
    for (const PictureBox& other : boxes) EXPECT_FALSE(may_overlap(box, other)) << marker.text;
    boxes.push_back(box);
  }
  EXPECT_EQ(boxes.size(), 4U);
}

}  // namespace
}  // namespace hybrid_sphere::ros_interface::constraint_markers_test

#include "ros/markers/sphere_markers.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace hybrid_sphere::ros_interface::sphere_markers_test {
namespace {

using visualization_msgs::Marker;
using visualization_msgs::MarkerArray;

const Sphere ball({2, 0.25, 0.125});
const ros::Time stamp(100, 0);

const Marker* find(const MarkerArray& markers, const std::string& name) {
  for (const Marker& marker : markers.markers) {
    if (marker.ns == name) return &marker;
  }
  return nullptr;
}

State state_at(const Vector2d& position, const Vector2d& slip = Vector2d::Zero()) {
  State state;
  state.position = position;
  state.slip = slip;
  return state;
}

TEST(SlipArrow, BeginsAtTheContactPointAndGrowsWithTheSlip) {
  SphereMarkers markers({}, ball, {});
  markers.start_at({1, 2});
  for (const double slip : {0.5, 2.0}) {
    const Marker* arrow = find(markers.update(state_at({1, 2}, {0, slip}), stamp, false), "slip");
    ASSERT_NE(arrow, nullptr);
    EXPECT_EQ(arrow->action, Marker::ADD);
    ASSERT_EQ(arrow->points.size(), 2U);
    EXPECT_EQ(arrow->points[0].x, 1);
    EXPECT_EQ(arrow->points[0].y, 2);
    EXPECT_LT(arrow->points[0].z, ball.radius());
    EXPECT_EQ(arrow->points[1].x, 1);
    EXPECT_EQ(arrow->points[1].y, 2 + slip);
  }
}

TEST(SlipArrow, IsDeletedOnceWhenTheSlipHasEnded) {
  SphereMarkers markers({}, ball, {});
  markers.start_at({0, 0});
  EXPECT_EQ(find(markers.update(state_at({0, 0}), stamp, false), "slip"), nullptr);
  markers.update(state_at({0, 0}, {1, 0}), stamp, false);
  const Marker* gone = find(markers.update(state_at({0, 0}), stamp, false), "slip");
  ASSERT_NE(gone, nullptr);
  EXPECT_EQ(gone->action, Marker::DELETE);
  EXPECT_EQ(find(markers.update(state_at({0, 0}), stamp, false), "slip"), nullptr);
}

TEST(Trail, OfNoCornersLeadsFromTheLastOneToTheSphere) {
  SphereMarkers markers({}, ball, {});
  markers.start_at({0, 0});
  markers.update(state_at({1, 0}), stamp, false);
  MarkerStyle style;
  style.trail_length = 0;
  markers.set_style(style);
  for (const Vector2d& position : {Vector2d(2, 0), Vector2d(2, 1), Vector2d(1, 1)}) {
    const Marker* trail = find(markers.update(state_at(position), stamp, false), "trail");
    ASSERT_NE(trail, nullptr);
    ASSERT_EQ(trail->points.size(), 2U);
    EXPECT_EQ(trail->points.back().x, position.x());
    EXPECT_EQ(trail->points.back().y, position.y());
  }
}

TEST(Trail, HasACornerWhereTheSphereIsKickedAndNoneOnAStraightPath) {
  SphereMarkers markers({}, ball, {});
  markers.start_at({0, 0});
  for (const double x : {0.1, 0.2, 0.3}) markers.update(state_at({x, 0}), stamp, false);
  EXPECT_EQ(find(markers.update(state_at({0.4, 0}), stamp, false), "trail")->points.size(), 2U);
  const Marker* trail = find(markers.update(state_at({0.4, 0.1}), stamp, false), "trail");
  ASSERT_EQ(trail->points.size(), 3U);
  EXPECT_EQ(trail->points[1].x, 0.4);
  EXPECT_EQ(trail->points[1].y, 0);
  trail = find(markers.update(state_at({0.4, 0.05}), stamp, false), "trail");
  ASSERT_EQ(trail->points.size(), 4U);  // it turned back
  EXPECT_EQ(trail->points[2].y, 0.1);
}

// Whether a segment comes into a box, by a hundred of its points.
bool meets(const Vector2d& from, const Vector2d& to, const Vector2d& middle, const Vector2d& half) {
  for (int i = 0; i <= 100; ++i) {
    const Vector2d p = from + 0.01 * i * (to - from);
    if (((p - middle).cwiseAbs().array() < half.array()).all()) return true;
  }
  return false;
}

TEST(ImpulseSizes, AreLargeEnoughForTheSceneAndLieNeitherOverTheArrowNorOverThePath) {
  const Vector2d place(1, 2);
  for (int i = 0; i < 16; ++i) {
    const double angle = 0.4 * i;
    for (const double turn : {0.0, 0.3, 1.5, 3.0}) {
      Switch event{};
      event.position = place;
      event.impulse = Vector2d(std::cos(angle), std::sin(angle));
      event.before.velocity = -Vector2d(std::cos(angle + turn), std::sin(angle + turn));
      event.energy_before = 1;
      SphereMarkers markers({}, ball, {});
      markers.start_at(place - event.before.velocity);
      markers.add(event, stamp);
      const MarkerArray array = markers.update(state_at(place), stamp, false, 20);
      const Marker* label = find(array, "impulse_sizes");
      const Marker* arrow = find(array, "impulses");
      ASSERT_TRUE(label != nullptr && arrow != nullptr);
      EXPECT_GE(label->scale.z, 0.02 * 20);
      const Vector2d middle(label->pose.position.x, label->pose.position.y);
      const double letters = static_cast<double>(label->text.size());
      const Vector2d half = 0.5 * label->scale.z * Vector2d(0.5 * letters, 1);
      const Vector2d tip(arrow->points[1].x, arrow->points[1].y);
      EXPECT_FALSE(meets(place, tip, middle, half)) << angle << ", " << turn;
      EXPECT_FALSE(meets(place, place - event.before.velocity, middle, half)) << angle << ", " << turn;
    }
  }
}

TEST(ImpulseSizes, GrowWithTheView) {
  SphereMarkers markers({}, ball, {});
  markers.start_at({0, 0});
  Switch event{};
  event.impulse = {1, 0};
  event.energy_before = 1;
  markers.add(event, stamp);
  const double none_drawn = 0;
  const double small =
      find(markers.update(state_at({0, 0}), stamp, false, none_drawn), "impulse_sizes")->scale.z;
  EXPECT_GT(find(markers.update(state_at({0, 0}), stamp, false, 20), "impulse_sizes")->scale.z, 2 * small);
  EXPECT_EQ(find(markers.update(state_at({0, 0}), stamp, false, 20), "impulse_sizes"), nullptr);
}

TEST(ImpulseSizes, OfOnePlaceStandOneOverTheOther) {
  SphereMarkers markers({}, ball, {});
  markers.start_at({0, 0});
  for (int i = 0; i < 4; ++i) {
    Switch event{};
    event.position = {1, 2};
    event.impulse = {-1 - i, 0};
    event.before.velocity = {1, 0};
    event.energy_before = 1;
    markers.add(event, stamp);
  }
  std::vector<double> heights;
  const MarkerArray array = markers.update(state_at({1, 2}), stamp, false, 20);
  for (const Marker& marker : array.markers) {
    if (marker.ns == "impulse_sizes") heights.push_back(marker.pose.position.y);
  }
  ASSERT_EQ(heights.size(), 4U);
  std::sort(heights.begin(), heights.end());
  for (std::size_t i = 1; i < heights.size(); ++i) EXPECT_GE(heights[i] - heights[i - 1], 0.02 * 20);
}

Switch impulse_at(const Vector2d& position) {
  Switch event{};
  event.position = position;
  event.impulse = {-1, 0};
  event.before.velocity = {1, 0};
  event.energy_before = 1;
  return event;
}

TEST(ImpulseSizes, MakeRoomForTheSphereAndForNames) {
  SphereMarkers markers({}, ball, {});
  markers.start_at({0, 0});
  markers.add(impulse_at({0, 0}), stamp);
  constexpr double unit = 10;
  const MarkerArray first = markers.update(state_at({5, 5}), stamp, false, unit);
  const Marker* label = find(first, "impulse_sizes");
  ASSERT_NE(label, nullptr);
  const Vector2d place(label->pose.position.x, label->pose.position.y);
  const std::vector<RegionName> names = {{0, place, label->scale.z, "name: rough"}};
  const Marker* moved = find(markers.update(state_at({5, 5}), stamp, false, unit, names), "impulse_sizes");
  ASSERT_NE(moved, nullptr);
  const Vector2d away(moved->pose.position.x, moved->pose.position.y);
  EXPECT_GT((away - place).norm(), 0.9 * moved->scale.z);
  const Marker* again = find(markers.update(state_at(away), stamp, false, unit, names), "impulse_sizes");
  ASSERT_NE(again, nullptr);
  EXPECT_GT(Vector2d(again->pose.position.x - away.x(), again->pose.position.y - away.y()).norm(),
            ball.radius());
}

TEST(Impulses, StayForAnHourUnlessThereAreTooMany) {
  SphereMarkers markers({}, ball, {});
  markers.start_at({0, 0});
  for (int i = 0; i < 60; ++i) markers.add(impulse_at({3.0 * i, 0}), stamp);
  const MarkerArray array = markers.update(state_at({0, 9}), stamp + ros::Duration(3000), false, 10);
  EXPECT_EQ(std::count_if(array.markers.begin(), array.markers.end(),
                          [](const Marker& m) { return m.ns == "impulses" && m.action == Marker::ADD; }),
            50);
}

}  // namespace
}  // namespace hybrid_sphere::ros_interface::sphere_markers_test

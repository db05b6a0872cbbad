// Polygons of thousands of corners: each is crossed as often as its path leads, and the search asks whether
// to go on.

#include <gtest/gtest.h>

#include <cmath>

#include "support/interrupted.hpp"
#include "support/recorded.hpp"

namespace hybrid_sphere::testing::many_corners_test {
namespace {

using scene::Law;

/// Teeth along the x axis from 0 on, which the axis cuts once up and once down each.
scene::Polygon comb(int teeth, double width) {
  scene::Polygon polygon{{{0, -1}, {teeth * width, -1}}};
  for (int i = teeth; i-- > 0;) {
    polygon.vertices.emplace_back((i + 0.5) * width, 1);
    polygon.vertices.emplace_back(i * width, -0.5);
  }
  return polygon;
}

/// @param teeth  over 10 m
scene::Scene over_a_comb(int teeth, Law law) {
  scene::Scene scene{};
  scene.sphere = {1, 0.1, 0.1 * std::sqrt(0.4)};
  scene.initial_state.position = {-1, 0.01};
  scene.initial_state.velocity = {1, 0};
  scene.surface.regions = {{"comb", comb(teeth, 10.0 / teeth), law}};
  return scene;
}

std::size_t switches_until(const scene::Scene& scene, double time) {
  Simulation simulation(scene);
  std::size_t switches = 0;
  EXPECT_NO_THROW(simulation.advance_to(time, [&](const Switch&) { ++switches; }));
  EXPECT_EQ(simulation.time(), time);
  return switches;
}

// More than the crossings of one edge that make a chatter, 4096.
TEST(ManyCorners, ACombIsCrossedToItsEnd) {
  constexpr int teeth = 2500;
  EXPECT_EQ(switches_until(over_a_comb(teeth, Law::smooth), 12), 0U);
  EXPECT_EQ(switches_until(over_a_comb(teeth, Law::rough), 15.4), 2U * teeth);
}

// Each switch makes void what has been found of the circle ahead: little of it is looked at. The search asks
// whether to go on at every 256 corners that it looks at.
TEST(ManyCorners, ACombIsCrossedOnAnArcAtTheCostOfAFewOfItsTeethASwitch) {
  constexpr int teeth = 512;
  scene::Scene scene = over_a_comb(teeth, Law::rubber);
  scene.surface.base.law = Law::rubber;
  scene.surface.base.turntable_rate = -0.2;
  scene.surface.base.turntable_center = {5, -30};
  Simulation simulation(scene);
  Switches switches;
  const std::uint64_t turns = count_turns(simulation, 8, recorder(switches));
  EXPECT_GT(switches.size(), 200U);
  EXPECT_LT(turns, 12 * 2 * teeth * switches.size());
}

TEST(ManyCorners, ACombIsCrossedToItsEndUnderAForceThatHardlyBendsThePath) {
  constexpr int teeth = 3000;  // 3.3 mm: rounding tells no excursion across one side from so short a time
  for (const double pull : {1e-4, 1e-2}) {
    scene::Scene scene = over_a_comb(teeth, Law::smooth);
    scene.initial_state.position.y() = 0.6;
    scene.initial_state.velocity.x() = 3;
    scene.forces.gravity = {0, -pull, -9.81};
    EXPECT_EQ(switches_until(scene, 4), 0U) << pull;
  }
}

std::uint64_t turns_until(const scene::Scene& scene, double time) {
  Simulation simulation(scene);
  return count_turns(simulation, time);
}

// A piece of the path ends after at most 128 crossings, and each piece asks at every corner.
TEST(ManyCorners, APolygonOfManyCornersIsAskedAboutWhileACurvedPathCrossesThem) {
  constexpr std::uint64_t teeth = 4000;
  scene::Scene scene = over_a_comb(teeth, Law::smooth);
  scene.initial_state.velocity = {1, 1e-3};
  scene.forces.gravity = {0, -1e-4, -9.81};
  constexpr std::uint64_t crossings = 2 * teeth, corners = 2 * teeth;
  EXPECT_GT(turns_until(scene, 12), crossings / 128 * corners);
}

// The crossings of the polygon are sorted, then those of all regions; each comparison asks, and n crossings
// take at least log2(n!) comparisons, 10 n of 3000.
TEST(ManyCorners, APolygonOfManyCornersIsAskedAboutWhileAStraightPathMeetsThemInOnePlace) {
  scene::Scene scene = over_a_comb(100, Law::smooth);
  constexpr int teeth = 1500;
  scene.surface.regions = {{"comb", comb(teeth, 0x1p-51), Law::smooth}};
  constexpr std::uint64_t crossings = 2 * teeth;
  EXPECT_GT(turns_until(scene, 2), 2 * 10 * crossings);
}

// Two crossings of each region are sorted: log2(n!) is 12 n for n = 20000.
TEST(EdgesOnOneLine, AreAskedAboutWhileAPathDownASlopeCrossesThem) {
  scene::Scene scene = over_a_comb(100, Law::smooth);
  scene.surface.regions.clear();
  constexpr int regions = 10000;
  for (int i = 0; i < regions; ++i) {
    const double high = 1 + std::ldexp(i, -20);
    const scene::Polygon square{{{1, -high}, {2 + high, -high}, {2 + high, high}, {1, high}}};
    scene.surface.regions.push_back({"square " + std::to_string(i), square, Law::smooth});
  }
  scene.forces.gravity = {0.1, 0, -9.81};
  constexpr std::uint64_t crossings = 2 * regions;
  EXPECT_GT(turns_until(scene, 3), 12 * crossings);
}

// What is met by more edges than are traced at once is left to the next piece, which begins within rounding
// of them.
TEST(EdgesOnOneLine, AreMetByAnIntegratedPathAtTheBeginningOfAPiece) {
  scene::Scene scene{};
  scene.sphere = {2, 0.75, 0.375};
  scene.initial_state.position = {-2, -6};
  scene.initial_state.velocity = {0, 10};
  scene.initial_state.angular_velocity = {1.125, 0.25, 0};
  scene.surface.base.law = Law::coulomb;
  scene.surface.base.friction = 0.28125;
  scene.surface.base.rolling_resistance = 0.087890625;
  scene.solver.accuracy = 1e-4;
  for (int i = 0; i < 129; ++i) {
    const double width = 4 + i / 32.0;
    const scene::Polygon triangle{{{-2 - width, -2}, {-2 + width, -2}, {-2, 6}}};
    scene.surface.regions.push_back({"triangle " + std::to_string(i), triangle, Law::rough});
  }
  const Record record = testing::record(scene, 1, 1);
  ASSERT_EQ(record.switches.size(), 1U);
  EXPECT_EQ(record.switches[0].position.y(), -2);
  EXPECT_EQ(record.switches[0].to, "triangle 128");
}

}  // namespace
}  // namespace hybrid_sphere::testing::many_corners_test

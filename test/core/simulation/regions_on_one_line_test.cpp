// Edges that share a line or a corner. Regions whose edges lie on one line are met as one of them is, however
// many there are: a path that may meet very many edges is searched a piece at a time, and a piece may end
// right before an instant.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "support/recorded.hpp"
#include "support/transformed.hpp"

namespace hybrid_sphere::testing::regions_on_one_line_test {
namespace {

using scene::Law;

/// Triangles under one line through the origin, each over a longer part of it than the one before.
std::vector<scene::Region> triangles(int count, const Vector2d& along, const scene::Material& material) {
  const Vector2d inwards(along.y(), -along.x());
  std::vector<scene::Region> regions;
  for (int i = 0; i < count; ++i) {
    const double reach = 40 + i / 16.0;
    regions.push_back({"region_" + std::to_string(i),
                       scene::Polygon{{-reach * along, (40 + i / 8.0) * inwards + along, reach * along}},
                       material});
  }
  return regions;
}

/// Rolls out of the top region over its long side, and is driven back.
/// @param drive  of what drives it back: a slope or, on a turntable, what bends the path
scene::Scene out_and_back(int count, std::minstd_rand& random, bool turns) {
  const auto eighths = [&](int from, int to) {
    return std::uniform_int_distribution<int>(8 * from, 8 * to)(random) / 8.0;
  };
  scene::Scene scene{};
  scene.sphere = {1.25, 0.5, 0.5 * std::sqrt(0.4)};
  const Vector2d along(eighths(1, 3), eighths(1, 3));
  const Vector2d inwards(along.y(), -along.x());
  const Vector2d n = inwards.normalized();
  // So slowly that the rounding of the place from which it leaves is many roundings of the time.
  const Vector2d slope = eighths(1, 3) / 16 * n + eighths(-1, 1) / 4 * along;
  scene.forces.gravity = {slope.x(), slope.y(), -9.81};
  scene.initial_state.position = n / 64 + eighths(-1, 1) * along / 2;
  scene.initial_state.velocity = -eighths(2, 4) / 16 * n + eighths(-4, 4) * along / 2;
  scene::Material material(Law::rough);
  if (turns) material.turntable_rate = 0.25;
  scene.surface.regions = triangles(count, along, material);
  return scene;
}

void expect_the_same(bool turns) {
  int returns = 0;
  for (unsigned seed = 1; seed <= 100; ++seed) {
    std::minstd_rand random(seed);
    std::minstd_rand again(seed);
    const Record one = record(out_and_back(1, random, turns), 2, 1);
    const Record many = record(out_and_back(140, again, turns), 2, 1);
    returns += one.switches.size() > 2 ? 1 : 0;
    // Throws become shorter and shorter; how many there are is a matter of rounding.
    const std::size_t first = std::min<std::size_t>(one.switches.size(), 4);
    ASSERT_GE(many.switches.size(), first) << "seed " << seed;
    for (std::size_t i = 0; i < first; ++i) {
      EXPECT_NEAR(many.switches[i].time, one.switches[i].time, 1e-12) << "seed " << seed << ", switch " << i;
    }
  }
  EXPECT_GT(returns, 25) << "many come back";
}

TEST(RegionsOnOneLine, AreMetAsOneIsOnAParabola) { expect_the_same(false); }

TEST(RegionsOnOneLine, AreMetAsOneIsByAPathThatATurntableHasBent) { expect_the_same(true); }

// At a corner of two sides a slow path under a force follows that along which the force pulls, whichever
// comes first in the polygon.
TEST(PathsAlongEdges, ACurvedPathFromACornerFollowsTheSideItLiesOn) {
  const std::vector<Vector2d> corners = {{0, -1}, {-1, 0}, {-3, -4}};
  for (std::size_t first = 0; first < 3; ++first) {
    scene::Scene scene{};
    scene.sphere = {1, 0.875, 0.25};
    scene.surface.base = Law::rough;
    scene::Polygon polygon{corners, true};
    std::rotate(polygon.vertices.begin(), polygon.vertices.begin() + static_cast<std::ptrdiff_t>(first),
                polygon.vertices.end());
    scene.surface.regions = {{"around", polygon, Law::smooth}};
    scene.forces.wrench.force = {-0.125, -0.25};
    scene.initial_state.position = {-1, 0};
    scene.initial_state.velocity = {0, -5e-29};
    for (const bool is_mirrored : {false, true}) {
      Simulation simulation(is_mirrored ? mirror().of(scene) : scene);
      simulation.advance_to(5, {});
      EXPECT_EQ(simulation.switches(), 0U) << first << (is_mirrored ? ", mirrored" : "");
    }
  }
}

// The velocity leads out of the wedge, into which the slope would pull: the ground outside acts at once,
// however far away the other corners are.
TEST(PathsAlongEdges, ATinyVelocityInACornerDecidesWhicheverWayTheMapIsTurned) {
  scene::Scene scene{};
  scene.sphere = {2, 0.75, 0.328125};
  scene.forces.gravity = {0.375, 0.25, -8};
  scene.initial_state.velocity = {0, -1e-40};
  scene.surface.base = Law::rough;
  scene::Material belt(Law::coulomb);
  belt.friction = 0.375;
  belt.belt = {2, -0.5};
  scene.surface.regions = {{"outside", scene::Polygon{{{4, 4}, {4, 6}, {2, 6}}, true}, belt},
                           {"wedge", scene::Polygon{{{4, 4}, {0, 0}, {4, 2}}, false}, Law::rough}};
  for (int turn = 0; turn < 4; ++turn, scene = quarter_turn().of(scene)) {
    Simulation simulation(scene);
    simulation.advance_to(0.1, {});
    EXPECT_EQ(simulation.state().region, "outside") << turn;
  }
}

// Within 1e-17 m of its corner a belt carries the sphere across a wedge whose other corners are 8 m away. The
// 2e-9 s there, and the velocity of 4e-9 m/s, are all by which the end differs from that of a fall from rest.
TEST(PathsAlongEdges, ATinyWayFromACornerIsMeasuredFromTheCorner) {
  scene::Scene scene{};
  scene.sphere = {1, 0.25, 0.15625};
  scene.forces.gravity = {-0.25, 0.25, -9.81};
  scene.initial_state.velocity = {-4e-9, -1e-9};
  scene::Material belt(Law::coulomb);
  belt.friction = 1;
  belt.belt = {-1, 0.5};
  scene.surface.regions = {{"wedge", scene::Polygon{{{0, 0}, {-8, 1}, {-8, -0.5}}, false}, belt}};
  for (int turn = 0; turn < 4; ++turn, scene = quarter_turn().of(scene)) {
    Simulation simulation(scene);
    simulation.advance_to(1, {});
    EXPECT_EQ(simulation.state().region, "base") << turn;
    EXPECT_NEAR(simulation.state().position.norm(), 0.125 * std::sqrt(2), 2e-8) << turn;
  }
}

// A spring pulls the sphere back along the side of a belt, or 1e-17 m beside it, where the ground holds it:
// the place of rest is rounded to either side.
TEST(PathsAlongEdges, ComingToRestWithinRoundingOfASideIsNoSwitch) {
  scene::Scene scene{};
  scene.sphere = {1.5, 1, 0.25};
  scene.initial_state.velocity = {0.6, -0.8};
  scene.initial_state.angular_velocity = {0.4, 0.3, 0};
  scene.forces.gravity = {-0.45, 0.6, -8};
  scene.forces.drag.rotational = 0.03515625;
  scene.forces.spring.stiffness = 0.75;
  scene::Material felt(Law::coulomb);
  felt.friction = 0.09375;
  felt.rolling_resistance = 0.087890625;
  scene::Material belt(Law::coulomb);
  belt.friction = 0.40625;
  belt.belt = {-1.5, 2};
  scene.surface.base = felt;
  scene.surface.regions = {{"belt", scene::Polygon{{{0, 0}, {-3, 4}, {-4, -3}}, false}, belt}};
  using Method = scene::Solver::Method;
  double distance = 0;
  for (const Method method : {Method::automatic, Method::dopri87, Method::cvode_bdf}) {
    scene.solver.method = method;
    for (int turn = 0; turn < 8; ++turn) {
      scene = turn == 4 ? mirror().of(scene) : quarter_turn().of(scene);
      Simulation simulation(scene);
      simulation.advance_to(6, {});
      simulation.set_command({{0, 1e-12}, {0, 0, 0}});  // which the ground holds, too
      simulation.advance_to(8, {});
      const State& state = simulation.state();
      EXPECT_EQ(state.region, "base") << turn;
      EXPECT_EQ(simulation.switches(), 1U) << "the slip has ended once";
      EXPECT_TRUE(state.twist.velocity.isZero(0));
      if (distance == 0) distance = state.position.norm();
      EXPECT_NEAR(state.position.norm(), distance, 1e-9) << "the accuracy asked for";
    }
  }
}

// The same on the orbits of a turntable, 1e-18 m from the corner.
TEST(PathsAlongEdges, ATinyOrbitBesideACornerIsMeasuredFromTheCorner) {
  scene::Scene scene{};
  scene.sphere = {1, 0.25, 0.15625};
  scene.initial_state.position = {0x1.8p-62, 0x1p-61};
  scene.initial_state.velocity = {0x1p-50, 0x1.4p-49};
  scene.initial_state.angular_velocity = {-0x1p-51, -0x1p-50, 0};
  scene::Material table(Law::rough);
  table.turntable_rate = -1.25;
  table.turntable_center = {0, 0x1p-23};
  scene::Material wedge(Law::coulomb);
  wedge.friction = 0.625;
  wedge.belt = {-0.25, -0.25};
  scene::Material other(Law::rough);
  other.belt = {-0.25, -0.25};
  scene.surface.base = table;
  scene.surface.regions = {{"wedge", scene::Polygon{{{0, 0}, {-3, 3}, {-2, -2}}, false}, wedge},
                           {"other", scene::Polygon{{{0, 0}, {-2, -2}, {8, -2}}, false}, other}};
  double distance = 0;
  for (int turn = 0; turn < 4; ++turn, scene = quarter_turn().of(scene)) {
    Simulation simulation(scene);
    simulation.advance_to(1, {});
    EXPECT_EQ(simulation.state().region, "wedge") << turn;
    if (turn == 0) distance = simulation.state().position.norm();
    EXPECT_NEAR(simulation.state().position.norm(), distance, 1e-14) << turn;
  }
}

// An integrated path meets all of them at one instant, which no piece may end within rounding of.
TEST(PathsAlongEdges, ACurvedPathMeetsManyRegionsOnOneLineByEveryMethod) {
  using Method = scene::Solver::Method;
  scene::Scene scene{};
  scene.sphere = {0.75, 0.5, 0.34375};
  scene.initial_state.position = {4, -6};
  scene.initial_state.velocity = {-3.03125, 9.03125};
  scene.initial_state.angular_velocity = {1.75, -0.75, 6.5};
  scene.forces.gravity.z() = -8;
  scene.forces.drag.rotational = 0.033233642578125;
  scene.forces.drag.quadratic = 0.09375;
  scene.forces.spring.center = {1, 3.5};
  scene.forces.spring.stiffness = 0.375;
  scene.surface.base = Law::coulomb;
  scene.surface.base.friction = 0.4375;
  scene.surface.base.rolling_resistance = 0.13671875;
  scene.surface.base.belt = {1.75, 0.25};
  for (int i = 0; i < 129; ++i) {
    const Vector2d reach = (1 + i / 128.0) * Vector2d(3, 1);
    scene.surface.regions.push_back(
        {"region_" + std::to_string(i),
         scene::Polygon{{Vector2d(2, 0) + reach, {0.5, 4.5}, Vector2d(2, 0) - reach}, false}, Law::rough});
  }
  for (const Method method : {Method::automatic, Method::arkode_erk, Method::arkode_erk5, Method::cvode_adams,
                              Method::cvode_bdf, Method::dopri5}) {
    scene.solver.method = method;
    const Record run = record(scene, 1.03, 1);
    ASSERT_FALSE(run.switches.empty()) << to_string(method);
    EXPECT_NEAR(run.switches[0].time, 1.00448941357, 1e-9) << to_string(method);
    EXPECT_EQ(run.switches[0].to, "region_128");
  }
}

// Two triangles with a side in common throw the sphere at each other in the corner where it begins. By
// decimals, in every order of the corners: the slide keeps to both sides.
TEST(PathsAlongEdges, ASlideFromACornerKeepsToTheSidesOfBothGrounds) {
  scene::Scene scene{};
  scene.sphere = {0.75, 0.25, 0.0625};
  scene.initial_state.position = {1.5, -0.7};
  scene.initial_state.velocity = {0.1, 0.1};
  scene.initial_state.angular_velocity = {1.4, -2.8, 0};
  const std::vector<Vector2d> left = {{1.8, -0.7 + 0.3}, {1.8 + 1, -0.4 + 1}, {1.8 - 1, -0.4 + 1}};
  const std::vector<Vector2d> right = {left[0], {left[1].x(), -1.4}, left[1]};
  scene::Material belt(Law::rough);
  belt.belt = {-0.8, -1.2};
  const Vector2d end =
      Vector2d(1.8, -0.4) + 5 * (0.2 / 17) * Vector2d(1, 1);  // p_c + kappa sigma along the side
  for (std::size_t turn = 0; turn < 3; ++turn) {
    std::vector<Vector2d> corners = right;
    std::rotate(corners.begin(), corners.begin() + static_cast<std::ptrdiff_t>(turn), corners.end());
    scene.surface.regions = {{"left", scene::Polygon{left, false}, belt},
                             {"right", scene::Polygon{corners, false}, Law::rough}};
    for (const scene::Scene& one : {scene, mirror().of(scene), quarter_turn().of(scene)}) {
      Simulation simulation(one);
      simulation.advance_to(8, {});
      EXPECT_EQ(simulation.state().mode, Mode::edge_sliding);
      EXPECT_NEAR(simulation.state().position.norm(), end.norm(), 1e-9) << turn;
    }
  }
}

}  // namespace
}  // namespace hybrid_sphere::testing::regions_on_one_line_test

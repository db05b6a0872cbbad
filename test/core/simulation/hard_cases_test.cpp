// What has no end or no answer, or only looks as if it had none.

#include <gtest/gtest.h>

#include <cmath>

#include "hybrid_sphere/simulation/simulation.hpp"
#include "support/recorded.hpp"

namespace hybrid_sphere::testing::hard_cases_test {
namespace {

using scene::Law;

scene::Scene base_scene() {
  scene::Scene scene{};
  scene.sphere = {2, 0.5, 0.25};  // kappa = 1/5
  scene.forces.gravity = {0, 0, -8};
  return scene;
}

// The sphere begins with no spin but that of rounding: a step of a fraction of a turn would be longer than
// any time, and the motion, which is integrated, would be asked for all of it.
TEST(HardCases, ASphereWithoutASpinIsFollowedWithoutALookFarAhead) {
  scene::Scene scene = base_scene();
  scene.sphere = {2, 1, std::sqrt(0.4)};
  scene.forces.gravity.z() = -9.81;
  scene::Material material(Law::coulomb);
  material.friction = 0.01;
  material.turntable_rate = 1.5;
  material.turntable_center = {-3, -2};
  scene.surface.base = material;
  scene.initial_state.position = {1.5, -1.5};
  scene.initial_state.velocity = {-3, 0};
  Simulation simulation(scene);
  for (int i = 0; i <= 100; ++i) {
    simulation.advance_to(0.01 * i, {});
    ASSERT_NEAR(simulation.state().orientation.norm(), 1, 1e-12);
  }
  EXPECT_LT(simulation.evaluations(), 1000000U);
}

// On the slope (3, 0, -8) rolling takes |lambda| = kappa 3 m = 0.6 m; the couple of 0.05 R N adds
// 0.05 (1 - kappa) 8 m = 0.32 m. Friction gives mu 8 m.
scene::Scene resisted_slope(double friction) {
  scene::Scene scene = base_scene();
  scene.forces.gravity = {3, 0, -8};
  scene::Material material(Law::coulomb);
  material.friction = friction;
  material.rolling_resistance = 0.05;
  scene.surface.base = material;
  scene.initial_state.velocity = {1, 0};
  scene.initial_state.angular_velocity = {0, 2, 0};
  return scene;
}

TEST(RollingResistance, WithinTheGripLetsTheSphereRoll) {
  Simulation simulation(resisted_slope(0.12));
  simulation.advance_to(0.5, {});
  EXPECT_EQ(simulation.state().mode, Mode::rolling);
  // v' = (1 - kappa) 3 - 0.05 (1 - kappa) 8
  EXPECT_NEAR(simulation.state().twist.velocity.x(), 1 + 0.5 * (2.4 - 0.32), 1e-12);
}

// Friction of 0.64 m is less than the 0.92 m that rolling against the couple takes: the sphere slips
// backwards, and what slides feels the couple too. v' = 3 - 0.64, nu' = 4 (0.64 - 0.4), s' = 1.4.
TEST(RollingResistance, BeyondTheGripLetsTheSphereSlide) {
  Simulation simulation(resisted_slope(0.08));  // enough without the couple
  simulation.advance_to(0.5, {});
  EXPECT_EQ(simulation.state().mode, Mode::sliding);
  EXPECT_NEAR(simulation.state().twist.velocity.x(), 1 + 0.5 * 2.36, 1e-12);
  EXPECT_NEAR(simulation.state().slip.x(), 0.5 * 1.4, 1e-12);
}

// Tiles of 1 m with gaps of smooth ground, so that each is a switch.
scene::Surface tiles(int columns, int rows) {
  scene::Surface surface;
  for (int i = -columns; i < columns; ++i) {
    for (int j = -rows; j < rows; ++j) {
      const double x = i;
      const double y = j;
      surface.regions.push_back(
          {"tile_" + std::to_string(i) + "_" + std::to_string(j),
           scene::Polygon{{{x, y}, {x + 0.75, y}, {x + 0.75, y + 0.75}, {x, y + 0.75}}, false},
           (i + j) % 2 == 0 ? Law::rough : Law::smooth});
    }
  }
  return surface;
}

Switches crossing_of(const scene::Surface& surface, const Vector3d& gravity) {
  scene::Scene scene = base_scene();
  scene.forces.gravity = gravity;
  scene.surface = surface;
  scene.initial_state.position = {-3.1, -1.2};
  scene.initial_state.velocity = {1, 0.3};
  scene.initial_state.angular_velocity = {0.5, 1, 2};
  Simulation simulation(scene);
  Switches switches;
  simulation.advance_to(5, recorder(switches));
  return switches;
}

class LargeMap : public ::testing::TestWithParam<double> {};

TEST_P(LargeMap, MakesTheSwitchesOfItsPartRoundThePath) {
  const Vector3d gravity(GetParam(), 0.5 * GetParam(), -8);
  const auto near = crossing_of(tiles(8, 6), gravity);
  const auto large = crossing_of(tiles(160, 156), gravity);  // 99,840 tiles
  ASSERT_GE(near.size(), 6U);
  ASSERT_EQ(large.size(), near.size());
  for (std::size_t i = 0; i < near.size(); ++i) {
    EXPECT_EQ(large[i].to, near[i].to);
    EXPECT_NEAR(large[i].time, near[i].time, 1e-14);  // a few ulp: the pieces of the path differ
    EXPECT_NEAR((large[i].position - near[i].position).norm(), 0, 4e-14);
  }
}

INSTANTIATE_TEST_SUITE_P(StraightAndCurved, LargeMap, ::testing::Values(0.0, 0.25),
                         [](const auto& info) { return info.param == 0 ? "Straight" : "Curved"; });

// A square of rough ground on smooth ground, and a force along its right side.
scene::Scene beside_a_square(const Vector2d& start, const Vector2d& velocity, double pull) {
  scene::Scene scene = base_scene();
  scene.surface.regions = {{"square", scene::Polygon{{{0, 0}, {2, 0}, {2, 2}, {0, 2}}, false}, Law::rough}};
  scene.initial_state.position = start;
  scene.initial_state.velocity = velocity;
  scene.forces.gravity = {0, pull, -8};
  return scene;
}

TEST(HardCases, ASphereThatRunsAlongASideUnderAForceLeavesTheSideAtItsEnd) {
  for (const scene::Drag& drag : {scene::Drag{0, 0, 0}, scene::Drag{0.25, 0, 0}, scene::Drag{0, 0, 0.25}}) {
    scene::Scene scene = beside_a_square({2, 1.5}, {0, 0}, 0.5);
    scene.forces.drag = drag;
    Simulation simulation(scene);
    Switches switches;
    simulation.advance_to(10, recorder(switches));
    ASSERT_EQ(switches.size(), 2U);
    EXPECT_EQ(switches[1].kind, SwitchKind::released);
    EXPECT_NEAR((switches[1].position - Vector2d(2, 2)).norm(), 0, 1e-12);
  }
}

TEST(HardCases, ASphereThatRunsAlongAnObliqueSideUnderAForceLeavesTheSideAtItsEnd) {
  scene::Scene scene = base_scene();
  scene.surface.regions = {{"triangle", scene::Polygon{{{0, 0}, {2, 2}, {-1, 3}}, false}, Law::rough}};
  scene.initial_state.position = {1, 1};
  scene.forces.gravity = {0.5, 0.5, -8};
  Simulation simulation(scene);
  Switches switches;
  simulation.advance_to(10, recorder(switches));
  ASSERT_EQ(switches.size(), 2U);
  EXPECT_NEAR((switches[1].position - Vector2d(2, 2)).norm(), 0, 1e-12);
}

TEST(HardCases, ASphereThatStartsAtACornerMeetsNothingWhereItMovesAwayInTheDirectionOfASide) {
  for (const double drag : {0.0, 0.25}) {
    for (const int sign : {1, -1}) {
      scene::Scene scene = beside_a_square({2, sign > 0 ? 2.0 : 0.0}, {0, 0.5 * sign}, 0.25 * sign);
      scene.initial_state.angular_velocity = {-4, 0, 0};
      scene.forces.drag.translational = drag;
      Simulation simulation(scene);
      simulation.advance_to(10, {});
      EXPECT_EQ(simulation.switches(), 0U);
    }
  }
}

// The belt carries the sphere away from the spring until it pulls harder than the resistance holds: then the
// acceleration begins at 0, which says nothing about how long the motion lasts.
TEST(HardCases, ASphereThatBreaksLooseIsFollowedWithoutALookFarAhead) {
  scene::Scene scene = base_scene();
  scene.sphere = {2, 0.25, 0.25 * std::sqrt(0.4)};
  scene.forces.gravity.z() = -9.81;
  scene.surface.base.law = Law::rough;
  scene.surface.base.rolling_resistance = 0.05;
  scene.surface.base.belt = {-1, 0};
  scene.forces.spring.stiffness = 0.5;
  scene.initial_state.position = {-0.805, -0.555};
  scene.initial_state.velocity = {-1, 0};
  Simulation simulation(scene);
  for (int i = 0; i <= 100; ++i) simulation.advance_to(0.1 * i, {});
  EXPECT_LT(simulation.evaluations(), 1000000U);
  EXPECT_GT((simulation.state().twist.velocity - Vector2d(-1, 0)).norm(), 0.01);
}

// What carries the sphere lets it go at rest relative to the ground, exactly: from a velocity that only
// rounding gives it, its first steps would be without end.
TEST(HardCases, ASphereThatBreaksLooseFromATurntableStartsFromRestOnIt) {
  scene::Scene scene = base_scene();
  scene.sphere = {2, 0.25, 0.158};
  scene.forces = {{0, 0, -9.81}, {}, {0, 0, 2.997}, {{-1, -0.25}, 3.996}};
  scene.surface.base.law = Law::rough;
  scene.surface.base.rolling_resistance = 0.3;
  scene.surface.base.turntable_rate = -0.9385706316900295;
  scene.surface.base.turntable_center = {0, 0.5};
  scene.initial_state.position = {-0.5, 0};
  scene.initial_state.velocity = {0, 0.3810307413074435};
  scene.initial_state.angular_velocity = {0, 0, -6};
  scene.solver.accuracy = 1e-6;
  Simulation simulation(scene);
  for (int i = 0; i <= 30; ++i) simulation.advance_to(0.1 * i, {});
  EXPECT_LT(simulation.evaluations(), 1000000U);
}

// The turntable carries the sphere to the edge, the belt throws it back; there its rolling, which is that of
// rounding, ends as soon as it begins, and the turntable carries it over the same edge again.
TEST(HardCases, ASphereThatIsCarriedOverAnEdgeAgainHasTheEdgeForItsCause) {
  scene::Scene scene = base_scene();
  scene.sphere = {2, 0.7, 0.4};
  scene::Material turntable(Law::rough), belt(Law::rough);
  turntable.turntable_rate = -0.2;
  turntable.turntable_center = {-2.8, -4.5};
  turntable.rolling_resistance = 0.0625;
  belt.belt = {-5.1, -0.1};
  scene.surface.base = turntable;
  scene.surface.regions = {{"belt", scene::HalfPlane{{0, 0}, {1, 0.5}}, belt}};
  scene.surface.livelock = scene::Livelock::stop;
  scene.initial_state.position = {-1, 0};
  scene.initial_state.velocity = {0.9, -0.36};
  Simulation simulation(scene);
  Switches switches;
  EXPECT_THROW(simulation.advance_to(6, recorder(switches)), HaltedError);
  ASSERT_GE(switches.size(), 3U);
  EXPECT_EQ(switches.front().cause, Cause::placed);
  for (std::size_t i = 1; i < switches.size(); ++i)
    EXPECT_EQ(switches[i].cause, Cause::edge) << "switch " << i;
}

TEST(HardCases, APreparedGroundNamesTheRegionThatTheSphereIsIn) {
  scene::Scene scene = base_scene();
  scene.initial_state.velocity = {1, 0};
  Simulation simulation(scene);
  simulation.advance_to(1, {});
  for (int i = 0; i < 3; ++i) {
    scene::Surface surface;
    surface.regions = {{"half_" + std::to_string(i), scene::HalfPlane{{0, 0}, {1, 0}}, Law::rough}};
    simulation.set_ground(prepare_ground(surface));
    EXPECT_EQ(simulation.state().region, i == 0 ? "base" : "half_" + std::to_string(i - 1));
    simulation.advance_to(1 + i, {});
    EXPECT_EQ(simulation.state().region, "half_" + std::to_string(i));
  }
}

// Nothing slips across the edge, so the impulse leaves it at 0 there, exactly: rounding would have the ground
// throw the sphere back without end. The slope and the resistance drive it to the edge from both sides.
TEST(HardCases, AnImpulseChangesNothingAlongAnAxisWithoutASlip) {
  scene::Scene scene = base_scene();
  scene.sphere = {1.25, 1, 0.375};
  scene.forces.gravity = {1, 0.25, -8};
  scene::Material belt(Law::rough);
  belt.rolling_resistance = 0.0625;
  belt.belt = {0, -2};
  scene.surface.regions = {{"half", scene::HalfPlane{{0, 0}, {0, 1}}, belt}};
  scene.initial_state.velocity = {-4, 0};
  scene.initial_state.angular_velocity = {-2, 8, 7.75};
  Switches switches;
  Simulation simulation(scene);
  EXPECT_THROW(simulation.advance_to(1, recorder(switches)), HaltedError);
  ASSERT_FALSE(switches.empty());
  EXPECT_EQ(switches[0].impulse.y(), 0);
  EXPECT_EQ(switches[0].after.velocity.y(), 0);
  EXPECT_EQ(switches[0].after.angular_velocity.x(), -2);
  EXPECT_LT(switches.size(), 10U);
}

// Belts of (1, -3) and (-1, 2) m/s drive a sphere along the line between them, at kappa (0, -0.5), to a
// smooth disc below the right one. What leaves the disc comes to the left belt, which throws it into the disc
// again; inside the disc no throw is left that would keep the sphere on the line.
TEST(HardCases, ASlideAlongAnEdgeEndsWhereACircleTakesTheGroundOnOneSideAway) {
  scene::Scene scene = base_scene();
  scene.surface.base = Law::rough;
  scene.surface.base.belt = {1, -3};
  scene::Material right(Law::rough);
  right.belt = {-1, 2};
  scene.surface.regions = {{"disc", scene::Circle{{-4, -4}, 5}, Law::smooth},
                           {"right", scene::HalfPlane{{0, 0}, {1, 0}}, right}};
  Simulation simulation(scene);
  simulation.advance_to(9, {});
  EXPECT_EQ(simulation.state().mode, Mode::edge_sliding);
  try {
    simulation.advance_to(20, {});
    FAIL() << "no halt";
  } catch (const HaltedError& error) {
    EXPECT_NEAR(error.time(), 10, 1e-14);
    EXPECT_NE(std::string(error.what()).find("no motion along an edge"), std::string::npos) << error.what();
  }
  EXPECT_NEAR(simulation.state().position.y(), -1, 1e-15);
}

// The disc only touches the side: a little way down there is smooth ground between the two, which the throws
// to and fro would have to cross.
TEST(HardCases, ASlideAlongAnEdgeDoesNotBeginWhereACircleTouchesTheEdge) {
  scene::Scene scene = base_scene();
  scene.sphere = {0.5, 0.625, 0.2734375};
  scene.initial_state.position = {3, 0};
  scene.initial_state.angular_velocity = {7.125, -1.625, 0};
  scene::Material belt(Law::rough);
  belt.belt = {1.5, 2};
  for (const double radius : {1e-3, 1.0, 20.0}) {
    scene.surface.regions = {{"belt", scene::Polygon{{{3, 0}, {0, -3}, {3, -1}}, false}, belt},
                             {"disc", scene::Circle{{3 + radius, 0}, radius}, Law::rough}};
    Simulation simulation(scene);
    try {
      simulation.advance_to(1, {});
      FAIL() << "no halt";
    } catch (const HaltedError& error) {
      EXPECT_LT(error.time(), 1e-15);
      EXPECT_NE(std::string(error.what()).find("no motion along an edge"), std::string::npos) << error.what();
    }
  }
}

// The straight path over the smooth ground comes by a corner of the other within rounding: by exact signs it
// cuts it by 1e-17 m. The curved path over the ground in the corner does not see that much. The side that is
// cut begins there, or ends there.
TEST(HardCases, ACornerWithinRoundingOfThePathIsNoLivelock) {
  scene::Scene scene = base_scene();
  scene.sphere = {0.175, 0.025, 0.00625};
  scene.forces.gravity.z() = -80;
  scene.initial_state.position = {0.2, 0.8};
  scene.initial_state.velocity = {4, -2};
  scene.initial_state.angular_velocity = {28.75, 0, -6.25};
  scene.forces.drag.quadratic = 0.15625;
  scene.surface.base = Law::coulomb;
  scene.surface.base.friction = 0.21875;
  const Vector2d corner(0.4, 0.1 * 7);
  const scene::Polygon begins{{{0.1 * 3, 0.4}, corner, {-0.8, 0.5}}, true};
  const scene::Polygon ends{{{0.1 * 3, 0.4}, {-0.8, 0.5}, corner}, true};
  for (const scene::Polygon& triangle : {begins, ends}) {
    scene.surface.regions = {{"smooth", triangle, Law::smooth}};
    Simulation simulation(scene);
    simulation.advance_to(0.8, {});
    EXPECT_EQ(simulation.switches(), 0U);
    EXPECT_EQ(simulation.state().region, "smooth");
  }
}

// The same where the path comes from far away, which says how exactly the place is known.
TEST(HardCases, ACornerWithinRoundingOfALongPathIsNoLivelock) {
  scene::Scene scene = base_scene();
  scene.sphere = {1.5, 0.75, 0.5625};
  scene.initial_state.position = {3, -2};
  scene.forces.drag.translational = 1;
  scene.forces.spring = {{-4, 1.5}, 0.75};
  scene::Material belt(Law::coulomb);
  belt.friction = 0.5;
  belt.belt = {1.25, 0.5};
  scene.surface.regions = {
      {"belt", scene::Polygon{{{-0.2, -0.4}, {0, -0.4}, {0, -0.2}, {-0.2, -0.2}}, false}, belt}};
  Simulation simulation(scene);
  simulation.advance_to(2, {});
  EXPECT_EQ(simulation.switches(), 0U);
  EXPECT_EQ(simulation.state().region, "base");
}

// An integrated motion goes on over an edge between two grounds of one law, long after its beginning has been
// forgotten.
TEST(HardCases, AnEdgeBetweenGroundsOfOneLawIsCrossedByAMotionThatHasForgottenItsBeginning) {
  scene::Scene scene = base_scene();
  scene.surface.base = Law::rough;
  scene.surface.base.rolling_resistance = 0.01;
  scene.surface.base.turntable_rate = 15;
  scene.surface.regions = {
      {"field", scene::Polygon{{{-1, -3}, {3, -3}, {3, 3}, {-1, 3}}, false}, scene.surface.base},
      {"ice", scene::HalfPlane{{-1, 0}, {-1, 0}}, Law::smooth}};
  scene.forces.gravity.y() = -3;
  scene.initial_state.position = {-1.5, 0.5};
  scene.initial_state.velocity = {2, 0};
  Simulation simulation(scene);
  for (int i = 1; i <= 160; ++i) simulation.advance_to(0.05 * i, {});
  EXPECT_EQ(simulation.switches(), 1U);  // from the ice
  EXPECT_EQ(simulation.state().region, "base");
}

// Nodes of the motion and of the orientation are sums of the same steps, a rounding apart: so is what may be
// forgotten before the next piece of the path.
TEST(HardCases, AMotionOfFixedStepsIsRememberedFromWhereItIsFollowed) {
  scene::Scene scene = base_scene();
  scene.sphere = {250, 50, 3.125};
  scene.forces.gravity.z() = -8e-8;
  scene.initial_state.position = {-100, -700};
  scene.initial_state.velocity = {-0.002, 0.002};
  scene.surface.base = Law::rough;
  scene.surface.base.turntable_center = {-100, 700};
  scene.surface.base.turntable_rate = -1e-5;
  scene.surface.regions = {{"disc", scene::Circle{{0, -400}, 300}, Law::rough}};
  for (const auto method : {scene::Solver::Method::rk4, scene::Solver::Method::rkmk4}) {
    for (const double step : {1562.5, 1000.0, 700.0, 3000.0}) {
      scene.solver = {method, 1e-9, step};
      Simulation simulation(scene);
      for (int i = 1; i <= 20; ++i) simulation.advance_to(2e4 * i, {});
      EXPECT_EQ(simulation.switches(), 3U);
    }
  }
}

}  // namespace
}  // namespace hybrid_sphere::testing::hard_cases_test

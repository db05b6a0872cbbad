// Accelerated paths that run along edges, over corners and back: they meet what a path on level ground meets.

#include <gtest/gtest.h>

#include <cmath>

#include "hybrid_sphere/scene/read_scene.hpp"
#include "support/interrupted.hpp"
#include "support/materials.hpp"
#include "support/recorded.hpp"

namespace hybrid_sphere::testing::paths_along_edges_test {
namespace {

using scene::Law;

scene::Scene fault(const std::string& name) {
  return scene::read_scene_file(std::string(TEST_DATA_DIR) + "/faults/" + name + ".yaml");
}

std::string told(const Switches& switches) {
  std::string text;
  for (const RecordedSwitch& event : switches) {
    text += std::string(to_string(event.kind)) + " " + event.from + " -> " + event.to + "; ";
  }
  return text;
}

Record run(const scene::Scene& scene, double until) {
  Record result = record(scene, until, 1);
  EXPECT_EQ(result.halt, "");
  return result;
}

TEST(PathsAlongEdges, AnAcceleratedPathAlongASideDoesNotMeetAPolygonThatLiesAheadBeforeItComesThere) {
  // The mat's side lies on the path: smooth ground is visible on it, and stays in force.
  EXPECT_EQ(told(run(fault("polygon_ahead_on_the_path"), 20).switches), "");
}

TEST(PathsAlongEdges, AnAcceleratedPathAlongASideDoesNotMeetAPolygonThatLiesAheadOfAnEdge) {
  const auto switches = run(fault("polygon_ahead_after_a_strip"), 20).switches;
  ASSERT_EQ(told(switches), "applied base -> strip; released strip -> base; ");
  EXPECT_EQ(switches[0].position, Vector2d(-1, 0));
  EXPECT_EQ(switches[1].position, Vector2d(0, 0));
  EXPECT_NEAR(switches[0].time, std::sqrt(6) - 1, 1e-15);  // 2.5 = t + t^2/2
}

TEST(PathsAlongEdges, AnAcceleratedPathAlongASideLeavesItAtItsEnd) {
  const auto switches = run(fault("down_a_side"), 20).switches;
  ASSERT_EQ(told(switches), "applied p -> base; ");
  EXPECT_EQ(switches[0].position, Vector2d(3, -10));
  EXPECT_NEAR(switches[0].time, 4, 4e-15);  // 10 = t/2 + t^2/2
}

TEST(PathsAlongEdges, AnAcceleratedPathAlongASideFollowsThatOfAPolygonOnTop) {
  const auto switches = run(fault("side_of_a_polygon_on_top"), 20).switches;
  ASSERT_EQ(told(switches), "applied p -> h; ");
  EXPECT_EQ(switches[0].position, Vector2d(2, 3));
}

// A path that begins on the line of a side, but far from the side, with hardly any velocity.
TEST(PathsAlongEdges, AnAcceleratedPathFromTheLineOfASideMeetsTheOtherSides) {
  scene::Scene scene = fault("start_on_the_line_of_a_far_side");
  const Record hardly_moves = run(scene, 8);
  scene.initial_state.angular_velocity.setZero();
  const Record at_rest = run(scene, 8);
  EXPECT_EQ(told(hardly_moves.switches), told(at_rest.switches));
  ASSERT_EQ(hardly_moves.switches.size(), 2U);
  EXPECT_NEAR(hardly_moves.switches[1].position.x(), -0.6, 1e-14);
}

// At rest on an edge, on a belt of 1 m/s: the velocity is the sum of that and of the slip, and its rounding
// does not tell that the path begins on one side.
TEST(PathsAlongEdges, AnAcceleratedPathFromRestOnAnEdgeBeginsOnTheSideToWhichTheForcesLead) {
  const scene::Scene scene = fault("off_the_edge_from_rest_on_a_belt");
  const Record result = record(scene, 1, 100);
  EXPECT_EQ(result.halt.find("livelock at t = 0.75 s"), 0U) << result.halt;
  for (const RecordedState& state : result.states) EXPECT_GE(state.position.x(), 0) << state.time;
}

/// A path on a line between cells, and one that is less than the tolerance beside it.
void expect_the_same(const Record& on_line, const Record& beside) {
  ASSERT_EQ(told(on_line.switches), told(beside.switches));
  for (std::size_t i = 0; i < on_line.switches.size(); ++i) {
    EXPECT_NEAR(on_line.switches[i].time, beside.switches[i].time, 1e-12) << i;
    EXPECT_NEAR(on_line.switches[i].position.x(), beside.switches[i].position.x(), 1e-12) << i;
  }
}

TEST(PathsAlongEdges, APathBetweenTwoCellsOfAMapRunsInTheUpperOne) {
  scene::Scene scene = fault("ice_patches_on_a_grid_line");
  for (const double slope : {0.1, 0.0}) {
    scene.forces.gravity.x() = slope;
    scene.initial_state.position.y() = -0.5;
    const Record on_line = run(scene, 20);
    EXPECT_GE(on_line.switches.size(), 7U) << told(on_line.switches);
    scene.initial_state.position.y() = -0.4999999;
    expect_the_same(on_line, run(scene, 20));
  }
}

/// Without some of its regions.
scene::Scene without(scene::Scene scene, std::size_t begin, std::size_t end) {
  auto& regions = scene.surface.regions;
  regions.erase(regions.begin() + static_cast<std::ptrdiff_t>(begin),
                regions.begin() + static_cast<std::ptrdiff_t>(end));
  return scene;
}

TEST(PathsAlongEdges, ASlideAlongAnEdgeIsNotBrokenByAnEdgeThatIsHiddenUnderBothGrounds) {
  const scene::Scene over = fault("slide_over_a_hidden_circle");
  const auto switches = run(over, 20).switches;
  EXPECT_EQ(switches.back().cause, Cause::livelock);
  EXPECT_EQ(told(switches), told(run(without(over, 0, 1), 20).switches));
  const scene::Scene under = fault("slide_under_hidden_circles");
  EXPECT_EQ(told(run(under, 20).switches), told(run(without(under, 0, 2), 20).switches));
}

// The polygon's ground is that of the base: beyond the corner the edge between the two grounds is the
// half-plane's.
TEST(PathsAlongEdges, AThrowAtACornerLeadsBackIntoTheGroundBeforeIt) {
  const Record thrown = run(fault("thrown_back_at_a_corner"), 0.03);
  EXPECT_EQ(told(thrown.switches), "applied region_3 -> region_4; released region_4 -> region_3; ");
  EXPECT_EQ(thrown.switches[0].time, thrown.switches[1].time);
}

TEST(PathsAlongEdges, ASlideAlongAnEdgeTurnsWhereTheEdgeBetweenItsGroundsDoes) {
  const Record slide = run(fault("slide_past_a_corner"), 6);
  const RecordedSwitch& last = slide.switches.back();
  EXPECT_EQ(last.cause, Cause::livelock);
  EXPECT_EQ(last.position, Vector2d(-7.5, 5));
  EXPECT_NEAR(last.after.velocity.x() + last.after.velocity.y(), 0, 1e-15);
  const Vector2d end = slide.states.back().position;
  EXPECT_LT(end.x(), -7.5);
  EXPECT_NEAR(end.x() + end.y(), -2.5, 1e-14);
}

// The sphere begins on the edge, outside of a circle above both grounds by 4e-16 m, and slides into it.
TEST(PathsAlongEdges, ASlideAlongAnEdgeEndsWhereItBeginsUnderAnotherGround) {
  scene::Scene scene{};
  scene.sphere = {0.5, 0.125, 0.046875};
  scene.initial_state.position = {-0.78885438199983182, -0.89442719099991597};
  scene::Material belts[] = {Law::rough, Law::rough};
  belts[0].belt = {-1, 2};
  belts[1].belt = {3, -1};
  scene::Material dry(Law::coulomb);
  dry.friction = 0.4375;
  scene.surface = {
      belts[0],
      {{"above", scene::HalfPlane{{-1, -1}, {-1, 2}}, belts[1]}, {"circle", scene::Circle{{1, 0}, 2}, dry}}};
  const Record slide = run(scene, 1);
  EXPECT_EQ(slide.switches[0].time, 0);
  const RecordedState& last = slide.states.back();
  EXPECT_EQ(last.name, "circle");
  EXPECT_EQ(last.mode, Mode::resting);
}

// The path stays within 2 m of the spring's centre, 1e7 m from the polygon's end: each period is looked at,
// but no more than that. A search over the time to that end takes 8000 turns and more.
TEST(PathsAlongEdges, ASpringIsSearchedForEdgesNoFartherAheadThanItsMotionTells) {
  scene::Scene scene = fault("spring_in_a_long_polygon");
  for (const double off : {0.0, 1.0}) {  // along a line, and along an ellipse
    scene.forces.spring.center.y() = off;
    Simulation simulation(scene);
    Switches switches;
    EXPECT_LT(count_turns(simulation, 1e-3, recorder(switches)), 100U);
    EXPECT_EQ(told(switches), "applied  -> p; ");
  }
}

scene::Scene smooth_slope(const Vector2d& slope) {
  scene::Scene scene{};
  scene.sphere = {2, 0.25, 0.125};
  scene.forces.gravity = {slope.x(), slope.y(), -8};
  return scene;
}

scene::Region box(const std::string& name, const Vector2d& low, const Vector2d& high, Law law) {
  scene::Polygon polygon;
  polygon.vertices = {low, {high.x(), low.y()}, high, {low.x(), high.y()}};
  return {name, polygon, law};
}

TEST(PathsAlongEdges, AStraightPathThatTurnsRoundDoesNotEnterTheRegionAtWhichItTurns) {
  scene::Scene scene = smooth_slope({-1, 0});
  scene.initial_state.velocity = {2, 0};  // to x = 2 and back
  scene.surface.regions.push_back(box("touched", {2, -1}, {3, 1}, Law::rough));
  EXPECT_EQ(told(run(scene, 10).switches), "");
  // 2^-29 m farther, which is more than rounding, it is entered.
  scene.initial_state.velocity = {2 + 0x1p-30, 0};
  EXPECT_EQ(told(run(scene, 2.001).switches).substr(0, 24), "applied base -> touched;");
}

TEST(PathsAlongEdges, AStraightPathThatTurnsRoundPassesTheSameEdgesBackwards) {
  scene::Scene scene = smooth_slope({0, 0});
  scene.initial_state.position = {1, 0};
  scene.forces.spring = {{0, 0}, 2};  // x = cos t
  // Along the sides of three boxes, and through one.
  scene.surface.regions.push_back(box("left", {-3, 0}, {-0.5, 1}, Law::smooth));
  scene.surface.regions.push_back(box("middle", {-0.5, -1}, {0.25, 0}, Law::smooth));
  scene.surface.regions.push_back(box("through", {0.25, -1}, {0.75, 1}, Law::smooth));
  Simulation simulation(scene);
  for (int i = 1; i < 400; ++i) {
    const double time = 0.0625 * i;
    simulation.advance_to(time, {});
    // "through" is left into the box beside the path, and that into the next one.
    const double x = std::cos(time);
    const char* expected = x > 0.75 ? "base" : x > 0.25 ? "through" : x > -0.5 ? "middle" : "left";
    EXPECT_EQ(simulation.state().region, expected) << time;
  }
}

TEST(PathsAlongEdges, AStraightPathMeetsAnEdgeWhereItsForcesCancelUpToRounding) {
  const auto switches = run(fault("forces_that_cancel"), 4).switches;
  ASSERT_EQ(told(switches), "applied  -> half; exchanged half -> base; ");
  const Vector2d place = switches[1].position;
  EXPECT_NEAR(3 * place.x() - 2 * (place.y() - 0.5), 0, 1e-13);
}

// A slip is used up on the line of a side. The place there is rounded, and with it the force of the spring,
// whose centre was the start.
TEST(PathsAlongEdges, AStraightPathGoesOnAlongItsSideWhereItsMotionEnds) {
  scene::Scene scene{};
  scene.sphere = {1, 1, 0.5};
  scene.initial_state.position = {8, -6};
  scene.initial_state.angular_velocity = {0.3, 0.4, 0};
  scene.forces.spring = {{8, -6}, 0.5};
  scene.surface.base.law = Law::coulomb;
  scene.surface.base.friction = 0.03125;
  scene::Material rough(Law::coulomb);
  rough.friction = 0.25;
  rough.rolling_resistance = 0.21875;
  scene.surface.regions = {{"rough", scene::Polygon{{{12, -9}, {5, -10}, {8, -6}}, false}, rough}};
  scene.solver.method = scene::Solver::Method::cvode_bdf;
  EXPECT_EQ(told(run(scene, 0.5).switches), "applied rough -> rough; ");
}

TEST(PathsAlongEdges, AStraightPathEntersARegionOfTheWidthOfRounding) {
  scene::Scene scene = smooth_slope({1, 0});
  scene.initial_state.velocity = {1, 0};
  scene.surface.regions.push_back(box("thin", {1, -1}, {std::nextafter(1.0, 2.0), 1}, Law::rough));
  const auto switches = run(scene, 10).switches;
  EXPECT_EQ(told(switches), "applied base -> thin; released thin -> base; ");
  EXPECT_EQ(switches[0].position, Vector2d(1, 0));
}

TEST(PathsAlongEdges, AStraightPathDoesNotEnterACircleThatItTouches) {
  scene::Scene scene = smooth_slope({0.3, 0});
  scene.initial_state.velocity = {1, 0};
  scene.surface.regions.push_back({"above", scene::Circle{{2, 1}, 1}, Law::rough});
  scene.surface.regions.push_back({"below", scene::Circle{{3, -0.3}, 0.3}, Law::rough});
  EXPECT_EQ(told(run(scene, 10).switches), "");
  scene.initial_state.position.y() = 0x1p-50;
  EXPECT_EQ(told(run(scene, 10).switches), "applied base -> above; released above -> base; ");
}

// A slope changes when a path comes somewhere, not what it meets. The map is large enough for an index.
TEST(PathsAlongEdges, AStraightPathMeetsTheSameCellsOfALargeMapOnASlopeAsOnLevelGround) {
  scene::Scene scene = smooth_slope({0, 0});
  for (int i = 0; i < 40; ++i) {
    for (int j = 0; j < 40; ++j) {
      if ((i * 7 + j * 3) % 5 == 0) continue;
      const Vector2d low(0.1 * i, 0.1 * j);
      scene.surface.regions.push_back(
          box(std::to_string(i) + "_" + std::to_string(j), low, {0.1 * (i + 1), 0.1 * (j + 1)}, Law::smooth));
    }
  }
  const auto regions_on_the_way = [&scene](double slope, double drag, const Vector2d& start) {
    scene::Scene run = scene;
    run.forces.gravity.x() = slope;
    run.forces.drag.translational = drag * run.sphere.mass;
    run.initial_state.position = start;
    run.initial_state.velocity = {1, 0};
    Simulation simulation(run);
    std::vector<std::string> names;
    for (int k = 1; k < 90; ++k) {
      const double x = 0.05 * k;  // between two edges, for odd k
      const double time = slope == 0 && drag == 0 ? x
                          : slope == 0            ? -std::log1p(-drag * x) / drag
                                                  : 2 * x / (1 + std::sqrt(1 + 2 * slope * x));
      if (k % 2 == 0) continue;
      simulation.advance_to(time, {});
      names.emplace_back(simulation.state().region);
    }
    return names;
  };
  for (const int row : {1, 7, 20, 33}) {
    const Vector2d start(0, 0.1 * row);
    const auto level = regions_on_the_way(0, 0, start);
    EXPECT_EQ(regions_on_the_way(0.5, 0, start), level) << row;
    EXPECT_EQ(regions_on_the_way(0, 0.125, start), level) << row;
  }
}

// Straight from (-4, -4) through the corner (5, -1), at which the path lies on two sides.
TEST(PathsAlongEdges, AnIntegratedPathThroughACornerGoesOn) {
  scene::Scene scene{};
  scene.sphere = {2, 0.5, 0.25};
  scene.forces.gravity = {0, 0, -8};
  scene.forces.drag.quadratic = 0.0625;
  scene.surface.base = coulomb(0.0625);
  const scene::Polygon polygon{{{-7, -5}, {-2, -8}, {8, -8}, {4, -4}, {5, -1}, {7, 2}, {6, 3}, {-2, 6}},
                               false};
  scene.surface.regions = {{"smooth", polygon, Law::smooth}};
  scene.initial_state.position = {-4, -4};
  scene.initial_state.velocity = {3, 1};
  Simulation simulation(scene);
  EXPECT_NO_THROW(simulation.advance_to(8, {}));
  EXPECT_GT(simulation.state().position.x(), 5);
  EXPECT_EQ(simulation.state().region, "base");
}

// Along a side, out of its corner and back over it by a spring: what rounding leaves of the way is in the
// region.
TEST(PathsAlongEdges, AnIntegratedPathBackOverTheCornerFromWhichItCameLeavesTheRegion) {
  scene::Scene scene{};
  scene.forces.gravity = {0, 0, -8};
  scene.sphere = {0.25, 0.25, 0.15625};
  scene.surface.base = coulomb(0.21875);
  scene.surface.regions = {{"triangle", scene::Polygon{{{0, 0}, {1, 3}, {3, -1}}, false}, coulomb(0.34375)}};
  scene.initial_state.angular_velocity = {2.5298221281347035, 7.5894663844041101, 1.875};
  scene.forces.spring.stiffness = 1;
  scene.solver.method = scene::Solver::Method::arkode_erk3;
  Simulation simulation(scene);
  for (const double time : {2.1, 2.5, 3.0}) {
    simulation.advance_to(time, {});
    ASSERT_LT(simulation.state().position.x(), -0.01);
    EXPECT_EQ(simulation.state().region, "base") << time;
  }
}

/// Starts at every hundredth of the way from one corner of the first polygon to another, across it both ways:
/// the sphere has to be on the ground ahead.
/// @param ahead  the region into which the velocity of the scene leads
void expect_ground_ahead(scene::Scene scene, std::size_t from, std::size_t to, double time,
                         const char* ahead) {
  const auto& corners = std::get<scene::Polygon>(scene.surface.regions.front().shape).vertices;
  const Vector2d velocity = scene.initial_state.velocity;
  for (int i = 1; i < 100; ++i) {
    for (const double sense : {1.0, -1.0}) {
      scene.initial_state.position = corners[from] + 0.01 * i * (corners[to] - corners[from]);
      scene.initial_state.velocity = sense * velocity;
      Simulation simulation(scene);
      ASSERT_NO_THROW(simulation.advance_to(time, {})) << i;
      EXPECT_EQ(simulation.state().region, sense > 0 ? ahead : "base") << i;
    }
  }
}

// What begins beside an edge by the rounding of the place begins on the ground on which it exactly is, and is
// at once on the one into which it leads.
TEST(PathsAlongEdges, AnAcceleratedPathFromBesideAnEdgeByLessThanRoundingLeadsIntoTheGroundAhead) {
  expect_ground_ahead(fault("start_beside_an_edge"), 0, 2, 0x1p-16, "turning");
}

// The normal of a side is the difference of its ends, which is rounded: on which side of it a path begins
// must not follow from that, where the exact place says another thing.
TEST(PathsAlongEdges, AParabolaFromBesideASideLeadsIntoTheGroundAhead) {
  expect_ground_ahead(fault("parabola_beside_a_side"), 1, 2, 1000, "around");
}

// Within rounding of the line of a side nothing tells when the path crosses it; when it passes the corners is
// told none the less.
TEST(PathsAlongEdges, APathWithinRoundingOfASideIsNotInItsRegionBeyondTheCorners) {
  Simulation simulation(fault("oscillation_beside_a_side"));
  for (int i = 1; i <= 800; ++i) {
    simulation.advance_to(0.01 * i, {});
    const double y = simulation.state().position.y();
    const bool is_beyond = y < -2 - 1e-9 || y > 1e-9;
    EXPECT_TRUE(!is_beyond || simulation.state().region == "base") << "t = " << 0.01 * i;
  }
}

}  // namespace
}  // namespace hybrid_sphere::testing::paths_along_edges_test

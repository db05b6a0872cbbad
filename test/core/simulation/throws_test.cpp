// Throws to and fro: those that accumulate come to an end by every method, and those that only become short
// for a while go on.

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "hybrid_sphere/simulation/simulation.hpp"
#include "support/materials.hpp"
#include "support/recorded.hpp"
#include "support/transformed.hpp"

namespace hybrid_sphere::testing::throws_test {
namespace {

using scene::Law;

struct Halted {
  std::string reason;
  std::uint64_t switches = 0;
  Vector2d place = Vector2d::Zero();
};

/// Where a run of 4 s halts; no reason if it does not.
Halted halt_of(scene::Scene scene, scene::Solver::Method method) {
  scene.solver.method = method;
  Simulation simulation(scene);
  Halted halted;
  try {
    simulation.advance_to(4, {});
  } catch (const HaltedError& error) {
    halted.reason = error.what();
  }
  halted.switches = simulation.switches();
  halted.place = simulation.state().position;
  return halted;
}

void expect_the_same_accumulation(const scene::Scene& scene, const Vector2d& corner) {
  using Method = scene::Solver::Method;
  const Halted expected = halt_of(scene, Method::automatic);
  EXPECT_EQ(expected.reason.find("switches accumulate"), 0U) << expected.reason;
  for (const Method method : {Method::dopri87, Method::arkode_erk5, Method::cvode_adams, Method::cvode_bdf}) {
    for (const bool is_turned : {false, true}) {
      SCOPED_TRACE(std::string(scene::to_string(method)) + (is_turned ? ", turned by a right angle" : ""));
      const Halted halted = halt_of(is_turned ? quarter_turn().of(scene) : scene, method);
      const Vector2d end = is_turned ? Vector2d(-corner.y(), corner.x()) : corner;
      EXPECT_EQ(halted.reason.substr(0, 20), expected.reason.substr(0, 20));
      EXPECT_EQ(halted.switches, expected.switches);
      EXPECT_LT((halted.place - end).norm(), 1e-9);
    }
  }
}

// In a wedge of 1.4 degrees the throws come to be as short as the errors of an integrated path while they are
// far from the corner.
TEST(Throws, IntoASharpCornerAccumulateByEveryMethod) {
  scene::Scene scene{};
  scene.sphere = {1.25, 1, 0.4375};
  scene.forces.gravity = {0, 0, -9.81};
  scene.initial_state.position = {-4, 0.5};
  scene.initial_state.velocity = {8.03125, 12.09375};
  scene.initial_state.angular_velocity = {0.875, -3.125, -4.125};
  scene.surface.base = coulomb(0.5);
  scene::Material turntable(Law::rough);
  turntable.turntable_center = {-8, -6};
  turntable.turntable_rate = -1.25;
  scene::Material rubber(Law::rubber);
  rubber.belt = {-1.25, 0.25};
  const auto triangle = [](const Vector2d& first, const Vector2d& last) {
    return scene::Polygon{{first, {8, 18.5}, last}, false};
  };
  scene.surface.regions = {{"below", triangle({3, -2}, {-9, 6}), turntable},
                           {"between", triangle({2.953125, -1.96875}, {-8.953125, 5.96875}), coulomb(0.25)},
                           {"above", triangle({2.671875, -1.78125}, {-8.671875, 5.78125}), rubber}};
  expect_the_same_accumulation(scene, {8, 18.5});
}

// Each cycle takes 8e-5 of the one before: the third one is lost in rounding.
TEST(Throws, ThatShrinkFastAccumulateByEveryMethod) {
  scene::Scene scene{};
  scene.sphere = {0.5, 1, 0.3125};
  scene.forces.gravity = {0, 0, -9.81};
  scene.initial_state.position = {-4, 6};
  scene.initial_state.velocity = {0, -2};
  scene.initial_state.angular_velocity = {-1.125, 1.625, 0};
  scene.surface.base = coulomb(0.375);
  scene::Material rubber(Law::rubber);
  rubber.turntable_center = {-4, -8};
  rubber.turntable_rate = 1.75;
  scene.surface.regions = {{"left", scene::Polygon{{{-4, 4}, {-4, 5}, {-6, 6}}, false}, Law::rough},
                           {"right", scene::Polygon{{{-4, 4}, {0, 0}, {-3, 5}}, false}, rubber}};
  expect_the_same_accumulation(scene, {-4, 4});
}

// The second throw takes 4e-4 of the first one, and then they grow: on that turntable the speed across the
// edge has its least value near 0.
TEST(Throws, ThatBecomeShortForOnceGoOn) {
  scene::Scene scene{};
  scene.sphere = {1, 1, std::sqrt(0.4)};
  scene.forces.gravity = {14, 1, -9.81};
  scene.initial_state.position = {0, -0.005};
  scene.initial_state.velocity = {0, 1};
  scene.initial_state.angular_velocity = {0, -21.875, 0};
  scene::Material turntable(Law::rough);
  turntable.turntable_rate = -1;
  for (const double center : {-4.25, -4.2501, -4.2505, -4.251}) {
    turntable.turntable_center = {center, 0};
    scene.surface.regions = {{"table", scene::HalfPlane{{20, 0}, {0, 1}}, turntable}};
    Simulation simulation(scene);
    EXPECT_NO_THROW(simulation.advance_to(2, {})) << center;
    EXPECT_GT(simulation.switches(), 10U);
  }
}

/// Belts throw a sphere to and fro between a floor and a ceiling that comes down to another height at x = 5.
scene::Scene corridor(const std::vector<Vector2d>& ceiling) {
  scene::Scene scene{};
  scene.sphere = {1, 1, std::sqrt(0.4)};
  scene.forces.gravity = {0, 0, -9.81};
  scene.initial_state.position = {3.750015, 0.5};
  scene.initial_state.velocity = {0.5, -1};
  scene.initial_state.angular_velocity = {-2.5, -1.25, 0};
  scene.surface.regions = {{"floor", scene::HalfPlane{{5, 0}, {0, -1}}, belt({1.75, 3.5})},
                           {"ceiling", scene::Polygon{ceiling, false}, belt({1.75, -3.5})}};
  return scene;
}

TEST(Throws, InACorridorThatNarrowsInAStepGoOn) {
  for (const double height : {6e-5, 1e-5}) {
    Simulation simulation(corridor({{-9, 1}, {5, 1}, {5, height}, {9, height}, {9, 9}, {-9, 9}}));
    EXPECT_NO_THROW(simulation.advance_to(2.6, {})) << height;
    EXPECT_GT(simulation.switches(), 1000U);
  }
}

// The lines of its floor and its ceiling meet beyond its end.
TEST(Throws, InAFunnelThatEndsBeforeItsCornerGoOn) {
  Simulation simulation(corridor({{-9, 1}, {5, 1}, {5, 6e-5}, {5.000054, 6e-6}, {5.000054, 9}, {-9, 9}}));
  EXPECT_NO_THROW(simulation.advance_to(6, {}));
  EXPECT_GT(simulation.state().position.x(), 6);
}

// On straight paths exact signs tell each throw from the next one: the sphere is on its side of the wall
// until the last of them.
TEST(Throws, AlongTheSidesOfACornerAreFollowedToItsEnd) {
  scene::Scene scene{};
  scene.sphere = {1, 1, std::sqrt(0.4)};
  scene.forces.gravity = {0, 0, -9.81};
  scene.initial_state.position = {0.5, 5e-13};
  scene.initial_state.velocity = {1, -2e-12};
  scene.initial_state.angular_velocity = {-5e-12, -2.5, 0};
  scene.surface.regions = {{"wall", scene::HalfPlane{{0, 3}, {-1, 0}}, belt({3.5, -7e-12})},
                           {"floor", scene::HalfPlane{{3, 0}, {0, -1}}, belt({-3.5, 3.5e-12})}};
  Simulation simulation(scene);
  try {
    for (int i = 1; i <= 100; ++i) {
      simulation.advance_to(0.025 * i, {});
      EXPECT_GT(simulation.state().position.x(), -1e-9) << "t = " << simulation.time();
    }
  } catch (const HaltedError&) {
  }
  EXPECT_GT(simulation.switches(), 100U);
}

// Places of a coarse integration are off the integral of its velocities: that hides no return to the edge.
TEST(Throws, ByACoarseIntegrationComeBackToTheEdge) {
  scene::Scene scene{};
  scene.sphere = {0.5, 0.375, 0.28125};
  scene.initial_state.position = {-0.3, -0.4};
  scene.forces.gravity = {0.24, 0.32, -9.81};
  scene.surface.base = Law::coulomb;
  scene.surface.base.friction = 0.36;
  scene::Material belt(Law::rough);
  belt.belt = {-1.14, -1.52};
  scene.surface.regions = {{"belt", scene::HalfPlane{{0, 0}, {1, 0}}, belt}};
  scene.solver.accuracy = 1e-3;
  using Method = scene::Solver::Method;
  for (const Method method : {Method::cvode_adams, Method::cvode_bdf, Method::arkode_erk3}) {
    scene.solver.method = method;
    const Record run = record(scene, 8, 16);
    EXPECT_GT(run.switches.size(), 50U);
    for (const RecordedSwitch& event : run.switches) {
      if (event.to != "base") continue;
      EXPECT_LE(event.position.x(), 1e-9) << to_string(method) << ", " << event.time;
    }
  }
}

}  // namespace
}  // namespace hybrid_sphere::testing::throws_test

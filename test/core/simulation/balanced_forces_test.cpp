// Forces that just balance: a slope that pulls as much as friction or a resistance holds. What they leave of
// each other is rounding, and nothing may hang on that.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "support/interrupted.hpp"
#include "support/recorded.hpp"

namespace hybrid_sphere::testing::balanced_forces_test {
namespace {

using scene::Law;

scene::Material coulomb(double friction, double resistance = 0) {
  scene::Material material(Law::coulomb);
  material.friction = friction;
  material.rolling_resistance = resistance;
  return material;
}

// q = R^2/k^2 = (16/9)^2
scene::Scene small_sphere() {
  scene::Scene scene{};
  scene.sphere = {0.25, 0.125, 0.0703125};
  return scene;
}

/// When a rolling velocity is used up by a constant deceleration and drag, nu' = -a - d nu [s].
double time_to_stop(double nu, double deceleration, double drag) {
  return std::log1p(drag * nu / deceleration) / drag;
}

// The pull of 1.75 m/s^2 is that of the friction of the ground on the left, and the slip points down the
// slope: the sphere turns in place, on a corner of both grounds at the origin of the map, until the slip is
// used up.
TEST(BalancedForces, LetTheSphereTurnInPlaceOnAnEdge) {
  scene::Scene scene = small_sphere();
  scene.surface.base = coulomb(0.5);
  scene.surface.regions = {
      {"left", scene::Polygon{{{-2, -2}, {0, -2}, {0, 0}, {-2, 0}}, false}, coulomb(0.21875)},
      {"right", scene::Polygon{{{0, -2}, {2, -2}, {2, 0}, {0, 0}}, false}, coulomb(0.03125)}};
  scene.initial_state.angular_velocity = {0, 3, 0};
  scene.forces.gravity = {-1.75, 0, -8};
  scene.forces.drag.rotational = 0x1p-11;
  const Record run = record(scene, 1, 10);
  ASSERT_EQ(run.switches.size(), 1U);
  const double drag = 0x1p-11 / (0.25 * 0.0703125 * 0.0703125);
  EXPECT_NEAR(run.switches[0].time, time_to_stop(0.375, 256. / 81 * 1.75, drag), 1e-9);
  EXPECT_LT(run.switches[0].position.norm(), 1e-16);
  EXPECT_LT(run.states.back().position.x(), -0.1);
  EXPECT_LT(run.evaluations, 100'000U);
}

// It turns on a corner of rough ground, until it rolls away from that, down the slope.
TEST(BalancedForces, LetTheSphereTurnInPlaceOnACorner) {
  scene::Scene scene{};
  scene.sphere = {1.25, 1, 0.1875};
  scene.surface.base = coulomb(0.125);
  scene.surface.regions = {{"rough", scene::Polygon{{{0, 0}, {2, -3}, {-3, -2}}, false}, Law::rough}};
  scene.initial_state.angular_velocity = {1.1094003924504583, -1.6641005886756874, 0};
  scene.forces.gravity = {0.83205029433784372, 0.55470019622522915, -8};
  const Record run = record(scene, 0.125, 8);
  ASSERT_EQ(run.switches.size(), 1U);
  EXPECT_NEAR(run.switches[0].time, 0.0703125, 1e-9);
  EXPECT_GT(run.states.back().position.x(), 1e-5);
  EXPECT_EQ(run.states.back().name, "base");
}

// A belt's friction and the slope leave the centre where it is but for the rounding of both, until the
// turning is used up and the sphere comes to rest on the ground beside, which holds it.
TEST(BalancedForces, LeaveOfFasterMotionsNoSpeedThatIsNotTold) {
  scene::Scene scene{};
  scene.sphere = {1, 0.5, 0.125};
  scene.surface.base = coulomb(0.34375, 0.34375);
  scene::Material belt = scene.surface.base;
  belt.belt = {-1, -0.5};
  scene.surface.regions = {{"belt", scene::Polygon{{{-1, 2}, {-2, -1}, {1, -2}}, false}, belt}};
  scene.initial_state.angular_velocity = {1.3416407864998738, -2.6832815729997477, 0};
  scene.forces.gravity = {2.4596747752497667, 1.2298373876248834, -8};
  scene.forces.spring.stiffness = 1.25;
  const Record run = record(scene, 1, 8);
  ASSERT_EQ(run.switches.size(), 1U);
  EXPECT_EQ(run.switches[0].to, "base");
  EXPECT_LT(run.states.back().position.norm(), 1e-15);
  EXPECT_TRUE(run.states.back().twist.velocity.isZero(0));
  EXPECT_LT(run.evaluations, 100'000U);
}

// The centre stays where it is, so that slip and rolling velocity vanish together.
TEST(BalancedForces, UseUpSlipAndTurningAtOnce) {
  scene::Scene scene = small_sphere();
  scene.surface.base = coulomb(0.5, 0.03);
  scene.initial_state.angular_velocity = {-0.3, -0.4, 2};
  scene.forces.gravity = {3.2, -2.4, -8};
  scene.forces.drag.rotational = 0.0003;
  const Record run = record(scene, 4, 10);
  ASSERT_GE(run.switches.size(), 1U);
  const double drag = 0.0003 / (0.25 * 0.0703125 * 0.0703125);
  EXPECT_NEAR(run.switches[0].time, time_to_stop(0.0625, 256. / 81 * (4 + 0.24), drag), 1e-9);
  EXPECT_EQ(run.states.back().mode, Mode::rolling);
  EXPECT_LT(run.evaluations, 100'000U);
}

// From rest the sphere would roll with a reaction of just mu N, and drag asks for more of it as soon as it
// turns: it slides, v' = f - mu g.
TEST(BalancedForces, DoNotHoldASphereThatTheGroundCannotHold) {
  scene::Scene scene{};
  scene.sphere = {1.25, 0.875, 0.4375};
  scene.surface.base = coulomb(0.0625, 0.046875);
  scene.forces.gravity = {1, 0, -8};
  scene.forces.drag.rotational = 0.03;
  const Record run = record(scene, 2, 8);
  EXPECT_EQ(run.halt, "");
  for (const RecordedState& state : run.states) {
    EXPECT_NEAR(state.twist.velocity.x(), 0.5 * state.time, 1e-8);
    EXPECT_LE(state.reaction.head<2>().norm(), 0.625 * (1 + 1e-8)) << state.time;
  }
  EXPECT_EQ(run.states.back().mode, Mode::sliding);
  EXPECT_GT(run.states.back().slip.x(), 0.1);
}

// A sphere rolls up a slope to its rest, where rolling back would take just mu N.
TEST(BalancedForces, LeaveNumbersWhereASphereComesToRest) {
  scene::Scene scene{};
  scene.sphere = {0.5, 0.375, 0.0703125};
  scene.surface.base = coulomb(0.34375, 0.30078125);
  scene.surface.regions = {{"ice", scene::Polygon{{{3, 1}, {-1, 3}, {-3, -1}}, false}, Law::smooth}};
  scene.initial_state.angular_velocity = {1.2649110640673518, 0.4216370213557839, 5.75};
  scene.forces.gravity = {-25.605664942752295, 76.816994828256881, -8};
  scene.forces.spring.stiffness = 0.25;
  scene.solver.accuracy = 1e-12;
  const Record run = record(scene, 8, 80);
  for (const RecordedState& state : run.states) {
    EXPECT_TRUE(state.twist.velocity.allFinite()) << state.time;
    EXPECT_TRUE(state.twist.angular_velocity.allFinite()) << state.time;
    EXPECT_LE(state.reaction.head<2>().norm(), 0.34375 * 0.5 * 8 * (1 + 1e-6)) << state.time;
  }
  EXPECT_EQ(run.halt, "");
}

// On the edge of a belt, where each of two motions ends after 1e-24 s.
TEST(BalancedForces, LetNoMotionEndAgainAndAgainInNoTime) {
  scene::Scene scene{};
  scene.sphere = {1.5, 0.5, 0.3125};
  scene.surface.base = coulomb(0.40625, 0.025390625);
  scene::Material belt = scene.surface.base;
  belt.belt = {0.5, 0};
  scene.surface.regions = {{"belt", scene::HalfPlane{{0, 0}, {1, 0}}, belt}};
  scene.initial_state.velocity = {0.5, 0};
  scene.initial_state.angular_velocity = {0, 0, 2.75};
  scene.forces.gravity = {-11.05, 0, -8};
  scene.forces.spring.stiffness = 1;
  scene.solver.method = scene::Solver::Method::arkode_erk3;
  scene.solver.accuracy = 1e-9;
  Simulation simulation(scene);
  const auto count = [&](const Switch& event) {
    if (event.index == 100) throw std::logic_error("a hundred switches");
  };
  EXPECT_NO_THROW(simulation.advance_to(1e-8, count));
}

// Slip, slope and friction lie on one line, which no stage of a step leaves but by rounding, and the slip
// hardly changes: nothing but its stability keeps the step of an explicit method short.
TEST(BalancedForces, AlongALineLeaveAPathToBeToldBetweenTheSteps) {
  scene::Scene scene{};
  scene.sphere = {1.25, 0.75, 0.046875};
  scene.surface.base = coulomb(0.28125);
  scene.initial_state.position = {-7, -2};
  scene.initial_state.velocity = {0.89442719099991586, 0.44721359549995793};
  scene.initial_state.angular_velocity = {-0.29814239699997197, 0.59628479399994394, 0};
  scene.forces.gravity = {-517.20252319570136, -258.60126159785068, -8};  // 257 mu g
  scene.forces.spring = {{-7, -2}, 2};
  scene.solver.accuracy = 1e-9;
  const Record run = record(scene, 0.00625, 500);
  scene.solver.method = scene::Solver::Method::cvode_bdf;
  const Record implicit = record(scene, 0.00625, 500);
  ASSERT_EQ(run.states.size(), implicit.states.size());
  for (std::size_t i = 0; i < run.states.size(); ++i) {
    const RecordedState& a = run.states[i];
    const RecordedState& b = implicit.states[i];
    EXPECT_LT((a.position - b.position).norm(), 1e-9) << a.time;
    EXPECT_LT((a.twist.velocity - b.twist.velocity).norm(), 1e-6) << a.time;
    EXPECT_LT(a.orientation.angularDistance(b.orientation), 1e-7) << a.time;
  }
}

// The sphere turns in place: its velocity is what is left of slip and turning, and no step may ask for more
// figures of the place than that has.
TEST(BalancedForces, CostNoMoreThanOthersWhereTheSphereTurnsInPlace) {
  scene::Scene scene{};
  scene.sphere = {0.75, 0.125, 0.0390625};
  scene.surface.base = coulomb(0.03125);
  scene.surface.regions = {{"belt", scene::Polygon{{{0, 0}, {0, 1}, {1, 0}}, false}, coulomb(0.03125)}};
  scene.surface.regions[0].material.belt = {0.5, 0};
  scene.initial_state.angular_velocity = {0, -16, -5.5};
  scene.forces.gravity = {0.25, 0, -8};
  scene.forces.spring.stiffness = 1;
  scene.solver.accuracy = 1e-12;
  Simulation simulation(scene);
  simulation.advance_to(8, {});
  EXPECT_LT(simulation.evaluations(), 1'000'000U);
}

// On a belt the velocity is what is left of the belt's and of the slip: a turning that is less than the
// rounding of these, which friction as strong as the resistance neither ends nor lets grow, is none.
TEST(BalancedForces, LeaveNothingOfATurningThatIsLessThanTheRoundingOfTheSlip) {
  scene::Scene scene{};
  scene.sphere = {0.25, 0.125, 0.0234375};
  scene.surface.base = coulomb(0.09375);
  scene.surface.regions = {{"belt", scene::HalfPlane{{-1, -5}, {1, 0}}, coulomb(0.5, 0.5)}};
  scene.surface.regions[0].material.belt = {-0.25, 2};
  scene.surface.regions[0].material.spin_friction = 0.03125;
  scene.initial_state.position = {-1, -5};
  scene.initial_state.angular_velocity = {0, 8, -7.125};
  scene.forces.gravity = {-0.75, 0, -8};
  scene.forces.spring = {{-1, -5}, 0.25};
  Simulation simulation(scene);
  simulation.advance_to(8, {});
  EXPECT_LT(simulation.evaluations(), 1'000'000U);
}

// A slope that pulls just as much as the resistance holds, and that takes just the grip there is: the margin
// of the grip is 0 but for rounding, and only a bound on its bend that knows what friction takes from all
// growth tells that for more than a tiny part of a step. Looks are counted by the questions of the loops.
TEST(BalancedForces, CostFewLooksWhereTheGripIsJustEnough) {
  scene::Scene scene{};
  scene.sphere = {1, 0.375, 0.0703125};
  scene.surface.base = coulomb(0.34375, 0.34375);
  scene.surface.regions = {{"half", scene::HalfPlane{{0, 0}, {-2, -4}}, coulomb(0.34375)}};
  scene.initial_state.angular_velocity = {1.1925695879998879, -0.59628479399994394, -4.875};
  scene.forces.gravity = {1.2298373876248843, 2.4596747752497685, -8};
  scene.forces.spring.stiffness = 0.25;
  const QuestionsEvery questions(1);
  int turns = 0;
  Simulation simulation(scene);
  simulation.set_interrupt([&] { return ++turns < 0; });
  Switches switches;
  simulation.advance_to(2, recorder(switches));
  ASSERT_EQ(switches.size(), 1U);
  EXPECT_LT(switches[0].time, 0.01);
  EXPECT_LT(turns, 1'000'000);
}

// A resistance that just holds a sphere of next to no speed: what rounding of the two forces could give it in
// any time of interest is far more.
TEST(BalancedForces, HoldASphereOfLessSpeedThanTheirRoundingGives) {
  scene::Scene scene{};
  scene.sphere = {1, 0.625, 0.2734375};
  scene.surface.base = scene::Material(Law::rough);
  scene.surface.base.rolling_resistance = 0.15625;
  scene.surface.base.turntable_rate = -0x1p-107;
  scene.forces.gravity = {1, 0.75, -8};
  scene.forces.drag = {0, 0.125, 0.75};
  scene.initial_state.position = {4, -4};
  scene.initial_state.velocity = {-0x1p-107, -0x1p-108};
  Simulation simulation(scene);
  simulation.advance_to(8, {});
  EXPECT_LT(simulation.evaluations(), 10'000U);
  EXPECT_EQ(simulation.state().slip, Vector2d(0, 0));
  EXPECT_EQ(simulation.state().twist.velocity, Vector2d(-0x1p-105, -0x1p-105)) << "that of the ground";
}

// The slip is along the slope, whose pull friction takes up but for rounding: the sphere stays in the corner
// of smooth ground, whatever the last bits of the forces say.
TEST(BalancedForces, MoveASphereThatSlipsOutOfNoCorner) {
  for (int i = 0; i < 144; ++i) {
    SCOPED_TRACE(i);
    Vector2d down(1 + i % 6, 1 + i / 6 % 6);
    for (int turn = 0; turn < i / 36; ++turn) down = Vector2d(-down.y(), down.x());
    const Vector2d unit = down.normalized();
    scene::Scene scene{};
    scene.sphere = {1, 1, 0.1875};
    scene.forces.gravity = {2.5 * unit.x(), 2.5 * unit.y(), -8};
    scene.initial_state.angular_velocity = {1.5 * unit.y(), -1.5 * unit.x(), 0};
    scene.surface.base = coulomb(0.3125);
    const scene::Polygon behind{{{0, 0}, {down.y(), -down.x()}, -down}, false};
    scene.surface.regions = {{"behind", behind, Law::smooth}};
    Simulation simulation(scene);
    ASSERT_NO_THROW(simulation.advance_to(0.02, {}));  // the slip lasts 0.0211 s
    EXPECT_EQ(simulation.state().region, "base");
    EXPECT_LT(simulation.state().position.norm(), 1e-18);
  }
}

}  // namespace
}  // namespace hybrid_sphere::testing::balanced_forces_test

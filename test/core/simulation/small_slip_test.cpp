// Slips and rolls that are small beside the other, or that friction can just hold: they are followed at the
// cost of others, and end where they should.

#include <gtest/gtest.h>

#include <cfloat>
#include <cmath>
#include <string>

#include "hybrid_sphere/scene/read_scene.hpp"
#include "support/recorded.hpp"

namespace hybrid_sphere::testing::small_slip_test {
namespace {

scene::Scene read(const std::string& name) {
  return scene::read_scene_file(std::string(TEST_DATA_DIR) + "/dissipation/" + name);
}

// Friction and resistance are the same: beside a slip, what drives nu is just what holds it. Rotational drag
// lets nu die out for ever, and its direction follows that of the slip in far less than any time that
// matters.
TEST(SmallSlip, AResistanceThatEqualsFrictionIsFollowedWhileTheTurningDiesOut) {
  scene::Scene scene{};
  scene.sphere = {2, 0.5, 0.25};
  scene.surface.base.law = scene::Law::coulomb;
  scene.surface.base.friction = scene.surface.base.rolling_resistance = 0.25;
  scene.initial_state.angular_velocity = {3, -2.5, 0};
  scene.forces.gravity = {3.5, 3, -8};
  scene.forces.drag.rotational = 0.125;
  scene.forces.drag.quadratic = 0.25;
  Simulation simulation(scene);
  simulation.advance_to(4, {});
  EXPECT_LT(simulation.evaluations(), 10'000'000U);
  EXPECT_LT(simulation.state().twist.angular_velocity.norm(), 1e-3);
}

// With mu = rho nu neither dies nor grows by itself: it turns to the slip, ever faster the shorter it is.
TEST(SmallSlip, ARollThatDiesWithoutEndBesideASlipIsFollowedUntilNothingIsSeenOfIt) {
  scene::Scene scene = read("roll_that_never_ends.yaml");
  Simulation fine(scene);
  scene.solver.accuracy = 1e-6;
  Simulation coarse(scene);
  for (double time = 0.5; time <= 8; time += 0.5) {
    fine.advance_to(time, {});
    coarse.advance_to(time, {});
    const State& state = fine.state();
    const double way = (state.position - scene.initial_state.position).norm();
    EXPECT_LE((coarse.state().position - state.position).norm(), 1e-6 * way) << time;
    EXPECT_LE((coarse.state().twist.velocity - state.twist.velocity).norm(), 1e-6 * 7) << time;
    EXPECT_LE((coarse.state().twist.angular_velocity - state.twist.angular_velocity).norm(), 1e-6 * 7 / 0.125)
        << time;
  }
  EXPECT_TRUE(fine.state().twist.angular_velocity.head<2>().isZero(0));
  EXPECT_LT(fine.evaluations(), 200'000U);
}

// Down a slope that pulls just as much as the resistance holds: drag alone slows it down, for ever.
TEST(SmallSlip, ARollAgainstAResistanceThatEqualsTheSlopeIsFollowedThoughItNeverEnds) {
  scene::Scene scene{};
  scene.sphere = {0.75, 0.375, 0.1640625};
  scene.forces.gravity = {-0.125, 0, -8};
  scene.forces.drag.translational = 0.875;
  scene.surface.base.law = scene::Law::rough;
  scene.surface.base.rolling_resistance = 0.015625;
  scene.initial_state.velocity = {2, 4};
  Simulation simulation(scene);
  simulation.advance_to(8, {});
  EXPECT_LT(simulation.evaluations(), 2'000'000U);
  const State before = simulation.state();
  EXPECT_NEAR(before.twist.velocity.y(), 0, 1e-9);
  // By then it rolls down the slope: v' = -(1 - kappa) c/m v.
  simulation.advance_to(9, {});
  const double rate = (1 - 0.1640625 * 0.1640625 / (0.375 * 0.375 + 0.1640625 * 0.1640625)) * 0.875 / 0.75;
  EXPECT_NEAR(simulation.state().twist.velocity.x(), before.twist.velocity.x() * std::exp(-rate), 1e-8);
}

// The same on ground whose grip is looked after: the direction of what hardly moves turns no more, and is
// held once nothing is seen of it.
TEST(SmallSlip, ARollAgainstAResistanceThatEqualsTheSlopeKeepsItsGripAtTheCostOfOthers) {
  scene::Scene scene{};
  scene.sphere = {0.5, 0.125, 0.0078125};
  scene.surface.base.law = scene::Law::coulomb;
  scene.surface.base.friction = 0.125;
  scene.surface.base.rolling_resistance = 0.0625;
  scene.initial_state.velocity = {-1, -4};
  scene.initial_state.angular_velocity = {6.25, 2.25, 2.5};
  scene.forces.gravity = {0, 0.5, -8};
  scene.forces.drag.rotational = 0.109375;
  Simulation simulation(scene);
  simulation.advance_to(8, {});
  EXPECT_LT(simulation.evaluations(), 100'000U);
  EXPECT_LE(simulation.state().twist.velocity.norm(), 1e-9 * 4);
}

// Friction and resistance both equal the pull of the slope: a slip of one rounding error stays, beside edges.
TEST(SmallSlip, ASlipThatNothingDrivesOrHoldsIsFollowedAtAnEdge) {
  scene::Scene scene{};
  scene.sphere = {2, 1, 0.1875};
  scene.forces.gravity = {1.75, 0, -8};
  scene.forces.drag.rotational = 0.00439453125;
  scene.surface.base.law = scene::Law::coulomb;
  scene.surface.base.friction = scene.surface.base.rolling_resistance = 0.21875;
  scene.surface.regions = {
      {"cell", scene::Polygon{{{-0.6, -0.6}, {-0.3, -0.6}, {-0.3, -0.3}, {-0.6, -0.3}}}, scene.surface.base}};
  scene.initial_state.position = {-0.6, -0.6};
  scene.initial_state.angular_velocity = {0, -3.75, -1};
  Simulation simulation(scene);
  simulation.advance_to(8, {});
  EXPECT_LT((simulation.state().position - scene.initial_state.position).norm(), 1e-14);
  EXPECT_LT(simulation.evaluations(), 2'000'000U);
}

// The motion is not asked for beyond its end.
TEST(SmallSlip, ARollThatEndsWithinAPieceOfItsPathIsNotFollowedFarther) {
  Simulation simulation(read("grip_lost_over_cells.yaml"));
  Switches switches;
  simulation.advance_to(8, recorder(switches));
  ASSERT_EQ(switches.size(), 6U);
  EXPECT_EQ(switches.back().cause, Cause::grip_lost);
  EXPECT_LT(simulation.evaluations(), 200'000U);
}

TEST(SmallSlip, ARollOnAStraightPathThatEndsWithinAPieceOfItIsNotFollowedFarther) {
  Simulation simulation(read("straight_roll_over_cells.yaml"));
  Switches switches;
  simulation.advance_to(8, recorder(switches));
  ASSERT_EQ(switches.size(), 2U);
  EXPECT_EQ(switches.back().cause, Cause::grip_lost);
  EXPECT_LT(simulation.evaluations(), 200'000U);
}

// What rounding leaves of a slip beside a roll dies at once.
// On an oblique line what rounding has left across it is taken away, and with it, here and there, the whole
// slip: then friction holds.
TEST(SmallSlip, ASlipOfTheSizeOfRoundingOnAnObliqueLineDiesAtOnce) {
  scene::Scene scene{};
  scene.sphere = {1.75, 0.75, 0.46875};
  scene.forces.gravity = {-1.4810495239213617, -0.98736634928090783, -8};
  scene.forces.drag.rotational = 0.0240325927734375;
  scene.surface.base.law = scene::Law::coulomb;
  scene.surface.base.friction = 0.46875;
  scene.surface.base.belt = {-1.5, -1};
  scene.initial_state.velocity = scene.surface.base.belt;
  const Record run = record(scene, 8, 128);
  ASSERT_EQ(run.halt, "");
  for (std::size_t i = 1; i + 1 < run.states.size(); ++i) {
    const RecordedState& there = run.states[i];
    scene.initial_state.position = there.position;
    scene.initial_state.velocity = there.twist.velocity;
    scene.initial_state.angular_velocity = there.twist.angular_velocity;
    // One rounding beside the ground's speed.
    scene.initial_state.angular_velocity.x() *= 1 + DBL_EPSILON;
    const Record rest = record(scene, 0.25, 4);
    EXPECT_EQ(rest.states.back().mode, Mode::rolling) << there.time;
    if (i + 4 >= run.states.size()) continue;
    EXPECT_LT((rest.states.back().position - run.states[i + 4].position).norm(), 1e-12 * 40) << there.time;
  }
}

TEST(SmallSlip, ASlipOfTheSizeOfRoundingDiesAtOnce) {
  const Record run = record(read("slip_of_rounding.yaml"), 1e-6, 1);
  ASSERT_EQ(run.halt, "");
  EXPECT_EQ(run.states.back().mode, Mode::rolling);
}

// The sphere stays on the ground on which the slide has begun.
// A blow has stopped a sphere of 1e12 m/s but for what rounding has left: on ground with friction that is
// rest.
TEST(SmallSlip, ASlipThatRoundingHasLeftOfAFasterMotionEndsWhereFrictionBegins) {
  scene::Scene scene{};
  scene.sphere = {1, 0.5, 0.25};
  scene.forces.gravity = {0, 0, -9.81};
  scene.initial_state.velocity = {1e12, 0};
  scene::Material dry(scene::Law::coulomb);
  dry.friction = 0.3;
  scene.surface.regions = {{"dry", scene::HalfPlane{{0.01, 0}, {1, 0}}, dry}};
  Simulation simulation(scene);
  simulation.advance_to(0, {});
  simulation.kick({-1e12 + 0.005, 0});
  Switches switches;
  simulation.advance_to(4, recorder(switches));
  ASSERT_EQ(switches.size(), 1U);
  EXPECT_EQ(switches[0].after.velocity, Vector2d(0, 0));
  EXPECT_EQ(simulation.state().twist.velocity, Vector2d(0, 0));
  EXPECT_EQ(simulation.state().position, switches[0].position);
  EXPECT_EQ(simulation.state().mode, Mode::resting);
}

// From rest down a slope, beside a slip as small as the ground's velocity: that is lost in the motion.
TEST(SmallSlip, ASlideOnGroundThatHardlyMovesIsThatOnGroundAtRest) {
  scene::Scene scene{};
  scene.sphere = {0.25, 0.125, 0.0703125};
  scene.initial_state.position = {0, 5};
  scene.forces.gravity = {-2, 4, -8};
  scene.surface.base.law = scene::Law::coulomb;
  scene.surface.base.friction = 0.28125;
  scene.surface.base.rolling_resistance = 0.21875;
  for (const double drag : {0.0, 1.125}) {
    scene.forces.drag.quadratic = drag;
    scene.surface.base.belt.setZero();
    Simulation at_rest(scene);
    at_rest.advance_to(1, {});
    const State& expected = at_rest.state();
    const double way = (expected.position - scene.initial_state.position).norm();
    for (const double speed : {1e-9, 1e-12, 1e-26, 1e-60, 1e-200}) {
      SCOPED_TRACE(::testing::Message() << drag << " " << speed);
      scene.surface.base.belt = {speed, -speed};
      Simulation moving(scene);
      moving.advance_to(1, {});
      const double allowed = 8 * speed + 2 * scene.solver.accuracy * way;
      EXPECT_LE((moving.state().position - expected.position).norm(), allowed);
      EXPECT_LE((moving.state().twist.angular_velocity - expected.twist.angular_velocity).norm(),
                allowed / scene.sphere.radius);
    }
  }
}

TEST(SmallSlip, ASlideThatEndsAtOnceLeadsNowhere) {
  const Record run = record(read("slip_that_ends_at_once.yaml"), 3.5, 1);
  ASSERT_EQ(run.halt, "");
  for (const RecordedSwitch& event : run.switches) EXPECT_NE(event.to, "base") << event.time;
}

// Nothing is lost, and the search for a loss does not look at every rounding of the margin.
TEST(SmallSlip, ARollThatTakesAllTheGripThereIsGoesOn) {
  Simulation simulation(read("grip_that_is_just_enough.yaml"));
  int questions = 0;
  simulation.set_interrupt([&] { return ++questions > 1000; });
  ASSERT_NO_THROW(simulation.advance_to(8, {}));
  EXPECT_EQ(simulation.switches(), 1U);
}

// Without friction a slip of 0 is nothing special: v' = g - d v, and the resistance turns the sphere at a
// constant rate, rho g R/k^2.
TEST(SmallSlip, OfNoneOnGroundWithAResistanceAloneIsAsAnyOther) {
  using Method = scene::Solver::Method;
  for (const Method method : {Method::automatic, Method::dopri5, Method::dopri87, Method::cvode_bdf,
                              Method::cvode_adams, Method::arkode_erk, Method::arkode_erk3, Method::rk4}) {
    SCOPED_TRACE(scene::to_string(method));
    scene::Scene scene{};
    scene.sphere = {1, 1, std::sqrt(0.4)};
    scene.forces.gravity = {1, 0, -9.81};
    scene.forces.drag.translational = 0.01;
    scene.initial_state.velocity = {0, 1};
    scene.initial_state.angular_velocity = {-1, 0, 0};
    scene::Material ice(scene::Law::coulomb);
    ice.rolling_resistance = 0.01;
    scene.surface.base = ice;
    scene.solver.method = method;
    Simulation simulation(scene);
    ASSERT_NO_THROW(simulation.advance_to(1, {}));
    const State& state = simulation.state();
    EXPECT_NEAR(state.twist.velocity.x(), -100 * std::expm1(-0.01), 1e-9);
    EXPECT_NEAR(state.twist.velocity.y(), std::exp(-0.01), 1e-9);
    EXPECT_NEAR(state.twist.angular_velocity.x(), -1 + 0.01 * 9.81 * 2.5, 1e-9);
  }
}

}  // namespace
}  // namespace hybrid_sphere::testing::small_slip_test

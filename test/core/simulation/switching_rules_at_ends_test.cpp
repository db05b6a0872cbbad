// What holds exactly at the end of a motion, on a line and on an edge, without a simulation.

#include <gtest/gtest.h>

#include <cfloat>
#include <cmath>
#include <utility>
#include <vector>

#include "core/simulation/rules_bench.hpp"
#include "geometry/exact.hpp"
#include "simulation/switching_rules.hpp"

namespace hybrid_sphere::testing::switching_rules_at_ends_test {
namespace {

// A resistance that holds the sphere against rho N/m = 1 m/s^2, and friction against 2 m/s^2.
const Material resisting = ground_of(Law::coulomb, 0.25, 0.125, belt_velocity);

Arrival ended(const Bench& bench, MotionEnd end, ContactMode mode, const Arrival& at,
              const Material& ground = resisting) {
  Arrival arrival = at;
  arrival.cause = Cause::slip_ended;  // as the event loop does
  bench.rules.end_motion(end, mode, ground, arrival);
  return arrival;
}

TEST(SwitchingRules, EndASlipExactlyAtTheVelocityOfTheGround) {
  const Bench bench;
  const Arrival at = bench.arrival(belt_velocity + Vector2d(1 + 0x1p-50, 0), {1, 0});
  const Arrival end = ended(bench, MotionEnd::slip_used_up, ContactMode::sliding, at);
  EXPECT_EQ(end.state.contact_velocity, belt_velocity);
  EXPECT_EQ(end.state.twist.velocity, at.state.twist.velocity);
  EXPECT_EQ(end.state.twist.angular_velocity, at.state.twist.angular_velocity);
  EXPECT_FALSE(end.mode);
}

TEST(SwitchingRules, EndAtRestASlipThatIsUsedUpTogetherWithTheTurning) {
  const Bench bench(rounding);
  const Arrival at = bench.arrival(belt_velocity + Vector2d(rounding, 0), {rounding / 2, 0});
  expect_rest(ended(bench, MotionEnd::slip_used_up, ContactMode::sliding, at).state, belt_velocity);
}

TEST(SwitchingRules, KeepASlowTurningAtTheEndOfASlipWhereNothingResistsIt) {
  const Bench bench(rounding);
  const Arrival at = bench.arrival(belt_velocity + Vector2d(rounding, 0), {rounding / 2, 0});
  const Material ground = ground_of(Law::coulomb, 0.25, 0, belt_velocity);
  const Arrival end = ended(bench, MotionEnd::slip_used_up, ContactMode::sliding, at, ground);
  EXPECT_EQ(end.state.twist.angular_velocity, at.state.twist.angular_velocity);
}

TEST(SwitchingRules, EndASkidAtRest) {
  const Bench bench;
  const Arrival at = bench.arrival(belt_velocity + Vector2d(0x1p-49, 0), {0x1p-50, 0});
  expect_rest(ended(bench, MotionEnd::slip_used_up, ContactMode::skidding, at).state, belt_velocity);
}

TEST(SwitchingRules, EndRollingAtRest) {
  const Bench bench;
  const Arrival at = bench.arrival(belt_velocity + Vector2d(0x1p-50, 0), {0x1p-50, 0});
  expect_rest(ended(bench, MotionEnd::roll_used_up, ContactMode::rolling, at).state, belt_velocity);
}

// A slope f holds the sphere up to rho N/m = 1. Rolling takes abs(lambda)/m = 0.2 f + 0.8 of mu N/m = 2.
TEST(SwitchingRules, LetTheForcesDecideWhatFollowsWhereRollingEnds) {
  const std::vector<std::pair<double, ContactMode>> cases = {
      {0.5, ContactMode::sticking}, {1.5, ContactMode::rolling}, {10, ContactMode::sliding}};
  for (const auto& [pull, mode] : cases) {
    const Bench bench(0, pull);
    const Arrival at = bench.arrival(belt_velocity, still);
    const Arrival end = ended(bench, MotionEnd::roll_used_up, ContactMode::rolling, at);
    EXPECT_EQ(end.mode, mode) << pull;
    EXPECT_EQ(end.cause, mode == ContactMode::sliding ? Cause::grip_lost : Cause::slip_ended) << pull;
  }
}

TEST(SwitchingRules, LetSlipOnWithoutTurningASphereWhoseTurningIsUsedUp) {
  const Bench bench(rounding);
  const Arrival at = bench.arrival(belt_velocity + Vector2d(1, 0), {0x1p-50, 0});
  const Arrival end = ended(bench, MotionEnd::roll_used_up, ContactMode::sliding, at);
  EXPECT_EQ(end.state.contact_velocity, at.state.twist.velocity);
  EXPECT_EQ(end.state.twist.velocity, at.state.twist.velocity);
  EXPECT_EQ(end.state.twist.angular_velocity.head<2>(), still);
  EXPECT_FALSE(end.mode);
}

TEST(SwitchingRules, EndAtRestATurningThatIsUsedUpTogetherWithTheSlip) {
  const Bench bench(rounding);
  const Arrival at = bench.arrival(belt_velocity + Vector2d(rounding, 0), {rounding / 2, 0});
  expect_rest(ended(bench, MotionEnd::roll_used_up, ContactMode::sliding, at).state, belt_velocity);
}

TEST(SwitchingRules, LetTheSphereSlideWhereRollingLosesItsGrip) {
  const Bench bench;
  const Arrival at = bench.arrival(belt_velocity + Vector2d(1, 0), {1, 0});
  const Arrival end = ended(bench, MotionEnd::grip_lost, ContactMode::rolling, at);
  EXPECT_EQ(end.mode, ContactMode::sliding);
  EXPECT_EQ(end.cause, Cause::grip_lost);
  expect_unchanged(end.state, at.state);
}

TEST(SwitchingRules, KeepASlowTurningWhereRollingLosesItsGrip) {
  const Bench bench(rounding);
  const Arrival at = bench.arrival(belt_velocity + Vector2d(rounding / 2, 0), {rounding / 2, 0});
  expect_unchanged(ended(bench, MotionEnd::grip_lost, ContactMode::rolling, at).state, at.state);
}

TEST(SwitchingRules, LetTheSphereSlideWhereSkiddingBreaksLoose) {
  const Bench bench;
  const Arrival at = bench.arrival(belt_velocity + Vector2d(1, 0), {0x1p-50, 0});
  const Arrival end = ended(bench, MotionEnd::breaks_loose, ContactMode::skidding, at);
  EXPECT_EQ(end.mode, ContactMode::sliding);
  EXPECT_EQ(end.cause, Cause::grip_lost);
  EXPECT_EQ(end.state.contact_velocity, at.state.twist.velocity);
  EXPECT_EQ(end.state.twist.angular_velocity.head<2>(), still);
}

// Where holding takes mu N/m = 2, all that friction has, it does not roll.
TEST(SwitchingRules, LetTheSphereRollOrSkidWhereStickingEnds) {
  for (const double pull : {1., 2.}) {
    const Bench bench(0, pull);
    const Arrival at = bench.arrival(belt_velocity, still);
    const Arrival loose = ended(bench, MotionEnd::breaks_loose, ContactMode::sticking, at);
    EXPECT_EQ(loose.mode, pull < 2 ? ContactMode::rolling : ContactMode::skidding);
    EXPECT_EQ(loose.cause, pull < 2 ? Cause::slip_ended : Cause::grip_lost);
    const Arrival slips = ended(bench, MotionEnd::grip_lost, ContactMode::sticking, at);
    EXPECT_EQ(slips.mode, ContactMode::skidding);
  }
}

TEST(SwitchingRules, KeepTheSpinAtTheEndOfAMotion) {
  const Bench bench;
  for (const MotionEnd end : {MotionEnd::slip_used_up, MotionEnd::roll_used_up, MotionEnd::breaks_loose}) {
    const Arrival at = bench.arrival(belt_velocity, still);
    EXPECT_EQ(ended(bench, end, ContactMode::skidding, at).state.twist.angular_velocity.z(), 1.5);
  }
}

struct Held {
  bool holds;
  Arrival arrival;
};

Held held(double pull, const Vector2d& slip, const Vector2d& nu, const Material& ground) {
  const Bench bench(0, pull);
  Held held{false, bench.arrival(belt_velocity + slip + nu, nu)};
  held.holds = bench.rules.hold(ground, held.arrival);
  return held;
}

// A skid takes abs(c)/m = mu N/m = 2 of rho N/m.
TEST(SwitchingRules, HoldASkidWhoseResistanceLacksLessThanRoundingHides) {
  for (const double part : {1 - 0x1p-21, 1 - 0x1p-19}) {
    const Held skid = held(0, {1, 0}, still, ground_of(Law::coulomb, 0.25, part * 0.25, belt_velocity));
    EXPECT_EQ(skid.holds, part == 1 - 0x1p-21);
    EXPECT_EQ(skid.arrival.mode, ContactMode::skidding);
  }
}

TEST(SwitchingRules, HoldInRollingWhatTurnsWithoutSlip) {
  const Held rolling = held(0, still, {1, 0}, resisting);
  EXPECT_TRUE(rolling.holds);
  EXPECT_EQ(rolling.arrival.mode, ContactMode::rolling);
}

TEST(SwitchingRules, HoldInRollingWhatRestsWhereNothingResists) {
  const Held rolling = held(0, still, still, ground_of(Law::coulomb, 0.25, 0, belt_velocity));
  EXPECT_TRUE(rolling.holds);
  EXPECT_EQ(rolling.arrival.mode, ContactMode::rolling);
}

// Friction holds mu N/m = 2, or 0.8, the resistance rho N/m = 1.
TEST(SwitchingRules, HoldAtRestWhatTheForcesMoveByNoMoreThanRounding) {
  const Material slippery = ground_of(Law::coulomb, 0.1, 0.125, belt_velocity);
  EXPECT_EQ(held(1 + 0x1p-45, still, still, resisting).arrival.mode, ContactMode::sticking);
  EXPECT_EQ(held(1 + 0x1p-30, still, still, resisting).arrival.mode, ContactMode::rolling);
  EXPECT_EQ(held(0.9, still, still, slippery).arrival.mode, ContactMode::skidding);
}

TEST(SwitchingRules, LetTheLimitsBeExceededSlightlyByWhatTheyHold) {
  EXPECT_TRUE(held(0, still, {1, 0}, resisting).arrival.state.loose);
}

TEST(SwitchingRules, StopTheSphereOnTheGroundButForItsSpin) {
  const Bench bench;
  Arrival arrival = bench.moving();
  bench.rules.stop(turntable(Law::rough), arrival);
  expect_rest(arrival.state, {2.5, 1});
  EXPECT_EQ(arrival.state.twist.angular_velocity.z(), 1.5);
}

TEST(SwitchingRules, LetTheForcesDecideWhatFollowsAStop) {
  const std::vector<std::pair<double, ContactMode>> cases = {
      {0.5, ContactMode::sticking}, {1.5, ContactMode::rolling}, {10, ContactMode::sliding}};
  for (const auto& [pull, mode] : cases) {
    const Bench bench(0, pull);
    Arrival arrival = bench.moving();
    bench.rules.stop(resisting, arrival);
    EXPECT_EQ(arrival.mode, mode) << pull;
  }
}

// Centre and contact move along (3, 4), but for `across` of it.
Arrival along_a_line(const Bench& bench, double across) {
  const Vector2d off = across * Vector2d(-0.8, 0.6);
  return bench.arrival(Vector2d(3, 4) + off, Vector2d(1.5, 2) + 2 * off);
}

TEST(SwitchingRules, TakeAwayWhatRoundingLeavesAcrossALine) {
  const Bench bench(rounding);
  Segment::Start state = along_a_line(bench, rounding / 4).state;
  EXPECT_FALSE(bench.rules.keep_on_line({6, 8}, still, state));
  // Six roundings: of the unit vector, the products and the sum, and of the product with it.
  for (const Vector2d& v : {state.twist.velocity, Vector2d(2 * state.contact_velocity)}) {
    EXPECT_LE((v - Vector2d(3, 4)).norm(), 6 * unit * 5);
  }
  EXPECT_LE((bench.nu(state.twist) - Vector2d(1.5, 2)).norm(), 12 * unit * 5);
}

TEST(SwitchingRules, KeepWhatIsAcrossALineByMoreThanRounding) {
  const Bench bench(rounding);
  const Segment::Start before = along_a_line(bench, rounding).state;
  Segment::Start state = before;
  EXPECT_FALSE(bench.rules.keep_on_line({6, 8}, still, state));
  expect_unchanged(state, before);
}

TEST(SwitchingRules, KeepTheVelocitiesOnALineAlongAnAxis) {
  const Bench bench(rounding);
  for (const Vector2d& line : {Vector2d(1, 0), Vector2d(0, 1), still}) {
    const Vector2d off = rounding / 8 * turned(line);
    const Segment::Start before = bench.arrival(2 * line + off, line).state;
    Segment::Start state = before;
    EXPECT_FALSE(bench.rules.keep_on_line(line, still, state));
    expect_unchanged(state, before);
  }
}

TEST(SwitchingRules, KeepOnTheGroundWhatMovesExactlyWithIt) {
  const Bench bench(rounding);
  const Vector2d off = rounding / 4 * Vector2d(-0.8, 0.6);
  const Vector2d ground = Vector2d(3, 4) + off;
  Segment::Start state = bench.arrival(2 * ground, ground).state;
  state.contact_velocity = ground;
  bench.rules.keep_on_line({3, 4}, ground, state);
  EXPECT_EQ(state.contact_velocity, ground);
  EXPECT_LE((state.twist.velocity - Vector2d(6, 8)).norm(), 6 * unit * 10);
}

TEST(SwitchingRules, TellWhetherAllSlipWasAcrossTheLine) {
  const Bench bench(rounding);
  const Vector2d slip(rounding / 4, -rounding / 4);
  Segment::Start state = bench.arrival(Vector2d(1, 1) + slip, {1, 1}).state;
  EXPECT_TRUE(bench.rules.keep_on_line({1, 1}, still, state));
  EXPECT_EQ(state.contact_velocity, still);
}

TEST(SwitchingRules, TellWhetherAllTurningWasAcrossTheLine) {
  const Bench bench(rounding);
  const Vector2d nu(rounding / 4, -rounding / 4);
  Segment::Start state = bench.arrival(nu, nu).state;
  EXPECT_TRUE(bench.rules.keep_on_line({1, 1}, still, state));
  EXPECT_EQ(state.twist.angular_velocity.head<2>(), still);
}

TEST(SwitchingRules, TellNoEndOfASlipOrATurningThatWasNotThere) {
  const Bench bench(rounding);
  const Vector2d off = rounding / 4 * Vector2d(-0.8, 0.6);
  Segment::Start rolling = bench.arrival(Vector2d(3, 4) + off, Vector2d(3, 4) + off).state;
  EXPECT_FALSE(bench.rules.keep_on_line({3, 4}, still, rolling));
  Segment::Start skidding = bench.arrival(Vector2d(3, 4) + off, still).state;
  EXPECT_FALSE(bench.rules.keep_on_line({3, 4}, still, skidding));
}

TEST(SwitchingRules, StopExactlyAcrossAnEdgeAlongAnAxis) {
  const Bench bench;
  for (const int axis : {0, 1}) {
    for (const double side : {1, -1}) {
      Vector2d normal = still;
      normal[axis] = side;
      Arrival arrival = bench.arrival({0.1, 0.3}, still);
      bench.rules.stop_across(normal, arrival);
      EXPECT_EQ(arrival.state.twist.velocity[axis], 0);
      EXPECT_EQ(arrival.state.twist.velocity[1 - axis], axis == 0 ? 0.3 : 0.1);
    }
  }
}

// What is left of the velocity across the edge are some roundings, and none of them leads out of the ground.
TEST(SwitchingRules, LeaveNothingAcrossAnObliqueEdgeThatLeadsOutOfTheGround) {
  const Bench bench;
  for (int i = 0; i < 1000; ++i) {
    const Vector2d normal(std::cos(i), std::sin(i));
    const Vector2d along = 3 * turned(normal);
    Arrival arrival = bench.arrival(along - 0x1p-20 * normal, still);
    bench.rules.stop_across(normal, arrival);
    const Vector2d& velocity = arrival.state.twist.velocity;
    EXPECT_GE(exact::sign_of_dot(velocity, normal, still), 0) << i;
    // As much as is added, and again what it has to outweigh.
    EXPECT_LE((velocity - along).norm(), 4 * DBL_EPSILON * 3) << i;
  }
}

TEST(SwitchingRules, StopAcrossAnEdgeByTurningAboutTheContact) {
  const Bench bench;
  for (const Vector2d& normal : {Vector2d(1, 0), Vector2d(0, 1)}) {
    Arrival arrival = bench.moving();
    bench.rules.stop_across(normal, arrival);
    EXPECT_EQ(arrival.state.contact_velocity, Vector2d(2.25, 0.5));
    EXPECT_EQ(bench.nu(arrival.state.twist), normal.x() == 1 ? Vector2d(-2.25, -1) : Vector2d(-0.75, -0.5));
  }
}

}  // namespace
}  // namespace hybrid_sphere::testing::switching_rules_at_ends_test

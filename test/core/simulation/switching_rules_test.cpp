// What a ground does at once to a sphere that reaches it, without a simulation.

#include "simulation/switching_rules.hpp"

#include <gtest/gtest.h>

#include <cfloat>
#include <cmath>
#include <utility>
#include <vector>

#include "core/simulation/rules_bench.hpp"

namespace hybrid_sphere::testing::switching_rules_test {
namespace {

void expect_impulse(const Bench& bench, const Vector2d& impulse, const Vector2d& slip) {
  const double k2 = std::pow(bench.body.gyration_radius, 2);
  const double R2 = std::pow(bench.body.radius, 2);
  const Vector2d expected = -bench.body.mass * k2 / (k2 + R2) * slip;
  // Seven roundings of each of the two forms.
  EXPECT_LE((impulse - expected).norm(), 14 * unit * expected.norm()) << "R = " << bench.body.radius;
}

TEST(SwitchingRules, StopTheSlipOnRoughGroundByAnImpulse) {
  for (const scene::SphereBody& body : bodies()) {
    const Bench bench(body);
    Arrival arrival = bench.moving();
    expect_impulse(bench, bench.apply_reset(Law::rough, arrival).impulse, {2.25, 0.5});
  }
}

TEST(SwitchingRules, ReckonTheSlipRelativeToTheGroundEntered) {
  const Bench bench;
  Arrival on_belt = bench.moving();
  EXPECT_EQ(bench.apply_reset(ground_of(Law::rough, 0, 0, belt_velocity), on_belt).slip_before,
            Vector2d(1.25, 0));
  Arrival on_turntable = bench.moving();
  const Reset reset = bench.apply_reset(turntable(Law::rough), on_turntable);
  EXPECT_EQ(reset.slip_before, Vector2d(-0.25, -0.5));
  expect_impulse(bench, reset.impulse, {-0.25, -0.5});
}

// (20): m (v2 - v1) = P, m k^2 (w2 - w1) = (R P_y, -R P_x, 0), the second one over m k^2/R.
TEST(SwitchingRules, ChangeBothVelocitiesByTheOneImpulse) {
  for (const scene::SphereBody& body : bodies()) {
    for (const Material& ground : {Material(Law::rough), turntable(Law::rough)}) {
      const Bench bench(body);
      const Twist before = bench.moving().state.twist;
      Arrival arrival = bench.moving();
      const Reset reset = bench.apply_reset(ground, arrival);
      const Twist& after = arrival.state.twist;
      const Vector3d turned = Vector3d(reset.impulse.y(), -reset.impulse.x(), 0) / body.mass;
      const double ratio = std::pow(body.radius / body.gyration_radius, 2);
      // Eight roundings of p_c, as many of kappa u, and again as many of P.
      const double tolerance = 24 * unit * (bench.size(before) + 3);
      EXPECT_LE((after.velocity - before.velocity - reset.impulse / body.mass).norm(), tolerance);
      const Vector3d turn = body.radius * (after.angular_velocity - before.angular_velocity);
      EXPECT_LE((turn - ratio * turned).norm(), tolerance);
      EXPECT_LE((reset.angular_impulse / (body.mass * body.radius) - turned).norm(), tolerance);
    }
  }
}

TEST(SwitchingRules, LetTheContactMoveExactlyWithTheGroundAfterAnImpulse) {
  for (const scene::SphereBody& body : bodies()) {
    const Bench bench(body);
    Arrival arrival = bench.moving();
    bench.apply_reset(turntable(Law::rough), arrival);
    EXPECT_EQ(arrival.state.contact_velocity, Vector2d(2.5, 1));
  }
}

TEST(SwitchingRules, LeaveTheVelocitiesAloneAlongAnAxisWithoutSlip) {
  for (const scene::SphereBody& body : bodies()) {
    const Bench bench(body);
    Arrival arrival = bench.arrival({1, 0.1}, {0, 0.1});
    const Twist before = arrival.state.twist;
    bench.apply_reset(Law::rough, arrival);
    EXPECT_EQ(arrival.state.twist.velocity.y(), 0.1);
    EXPECT_EQ(arrival.state.twist.angular_velocity.x(), before.angular_velocity.x());
  }
}

// T1 - T2 = m kappa s.s/2 - P.u + m k^2 (w3 - W)^2/2 - L_z W, P and L_z being those of the reset.
TEST(SwitchingRules, BalanceTheEnergyWithTheLostSlipAndTheWorkOfTheGround) {
  const Vector2d u(2.5, 1);
  const double W = 2;
  for (const scene::SphereBody& body : bodies()) {
    for (const Law law : {Law::rough, Law::rubber}) {
      const Bench bench(body);
      Arrival arrival = bench.moving();
      const Twist before = arrival.state.twist;
      const Reset reset = bench.apply_reset(turntable(law), arrival);
      const double kappa = 1 / (1 + std::pow(body.radius / body.gyration_radius, 2));
      double lost = body.mass * kappa * reset.slip_before.squaredNorm() / 2 - reset.impulse.dot(u);
      if (law == Law::rubber) {
        const double inertia = body.mass * std::pow(body.gyration_radius, 2);
        lost += inertia * std::pow(before.angular_velocity.z() - W, 2) / 2 - reset.angular_impulse.z() * W;
      }
      const double size = bench.size(before) + u.norm() + body.radius * W;
      // 24 roundings of each of the two velocities, twice in their squares, and eight of each of three
      // energies.
      const double tolerance = (2 * 2 * 24 + 3 * 8) * unit * body.mass * size * size;
      const double change =
          bench.sphere.kinetic_energy(before) - bench.sphere.kinetic_energy(arrival.state.twist);
      EXPECT_LE(std::abs(change - lost), tolerance);
    }
  }
}

// Backspin with which R xd + k^2 w2 is `part` of R xd.
Arrival backspin(const Bench& bench, double part) {
  const double ratio = std::pow(bench.body.radius / bench.body.gyration_radius, 2);
  const Vector2d v(0.3, 0.7);
  return bench.arrival(v, -ratio * (1 - part) * v);
}

TEST(SwitchingRules, BringToRestWhatOnlyRoundingKeepsMovingOnRoughGround) {
  for (const scene::SphereBody& body : bodies()) {
    const Bench bench(body);
    Arrival arrival = backspin(bench, 8 * DBL_EPSILON);
    bench.apply_reset(Law::rough, arrival);
    expect_rest(arrival.state, still);
  }
}

TEST(SwitchingRules, KeepMovingOnRoughGroundWhatIsFasterThanRounding) {
  constexpr double part = 0x1p-36;
  for (const scene::SphereBody& body : bodies()) {
    const Bench bench(body);
    Arrival arrival = backspin(bench, part);
    // Six roundings of nu, eight of p_c, two of what is expected.
    const double tolerance = 16 * unit * bench.size(arrival.state.twist);
    bench.apply_reset(Law::rough, arrival);
    const double left = part * (1 - bench.sphere.kappa());
    EXPECT_LE((arrival.state.twist.velocity - left * Vector2d(0.3, 0.7)).norm(), tolerance);
  }
}

TEST(SwitchingRules, TellTheModeByTheVelocitiesAfterTheImpulse) {
  const Bench bench;
  const Material ground = ground_of(Law::rough, 0, 0.125);
  Arrival moves_on = bench.moving();
  EXPECT_EQ(bench.apply_reset(ground, moves_on).mode, ContactMode::rolling);
  Arrival rests = bench.arrival({1, 0}, {-4, 0});  // R xd + k^2 w2 = 0
  EXPECT_EQ(bench.apply_reset(ground, rests).mode, ContactMode::sticking);
}

TEST(SwitchingRules, TellByTheTurningOnTheGroundWhetherItCarriesTheSphereAlong) {
  const Bench bench;
  Arrival carried = bench.arrival(belt_velocity, still);
  EXPECT_EQ(bench.apply_reset(ground_of(Law::rough, 0, 0.125, belt_velocity), carried).mode,
            ContactMode::sticking);
}

TEST(SwitchingRules, ChangeNothingOnGroundWithoutFriction) {
  const Bench bench;
  for (const Material& ground :
       {ground_of(Law::smooth, 0, 0, belt_velocity), ground_of(Law::coulomb, 0, 0, belt_velocity)}) {
    Arrival arrival = bench.moving();
    const Reset reset = bench.apply_reset(ground, arrival);
    EXPECT_EQ(reset.mode, ContactMode::free);
    EXPECT_FALSE(reset.jumps());
    expect_unchanged(arrival.state, bench.moving().state);
  }
}

TEST(SwitchingRules, LetTheSphereSlideOnCoulombGroundWithoutAnImpulse) {
  const Bench bench;
  for (const double friction : {0.25, 1e9}) {
    Arrival arrival = bench.moving();
    const Reset reset = bench.apply_reset(ground_of(Law::coulomb, friction, 0, belt_velocity), arrival);
    EXPECT_EQ(reset.mode, ContactMode::sliding);
    EXPECT_EQ(reset.slip_before, Vector2d(1.25, 0));
    EXPECT_FALSE(reset.jumps());
    expect_unchanged(arrival.state, bench.moving().state);
  }
}

// A sphere that does not turn is kept from it where mu < rho: section 4.6.
TEST(SwitchingRules, LetTheSphereSkidOnCoulombGroundWhoseResistanceExceedsItsFriction) {
  const Bench bench;
  for (const bool turns : {false, true}) {
    Arrival arrival = bench.arrival({1, 0}, {turns ? 0.5 : 0, 0});
    const ContactMode expected = turns ? ContactMode::sliding : ContactMode::skidding;
    EXPECT_EQ(bench.apply_reset(ground_of(Law::coulomb, 0.125, 0.25), arrival).mode, expected);
  }
}

TEST(SwitchingRules, LetRollOnCoulombGroundWhatDoesNotSlip) {
  const Bench bench;
  Arrival arrival = bench.arrival({1, 2}, {1, 2});
  const Reset reset = bench.apply_reset(ground_of(Law::coulomb, 0.25), arrival);
  EXPECT_EQ(reset.mode, ContactMode::rolling);
  EXPECT_FALSE(reset.jumps());
  expect_unchanged(arrival.state, bench.arrival({1, 2}, {1, 2}).state);
}

// It rolls while tan(alpha) <= mu/kappa.
TEST(SwitchingRules, LetSlideOnCoulombGroundWhatDoesNotSlipWhereTheGripIsTooWeak) {
  for (const scene::SphereBody& body : bodies()) {
    const double steepest = 0.25 * 8 / Sphere(body).kappa();
    for (const double part : {1 - 0x1p-20, 1 + 0x1p-20}) {
      const Bench bench(0, part * steepest, body);
      Arrival arrival = bench.arrival(still, still);
      const ContactMode expected = part < 1 ? ContactMode::rolling : ContactMode::sliding;
      EXPECT_EQ(bench.apply_reset(ground_of(Law::coulomb, 0.25), arrival).mode, expected);
    }
  }
}

// On the belt, with the slip and nu of these lengths along x.
Arrival nearly_at_rest(const Bench& bench, double slip, double nu) {
  return bench.arrival(belt_velocity + Vector2d(slip + nu, 0), {nu, 0});
}

TEST(SwitchingRules, TakeWhatRoundingLeavesOnCoulombGroundForRest) {
  const Bench bench(rounding);
  for (const double resistance : {0., 0.125}) {
    Arrival arrival = nearly_at_rest(bench, rounding / 4, 3 * rounding / 4);
    const Reset reset = bench.apply_reset(ground_of(Law::coulomb, 0.25, resistance, belt_velocity), arrival);
    expect_rest(arrival.state, belt_velocity);
    EXPECT_TRUE(arrival.restarts);
    EXPECT_EQ(reset.mode, resistance > 0 ? ContactMode::sticking : ContactMode::rolling);
  }
}

TEST(SwitchingRules, LetSlideOnCoulombGroundWhatExceedsRounding) {
  const Bench bench(rounding);
  for (const double slip : {1 + 0x1p-10, 0x1p-10}) {
    const auto arriving = [&] { return nearly_at_rest(bench, slip * rounding, rounding); };
    Arrival arrival = arriving();
    EXPECT_EQ(bench.apply_reset(ground_of(Law::coulomb, 0.25, 0, belt_velocity), arrival).mode,
              ContactMode::sliding);
    EXPECT_FALSE(arrival.restarts);
    expect_unchanged(arrival.state, arriving().state);
  }
}

TEST(SwitchingRules, TakeTheModeThatIsKnownBeforehand) {
  const Bench bench(rounding);
  for (const Law law : {Law::coulomb, Law::rough}) {
    for (const double slip : {0., rounding / 4, 1.}) {
      Arrival arrival = nearly_at_rest(bench, slip, 0);
      arrival.mode = ContactMode::skidding;
      EXPECT_EQ(bench.apply_reset(ground_of(law, 0.25, 0, belt_velocity), arrival).mode,
                ContactMode::skidding)
          << slip;
    }
  }
}

// L_z = m k^2 (W - w3)
TEST(SwitchingRules, SetTheSpinOnRubberToThatOfTheGroundByACouple) {
  for (const scene::SphereBody& body : bodies()) {
    const Bench bench(body);
    Arrival arrival = bench.arrival(Vector2d(2.5, 1), still);  // without slip
    const Reset reset = bench.apply_reset(turntable(Law::rubber), arrival);
    EXPECT_EQ(arrival.state.twist.angular_velocity.z(), 2);
    const double expected = body.mass * std::pow(body.gyration_radius, 2) * (2 - 0.75 / body.radius);
    EXPECT_LE(std::abs(reset.angular_impulse.z() - expected), 6 * unit * std::abs(expected));
    EXPECT_TRUE(reset.jumps());
  }
}

TEST(SwitchingRules, GiveNoCoupleOnRubberThatTurnsWithTheSphere) {
  const Bench bench;
  Arrival arrival = bench.arrival(Vector2d(2.5, 1), still, 1);  // omega_3 = 2
  const Reset reset = bench.apply_reset(turntable(Law::rubber), arrival);
  EXPECT_FALSE(reset.jumps());
  EXPECT_EQ(reset.mode, ContactMode::rolling);
}

TEST(SwitchingRules, KeepTheSpinOnRoughGround) {
  const Bench bench;
  Arrival arrival = bench.moving();
  const Reset reset = bench.apply_reset(turntable(Law::rough), arrival);
  EXPECT_EQ(reset.angular_impulse.z(), 0);
  EXPECT_EQ(arrival.state.twist.angular_velocity.z(), 1.5);
}

// The mode is one that the ground itself would not give.
TEST(SwitchingRules, LetTheSameGroundGoOnWithWhatItDoes) {
  const Bench bench;
  for (const Law law : {Law::rough, Law::rubber, Law::coulomb}) {
    const Material ground = ground_of(law, 0.25, 0, belt_velocity);
    Arrival arrival = bench.moving();
    const Reset reset = bench.rules.apply_reset(ground, {true, ContactMode::sticking, ground, {}}, arrival);
    EXPECT_EQ(reset.mode, ContactMode::sticking);
    EXPECT_FALSE(reset.jumps());
    expect_unchanged(arrival.state, bench.moving().state);
  }
}

TEST(SwitchingRules, LetTheSameGroundActAnewOnASphereThatHasBeenDisturbed) {
  const Bench bench;
  const Material ground(Law::rough);
  const Before goes_on{true, ContactMode::rolling, ground, {}};
  Arrival struck = bench.moving();
  struck.struck = true;
  Arrival restarts = bench.moving();
  restarts.restarts = true;
  Arrival told = bench.moving();
  told.mode = ContactMode::rolling;
  const Before put_there{false, ContactMode::rolling, ground, {}};
  const Before along_an_edge{true, ContactMode::edge_sliding, ground, {}};
  const std::vector<std::pair<Before, Arrival>> cases = {{goes_on, struck},
                                                         {goes_on, restarts},
                                                         {goes_on, told},
                                                         {put_there, bench.moving()},
                                                         {along_an_edge, bench.moving()}};
  for (std::size_t i = 0; i < cases.size(); ++i) {
    Arrival arrival = cases[i].second;
    EXPECT_TRUE(bench.rules.apply_reset(ground, cases[i].first, arrival).jumps()) << "case " << i;
  }
}

// Ground that differs from the one in force in its friction against spin alone, and a slip.
Reset enter_held(const Bench& bench, Law law, const Vector2d& held_on, bool struck, Arrival& arrival) {
  const Material before = ground_of(law, 0.25, 0, held_on);
  Material ground = ground_of(law, 0.25, 0, belt_velocity);
  ground.spin_friction = 0.5;
  arrival = nearly_at_rest(bench, 0x1p-50, 1);
  arrival.struck = struck;
  return bench.rules.apply_reset(
      ground, {true, ContactMode::rolling, before, constraint_of(ContactMode::rolling, before)}, arrival);
}

TEST(SwitchingRules, TakeTheSlipForNoneThatTheConstraintInForceKeepsAtZero) {
  const Bench bench;
  for (const Law law : {Law::rough, Law::coulomb}) {
    Arrival arrival;
    const Reset reset = enter_held(bench, law, belt_velocity, false, arrival);
    EXPECT_EQ(reset.slip_before, still);
    EXPECT_EQ(reset.mode, ContactMode::rolling);
    EXPECT_FALSE(reset.jumps());
    EXPECT_EQ(arrival.state.contact_velocity, belt_velocity);
  }
}

TEST(SwitchingRules, TakeTheSlipAsItIsThatNoConstraintKeepsAtZero) {
  const Bench bench;
  Arrival arrival;
  const Vector2d slip(0x1p-50, 0);
  EXPECT_EQ(enter_held(bench, Law::rough, belt_velocity, true, arrival).slip_before, slip);
  EXPECT_EQ(enter_held(bench, Law::rough, still, false, arrival).slip_before, slip);
}

}  // namespace
}  // namespace hybrid_sphere::testing::switching_rules_test

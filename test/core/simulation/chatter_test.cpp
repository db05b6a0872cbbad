// Switches without end that shrink like a power of their number, or not at all: they are reported.

#include <gtest/gtest.h>

#include <string>

#include "hybrid_sphere/scene/read_scene.hpp"
#include "sphere/constants.hpp"
#include "support/recorded.hpp"

namespace hybrid_sphere::testing::chatter_test {
namespace {

scene::Scene read(const std::string& name) {
  return scene::read_scene_file(std::string(TEST_DATA_DIR) + "/accumulation/" + name + ".yaml");
}

/// Of a simulation that halts before a time because no motion is known after switches without end [s].
double time_of_halt(Simulation& simulation, double until) {
  try {
    simulation.advance_to(until, {});
    ADD_FAILURE() << "no halt";
  } catch (const HaltedError& error) {
    const std::string reason = error.what();
    EXPECT_NE(reason.find("no motion along"), std::string::npos) << reason;
    return error.time();
  }
  return never;
}

// Two grounds that move with 1e-12 m/s and 0: each way takes 1e-13 s, and would have to be made 1e13 times
// until the place is another number.
TEST(Chatter, IsToldWhereEveryWayIsLostInTheRoundingOfThePlace) {
  Simulation simulation(read("ways_lost_in_rounding"));
  EXPECT_LT(time_of_halt(simulation, 8), 1e-9);
  EXPECT_EQ(simulation.state().position, Vector2d(-3, 1));
}

// Each throw is followed about as far as it reaches, not as far as the forces take to change the motion.
TEST(Chatter, OfThrowsThatBecomeShorterAndShorterCostsLittlePerThrow) {
  Simulation simulation(read("chatter_of_throws"));
  std::size_t switches = 0;
  simulation.advance_to(4.5, [](const Switch&) {});
  const std::size_t before = simulation.evaluations();
  simulation.advance_to(5.5, [&](const Switch&) { ++switches; });
  EXPECT_GT(switches, 1000U);
  EXPECT_LT(simulation.evaluations() - before, 400 * switches);
}

// The friction of both belts drives the sphere to the edge, in n-th intervals of about 1/n.
TEST(Chatter, BetweenTwoCoulombBeltsIsReportedAfterABoundedNumberOfCrossings) {
  Simulation simulation(read("chatter_of_two_coulomb_belts"));
  EXPECT_LT(time_of_halt(simulation, 1e6), 40);
  EXPECT_LT(simulation.evaluations(), 10'000'000U);
  EXPECT_LT(std::abs(simulation.state().position.x()), 1e-6);
}

// Friction with resistances, a turntable and a spring: the intervals halve until rounding lets them go no
// further.
TEST(Chatter, ThatIsLostInTheRoundingOfThePlaceIsReported) {
  Simulation simulation(read("chatter_of_friction_in_rounding"));
  EXPECT_NEAR(time_of_halt(simulation, 8), 6.9, 0.1);
  EXPECT_LT(simulation.evaluations(), 3'000'000U);
}

// A belt brings the sphere to the edge of a frictionless slope down which it comes back, until it does so in
// no time.
TEST(Chatter, OfABeltAndASlopeIsReported) {
  Simulation simulation(read("chatter_of_a_belt_and_a_slope"));
  EXPECT_NEAR(time_of_halt(simulation, 8), 6.882, 1e-3);
  EXPECT_LT(simulation.switches(), 20'000U);
}

// A belt's friction and a spring drive the sphere to the corner of the belt from both sides.
TEST(Chatter, ThroughACornerIsReported) {
  Simulation simulation(read("chatter_through_a_corner"));
  EXPECT_NEAR(time_of_halt(simulation, 8), 7.226, 1e-3);
  EXPECT_LT(simulation.switches(), 20'000U);
}

// From rest on the edge the intervals begin with a nanosecond, and hardly shrink.
TEST(Chatter, OfShortIntervalsFromTheBeginningIsReported) {
  Simulation simulation(read("chatter_from_rest"));
  EXPECT_NEAR(time_of_halt(simulation, 8), 0.04167, 1e-5);
  EXPECT_LT(simulation.evaluations(), 10'000'000U);
}

// Two grounds on the two sides of a corner throw the sphere back in turn, into friction that takes it there.
TEST(Chatter, OfThrowsInACornerIsReported) {
  Simulation simulation(read("chatter_of_throws_in_a_corner"));
  time_of_halt(simulation, 8);
  EXPECT_LT((simulation.state().position - Vector2d(0, -1)).norm(), 1e-7);
  EXPECT_LT(simulation.evaluations(), 50'000'000U);
}

// Three intervals that rounding lets shrink are no geometric series, after which the sphere would leave the
// edge.
TEST(Chatter, WhoseIntervalsAreRoundedIsNoGeometricSeries) {
  Simulation simulation(read("throws_whose_intervals_are_rounding"));
  const Vector2d a(-6, -5);
  const Vector2d b(-2, 6);
  const Vector2d inward = -turned(b - a).normalized();
  for (double time = 1.479; time < 1.4801; time += 2e-5) {
    simulation.advance_to(time, {});
    const State state = simulation.state();
    if (state.region == "region_0") {
      EXPECT_GT(inward.dot(state.position - a), -1e-11) << time;
    }
  }
}

// What is left of the throws would take a tenth of a second, in which the last one leads away from the edge.
TEST(Chatter, OfThrowsWithinRoundingLongBeforeTheirLimitIsReported) {
  Simulation simulation(read("chatter_of_throws_within_rounding"));
  time_of_halt(simulation, 1);
  EXPECT_NEAR(simulation.state().position.x(), 4, 1e-12);
}

// A ground throws the sphere back with 0.991 of its speed each time: a series of hundreds of throws, which
// comes to what rounding leaves of a throw before it comes to what the clock tells.
TEST(Chatter, OfThrowsThatHardlyBecomeShorterIsReportedBeforeTheyAreLost) {
  Simulation simulation(read("throws_that_hardly_become_shorter"));
  EXPECT_NEAR(time_of_halt(simulation, 8), 5.7596, 1e-4);
  EXPECT_LT(simulation.switches(), 5000U);
}

// Between a belt and ground that friction just holds the sphere on: its slip begins with less and less of
// what drives it, and would grow for ever.
TEST(Chatter, WhereASlipGrowsByNothingThatIsToldIsReported) {
  scene::Scene scene = read("chatter_at_the_limit_of_friction");
  scene.solver.accuracy = 1e-3;  // thousands of switches until the report: none of them needs more
  Simulation simulation(scene);
  EXPECT_NEAR(time_of_halt(simulation, 8), 7.923, 2e-3);
  EXPECT_LT((simulation.state().position - Vector2d(0, 2)).norm(), 1e-7);
  EXPECT_LT(simulation.evaluations(), 6'000'000U);
}

// The slip that would grow for ever is that of switch 64. Only an accurate path comes that near to it.
TEST(Chatter, PassesASlipThatGrowsByNothingThatIsToldAtABoundedCost) {
  Simulation simulation(read("chatter_at_the_limit_of_friction"));
  simulation.advance_to(7.9232, {});
  EXPECT_GT(simulation.switches(), 100U);
  EXPECT_LT(simulation.evaluations(), 2'000'000U);
}

}  // namespace
}  // namespace hybrid_sphere::testing::chatter_test

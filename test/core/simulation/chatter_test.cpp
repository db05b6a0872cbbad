// Switches without end that shrink like a power of their number, or not at all: they are reported.

#include <gtest/gtest.h>

#include <string>

#include "hybrid_sphere/scene/read_scene.hpp"
#include "support/recorded.hpp"

namespace hybrid_sphere::testing {
namespace {

scene::Scene read(const std::string& name) {
  return scene::read_scene_file(std::string(TEST_DATA_DIR) + "/accumulation/" + name + ".yaml");
}

// Each throw is followed about as far as it reaches, not as far as the forces take to change the motion.
TEST(AChatter, OfThrowsThatBecomeShorterAndShorterCostsLittlePerThrow) {
  Simulation simulation(read("chatter_of_throws"));
  std::size_t switches = 0;
  simulation.advance_to(4.5, [](const Switch&) {});
  const std::size_t before = simulation.evaluations();
  simulation.advance_to(5.5, [&](const Switch&) { ++switches; });
  EXPECT_GT(switches, 1000U);
  EXPECT_LT(simulation.evaluations() - before, 400 * switches);
}

// The friction of both belts drives the sphere to the edge, in n-th intervals of about 1/n.
TEST(AChatter, BetweenTwoCoulombBeltsIsReportedAfterABoundedNumberOfCrossings) {
  Simulation simulation(read("chatter_of_two_coulomb_belts"));
  try {
    simulation.advance_to(1e6, {});
    FAIL() << "no halt";
  } catch (const HaltedError& error) {
    EXPECT_EQ(std::string(error.what()).find("switches accumulate"), 0U) << error.what();
    EXPECT_LT(error.time(), 40);
  }
  EXPECT_LT(simulation.evaluations(), 10'000'000U);
  EXPECT_LT(std::abs(simulation.state().position.x()), 1e-6);
}

// Friction with resistances, a turntable and a spring: the intervals halve until rounding lets them go no
// further.
TEST(AChatter, ThatIsLostInTheRoundingOfThePlaceIsReported) {
  Simulation simulation(read("chatter_of_friction_in_rounding"));
  try {
    simulation.advance_to(8, {});
    FAIL() << "no halt";
  } catch (const HaltedError& error) {
    EXPECT_EQ(std::string(error.what()).find("switches accumulate"), 0U) << error.what();
    EXPECT_NEAR(error.time(), 6.9, 0.1);
  }
  EXPECT_LT(simulation.evaluations(), 3'000'000U);
}

// A belt brings the sphere to the edge of a frictionless slope down which it comes back, until it does so in
// no time.
TEST(AChatter, OfABeltAndASlopeIsReported) {
  Simulation simulation(read("chatter_of_a_belt_and_a_slope"));
  try {
    simulation.advance_to(8, {});
    FAIL() << "no halt";
  } catch (const HaltedError& error) {
    EXPECT_NE(std::string(error.what()).find("no motion along"), std::string::npos) << error.what();
    EXPECT_NEAR(error.time(), 6.882, 1e-3);
  }
  EXPECT_LT(simulation.switches(), 20'000U);
}

// A belt's friction and a spring drive the sphere to the corner of the belt from both sides.
TEST(AChatter, ThroughACornerIsReported) {
  Simulation simulation(read("chatter_through_a_corner"));
  try {
    simulation.advance_to(8, {});
    FAIL() << "no halt";
  } catch (const HaltedError& error) {
    EXPECT_NE(std::string(error.what()).find("no motion along"), std::string::npos) << error.what();
    EXPECT_NEAR(error.time(), 7.226, 1e-3);
  }
  EXPECT_LT(simulation.switches(), 20'000U);
}

// From rest on the edge the intervals begin with a nanosecond, and hardly shrink.
TEST(AChatter, OfShortIntervalsFromTheBeginningIsReported) {
  Simulation simulation(read("chatter_from_rest"));
  try {
    simulation.advance_to(8, {});
    FAIL() << "no halt";
  } catch (const HaltedError& error) {
    EXPECT_NE(std::string(error.what()).find("no motion along"), std::string::npos) << error.what();
    EXPECT_NEAR(error.time(), 0.04167, 1e-5);
  }
  EXPECT_LT(simulation.evaluations(), 10'000'000U);
}

// Two grounds on the two sides of a corner throw the sphere back in turn, into friction that takes it there.
TEST(AChatter, OfThrowsInACornerIsReported) {
  Simulation simulation(read("chatter_of_throws_in_a_corner"));
  try {
    simulation.advance_to(8, {});
    FAIL() << "no halt";
  } catch (const HaltedError& error) {
    EXPECT_NE(std::string(error.what()).find("no motion along"), std::string::npos) << error.what();
  }
  EXPECT_LT((simulation.state().position - Vector2d(0, -1)).norm(), 1e-7);
  EXPECT_LT(simulation.evaluations(), 50'000'000U);
}

// Three intervals that rounding lets shrink are no geometric series, after which the sphere would leave the
// edge.
TEST(AChatter, WhoseIntervalsAreRoundedIsNoGeometricSeries) {
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
TEST(AChatter, OfThrowsWithinRoundingLongBeforeTheirLimitIsReported) {
  Simulation simulation(read("chatter_of_throws_within_rounding"));
  try {
    simulation.advance_to(1, {});
    FAIL() << "no halt";
  } catch (const HaltedError& error) {
    EXPECT_NE(std::string(error.what()).find("no motion along"), std::string::npos) << error.what();
  }
  EXPECT_NEAR(simulation.state().position.x(), 4, 1e-12);
}

}  // namespace
}  // namespace hybrid_sphere::testing

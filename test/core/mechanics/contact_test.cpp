// Unilateral constraints: landing, bouncing, sliding, rolling, lifting off.
#include <gtest/gtest.h>

#include <cmath>

#include "core/mechanics/contact_systems.hpp"
#include "hybrid_sphere/mechanics/plant.hpp"
#include "hybrid_sphere/mechanics/solve.hpp"

namespace hybrid_sphere::mechanics::contact_test {
namespace {

using testing::gravity;

class Contact : public ::testing::TestWithParam<double> {
 protected:
  Options options() const {
    Options options;
    options.accuracy = GetParam();
    return options;
  }
};

TEST_P(Contact, OfABouncingBallEndsAtItsZenoTime) {
  for (const double e : {0.3, 0.8}) {
    const Solution motion = solve(testing::bouncing_ball(e), {0, {1.0}, {0.0}}, 5, options());
    ASSERT_EQ(motion.status().stop, Stop::reached_end) << motion.status().message;
    const double first = std::sqrt(2 / gravity);
    double time = first;
    double speed = gravity * first;
    for (std::size_t i = 0; i < 10; ++i) {
      const Switch& bounce = motion.switches().at(i);
      EXPECT_NEAR(bounce.time, time, 2 * GetParam()) << i;
      EXPECT_NEAR(bounce.v_after[0], e * speed, 5 * GetParam()) << i;
      EXPECT_NEAR(bounce.multipliers[0], (1 + e) * speed, 10 * GetParam()) << i;
      EXPECT_TRUE(bounce.applied.empty() && bounce.released.empty());
      speed *= e;
      time += 2 * speed / gravity;
    }
    const Switch& last = motion.switches().back();
    EXPECT_NEAR(last.time, first * (1 + e) / (1 - e), 2 * GetParam());
    EXPECT_EQ(last.applied, ActiveSet{0});
    const State end = motion.at(5);
    EXPECT_EQ(end.q[0], 0);
    EXPECT_EQ(end.v[0], 0);
    EXPECT_NEAR(end.multipliers[0], gravity, 1e-13);
  }
}

// Where the floor is not at 0, bounces lower than the rounding of its height are none.
TEST_P(Contact, OfABallOnAHighFloorComesToRest) {
  const Solution motion = solve(testing::bouncing_ball(0.5, 100), {0, {101.0}, {0.0}}, 5, options());
  ASSERT_EQ(motion.status().stop, Stop::reached_end) << motion.status().message;
  EXPECT_NEAR(motion.switches().back().time, 3 * std::sqrt(2 / gravity), 2 * GetParam() + 1e-6);
  EXPECT_LT(motion.switches().size(), 60u);
  EXPECT_EQ(motion.at(5).active, ActiveSet{0});
}

// The impulse of the ground stops the fall, and that of friction makes the slip less by 3 mu of it; then it
// slides until v = omega.
TEST_P(Contact, OfADiskThatLandsSlidesThenRolls) {
  constexpr double mu = 0.2, speed = 3, height = 0.5;
  const Solution motion =
      solve(testing::disk_on_level_ground(mu), {0, {0, 1 + height, 0}, {speed, 0, 0}}, 3, options());
  ASSERT_EQ(motion.status().stop, Stop::reached_end) << motion.status().message;
  ASSERT_EQ(motion.switches().size(), 2u);
  const double tolerance = 5 * GetParam();
  const Switch& landing = motion.switches()[0];
  const double fall = std::sqrt(2 * gravity * height);
  EXPECT_NEAR(landing.time, fall / gravity, tolerance);
  EXPECT_EQ(landing.applied, ActiveSet{0});
  EXPECT_EQ(landing.sliding, (Slides{{1, 1}}));
  EXPECT_NEAR(landing.multipliers[0], fall, tolerance);
  EXPECT_NEAR(landing.multipliers[1], -mu * fall, tolerance);
  EXPECT_NEAR(landing.v_after[0], speed - mu * fall, tolerance);
  EXPECT_NEAR(landing.v_after[2], 2 * mu * fall, tolerance);
  const Switch& rolling = motion.switches()[1];
  EXPECT_NEAR(rolling.time - landing.time, (speed - 3 * mu * fall) / (3 * mu * gravity), tolerance);
  EXPECT_EQ(rolling.applied, ActiveSet{1});
  EXPECT_NEAR(motion.at(3).v[0], speed * 2 / 3, tolerance);
  const State sliding = motion.at((landing.time + rolling.time) / 2);
  EXPECT_NEAR(sliding.multipliers[1], -mu * gravity, tolerance);
  EXPECT_NEAR(motion.at(3).q[1], 1, 1e-15);
}

// Great friction: it rolls from the landing on, as the bilateral constraint makes it.
TEST_P(Contact, OfADiskOnRoughGroundRollsAtOnce) {
  const Solution motion = solve(testing::disk_on_level_ground(10), {0, {0, 1.5, 0}, {3, 0, 0}}, 3, options());
  ASSERT_EQ(motion.switches().size(), 1u);
  EXPECT_EQ(motion.switches()[0].applied, (ActiveSet{0, 1}));
  EXPECT_NEAR(motion.switches()[0].v_after[0], 2, 5 * GetParam());
  EXPECT_NEAR(motion.switches()[0].v_after[2], 2, 5 * GetParam());
}

// On the way down from the crest the speed grows by v'^2 3/4 = g R (1 - c), c the cosine; the ground has to
// give friction sin/3 and the load g c - v^2/R, so that grip is lost where sin/3 = mu (c - v^2/(g R)).
TEST_P(Contact, OfADiskOverACrestLosesItsGripThenLiftsOff) {
  constexpr double mu = 0.3, R = 4, speed = 1;
  const Solution motion =
      solve(testing::disk_on_a_cylinder(mu, R), {0, {0, R, 0}, {speed, 0, speed}}, 3, options());
  ASSERT_EQ(motion.status().stop, Stop::reached_end) << motion.status().message;
  ASSERT_GE(motion.switches().size(), 2u);
  EXPECT_EQ(motion.at(0).active, (ActiveSet{0, 1}));
  const Switch& slip = motion.switches()[0];
  EXPECT_EQ(slip.released, ActiveSet{1});
  const double c = slip.q[1] / R;
  const double s = slip.q[0] / R;
  const double squared = speed * speed + 4.0 / 3 * gravity * R * (1 - c);
  EXPECT_NEAR(slip.v_after.head(2).squaredNorm(), squared, 50 * GetParam());
  EXPECT_NEAR(s / 3, mu * (c - squared / (gravity * R)), 50 * GetParam());
  EXPECT_EQ(slip.v_after, slip.v_before);
  const Switch& lift_off = motion.switches()[1];
  EXPECT_EQ(lift_off.released, ActiveSet{0});
  EXPECT_TRUE(lift_off.sliding.empty());
  // The load is used up: g c = v^2/R.
  EXPECT_NEAR(gravity * lift_off.q[1] / R, lift_off.v_after.head(2).squaredNorm() / R, 50 * GetParam());
  EXPECT_EQ(motion.at(lift_off.time).stage, 1);
  EXPECT_GT(motion.at(lift_off.time + 0.1).q.head(2).norm(), R);
}

INSTANTIATE_TEST_SUITE_P(AtEachAccuracy, Contact, ::testing::Values(1e-6, 1e-9, 1e-12));

TEST(ContactOfAPlant, IsThatOfOneMotionInAnyPeriods) {
  const Model model = testing::disk_on_level_ground(0.2, 0.4);
  const Initial start{0, {0, 1.5, 0}, {3, 0, 0}};
  Plant whole(model, start);
  std::vector<Switch> all;
  whole.advance(2, [&](const Switch& s) { all.push_back(s); });
  ASSERT_GT(all.size(), 5u);
  Plant parts(model, start);
  std::size_t count = 0;
  for (int i = 1; i <= 2000; ++i) {
    const Status status = parts.advance(0.001 * i, [&](const Switch& s) {
      ASSERT_LT(count, all.size());
      EXPECT_EQ(s.time, all[count].time);
      EXPECT_EQ(s.v_after, all[count].v_after);
      ++count;
    });
    ASSERT_EQ(status.stop, Stop::reached_end) << status.message;
  }
  EXPECT_EQ(count, all.size());
  EXPECT_EQ(parts.state().q, whole.state().q);
}

TEST(ContactOfAPlant, GoesOnFromASavedState) {
  const Model model = testing::disk_on_a_cylinder(0.3, 4);
  Plant plant(model, {0, {0, 4, 0}, {1, 0, 1}});
  std::vector<double> times;
  const auto note = [&](const Switch& s) { times.push_back(s.time); };
  plant.advance(0.3, note);
  const Plant::Snapshot snapshot = plant.save();
  plant.advance(2, note);
  const Vector q = plant.state().q;
  const std::vector<double> first = std::exchange(times, {});
  plant.restore(snapshot);
  plant.advance(2, note);
  ASSERT_EQ(times.size(), first.size());
  for (std::size_t i = 0; i < times.size(); ++i) EXPECT_NEAR(times[i], first[i], 1e-8);
  EXPECT_NEAR((plant.state().q - q).norm(), 0, 1e-7);
}

// The motion has been computed beyond the present, to a change of what holds that has not come yet.
TEST(ContactOfAPlant, ForgetsWhatIsAheadOfASavedState) {
  const Model model = testing::disk_on_a_cylinder(0.3, 4);
  const Initial start{0, {0, 4, 0}, {1, 0, 1}};
  const double slips = solve(model, start, 2).switches().at(0).time;
  for (const double before : {1e-1, 1e-2, 1e-3, 1e-4}) {
    Plant plant(model, start);
    const auto unexpected = [](const Switch& s) { ADD_FAILURE() << s.time; };
    plant.advance(slips - before, unexpected);
    plant.restore(plant.save());
    plant.advance(slips - before / 2, unexpected);
    EXPECT_EQ(plant.state().active, (ActiveSet{0, 1}));
  }
}

// With what holds, and without: the remaining switches are those of the whole motion.
TEST(ContactOfAMotion, GoesOnFromItsOwnStates) {
  const Model model = testing::disk_on_a_cylinder(0.3, 4);
  const Solution whole = solve(model, {0, {0, 4, 0}, {1, 0, 1}}, 1.5);
  for (int i = 0; i < 30; ++i) {
    const State now = whole.at(0.05 * i);
    std::size_t left = 0;
    for (const Switch& s : whole.switches()) left += s.time > now.time ? 1 : 0;
    for (const bool is_known : {true, false}) {
      Initial initial{now.time, now.q, now.v};
      if (is_known) initial.active = now.active;
      const Solution part = solve(model, initial, 1.5 - now.time);
      ASSERT_EQ(part.status().stop, Stop::reached_end) << part.status().message;
      ASSERT_EQ(part.switches().size(), left) << now.time << ' ' << is_known;
      EXPECT_EQ(part.at(now.time).active, now.active) << now.time << ' ' << is_known;
    }
  }
}

// A step after whose end guards are looked for may be interrupted there, too.
TEST(ContactOfAPlant, IsTheSameAfterInterruptions) {
  const Model model = testing::rod(0.3, 0.4);
  const Initial start{0, {0, 1.5, 0.4}, {1, 0, 0.5}};
  const auto switches = [&](const Options& options) {
    std::vector<double> all;
    Plant plant(model, start, options);
    for (;;) {
      const Status status = plant.advance(2, [&](const Switch& s) {
        all.push_back(s.time);
        for (const double v : s.v_after) all.push_back(v);
      });
      if (status.stop != Stop::cancelled) break;
    }
    return all;
  };
  const std::vector<double> whole = switches({});
  ASSERT_GT(whole.size(), 20u);
  Options interrupted;
  int calls = 0;
  interrupted.monitor = [&](const Progress&) { return ++calls % 3 != 0; };
  EXPECT_EQ(switches(interrupted), whole);
}

// A ball that lies on the floor is hit by one that falls on it: the floor gives back what it has taken.
TEST(ContactOfTwoBalls, AtRestBouncesWhereItIsPressed) {
  System<2> balls({"low", "high"}, [](auto, const auto& q, const auto& v) {
    return (v[0] * v[0] + v[1] * v[1]) / 2 - testing::gravity * (q[0] + q[1]);
  });
  balls.unilateral(
      "floor", [](const auto&, const auto& q) { return q[0]; }, 1);
  balls.unilateral(
      "between", [](const auto&, const auto& q) { return q[1] - q[0] - 1.0; }, 0);
  const Solution motion = solve(balls, {0, {0, 2}, {0, 0}}, 0.6);
  const double speed = std::sqrt(2 * gravity);
  ASSERT_GE(motion.switches().size(), 1u);
  const Switch& hit = motion.switches()[0];
  EXPECT_NEAR(hit.multipliers[0], 2 * speed, 1e-8);
  EXPECT_NEAR(hit.v_after[0], speed / 2, 1e-8);
  EXPECT_NEAR(hit.v_after[1], speed / 2, 1e-8);
}

TEST(ContactOfAModel, RefusesAStartInOverlap) {
  for (const double speed : {-1.0, 0.0, 1.0}) {
    try {
      solve(testing::bouncing_ball(0.5), {0, {-1.0}, {speed}}, 1);
      ADD_FAILURE() << "not refused";
    } catch (const std::invalid_argument& error) {
      EXPECT_NE(std::string(error.what()).find("the initial gap of constraint floor = -1"), std::string::npos)
          << error.what();
    }
  }
}

TEST(ContactOfAnInput, IsRefusedWhereItOverlapsAndOpensWhereTheFloorGoesDown) {
  const auto floor = [](const Vector& input) { return testing::bouncing_ball(0, input[0]); };
  Plant plant(floor, {0.0}, {0, {0.0}, {0.0}});
  plant.advance(1);
  EXPECT_THROW(plant.set_input({0.1}), std::invalid_argument);
  EXPECT_EQ(plant.input()[0], 0);
  plant.advance(2);
  EXPECT_EQ(plant.state().q[0], 0);
  EXPECT_THROW(plant.set_input({-0.1}), std::invalid_argument);
  const auto other = [](const Vector& input) {
    return input[0] > 0
               ? testing::bouncing_ball(0)
               : Model(System<1>({"z"}, [](auto, const auto&, const auto& v) { return v[0] * v[0] / 2; })
                           .constrain(
                               "floor", [](auto, const auto&, const auto& v) { return v[0]; }, always()));
  };
  Plant changes(other, {1.0}, {0, {1.0}, {0.0}});
  EXPECT_THROW(changes.set_input({0.0}), std::invalid_argument);
}

TEST(ContactOfARod, WithGreatFrictionIsPainlevesParadox) {
  // For mu above 4/3 there are angles at which a sliding end would be pressed into the ground.
  constexpr double angle = 1.1;
  const Model model = testing::rod(2, 0);
  const Solution motion = solve(model, {0, {0, std::sin(angle), angle}, {-20, 0, 0}}, 1);
  EXPECT_EQ(motion.status().stop, Stop::painleve) << motion.status().message;
  EXPECT_NE(motion.status().message.find("Painleve"), std::string::npos);
}

TEST(Contact, IsFoundWithFewEvaluations) {
  System<2> ball({"x", "z"}, [](const auto&, const auto& q, const auto& v) {
    return (v[0] * v[0] + v[1] * v[1]) / 2 - 9.81 * q[1];
  });
  ball.unilateral(
      "floor", [](const auto&, const auto& q) { return q[1]; }, 0.9);
  for (const double accuracy : {1e-6, 1e-9, 1e-12}) {
    Options options;
    options.accuracy = accuracy;
    const Solution motion = solve(ball, {0, {0, 1}, {1, 0}}, 5, options);
    ASSERT_EQ(motion.switches().size(), 8u);
    EXPECT_LE(motion.evaluations(), 8 * 150) << accuracy;  // a step takes 13
  }
}

TEST(Contact, OfABallBetweenWallsThatCloseIsAContradiction) {
  System<1> ball({"x"}, [](const auto&, const auto&, const auto& v) { return v[0] * v[0] / 2; });
  ball.unilateral("left", [](const auto& t, const auto& q) { return q[0] - t; });
  ball.unilateral("right", [](const auto&, const auto& q) { return 1 - q[0]; });
  const Solution motion = solve(ball, {0, {0.5}, {0}}, 3);
  EXPECT_EQ(motion.status().stop, Stop::inconsistent) << motion.status().message;
  EXPECT_NEAR(motion.end(), 1, 1e-12);
  EXPECT_NE(motion.status().message.find("left, right contradict each other"), std::string::npos)
      << motion.status().message;
}

}  // namespace
}  // namespace hybrid_sphere::mechanics::contact_test

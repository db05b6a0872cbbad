// Solution::estimated_error beside the errors of motions with a closed form, and what no accuracy can reach.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "core/mechanics/particle.hpp"
#include "hybrid_sphere/mechanics/plant.hpp"

namespace hybrid_sphere::mechanics::estimated_error_test {
namespace {

using testing::accurate;
using testing::particle;
using testing::vector;

/// A motion with a closed form.
struct Case {
  std::string name;
  Model model;
  Initial start;
  double duration;
  std::function<Vector(double)> exact;  // q and v
  Vector scale;                         // of them: the largest distances from the start, the greatest speed
};

Case oscillation(double duration) {
  System<1> model({"x"}, [](auto, const auto& q, const auto& v) { return (v[0] * v[0] - q[0] * q[0]) / 2; });
  const auto exact = [](double t) { return vector({std::cos(t), -std::sin(t)}); };
  return {"oscillation", model, {0, {1.0}, {0.0}}, duration, exact, vector({2, 1})};
}

/// A pendulum that is released from the level. Its angle from below is 2 asin(k sn(K - t)), k = sin(45 deg);
/// sn is known at eighths of the period 4 K.
struct LevelPendulum {
  const double k = std::sqrt(0.5), K = std::comp_ellint_1(k);

  /// Angle and rate at t, a multiple of K/2.
  Eigen::Vector2d at(double t) const {
    const double s = k / std::sqrt(1 + k);
    const double values[8] = {k, s, 0, -s, -k, -s, 0, s};
    const long i = std::lround(2 * t / K) % 8;
    const double angle = 2 * std::asin(values[i]);
    const double speed = i % 4 == 0 ? 0 : std::sqrt(2 * std::cos(angle));
    return {angle, i < 4 ? -speed : speed};
  }
};

Case pendulum(int periods) {
  const LevelPendulum level;
  System<1> model({"a"}, [](auto, const auto& q, const auto& v) {
    using std::cos;
    return v[0] * v[0] / 2 + cos(q[0]);
  });
  const auto exact = [=](double t) { return Vector(level.at(t)); };
  return {
      "pendulum", model, {0, {M_PI / 2}, {0.0}}, 4 * level.K * periods, exact, vector({M_PI, std::sqrt(2)})};
}

Case pendulum_on_a_rod() {
  const LevelPendulum level;
  System<2> model = particle(1);
  model.holonomic(
      "rod", [](auto, const auto& q) { return q.squaredNorm() - 1; }, always());
  const auto exact = [=](double t) {
    const Eigen::Vector2d angle = level.at(t);
    const double s = std::sin(angle[0]), c = std::cos(angle[0]);
    return vector({s, -c, angle[1] * c, angle[1] * s});
  };
  const double speed = std::sqrt(2);
  return {"pendulum on a rod", model, {0, {1, 0}, {0, 0}}, 4 * level.K, exact, vector({2, 1, speed, speed})};
}

/// abs(cos t)
Case spring_against_a_wall(double duration) {
  System<1> model({"x"}, [](auto, const auto& q, const auto& v) { return (v[0] * v[0] - q[0] * q[0]) / 2; });
  model.unilateral(
      "wall", [](auto, const auto& q) { return q[0]; }, 1);
  const auto exact = [](double t) {
    return vector({std::abs(std::cos(t)), std::cos(t) > 0 ? -std::sin(t) : std::sin(t)});
  };
  return {"spring against a wall", model, {0, {1.0}, {0.0}}, duration, exact, vector({1, 1})};
}

Case bouncing_ball() {
  constexpr double gravity = 9.81;
  System<2> model = particle(gravity);
  model.unilateral(
      "floor", [](auto, const auto& q) { return q[1]; }, 1);
  const double fall = std::sqrt(2 / gravity), speed = gravity * fall;
  const auto exact = [=](double t) {
    const double s = t - 2 * fall * std::floor((t + fall) / (2 * fall));
    return vector({t, 1 - gravity * s * s / 2, 1, -gravity * s});
  };
  return {"bouncing ball", model, {0, {0, 1}, {1, 0}}, 5, exact, vector({5, 1, speed, speed})};
}

/// On a circle.
Case rolling_disc() {
  constexpr double R = 0.5;
  System<4> model({"x", "y", "theta", "phi"}, [=](auto, const auto&, const auto& v) {
    return (v[0] * v[0] + v[1] * v[1] + R * R * (v[2] * v[2] / 4 + v[3] * v[3] / 2)) / 2;
  });
  model.constrain(
      "rolling",
      [=](auto t, const auto& q, const auto& v) {
        using std::cos, std::sin;
        return Eigen::Matrix<decltype(t), 2, 1>(v[0] - R * v[3] * cos(q[2]), v[1] - R * v[3] * sin(q[2]));
      },
      always());
  const auto exact = [](double t) {
    const double s = std::sin(t), c = std::cos(t);
    return vector({s, 1 - c, t, t / R, c, s, 1, 1 / R});
  };
  const double speed = std::sqrt(1 + R * R / 4 + 0.5);
  return {"rolling disc",
          model,
          {0, vector({0, 0, 0, 0}), vector({1, 0, 1, 1 / R})},
          10,
          exact,
          vector({1, 2, 10, 20, speed, speed, 2 / R * speed, std::sqrt(2) / R * speed})};
}

/// A circular motion on a spring that is forced onto a rail along (0.8, 0.6) at t = 1.
Case kicked_onto_a_rail() {
  System<2> model({"x", "y"},
                  [](auto, const auto& q, const auto& v) { return (v.squaredNorm() - q.squaredNorm()) / 2; });
  model.constrain(
      "rail", [](auto, const auto&, const auto& v) { return 0.6 * v[0] - 0.8 * v[1]; }, from(1));
  const auto exact = [](double t) {
    const double s = std::sin(std::min(t, 1.0)), c = std::cos(std::min(t, 1.0));
    if (t < 1) return vector({c, s, -s, c});
    const double along = 0.8 * c + 0.6 * s, speed = -0.8 * s + 0.6 * c;
    const double way = along * (std::cos(t - 1) - 1) + speed * std::sin(t - 1);
    const double rate = -along * std::sin(t - 1) + speed * std::cos(t - 1);
    return vector({c + 0.8 * way, s + 0.6 * way, 0.8 * rate, 0.6 * rate});
  };
  return {"kicked onto a rail", model, {0, {1, 0}, {0, 1}}, 10, exact, vector({2, 2, 1, 1})};
}

std::vector<Case> cases() {
  return {oscillation(10),           pendulum(1),     pendulum(10),   pendulum_on_a_rod(),
          spring_against_a_wall(10), bouncing_ball(), rolling_disc(), kicked_onto_a_rail()};
}

/// The largest error up to the end, relative to the scale, at eight instants.
double error_of(const Case& one, const Solution& motion) {
  double error = 0;
  for (int i = 1; i <= 8; ++i) {
    const double t = std::min(one.duration * i / 8, motion.end());
    const State state = motion.at(t);
    Vector found(one.scale.size());
    found << state.q, state.v;
    error = std::max(error, ((found - one.exact(t)).array() / one.scale.array()).abs().maxCoeff());
  }
  return error;
}

// A local error is estimated from above, by up to 100 times, and grows linearly, which not all errors do.
// Where errors cancel, as those of a disc on a circle do, it is still a small part of the accuracy.
TEST(EstimatedError, IsAtLeastTheErrorAndAtMost2000Times) {
  for (const Case& one : cases()) {
    for (const double accuracy : {1e-3, 1e-5, 1e-7, 1e-9, 1e-10, 1e-11, 1e-12, 1e-13}) {
      const Solution motion = solve(one.model, one.start, one.duration, accurate(accuracy));
      ASSERT_EQ(motion.status().stop, Stop::reached_end) << one.name << motion.status().message;
      const double error = error_of(one, motion);
      EXPECT_GE(motion.estimated_error(), error) << one.name << " at " << accuracy;
      EXPECT_LE(motion.estimated_error(), std::max(2000 * error, accuracy / 8))
          << one.name << " at " << accuracy;
    }
  }
}

// Some hundreds of steps, each of which rounds to 1e-16 of the scale.
TEST(EstimatedError, IsGreaterThanAnAccuracyThatRoundOffUndercuts) {
  for (const Case& one : cases()) {
    const Solution motion = solve(one.model, one.start, one.duration, accurate(1e-13));
    EXPECT_GT(motion.estimated_error(), 1e-13) << one.name;
  }
  const Case turns = oscillation(1000);
  for (const double accuracy : {1e-10, 1e-11, 1e-12}) {
    EXPECT_GT(solve(turns.model, turns.start, turns.duration, accurate(accuracy)).estimated_error(),
              accuracy);
  }
}

TEST(EstimatedError, IsWithinAnAccuracyThatRoundOffAllows) {
  for (const Case& one : cases()) {
    for (const double accuracy : {1e-3, 1e-6, 1e-9}) {
      const Solution motion = solve(one.model, one.start, one.duration, accurate(accuracy));
      EXPECT_LE(motion.estimated_error(), accuracy) << one.name;
    }
  }
}

// The accuracies of a long motion lead below the round-off of a step: down to that they still act. A pendulum
// that nearly stands still upright, ten times, keeps its energy the better.
TEST(EstimatedError, FollowsTheAccuracyAlsoBelowTheDefault) {
  const Case one = pendulum(1);
  const auto drift = [&](double accuracy) {
    const Solution motion = solve(one.model, {0, {3.1}, {0.0}}, 100, accurate(accuracy));
    return std::abs(motion.at(100).energy - motion.at(0).energy);
  };
  EXPECT_LE(drift(1e-10), 0.5 * drift(1e-9));
}

TEST(EstimatedError, OfAStateIsThatUpToItsTime) {
  const Case one = oscillation(50);
  const Solution motion = solve(one.model, one.start, one.duration, accurate(1e-6));
  EXPECT_EQ(motion.at(0).estimated_error, 0);
  EXPECT_EQ(motion.at(50).estimated_error, motion.estimated_error());
  EXPECT_LT(motion.at(25).estimated_error, 0.5 * motion.estimated_error());
  for (double t = 0.01; t <= 50; t += 0.01) {
    const State state = motion.at(t);
    const Vector exact = one.exact(t);
    const double error = std::max(std::abs(state.q[0] - exact[0]) / 2, std::abs(state.v[0] - exact[1]));
    EXPECT_GE(state.estimated_error, error) << t;
  }
}

TEST(EstimatedError, OfAPlantIsThatOfTheSolution) {
  const Case one = spring_against_a_wall(10);
  const Solution motion = solve(one.model, one.start, one.duration, accurate(1e-6));
  Plant plant(one.model, one.start, accurate(1e-6), one.duration);
  for (const double t : {0.7, 3.0, 7.0}) {
    plant.advance(t);
    EXPECT_EQ(plant.state().estimated_error, motion.at(t).estimated_error) << t;
  }
}

TEST(EstimatedError, OfAPlantIsKeptByInputsAndSnapshots) {
  const Case one = oscillation(10);
  Plant plant([&](const Vector&) { return one.model; }, {0.0}, one.start, accurate(1e-6));
  plant.advance(3);
  const double error = plant.state().estimated_error;
  EXPECT_GT(error, 0);
  const Plant::Snapshot then = plant.save();
  plant.set_input({1.0});
  EXPECT_EQ(plant.state().estimated_error, error);
  plant.advance(5);
  EXPECT_GT(plant.state().estimated_error, error);
  plant.restore(then);
  EXPECT_EQ(plant.state().estimated_error, error);
}

/// Flies at a height of 0.5 over a pillar of a height of 1 at x = 5, as wide as 0.01.
System<2> flight_over_a_pillar() {
  System<2> model = particle(0);
  model.unilateral("pillar", [](auto, const auto& q) {
    using std::exp;
    const auto x = (q[0] - 5) / 0.01;
    return q[1] - exp(-x * x);
  });
  return model;
}

TEST(Penetration, OfAContactThatAStepHasMissedIsReported) {
  const Solution motion = solve(flight_over_a_pillar(), {0, {0, 0.5}, {1, 0}}, 10);
  ASSERT_EQ(motion.status().stop, Stop::reached_end);
  ASSERT_TRUE(motion.switches().empty()) << "the step is too long for the pillar";
  for (const double t : {0.0, 4.0, 6.0, 10.0}) EXPECT_EQ(motion.at(t).penetrating, ActiveSet{}) << t;
  for (const double t : {4.995, 5.0, 5.005}) EXPECT_EQ(motion.at(t).penetrating, ActiveSet{0}) << t;
}

TEST(Penetration, IsNoneInShorterSteps) {
  Options options;
  options.max_step = 0.01;
  const Solution motion = solve(flight_over_a_pillar(), {0, {0, 0.5}, {1, 0}}, 10, options);
  ASSERT_FALSE(motion.switches().empty());
  EXPECT_NEAR(motion.switches()[0].q[0], 5 - 0.01 * std::sqrt(std::log(2.0)), 1e-9);
  for (double t = 0; t <= motion.end(); t += 0.001) EXPECT_EQ(motion.at(t).penetrating, ActiveSet{}) << t;
}

// Contacts that close, bounce to rest and stay closed have gaps of round-off, not penetrations.
TEST(Penetration, IsNoneOfContactsThatCloseOrHold) {
  System<2> ball = particle(9.81);
  ball.unilateral(
      "floor", [](auto, const auto& q) { return q[1] - 0.3 * q[0]; }, 0.5);
  const Solution motion = solve(ball, {0, {0, 1}, {1, 0}}, 3);
  ASSERT_GT(motion.switches().size(), 10u);
  for (const Switch& event : motion.switches())
    EXPECT_EQ(motion.at(event.time).penetrating, ActiveSet{}) << event.time;
  for (double t = 0; t <= motion.end(); t += 0.01) EXPECT_EQ(motion.at(t).penetrating, ActiveSet{}) << t;
}

TEST(Penetration, OfAPlantIsReported) {
  Plant plant(flight_over_a_pillar(), {0, {0, 0.5}, {1, 0}});
  plant.advance(5);
  EXPECT_EQ(plant.state().penetrating, ActiveSet{0});
  plant.advance(6);
  EXPECT_EQ(plant.state().penetrating, ActiveSet{});
}

}  // namespace
}  // namespace hybrid_sphere::mechanics::estimated_error_test

// Guards whose rates have noise, as finite differences have: they change their sign thousands of times in one
// step.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <utility>

#include "core/mechanics/particle.hpp"
#include "hybrid_sphere/mechanics/by_hand.hpp"
#include "hybrid_sphere/mechanics/solve.hpp"
#include "support/interrupted.hpp"

namespace hybrid_sphere::mechanics::noisy_guard_test {
namespace {

using testing::vector;

constexpr double infinity = std::numeric_limits<double>::infinity();

/// A sin(t + 4), its rate by a central difference. It is negative until 2 pi - 4 = 2.28.
class SineByDifferences final : public Guard {
 public:
  explicit SineByDifferences(double amplitude) : amplitude_(amplitude) {}

  double value(double t, const Vector&) const override { return amplitude_ * std::sin(t + 4); }
  double rate(double t, const Vector&, const Vector&) const override {
    constexpr double h = 1e-7;
    return amplitude_ * (std::sin(t + h + 4) - std::sin(t - h + 4)) / (2 * h);
  }

 private:
  double amplitude_;
};

/// A free particle in the plane; y' = 0 where the guard is positive.
Model levelled(double amplitude) {
  Model model;
  model.coordinates = {"x", "y"};
  model.velocities = {"x_dot", "y_dot"};
  model.equations = equations_by_hand(2, 2, [](double, const Vector&, const Vector& v, MotionTerms& terms) {
    terms.lagrangian = v.squaredNorm() / 2;
    terms.rate = v;
    terms.momentum = v;
    terms.mass.setIdentity();
    terms.force.setZero();
  });
  const auto level = constraint_by_hand(
      1, [](double, const Vector&, const Vector& v, const Vector&, ConstraintTerms& terms) {
        terms.value = v.tail(1);
        terms.gradient << 0, 1;
        terms.gamma.setZero();
      });
  model.constraints.push_back(
      {"level", level, {-infinity, infinity, std::make_shared<SineByDifferences>(amplitude)}});
  return model;
}

TEST(NoisyGuard, IsLookedAtABoundedNumberOfTimes) {
  const Initial start{0, vector({0, 0}), vector({1, 1})};
  for (const double amplitude : {1e-50, 1.0, 1e50}) {
    SCOPED_TRACE(amplitude);
    std::uint64_t asked = 0;
    Options options;
    options.monitor = [&](const Progress&) { return ++asked < 100000; };
    const Solution solution = solve(levelled(amplitude), start, 3, options);
    EXPECT_EQ(solution.status().stop, Stop::reached_end) << solution.status().message;
    ASSERT_EQ(solution.switches().size(), 1u);
    EXPECT_NEAR(solution.switches()[0].time, 2 * M_PI - 4, 1e-12);
    EXPECT_GT(asked, 0u);
  }
}

// A thousand guards in one step: the monitor is asked within it.
TEST(Monitor, IsAskedDuringAStepThatTakesLong) {
  Model model = levelled(1e50);
  for (int i = 0; i < 50; ++i) {
    model.constraints.push_back(model.constraints.front());
    model.constraints.back().name += std::to_string(i);
  }
  const hybrid_sphere::testing::QuestionsEvery questions(8);
  std::uint64_t last = std::numeric_limits<std::uint64_t>::max();
  std::uint64_t within = 0;  // one step, after the first time
  Options options;
  options.monitor = [&](const Progress& progress) {
    if (std::exchange(last, progress.steps) == progress.steps) ++within;
    return within < 3;
  };
  const Solution solution = solve(model, {0, vector({0, 0}), vector({1, 1})}, 3, options);
  EXPECT_EQ(within, 3U);
  EXPECT_EQ(solution.status().stop, Stop::cancelled);
}

}  // namespace
}  // namespace hybrid_sphere::mechanics::noisy_guard_test

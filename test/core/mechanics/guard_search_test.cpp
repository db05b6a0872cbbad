// No change of a guard is missed, however its zeros lie: against guards whose zeros are known.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <random>
#include <vector>

#include "core/mechanics/particle.hpp"
#include "hybrid_sphere/mechanics/by_hand.hpp"
#include "hybrid_sphere/mechanics/solve.hpp"

namespace hybrid_sphere::mechanics {
namespace {

using testing::vector;

/// (x - x_1) (x - x_2) ... times a factor.
class Product final : public Guard {
 public:
  Product(std::vector<double> zeros, double factor) : zeros_(std::move(zeros)), factor_(factor) {}

  double value(double, const Vector& q) const override {
    double product = factor_;
    for (const double zero : zeros_) product *= q[0] - zero;
    return product;
  }
  double rate(double, const Vector& q, const Vector& q_rate) const override {
    double sum = 0;
    for (std::size_t i = 0; i < zeros_.size(); ++i) {
      double product = factor_ * q_rate[0];
      for (std::size_t k = 0; k < zeros_.size(); ++k) product *= k == i ? 1 : q[0] - zeros_[k];
      sum += product;
    }
    return sum;
  }

 private:
  std::vector<double> zeros_;
  double factor_;
};

/// A particle that flies along x with the speed 1; y' = 0 where the guard is positive.
Model flying(std::shared_ptr<const Guard> guard) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
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
  model.constraints.push_back({"level", level, {-infinity, infinity, std::move(guard)}});
  return model;
}

TEST(GuardSearch, MissesNoneOfTheZerosOfPolynomials) {
  std::mt19937 engine(17);
  const auto number = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(engine);
  };
  for (int n = 0; n < 300; ++n) {
    SCOPED_TRACE(n);
    // Some in pairs, as close as a thousandth to a ten-thousandth of the way.
    std::vector<double> zeros;
    const int count = 1 + n % 5;
    while (static_cast<int>(zeros.size()) < count) {
      zeros.push_back(number(0.1, 9.9));
      if (n % 2 == 0) zeros.push_back(zeros.back() + std::pow(10.0, number(-4, -3)));
    }
    std::sort(zeros.begin(), zeros.end());
    bool apart = true;
    for (std::size_t i = 1; i < zeros.size(); ++i) apart = apart && zeros[i] - zeros[i - 1] > 5e-5;
    if (!apart) continue;
    const auto guard = std::make_shared<Product>(zeros, std::pow(10.0, number(-6, 6)));
    // Where the guard is positive to begin with, the velocity has to be on the level already.
    const double across = guard->value(0, vector({0, 0})) > 0 ? 0 : 1;
    const Solution solution = solve(flying(guard), {0, vector({0, 0}), vector({1, across})}, 10);
    ASSERT_EQ(solution.status().stop, Stop::reached_end) << solution.status().message;
    ASSERT_EQ(solution.switches().size(), zeros.size());
    for (std::size_t i = 0; i < zeros.size(); ++i) {
      EXPECT_NEAR(solution.switches()[i].time, zeros[i], 1e-8);
    }
  }
}

}  // namespace
}  // namespace hybrid_sphere::mechanics

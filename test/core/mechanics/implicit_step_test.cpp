#include "mechanics/implicit_step.hpp"

#include <gtest/gtest.h>

#include <cfloat>
#include <cmath>
#include <limits>
#include <memory>

#include "integration/radau.hpp"

namespace hybrid_sphere::mechanics::implicit_step_test {
namespace {

using integration::radau, integration::Radau;

constexpr double rounding = 64 * DBL_EPSILON;

TEST(Radau, IntegratesPolynomials) {
  for (int k = 1; k <= 9; ++k) {
    const Radau::Row powers = radau().nodes.array().pow(k - 1);
    EXPECT_NEAR(radau().slopes.row(Radau::stages - 1).dot(powers), 1.0 / k, rounding) << k;
    if (k > Radau::stages) continue;
    const Radau::Row integrals = radau().nodes.array().pow(k) / k;
    EXPECT_LE((radau().slopes * powers - integrals).cwiseAbs().maxCoeff(), rounding) << k;
    EXPECT_NEAR(radau().start.dot(powers), k == 1 ? 1 : 0, rounding) << k;
  }
}

TEST(Radau, KnowsTheEigenvectorsOfItsInverse) {
  const Radau::ComplexSquare product =
      radau().vectors * radau().eigenvalues.asDiagonal() * radau().vectors_inverse;
  const double size = radau().inverse.norm();
  EXPECT_LE((product.real() - radau().inverse).norm(), rounding * size);
  EXPECT_LE(product.imag().norm(), rounding * size);
  EXPECT_LE((radau().inverse * radau().slopes - Radau::Square::Identity()).norm(), rounding * size);
  EXPECT_GT(radau().real_eigenvalue, 0);
}

using State = Eigen::VectorXd;

std::shared_ptr<const ImplicitStart> start_of(double jacobian) {
  return std::make_shared<const ImplicitStart>(Eigen::MatrixXd::Constant(1, 1, jacobian), State::Ones(1));
}

/// y' = -y^2, of which 1/(1 + x) is a solution; with the integral of y beside it.
void square(double, const State& y, Eigen::Ref<State> slope) {
  slope[0] = -y[0] * y[0];
  if (slope.size() > 1) slope[1] = y[0];
}

TEST(ImplicitStep, IsOfOrderNine) {
  double before = 0;
  for (const double h : {0.5, 0.25, 0.125}) {
    ImplicitStep step;
    step.take(square, start_of(-2), 0, State::Ones(1), h);
    const double error = std::abs(step.end()[0] - 1 / (1 + h));
    // The error of a step of half the length is 2^10 times smaller, within a factor of two.
    if (before > 0) {
      EXPECT_LT(error, before / 512 + rounding) << h;
    }
    before = error;
  }
}

TEST(ImplicitStep, IntegratesAGuardBesideTheMotion) {
  ImplicitStep step;
  State y(2);
  y << 1, 0;
  const double h = 0.1;
  step.take(square, start_of(-2), 0, y, h);
  EXPECT_NEAR(step.end()[1], std::log1p(h), 1e-12);
}

TEST(ImplicitStep, IsFollowedByItsInterpolant) {
  ImplicitStep step;
  const double h = 0.1;
  step.take(square, start_of(-2), 0, State::Ones(1), h);
  State y(1);
  for (const double s : {0.0, 0.13, 0.5, 0.77, 1.0}) {
    step.interpolate(s * h, y);
    // h^6 y^(6)/6! = h^6, times a product of distances to the nodes that is below 1/100.
    EXPECT_NEAR(y[0], 1 / (1 + s * h), 1e-8) << s;
  }
}

TEST(ImplicitStep, LeavesNothingOfAFastDecay) {
  ImplicitStep step;
  const double rate = 1e12;
  const auto decay = [rate](double, const State& y, Eigen::Ref<State> slope) { slope = -rate * y; };
  step.take(decay, start_of(-rate), 0, State::Ones(1), 1);
  EXPECT_LE(std::abs(step.end()[0]), 100 / rate);
}

TEST(ImplicitStep, RefusesWhatItCannotSolve) {
  ImplicitStep step;
  const auto grows = [](double, const State& y, Eigen::Ref<State> slope) {
    slope[0] = 1 + y[0] * y[0] * y[0] * y[0];
  };
  EXPECT_THROW(step.take(grows, start_of(0), 0, State::Zero(1), 10), StepError);
  EXPECT_THROW(start_of(std::numeric_limits<double>::infinity()), NumericalError);
}

TEST(ImplicitStart, TellsADecayFromAnOscillation) {
  Eigen::MatrixXd jacobian(2, 2);
  jacobian << 0, 1, -100, -0.1;
  EXPECT_FALSE(ImplicitStart(jacobian, State::Ones(2)).decays);
  EXPECT_NEAR(ImplicitStart(jacobian, State::Ones(2)).fastest_rate, 10, 1e-10);
  jacobian << 0, 1, -1, -100;
  EXPECT_TRUE(ImplicitStart(jacobian, State::Ones(2)).decays);
}

}  // namespace
}  // namespace hybrid_sphere::mechanics::implicit_step_test

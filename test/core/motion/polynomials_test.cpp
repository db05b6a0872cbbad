#include "motion/polynomials.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cfloat>
#include <cmath>
#include <random>

namespace hybrid_sphere::testing::polynomials_test {
namespace {

/// One polynomial at a time, by the operations that the processor's version must reproduce.
double value(const Eigen::Matrix<double, 1, polynomials::size>& powers, double x) {
  const double square = x * x;
  double even = powers[polynomials::size - 2];
  double odd = powers[polynomials::size - 1];
  for (int k = polynomials::size - 4; k >= 0; k -= 2) {
    even = even * square + powers[k];
    odd = odd * square + powers[k + 1];
  }
  return even + odd * x;
}

template <int rows>
void expect_the_same_bits() {
  std::minstd_rand random(rows);
  std::normal_distribution<double> any;
  for (int i = 0; i < 200; ++i) {
    polynomials::Powers<rows> powers;
    for (double& c : powers.reshaped()) c = any(random);
    const double x = any(random);
    const auto values = polynomials::values<rows>(powers, x);
    for (int row = 0; row < rows; ++row) EXPECT_EQ(values[row], value(powers.row(row), x)) << row;
  }
}

TEST(Polynomials, AreTheSameToTheBitAsOneAtATime) {
  expect_the_same_bits<4>();
  expect_the_same_bits<8>();
  expect_the_same_bits<12>();
}

TEST(Polynomials, HaveTheirFirstCoefficientAtZeroAndTheirSumAtOne) {
  polynomials::Powers<4> powers = polynomials::Powers<4>::Zero();
  powers.col(0) << 1, 2, 3, 4;
  powers.col(1) << 8, 8, 8, 8;
  powers.col(polynomials::size - 1) << 16, 32, 64, 128;
  EXPECT_EQ(polynomials::values<4>(powers, 0), Eigen::Vector4d(1, 2, 3, 4));
  EXPECT_EQ(polynomials::values<4>(powers, 1), Eigen::Vector4d(25, 42, 75, 140));
}

Eigen::Vector4d sum_of(const polynomials::LongPowers& powers, double x) {
  Eigen::Vector4d sum = Eigen::Vector4d::Zero();
  for (int k = polynomials::long_size - 1; k >= 0; --k) sum = powers.col(k) + x * sum;
  return sum;
}

polynomials::LongPowers following(const polynomials::Powers<3>& rates, int terms,
                                  int count = polynomials::long_size) {
  polynomials::LongPowers q = polynomials::LongPowers::Zero();
  q.col(0) << 0, 0, 0, 1;
  polynomials::follow(rates, terms, count, q);
  return q;
}

// q' = (0, w) q with w along one line: a rotation by the integral of 2 w.
TEST(Polynomials, FollowARotationAboutAnAxisThatStays) {
  const Eigen::Vector3d axis = Eigen::Vector3d(1, -2, 2) / 3;
  for (const int terms : {1, 2, 3}) {
    polynomials::Powers<3> w = polynomials::Powers<3>::Zero();
    for (int k = 0; k < terms; ++k) w.col(k) = std::pow(0.1, k) * axis;
    const polynomials::LongPowers q = following(w, terms);
    for (const double x : {-1.0, -0.3, 0.5, 1.0}) {
      double angle = 0;
      for (int k = 0; k < terms; ++k) angle += std::pow(0.1, k) * std::pow(x, k + 1) / (k + 1);
      Eigen::Vector4d exact;
      exact << std::sin(angle) * axis, std::cos(angle);
      EXPECT_LE((sum_of(q, x) - exact).norm(), 16 * DBL_EPSILON) << terms << " terms at " << x;
    }
  }
}

TEST(Polynomials, FollowTwoRatesAsTheyFollowMany) {
  std::minstd_rand random(3);
  std::normal_distribution<double> any;
  for (int i = 0; i < 50; ++i) {
    polynomials::Powers<3> w = polynomials::Powers<3>::Zero();
    for (double& rate : w.leftCols<2>().reshaped()) rate = any(random);
    const polynomials::LongPowers two = following(w, 2);
    const polynomials::LongPowers many = following(w, 3);
    EXPECT_LE((two - many).cwiseAbs().maxCoeff(), 64 * DBL_EPSILON * many.cwiseAbs().maxCoeff());
    EXPECT_EQ(following(w, 2, 18).leftCols<18>(), two.leftCols<18>());
    EXPECT_TRUE(following(w, 3, 18).rightCols<6>().isZero(0));
  }
}

TEST(Polynomials, AreEconomizedByWhatTheySay) {
  polynomials::Powers<3> w = polynomials::Powers<3>::Zero();
  w.col(1) << 0.1, -0.2, 0.3;
  for (const double turn : {0.3, 1.0, 1.3, 2.0, 2.5}) {
    w.col(0) << turn, 0.4 * turn, -0.2 * turn;
    const polynomials::LongPowers q = following(w, 2);
    polynomials::Powers<4> economized;
    const double left_out = polynomials::economize(q, economized);
    double error = 0;
    double by_truncation = 0;
    for (double x = -1; x <= 1; x += 1.0 / 64) {
      const Eigen::Vector4d exact = sum_of(q, x);
      error = std::max(error, (polynomials::values<4>(economized, x) - exact).cwiseAbs().maxCoeff());
      polynomials::Powers<4> truncated = q.leftCols<polynomials::size>();
      by_truncation =
          std::max(by_truncation, (polynomials::values<4>(truncated, x) - exact).cwiseAbs().maxCoeff());
    }
    EXPECT_LE(error, 1.2 * left_out + 16 * DBL_EPSILON * std::exp(turn)) << turn;
    if (turn > 1) {
      EXPECT_LE(error, 1e-3 * by_truncation) << turn;
    }
  }
}

TEST(Polynomials, OfLowDegreeAreEconomizedAsTheyAre) {
  polynomials::LongPowers q = polynomials::LongPowers::Zero();
  for (int k = 0; k < polynomials::size; ++k) q.col(k) << k, 1 - k, 0.5 * k, 3;
  polynomials::Powers<4> economized;
  EXPECT_EQ(polynomials::economize(q, economized), 0);
  EXPECT_EQ(economized, q.leftCols<polynomials::size>());
}

TEST(Polynomials, AreMultipliedByAMatrix) {
  std::minstd_rand random(4);
  std::normal_distribution<double> any;
  Eigen::Matrix4d matrix;
  polynomials::Powers<4> powers;
  for (double& c : matrix.reshaped()) c = any(random);
  for (double& c : powers.reshaped()) c = any(random);
  const polynomials::Powers<4> expected = matrix * powers;
  polynomials::multiply(matrix, powers);
  EXPECT_LE((powers - expected).cwiseAbs().maxCoeff(), 32 * DBL_EPSILON);
}

}  // namespace
}  // namespace hybrid_sphere::testing::polynomials_test

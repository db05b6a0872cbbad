#include "motion/polynomials.hpp"

#include <gtest/gtest.h>

#include <random>

namespace hybrid_sphere::testing {
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

}  // namespace
}  // namespace hybrid_sphere::testing

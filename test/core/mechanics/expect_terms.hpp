#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <random>
#include <string>

#include "hybrid_sphere/mechanics/equations_of_motion.hpp"

namespace hybrid_sphere::mechanics {

/// Numbers that some dozens of operations, each exact to an ulp, give twice in different order.
/// @param size  of the largest number on the way
inline void expect_equal(const Matrix& found, const Matrix& expected, double size, const char* name) {
  ASSERT_EQ(found.rows(), expected.rows()) << name;
  ASSERT_EQ(found.cols(), expected.cols()) << name;
  const double error = (found - expected).cwiseAbs().maxCoeff();
  EXPECT_LE(error, 64 * DBL_EPSILON * size) << name << "\nfound\n" << found << "\nexpected\n" << expected;
}

inline void expect_equal(const MotionTerms& found, const MotionTerms& expected, double size) {
  EXPECT_NEAR(found.lagrangian, expected.lagrangian, 64 * DBL_EPSILON * size);
  expect_equal(found.rate, expected.rate, size, "rate");
  expect_equal(found.momentum, expected.momentum, size, "momentum");
  expect_equal(found.mass, expected.mass, size, "mass");
  expect_equal(found.force, expected.force, size, "force");
  EXPECT_EQ(found.mass, found.mass.transpose());
}

/// Vectors of random numbers in [-2, 2], the same in each run.
class RandomVectors {
 public:
  Vector operator()(Index size) {
    return Vector::NullaryExpr(size, [this] { return number_(generator_); });
  }

 private:
  std::mt19937 generator_{7};
  std::uniform_real_distribution<double> number_{-2, 2};
};

/// At 20 random times in [0, 3] and states in [-2, 2] the equations agree, and so do their momenta and rates.
inline void expect_equal(const EquationsOfMotion& found, const EquationsOfMotion& expected) {
  ASSERT_EQ(found.coordinates(), expected.coordinates());
  ASSERT_EQ(found.velocities(), expected.velocities());
  RandomVectors random;
  MotionTerms a;
  MotionTerms b;
  for (int i = 0; i < 20; ++i) {
    const double t = 0.15 * i;
    const Vector q = random(found.coordinates());
    const Vector v = random(found.velocities());
    found.evaluate(t, q, v, a);
    expected.evaluate(t, q, v, b);
    const double size = std::max({1.0, b.mass.cwiseAbs().maxCoeff(), b.momentum.cwiseAbs().maxCoeff(),
                                  b.force.cwiseAbs().maxCoeff(), std::abs(b.lagrangian)});
    expect_equal(a, b, size);
    Vector p;
    Vector rate;
    Matrix mass;
    found.momentum(t, q, v, p, mass);
    found.rate(q, v, rate);
    expect_equal(p, b.momentum, size, "momentum()");
    expect_equal(mass, b.mass, size, "mass of momentum()");
    expect_equal(rate, b.rate, size, "rate()");
  }
}

/// The name of the function that is not finite; empty if all are.
template <class Call>
std::string not_finite(Call call) {
  try {
    call();
  } catch (const NotFinite& error) {
    return error.function();
  }
  return "";
}

}  // namespace hybrid_sphere::mechanics

#pragma once

#include <gtest/gtest.h>

#include <cfloat>
#include <cmath>
#include <string>

#include "hybrid_sphere/mechanics/dual.hpp"

namespace hybrid_sphere::mechanics::testing {

/// First and second derivative of a function of one number.
using Second = Dual<Dual<double, 1>, 1>;

inline Second variable(double x) {
  Second result = x;
  result.value.derivatives[0] = 1;
  result.derivatives[0] = 1;
  return result;
}

struct Derivatives {
  double value, first, second;
};

inline Derivatives derivatives(const Second& f) {
  return {plain(f), f.derivatives[0].value, f.derivatives[0].derivatives[0]};
}

/// A dozen operations, each exact to an ulp, on numbers of order one that do not cancel.
constexpr double tolerance = 16 * DBL_EPSILON;

inline void expect_near(const Second& f, const Derivatives& expected, const std::string& name) {
  const auto [value, first, second] = derivatives(f);
  const auto near = [](double a, double b) { return std::abs(a - b) <= tolerance * (1 + std::abs(b)); };
  EXPECT_TRUE(near(value, expected.value))
      << name << ": " << value << " - " << expected.value << " = " << value - expected.value;
  EXPECT_TRUE(near(first, expected.first))
      << name << "': " << first << " - " << expected.first << " = " << first - expected.first;
  EXPECT_TRUE(near(second, expected.second))
      << name << "'': " << second << " - " << expected.second << " = " << second - expected.second;
  // Both levels of the derivative agree.
  EXPECT_EQ(f.value.derivatives[0], first) << name;
}

}  // namespace hybrid_sphere::mechanics::testing

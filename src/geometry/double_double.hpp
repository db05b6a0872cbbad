#pragma once

#include <cmath>

/// Sums and products without loss, as an unevaluated sum of a number and its remainder.
/// Source: T. J. Dekker, Numer. Math. 18 (1971) 224-242; D. E. Knuth, The Art of Computer Programming 2.
namespace hybrid_sphere::exact {

/// value + remainder, of which value is the nearest double.
struct DoubleDouble {
  double value = 0;
  double remainder = 0;
};

inline DoubleDouble two_sum(double a, double b) {
  const double sum = a + b;
  const double back = sum - a;
  return {sum, (a - (sum - back)) + (b - back)};
}

inline DoubleDouble two_difference(double a, double b) {
  const double difference = a - b;
  const double back = difference - a;
  return {difference, (a - (difference - back)) - (b + back)};
}

inline DoubleDouble two_product(double a, double b) {
  const double product = a * b;
  return {product, std::fma(a, b, -product)};
}

}  // namespace hybrid_sphere::exact

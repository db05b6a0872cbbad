#include "integration/bracketed_root.hpp"

#include <algorithm>
#include <boost/math/tools/toms748_solve.hpp>
#include <cfloat>
#include <cstdint>
#include <cstring>
#include <limits>

namespace hybrid_sphere::integration {

namespace {

constexpr bool close(double a, double b) {
  return b - a <= 2 * DBL_EPSILON * std::max(a < 0 ? -a : a, b < 0 ? -b : b);
}

/// Its place among all numbers, ascending.
std::int64_t rank_of(double x) {
  std::int64_t bits = 0;
  std::memcpy(&bits, &x, sizeof x);
  return bits < 0 ? std::numeric_limits<std::int64_t>::min() - bits : bits;
}

double number_of(std::int64_t rank) {
  const std::int64_t bits = rank < 0 ? std::numeric_limits<std::int64_t>::min() - rank : rank;
  double x = 0;
  std::memcpy(&x, &bits, sizeof x);
  return x;
}

double middle_number(double a, double b) {
  const std::int64_t low = rank_of(a);
  const std::int64_t high = rank_of(b);
  return number_of((low & high) + ((low ^ high) >> 1));  // does not overflow
}

}  // namespace

Bracket detail::bracketed_root(const std::function<double(double)>& value, double low, double high,
                               double at_low, double at_high) {
  std::uintmax_t evaluations = 100;
  const auto bracket =
      boost::math::tools::toms748_solve(std::cref(value), low, high, at_low, at_high, close, evaluations);
  Bracket root{bracket.first, bracket.second};
  const bool falls = at_low > 0;
  while (!close(root.low, root.high)) {
    const double middle = middle_number(root.low, root.high);
    if (middle == root.low || middle == root.high) break;
    const double there = value(middle);
    if (there == 0) return {middle, middle};
    ((there > 0) == falls ? root.low : root.high) = middle;
  }
  return root;
}

}  // namespace hybrid_sphere::integration

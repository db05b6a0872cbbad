// Quantiles against sorting, however they are found.

#include "study/order_statistics.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <vector>

#include "core/study/blocks.hpp"

namespace hybrid_sphere::testing::order_statistics_test {
namespace {

using study::quantiles;

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double greatest_double = std::numeric_limits<double>::max();
constexpr double least_double = std::numeric_limits<double>::denorm_min();
constexpr double least_normal = std::numeric_limits<double>::min();

constexpr std::size_t much = std::size_t{1} << 30U;

/// Ties, both zeros, the ends of the range, denormals, numbers of any magnitude and those that are missing.
std::vector<double> mixed_values(std::size_t count, SplitMix& random) {
  const std::vector<double> often = {0.0,
                                     -0.0,
                                     1,
                                     1,
                                     -1,
                                     infinity,
                                     -infinity,
                                     nan,
                                     -nan,
                                     least_double,
                                     -least_double,
                                     greatest_double,
                                     -greatest_double,
                                     least_normal,
                                     -least_normal,
                                     1 + 0x1p-52};
  std::vector<double> values;
  while (values.size() < count) {
    const double x = 2 * random.uniform() - 1;
    switch (random.below(6)) {
      case 0: values.push_back(often[random.below(often.size())]); break;
      case 1: values.push_back(std::round(10 * x)); break;
      case 2: values.push_back(least_double * std::round(100 * x)); break;
      case 3: values.push_back(std::ldexp(x, static_cast<int>(random.below(2000)) - 1000)); break;
      case 4: values.push_back(1e15 + std::round(8 * x) / 8); break;
      default: values.push_back(x);
    }
  }
  return values;
}

std::vector<double> sorted(const std::vector<double>& values) {
  std::vector<double> sorted;
  std::copy_if(values.begin(), values.end(), std::back_inserter(sorted),
               [](double x) { return std::isfinite(x); });
  std::sort(sorted.begin(), sorted.end());
  return sorted;
}

/// Those that make p (n - 1) whole where n - 1 is a power of two, and others.
std::vector<double> some_probabilities(SplitMix& random) {
  std::vector<double> probabilities = {0, 1, 0.5, 0.25, 0.025, 0.975, 0.5, 1 - 0x1p-53, 0x1p-1074};
  for (int i = 0; i < 5; ++i) probabilities.push_back(static_cast<double>(random.below(1025)) / 1024);
  for (int i = 0; i < 5; ++i) probabilities.push_back(random.uniform());
  return probabilities;
}

TEST(Quantiles, AreThoseOfSortedValues) {
  SplitMix random(1996);
  for (const std::size_t count : {8U, 9U, 1025U, 3000U}) {
    const std::vector<double> values = mixed_values(count, random);
    const std::vector<double> order = sorted(values);
    const std::vector<double> probabilities = some_probabilities(random);
    for (const std::size_t memory : {std::size_t{0}, 8 * count / 10, much}) {
      const std::vector<double> result =
          quantiles(in_random_blocks(values, 50, random), order.size(), probabilities, memory);
      ASSERT_EQ(result.size(), probabilities.size());
      for (std::size_t i = 0; i < result.size(); ++i) {
        const double place = probabilities[i] * static_cast<double>(order.size() - 1);
        const double low = order[static_cast<std::size_t>(std::floor(place))];
        const double high = order[static_cast<std::size_t>(std::ceil(place))];
        const long double share = static_cast<long double>(place) - std::floor(place);
        const auto expected = static_cast<double>(low + share * (static_cast<long double>(high) - low));
        // Exactly an order statistic, or the difference, the product and the sum are rounded: the first two
        // to half a unit of twice the greater magnitude, the sum to half a unit of that.
        const double size = std::max(std::abs(low), std::abs(high));
        const double error = low == high || share == 0 ? 0 : 5 * (0x1p-53 * size) + least_double;
        EXPECT_NEAR(result[i], expected, error)
            << "p = " << probabilities[i] << " of " << order.size() << " in " << memory << " bytes";
      }
    }
  }
}

TEST(Quantiles, AreTheSameToTheBitHoweverTheyAreFound) {
  SplitMix random(50);
  for (int round = 0; round < 3; ++round) {
    const std::vector<double> values = mixed_values(1000 + random.below(1000), random);
    const std::uint64_t count = sorted(values).size();
    const std::vector<double> probabilities = some_probabilities(random);
    const std::vector<double> expected = quantiles(in_one_block(values), count, probabilities, much);
    for (const std::size_t memory : {0U, 800U, 8000U}) {
      const std::vector<double> result =
          quantiles(in_random_blocks(values, 300, random), count, probabilities, memory);
      EXPECT_EQ(result, expected) << memory << " bytes";
    }
  }
}

TEST(Quantiles, TellApartWhatDiffersInOneDigitAlone) {
  for (const int digit : {0, 16, 32, 48}) {
    // Bits of 1.0 and of numbers above it; the first digit holds sign, exponent and four bits.
    const double step = digit == 48 ? 1 : std::ldexp(1.0, digit - 52);
    std::vector<double> values;
    for (int i = 0; i < 8; ++i) values.push_back(1 + step * ((3 * i) % 8));
    const std::vector<double> result =
        quantiles(in_one_block(values), values.size(), {0, 1.0 / 7, 3.0 / 7, 1}, 0);
    EXPECT_EQ(result, (std::vector<double>{1, 1 + step, 1 + 3 * step, 1 + 7 * step})) << "bit " << digit;
  }
}

TEST(Quantiles, AreLinearBetweenOrderStatistics) {
  // R: quantile(1:10, c(0.1, 0.33, 0.5, 0.9), type = 7)
  const std::vector<double> values = {10, 3, 5, 1, 2, 9, 8, 7, 6, 4};
  const std::vector<double> expected = {1.9, 3.97, 5.5, 9.1};
  const std::vector<double> result = quantiles(in_one_block(values), 10, {0.1, 0.33, 0.5, 0.9});
  for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_DOUBLE_EQ(result[i], expected[i]);
}

TEST(Quantiles, StayBetweenTheirNeighbours) {
  const std::vector<double> pairs[] = {
      {-greatest_double, greatest_double}, {1, 1 + 0x1p-52}, {0, least_double}, {-1e-300, 1e300}, {0.1, 0.3}};
  for (const std::vector<double>& pair : pairs) {
    double last = pair[0];
    for (int i = 0; i <= 64; ++i) {
      const double result = quantiles(in_one_block(pair), 2, {i / 64.0})[0];
      EXPECT_GE(result, last);
      EXPECT_LE(result, pair[1]);
      last = result;
    }
    EXPECT_EQ(last, pair[1]);
  }
}

TEST(Quantiles, OfNothingAreNone) {
  const std::vector<double> values = {nan};
  EXPECT_TRUE(quantiles(in_one_block(values), 0, {0.5}).empty());
  EXPECT_TRUE(quantiles(in_one_block(values), 0, {0.5}, 0).empty());
}

}  // namespace
}  // namespace hybrid_sphere::testing::order_statistics_test

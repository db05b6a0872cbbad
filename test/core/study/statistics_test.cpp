// Moments, histograms and intervals of a probability against arithmetic with more digits and closed forms.

#include "study/statistics.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "core/study/blocks.hpp"

namespace hybrid_sphere::testing::statistics_test {
namespace {

using Precise = boost::multiprecision::cpp_bin_float_100;
using study::Interval;
using study::probability_interval;
using study::summarize;
using study::Summary;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double greatest_double = std::numeric_limits<double>::max();
constexpr double least_double = std::numeric_limits<double>::denorm_min();

struct Population {
  std::string name;
  std::vector<double> values;
};

template <typename Draw>
Population population(const std::string& name, std::size_t count, Draw draw) {
  Population population = {name, {}};
  for (std::size_t i = 0; i < count; ++i) population.values.push_back(draw());
  return population;
}

std::vector<Population> populations() {
  SplitMix random(20050615);
  const auto signed_uniform = [&] { return 2 * random.uniform() - 1; };
  return {
      population("uniform", 1000, [&] { return random.uniform(); }),
      population("around zero", 999, signed_uniform),
      population("1e15 +- 1", 1000, [&] { return 1e15 + std::round(2 * signed_uniform()) / 2; }),
      population("1e15 and its neighbour", 1000,
                 [&] { return random.below(100) == 0 ? 1e15 + 0.125 : 1e15; }),
      population("one far away", 1000, [&, i = 0]() mutable { return i++ == 0 ? -1e15 : random.uniform(); }),
      population("1e300", 1000, [&] { return 1e300 * signed_uniform(); }),
      population("1e300 and its neighbours", 1000, [&] { return 1e300 * (1 + 0x1p-50 * signed_uniform()); }),
      population("largest", 1000, [&] { return 1e308 * (1 + 0.7 * random.uniform()); }),
      population("around 2^900", 1000, [&] { return 0x1p900 * (0.5 + random.uniform()); }),
      population("positive of any magnitude", 1000,
                 [&, i = 0]() mutable { return std::ldexp(random.uniform(), 2 * i++ - 1050); }),
      population("1e-300", 1000, [&] { return 1e-300 * signed_uniform(); }),
      population("denormal", 1000, [&] { return least_double * std::round(1e6 * signed_uniform()); }),
      population("any magnitude", 1000,
                 [&] { return std::ldexp(signed_uniform(), static_cast<int>(random.below(2000)) - 1000); }),
      population("two", 2, [&] { return random.uniform(); }),
  };
}

struct Moments {
  Precise mean;
  Precise magnitude;  ///< the mean of |x|
  Precise deviation;
};

Moments reference_moments(const std::vector<double>& values) {
  Moments moments;
  const auto n = static_cast<double>(values.size());
  for (const double x : values) {
    moments.mean += Precise(x) / n;
    moments.magnitude += Precise(std::abs(x)) / n;
  }
  Precise squares = 0;
  for (const double x : values) squares += (x - moments.mean) * (x - moments.mean);
  moments.deviation = sqrt(Precise(squares / (n - 1)));
  return moments;
}

TEST(Summary, MomentsAreThoseOfAHundredDigits) {
  for (const auto& [name, values] : populations()) {
    const Moments expected = reference_moments(values);
    const Summary summary = summarize(in_one_block(values), {}, 0);
    // The sum in two doubles is off by n^2 2^-106 of the magnitudes, then the quotient is rounded: half a
    // unit in the last place, of which the least is that of denormals.
    const auto n = static_cast<double>(values.size());
    const Precise mean_error = abs(Precise(summary.mean - expected.mean));
    EXPECT_LE(mean_error,
              0x1.001p-53 * abs(expected.mean) + n * n * 0x1p-106 * expected.magnitude + least_double)
        << name << ": off by " << mean_error;
    // Each difference from the mean is rounded once, its square once more: 3 2^-53 of the sum of the squares;
    // one rounding each of both sums, of their difference, of the quotient: 7 2^-53 and half of that after
    // the root, which adds one. What the rounded mean is off is corrected to within those.
    const Precise deviation_error = abs(Precise(summary.deviation - expected.deviation));
    EXPECT_LE(deviation_error, 4.5 * 0x1p-53 * expected.deviation + least_double)
        << name << ": off by " << Precise(deviation_error / expected.deviation);
  }
}

TEST(Summary, HasTheMomentsOfTheFirstIntegers) {
  std::vector<double> values;
  for (int i = 1; i <= 1000; ++i) values.push_back(i);
  const Summary summary = summarize(in_one_block(values), {0.5}, 10);
  EXPECT_EQ(summary.count, 1000U);
  EXPECT_EQ(summary.mean, 500.5);
  // n (n + 1) / 12; every sum is exact, what remains is the rounding of quotient and root.
  EXPECT_DOUBLE_EQ(summary.deviation, std::sqrt(1000.0 * 1001.0 / 12));
  EXPECT_EQ(summary.least, 1);
  EXPECT_EQ(summary.greatest, 1000);
  EXPECT_EQ(summary.quantiles, std::vector<double>{500.5});
  EXPECT_EQ(summary.histogram.counts, std::vector<std::uint64_t>(10, 100));
}

TEST(Summary, OfTheEndsOfTheRangeOverflowsOnlyWhereTheResultDoes) {
  const std::vector<double> values = {-greatest_double, greatest_double, 0, 0, 0, 0};
  const Summary summary = summarize(in_one_block(values), {0.1, 0.5, 0.9}, 4);
  EXPECT_EQ(summary.mean, 0);
  EXPECT_DOUBLE_EQ(summary.deviation, std::sqrt(2.0 / 5) * greatest_double);
  // Halfway between the first two order statistics.
  EXPECT_EQ(summary.quantiles, (std::vector<double>{-greatest_double / 2, 0, greatest_double / 2}));
  const std::vector<double>& edges = summary.histogram.edges;
  ASSERT_EQ(edges.size(), 5U);
  for (std::size_t i = 0; i < 5; ++i) {
    EXPECT_DOUBLE_EQ(edges[i], (static_cast<double>(i) / 2 - 1) * greatest_double);
  }
  EXPECT_EQ(summary.histogram.counts, (std::vector<std::uint64_t>{1, 0, 4, 1}));
}

TEST(Summary, OfEqualValuesHasNoDeviationAndNoHistogram) {
  for (const double x : {0.1, 0.0, -1e15 / 3, greatest_double, least_double, 1e-300 / 3}) {
    const std::vector<double> values(997, x);
    const Summary summary = summarize(in_one_block(values), {0, 0.3, 1}, 5);
    EXPECT_EQ(summary.mean, x);
    EXPECT_EQ(summary.deviation, 0);
    EXPECT_EQ(summary.quantiles, std::vector<double>(3, x));
    EXPECT_TRUE(summary.histogram.edges.empty());
    EXPECT_TRUE(summary.histogram.counts.empty());
  }
}

TEST(Summary, OfOneValueIsThatValue) {
  const std::vector<double> values = {nan, -2.5};
  const Summary summary = summarize(in_one_block(values), {0, 0.7, 1}, 3);
  EXPECT_EQ(summary.count, 1U);
  EXPECT_EQ(summary.missing, 1U);
  EXPECT_EQ(summary.mean, -2.5);
  EXPECT_EQ(summary.deviation, 0);
  EXPECT_EQ(summary.least, -2.5);
  EXPECT_EQ(summary.greatest, -2.5);
  EXPECT_EQ(summary.quantiles, std::vector<double>(3, -2.5));
}

TEST(Summary, LeavesOutWhatIsNotFinite) {
  const std::vector<double> some = {nan, 1, infinity, 2, -infinity, 4, nan};
  const Summary summary = summarize(in_one_block(some), {0, 0.5, 1}, 2);
  EXPECT_EQ(summary.count, 3U);
  EXPECT_EQ(summary.missing, 4U);
  EXPECT_DOUBLE_EQ(summary.mean, 7.0 / 3);
  EXPECT_EQ(summary.least, 1);
  EXPECT_EQ(summary.greatest, 4);
  EXPECT_EQ(summary.quantiles, (std::vector<double>{1, 2, 4}));
  EXPECT_EQ(summary.histogram.counts, (std::vector<std::uint64_t>{2, 1}));

  for (const std::vector<double>& none : {std::vector<double>{}, std::vector<double>{nan, infinity}}) {
    const Summary empty = summarize(in_one_block(none), {0.5}, 2);
    EXPECT_EQ(empty.count, 0U);
    EXPECT_EQ(empty.missing, none.size());
    EXPECT_EQ(empty.mean, 0);
    EXPECT_EQ(empty.deviation, 0);
    EXPECT_TRUE(empty.quantiles.empty());
    EXPECT_TRUE(empty.histogram.counts.empty());
  }
}

TEST(Summary, KnowsOneZero) {
  const std::vector<double> values = {-0.0, -0.0, -0.0};
  const Summary summary = summarize(in_one_block(values), {0.5}, 0);
  EXPECT_FALSE(std::signbit(summary.least) || std::signbit(summary.greatest) || std::signbit(summary.mean) ||
               std::signbit(summary.quantiles[0]));
}

TEST(Summary, IsTheSameToTheBitForAnyCut) {
  SplitMix random(7);
  for (auto [name, values] : populations()) {
    values.push_back(nan);
    const Summary whole = summarize(in_one_block(values), {0.05, 0.5, 0.95}, 7);
    for (const std::size_t longest : {1U, 3U, 100U, 2000U}) {
      const Summary cut = summarize(in_random_blocks(values, longest, random), {0.05, 0.5, 0.95}, 7);
      EXPECT_EQ(cut.count, whole.count) << name;
      EXPECT_EQ(cut.missing, whole.missing) << name;
      EXPECT_EQ(cut.mean, whole.mean) << name;
      EXPECT_EQ(cut.deviation, whole.deviation) << name;
      EXPECT_EQ(cut.least, whole.least) << name;
      EXPECT_EQ(cut.greatest, whole.greatest) << name;
      EXPECT_EQ(cut.quantiles, whole.quantiles) << name;
      EXPECT_EQ(cut.histogram.edges, whole.histogram.edges) << name;
      EXPECT_EQ(cut.histogram.counts, whole.histogram.counts) << name;
    }
  }
}

TEST(Histogram, HasEqualBinsOverTheRange) {
  for (const auto& [name, values] : populations()) {
    const Summary summary = summarize(in_one_block(values), {}, 13);
    const std::vector<double>& edges = summary.histogram.edges;
    ASSERT_EQ(edges.size(), 14U) << name;
    EXPECT_EQ(edges.front(), summary.least) << name;
    EXPECT_EQ(edges.back(), summary.greatest) << name;
    const Precise least(summary.least);
    const Precise width = Precise(summary.greatest) - least;
    for (int i = 0; i <= 13; ++i) {
      // The width, the product, the quotient and the sum are rounded; the first three are not above the
      // width, the sum not above the greatest magnitude.
      const double size = std::max(std::abs(summary.least), std::abs(summary.greatest));
      const Precise error = Precise(edges[static_cast<std::size_t>(i)]) - (least + i * width / 13);
      EXPECT_LE(abs(error),
                3 * Precise(0x1p-53) * width + Precise(0x1p-53) * Precise(size) + Precise(least_double))
          << name << ", edge " << i;
    }
  }
}

TEST(Histogram, CountsEachValueBetweenItsEdges) {
  for (const auto& [name, values] : populations()) {
    for (const std::size_t bins : {1U, 2U, 10U, 1000U}) {
      const study::Histogram histogram = summarize(in_one_block(values), {}, bins).histogram;
      std::vector<std::uint64_t> expected(bins);
      for (const double x : values) {
        const auto above = std::upper_bound(histogram.edges.begin(), histogram.edges.end(), x);
        ++expected[std::min(static_cast<std::size_t>(above - histogram.edges.begin()) - 1, bins - 1)];
      }
      EXPECT_EQ(histogram.counts, expected) << name << ", " << bins << " bins";
    }
  }
}

TEST(Histogram, CountsTheNeighboursOfAnEdgeOnTheirSides) {
  SplitMix random(4);
  for (const std::size_t bins : {3U, 10U, 77U}) {
    for (int round = 0; round < 20; ++round) {
      std::vector<double> values = {random.uniform() - 1, random.uniform()};
      const std::vector<double> edges = summarize(in_one_block(values), {}, bins).histogram.edges;
      for (std::size_t i = 1; i < bins; ++i) {
        values.insert(values.end(), {std::nextafter(edges[i], -1), edges[i], std::nextafter(edges[i], 1)});
      }
      // The ends, and of each inner edge one below and two above.
      std::vector<std::uint64_t> expected(bins, 3);
      expected.front() = 2;
      EXPECT_EQ(summarize(in_one_block(values), {}, bins).histogram.counts, expected);
    }
  }
}

TEST(Histogram, CountsAValueOnAnEdgeAboveItAndTheGreatestInTheLastBin) {
  const std::vector<double> values = {0, 0.25, 0.25, 0.5, 0.5, 0.5, 0.75, 1, 1, 1, 1};
  const study::Histogram histogram = summarize(in_one_block(values), {}, 4).histogram;
  EXPECT_EQ(histogram.edges, (std::vector<double>{0, 0.25, 0.5, 0.75, 1}));
  EXPECT_EQ(histogram.counts, (std::vector<std::uint64_t>{1, 2, 3, 5}));
}

/// The probability of at least k successes.
long double upper_tail(int k, int n, long double p) {
  long double sum = 0;
  for (int i = k; i <= n; ++i) {
    sum += std::exp(std::lgamma(n + 1.0L) - std::lgamma(i + 1.0L) - std::lgamma(n - i + 1.0L) +
                    static_cast<long double>(i) * std::log(p) +
                    static_cast<long double>(n - i) * std::log1p(-p));
  }
  return sum;
}

TEST(ProbabilityInterval, IsThePublishedOne) {
  // 1 - 0.025^(1/10), as each of the ten fails.
  const Interval none = probability_interval(0, 10);
  EXPECT_EQ(none.low, 0);
  EXPECT_DOUBLE_EQ(none.high, 0.30849710781876083);
  // Half a unit of the last digit of the table.
  const Interval half = probability_interval(5, 10);
  EXPECT_NEAR(half.low, 0.18708603, 5e-9);
  EXPECT_NEAR(half.high, 0.81291397, 5e-9);
  const Interval all = probability_interval(10, 10);
  EXPECT_DOUBLE_EQ(all.low, 1 - 0.30849710781876083);
  EXPECT_EQ(all.high, 1);
}

TEST(ProbabilityInterval, IsEverythingWithoutTrials) {
  const Interval interval = probability_interval(0, 0);
  EXPECT_EQ(interval.low, 0);
  EXPECT_EQ(interval.high, 1);
}

TEST(ProbabilityInterval, LeavesEqualTails) {
  for (const double confidence : {0.5, 0.95, 0.999}) {
    const double outside = (1 - confidence) / 2;
    for (const auto& [k, n] : {std::pair{1, 2}, {1, 100}, {37, 100}, {99, 100}, {3, 1000}, {500, 1000}}) {
      const Interval interval =
          probability_interval(static_cast<std::uint64_t>(k), static_cast<std::uint64_t>(n), confidence);
      // lgamma(1001) = 5912 has a unit of 2^-51 in long double: three of them leave 1e-15 of each term. A
      // unit of a bound p is one of 2^-53 n p of its tail; the inverse is good to a few.
      const auto low = static_cast<double>(upper_tail(k, n, interval.low));
      const auto high = static_cast<double>(1 - upper_tail(k + 1, n, interval.high));
      EXPECT_NEAR(low, outside, 1e-12 * outside) << k << " of " << n;
      EXPECT_NEAR(high, outside, 1e-12) << k << " of " << n;
    }
  }
}

TEST(ProbabilityInterval, OfManyTrialsIsNormal) {
  const double n = 1e12;
  const Interval interval = probability_interval(300'000'000'000, 1'000'000'000'000);
  const double deviation = std::sqrt(0.3 * 0.7 / n);
  // What the normal distribution misses is of the order 1 / n.
  EXPECT_NEAR(interval.low, 0.3 - 1.959963984540054 * deviation, 5 / n);
  EXPECT_NEAR(interval.high, 0.3 + 1.959963984540054 * deviation, 5 / n);
}

}  // namespace
}  // namespace hybrid_sphere::testing::statistics_test

// Sobol' indices against functions of which they are known, and their intervals against the scatter of small
// studies.

#include "study/sobol_indices.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <boost/random/sobol.hpp>
#include <cmath>
#include <limits>
#include <vector>

#include "core/study/blocks.hpp"

namespace hybrid_sphere::testing::sobol_indices_test {
namespace {

using study::sobol_indices;
using study::SobolIndex;
using study::SobolIndices;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double pi = 3.14159265358979323846;

using Point = std::vector<double>;

/// The output of a study with `saltelli`.
/// @param draw  the next coordinate: those of A, then those of B
template <typename Function, typename Draw>
std::vector<double> study_of(Function f, std::size_t variables, std::size_t groups, Draw draw) {
  std::vector<double> output;
  Point a(variables);
  Point b(variables);
  for (std::size_t i = 0; i < groups; ++i) {
    for (double& x : a) x = draw();
    for (double& x : b) x = draw();
    output.insert(output.end(), {f(a), f(b)});
    for (std::size_t j = 0; j < variables; ++j) {
      Point mixed = a;
      mixed[j] = b[j];
      output.push_back(f(mixed));
    }
  }
  return output;
}

template <typename Function>
std::vector<double> random_study(Function f, std::size_t variables, std::size_t groups, SplitMix& random) {
  return study_of(f, variables, groups, [&] { return random.uniform(); });
}

template <typename Function>
std::vector<double> sequence_study(Function f, std::size_t variables, std::size_t groups) {
  boost::random::sobol sequence(2 * variables);
  return study_of(f, variables, groups, [&] { return static_cast<double>(sequence()) * 0x1p-64; });
}

/// Of x uniform in (0, 1): variances 1, 4 and 9 twelfths.
double linear(const Point& x) { return x[0] - 2 * x[1] + 3 * x[2]; }
const std::vector<double> linear_shares = {1.0 / 14, 4.0 / 14, 9.0 / 14};

/// T. Ishigami, T. Homma, ISUMA 1990, 398-403, with a = 7, b = 0.1.
double ishigami(const Point& u) {
  const auto x = [&](std::size_t j) { return pi * (2 * u[j] - 1); };
  return std::sin(x(0)) + 7 * std::pow(std::sin(x(1)), 2) + 0.1 * std::pow(x(2), 4) * std::sin(x(0));
}

void expect_equal(const std::vector<SobolIndex>& x, const std::vector<SobolIndex>& y) {
  ASSERT_EQ(x.size(), y.size());
  for (std::size_t j = 0; j < x.size(); ++j) {
    EXPECT_EQ(x[j].value, y[j].value);
    EXPECT_EQ(x[j].low, y[j].low);
    EXPECT_EQ(x[j].high, y[j].high);
  }
}

/// The formulas as they stand in the literature, with the exact mean taken off.
struct Reference {
  long double variance = 0;
  std::vector<long double> first;
  std::vector<long double> total;
};

Reference reference(const std::vector<double>& output, std::size_t variables) {
  const std::size_t size = variables + 2;
  const std::size_t groups = output.size() / size;
  const auto n = static_cast<long double>(groups);
  const auto f = [&](std::size_t group, std::size_t i) {
    return static_cast<long double>(output[group * size + i]);
  };
  long double mean = 0;
  long double mean_of_all = 0;
  for (std::size_t g = 0; g < groups; ++g) mean += (f(g, 0) + f(g, 1)) / (2 * n);
  for (const double value : output) mean_of_all += value / static_cast<long double>(output.size());
  Reference result;
  for (std::size_t g = 0; g < groups; ++g) {
    result.variance += (std::pow(f(g, 0) - mean, 2.0L) + std::pow(f(g, 1) - mean, 2.0L)) / (2 * n - 1);
  }
  for (std::size_t j = 0; j < variables; ++j) {
    long double first = 0;
    long double total = 0;
    for (std::size_t g = 0; g < groups; ++g) {
      first += (f(g, 1) - mean_of_all) * (f(g, 2 + j) - f(g, 0)) / n;
      total += std::pow(f(g, 0) - f(g, 2 + j), 2.0L) / (2 * n);
    }
    result.first.push_back(first / result.variance);
    result.total.push_back(total / result.variance);
  }
  return result;
}

TEST(SobolIndices, FollowTheirFormulas) {
  SplitMix random(2010);
  for (const std::size_t groups : {1U, 2U, 10U, 300U, 1000U, 1001U, 2500U}) {
    const std::vector<double> output = random_study(ishigami, 3, groups, random);
    const SobolIndices indices = sobol_indices(in_one_block(output), 3, 0);
    const Reference expected = reference(output, 3);
    EXPECT_EQ(indices.groups, groups);
    EXPECT_EQ(indices.missing, 0U);
    // Sums of n terms, each below 20^2 = 400 times 2^-53 n off, where the variance is above 1.
    const double error = 400 * 0x1p-53 * static_cast<double>(groups);
    ASSERT_GT(indices.variance, 1);
    EXPECT_NEAR(indices.variance, static_cast<double>(expected.variance), error);
    for (std::size_t j = 0; j < 3; ++j) {
      EXPECT_NEAR(indices.first[j].value, static_cast<double>(expected.first[j]), error);
      EXPECT_NEAR(indices.total[j].value, static_cast<double>(expected.total[j]), error);
    }
  }
}

// Of 2^14 groups of independent points the first indices scatter by about 0.01. Points of Sobol's sequence
// are better by far; a wrong factor or term is off by more than 0.01.
constexpr std::size_t many = std::size_t{1} << 14U;

TEST(SobolIndices, OfALinearFunctionAreTheSharesOfTheVariance) {
  const std::vector<double> output = sequence_study(linear, 3, many);
  const SobolIndices indices = sobol_indices(in_one_block(output), 3, 0);
  EXPECT_NEAR(indices.variance, 14.0 / 12, 0.01);
  for (std::size_t j = 0; j < 3; ++j) {
    EXPECT_NEAR(indices.first[j].value, linear_shares[j], 0.01) << j;
    EXPECT_NEAR(indices.total[j].value, linear_shares[j], 0.01) << j;
  }
}

TEST(SobolIndices, OfIshigamisFunctionAreItsClosedForm) {
  const double a = 7;
  const double b = 0.1;
  const double v_1 = std::pow(1 + b * std::pow(pi, 4) / 5, 2) / 2;
  const double v_2 = a * a / 8;
  const double v_13 = b * b * std::pow(pi, 8) * 8 / 225;
  const double v = v_1 + v_2 + v_13;
  ASSERT_NEAR(v, a * a / 8 + b * std::pow(pi, 4) / 5 + b * b * std::pow(pi, 8) / 18 + 0.5, 1e-12);
  const std::vector<double> first = {v_1 / v, v_2 / v, 0};
  const std::vector<double> total = {(v_1 + v_13) / v, v_2 / v, v_13 / v};

  const std::vector<double> output = sequence_study(ishigami, 3, many);
  const SobolIndices indices = sobol_indices(in_one_block(output), 3, 0);
  EXPECT_NEAR(indices.variance, v, 0.01 * v);
  for (std::size_t j = 0; j < 3; ++j) {
    EXPECT_NEAR(indices.first[j].value, first[j], 0.01) << j;
    EXPECT_NEAR(indices.total[j].value, total[j], 0.01) << j;
  }
}

TEST(SobolIndices, OfAVariableWithoutInfluenceAreZero) {
  SplitMix random(3);
  const auto f = [](const Point& x) { return std::exp(x[0]); };
  const std::vector<double> output = random_study(f, 2, 100, random);
  const SobolIndices indices = sobol_indices(in_one_block(output), 2, 0);
  for (const SobolIndex& index : {indices.first[1], indices.total[1]}) {
    EXPECT_EQ(index.value, 0);
    EXPECT_EQ(index.low, 0);
    EXPECT_EQ(index.high, 0);
  }
  EXPECT_GT(indices.total[0].low, 0.5);
}

TEST(SobolIndices, AreTheSameToTheBitForAnyCut) {
  SplitMix random(11);
  std::vector<double> output = random_study(ishigami, 3, 1500, random);
  output[77] = nan;
  const SobolIndices whole = sobol_indices(in_one_block(output), 3, 5);
  for (const std::size_t longest : {1U, 4U, 6U, 1000U}) {
    const SobolIndices cut = sobol_indices(in_random_blocks(output, longest, random), 3, 5);
    EXPECT_EQ(cut.groups, whole.groups);
    EXPECT_EQ(cut.missing, whole.missing);
    EXPECT_EQ(cut.variance, whole.variance);
    expect_equal(cut.first, whole.first);
    expect_equal(cut.total, whole.total);
  }
}

TEST(SobolIndices, DoNotDependOnTheUnitOfTheOutput) {
  SplitMix random(12);
  const std::vector<double> output = random_study(linear, 3, 200, random);
  const SobolIndices indices = sobol_indices(in_one_block(output), 3, 5);
  for (const int power : {-900, 1000}) {
    std::vector<double> scaled;
    for (const double value : output) scaled.push_back(std::ldexp(value, power));
    const SobolIndices same = sobol_indices(in_one_block(scaled), 3, 5);
    EXPECT_EQ(same.variance, std::ldexp(indices.variance, 2 * power));
    expect_equal(same.first, indices.first);
    expect_equal(same.total, indices.total);
  }
}

TEST(SobolIndices, AreNotSpoiltByALargeMean) {
  SplitMix random(13);
  // Multiples of 2^-20, which stay what they are when 2^32 is added.
  const auto f = [](const Point& x) { return std::round(linear(x) * 0x1p20) * 0x1p-20; };
  const std::vector<double> output = random_study(f, 3, 500, random);
  std::vector<double> raised;
  for (const double value : output) raised.push_back(value + 0x1p32);
  const SobolIndices expected = sobol_indices(in_one_block(output), 3, 5);
  const SobolIndices indices = sobol_indices(in_one_block(raised), 3, 5);
  for (std::size_t j = 0; j < 3; ++j) {
    // The mean is rounded to 2^-20, by which at most f(B) differs; |f(AB_j) - f(A)| <= 3, the variance is
    // > 1.
    EXPECT_NEAR(indices.first[j].value, expected.first[j].value, 3 * 0x1p-20);
    EXPECT_NEAR(indices.total[j].value, expected.total[j].value, 500 * 10 * 0x1p-53);
  }
}

TEST(SobolIndices, LeaveOutGroupsWithAMissingValue) {
  SplitMix random(14);
  std::vector<double> output;
  std::vector<double> complete;
  for (std::size_t g = 0; g < 500; ++g) {
    std::vector<double> group = random_study(linear, 3, 1, random);
    if (g % 20 == 7) {
      // Each of the values is missing once in a while.
      group[g / 20 % 5] = g % 40 == 7 ? nan : std::numeric_limits<double>::infinity();
    } else {
      complete.insert(complete.end(), group.begin(), group.end());
    }
    output.insert(output.end(), group.begin(), group.end());
  }
  const SobolIndices indices = sobol_indices(in_one_block(output), 3, 5);
  const SobolIndices expected = sobol_indices(in_one_block(complete), 3, 5);
  EXPECT_EQ(indices.groups, 475U);
  EXPECT_EQ(indices.missing, 25U);
  EXPECT_EQ(indices.variance, expected.variance);
  expect_equal(indices.first, expected.first);
  expect_equal(indices.total, expected.total);
}

TEST(SobolIndices, LeaveOutAnIncompleteLastGroup) {
  SplitMix random(15);
  const std::vector<double> output = random_study(linear, 3, 20, random);
  std::vector<double> longer = output;
  longer.insert(longer.end(), {1e9, nan, 3, 4});
  const SobolIndices indices = sobol_indices(in_one_block(longer), 3, 5);
  const SobolIndices expected = sobol_indices(in_one_block(output), 3, 5);
  EXPECT_EQ(indices.groups, 20U);
  EXPECT_EQ(indices.missing, 0U);
  expect_equal(indices.first, expected.first);
  expect_equal(indices.total, expected.total);
}

TEST(SobolIndices, OfAConstantOutputAreNone) {
  for (const double value : {0.0, 0.1, 1e300 / 3, -1e-310}) {
    const std::vector<double> output(std::size_t{5} * 1234, value);
    const SobolIndices indices = sobol_indices(in_one_block(output), 3, 5);
    EXPECT_EQ(indices.groups, 1234U);
    EXPECT_EQ(indices.variance, 0);
    EXPECT_TRUE(indices.first.empty());
    EXPECT_TRUE(indices.total.empty());
  }
}

TEST(SobolIndices, OfNothingAreNone) {
  for (const std::vector<double>& output : {std::vector<double>{}, {1, 2, 3}, {1, nan, 3, 4, 5}}) {
    const SobolIndices indices = sobol_indices(in_one_block(output), 3, 5);
    EXPECT_EQ(indices.groups, 0U);
    EXPECT_EQ(indices.missing, output.size() / 5);
    EXPECT_EQ(indices.variance, 0);
    EXPECT_TRUE(indices.first.empty());
  }
}

bool covers(const SobolIndex& index, double value) { return index.low <= value && value <= index.high; }

TEST(SobolIntervals, CoverTheIndexInMostStudies) {
  SplitMix random(16);
  std::vector<int> first(3);
  std::vector<int> total(3);
  for (std::uint64_t study = 0; study < 100; ++study) {
    const std::vector<double> output = random_study(linear, 3, 100, random);
    const SobolIndices indices = sobol_indices(in_one_block(output), 3, study);
    for (std::size_t j = 0; j < 3; ++j) {
      first[j] += covers(indices.first[j], linear_shares[j]) ? 1 : 0;
      total[j] += covers(indices.total[j], linear_shares[j]) ? 1 : 0;
    }
  }
  // 95 of 100 are expected, with a deviation of 2.2; the percentiles of a small sample cover some less.
  for (std::size_t j = 0; j < 3; ++j) {
    EXPECT_GE(first[j], 85) << j;
    EXPECT_GE(total[j], 85) << j;
  }
}

TEST(SobolIntervals, OfManyGroupsAreThoseOfTheNormalDistribution) {
  SplitMix random(17);
  const std::size_t groups = 20000;
  const std::vector<double> output = random_study(ishigami, 3, groups, random);
  const SobolIndices indices = sobol_indices(in_one_block(output), 3, 5);
  const double mean = study::summarize(in_one_block(output), {}, 0).mean;
  for (std::size_t j = 0; j < 3; ++j) {
    // The quotient of two means, linearized: its variance is that of (x - index y) / V over n.
    double first_squares = 0;
    double total_squares = 0;
    for (std::size_t g = 0; g < groups; ++g) {
      const double a = output[5 * g] - mean;
      const double b = output[5 * g + 1] - mean;
      const double change = output[5 * g + 2 + j] - mean - a;
      const double spread = (a * a + b * b) / 2;
      first_squares += std::pow(b * change - indices.first[j].value * spread, 2);
      total_squares += std::pow(change * change / 2 - indices.total[j].value * spread, 2);
    }
    const auto half_width = [&](double squares) {
      return 1.96 * std::sqrt(squares) / static_cast<double>(groups) / indices.variance;
    };
    // The percentile of 1000 resamples scatters by sqrt(0.025 0.975 / 1000) / density(1.96) = 0.084
    // deviations; the deviation over 1000 parts by 1 / sqrt(2000) of itself, more where parts are not normal.
    // 0.25 of 1.96 deviations is five times that.
    const SobolIndex& first = indices.first[j];
    const SobolIndex& total = indices.total[j];
    const double first_width = half_width(first_squares);
    const double total_width = half_width(total_squares);
    EXPECT_NEAR(first.low, first.value - first_width, 0.25 * first_width) << j;
    EXPECT_NEAR(first.high, first.value + first_width, 0.25 * first_width) << j;
    EXPECT_NEAR(total.low, total.value - total_width, 0.25 * total_width) << j;
    EXPECT_NEAR(total.high, total.value + total_width, 0.25 * total_width) << j;
  }
}

TEST(SobolIntervals, FollowFromTheSeedAlone) {
  SplitMix random(18);
  const std::vector<double> output = random_study(linear, 3, 100, random);
  const SobolIndices indices = sobol_indices(in_one_block(output), 3, 5);
  expect_equal(sobol_indices(in_one_block(output), 3, 5).first, indices.first);
  // Both halves of the seed count.
  for (const std::uint64_t seed : {std::uint64_t{6}, std::uint64_t{5} + (std::uint64_t{1} << 32U)}) {
    const SobolIndices others = sobol_indices(in_one_block(output), 3, seed);
    EXPECT_EQ(others.total[0].value, indices.total[0].value);
    EXPECT_NE(others.total[0].low, indices.total[0].low);
    EXPECT_NE(others.total[0].high, indices.total[0].high);
  }
}

TEST(SobolIntervals, OfOneGroupAreItsIndices) {
  const std::vector<double> output = {1, 2, 3, 4, 5, nan, 1, 1, 1, 1};
  const SobolIndices indices = sobol_indices(in_one_block(output), 3, 5);
  EXPECT_EQ(indices.groups, 1U);
  EXPECT_EQ(indices.missing, 1U);
  // V = (1 - 1.5)^2 + (2 - 1.5)^2; the mean of the five is 3: f(B) = -1.
  EXPECT_EQ(indices.variance, 0.5);
  for (std::size_t j = 0; j < 3; ++j) {
    const double change = static_cast<double>(j) + 2;
    EXPECT_DOUBLE_EQ(indices.first[j].value, -change / 0.5);
    EXPECT_DOUBLE_EQ(indices.total[j].value, change * change / 2 / 0.5);
    for (const SobolIndex& index : {indices.first[j], indices.total[j]}) {
      EXPECT_EQ(index.low, index.value);
      EXPECT_EQ(index.high, index.value);
    }
  }
}

TEST(SobolIntervals, OfARareEventDoNotCountResamplesWithoutIt) {
  // Of a third of the resamples nothing but rounding is left, another one for each size of the event.
  for (const double size : {1.0, 0.1, 0.3, 1e3, 1.0 / 7, 1e-5 / 3}) {
    std::vector<double> output(std::size_t{4} * 300);
    // f(A) and f(AB_2) of one group: the first variable alone decides.
    output[400] = size;
    output[403] = size;
    const SobolIndices indices = sobol_indices(in_one_block(output), 2, 5);
    // With the event k times among 2 n = 600 values the variance is k (1 - k / 600) / 599, the mean of the
    // halved squares k / 600. More than ten times in a resample is less probable than 1e-7.
    EXPECT_NEAR(indices.total[0].value, 1, 1e-12);
    EXPECT_GE(indices.total[0].low, 1 - 1e-12);
    EXPECT_LE(indices.total[0].high, 599.0 / 590);
    EXPECT_EQ(indices.total[1].low, 0);
    EXPECT_EQ(indices.total[1].high, 0);
  }
}

}  // namespace
}  // namespace hybrid_sphere::testing::sobol_indices_test

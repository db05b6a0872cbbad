#include "study/sampler.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <boost/random/sobol.hpp>
#include <cmath>
#include <set>
#include <stdexcept>

namespace hybrid_sphere::testing::sampler_test {
namespace {

using namespace study;

constexpr Sampling without_grid[] = {Sampling::random, Sampling::latin_hypercube, Sampling::sobol};

Design design_of(Sampling sampling, std::size_t variables, std::uint64_t runs, bool saltelli = false) {
  Design design;
  design.sampling = sampling;
  design.seed = 42;
  design.runs = runs;
  design.saltelli = saltelli;
  for (std::size_t i = 0; i < variables; ++i) design.variables.push_back("v" + std::to_string(i));
  return design;
}

Design grid_of(const std::vector<std::uint64_t>& levels) {
  Design design = design_of(Sampling::grid, levels.size(), 1);
  design.levels = levels;
  for (const std::uint64_t level : levels) design.runs *= level;
  return design;
}

std::vector<double> points_of(const Design& design, std::uint64_t first, std::uint64_t count) {
  std::vector<double> points(count * design.variables.size());
  Sampler(design).points(first, count, points.data());
  return points;
}

std::vector<double> all_points(const Design& design) { return points_of(design, 0, design.runs); }

/// The numbers of variable j.
std::vector<double> column(const std::vector<double>& points, std::size_t variables, std::size_t j) {
  std::vector<double> column;
  for (std::size_t i = j; i < points.size(); i += variables) column.push_back(points[i]);
  return column;
}

/// Which of `count` equal parts each number is in.
std::vector<std::uint64_t> strata_of(const std::vector<double>& numbers, double count) {
  std::vector<std::uint64_t> strata;
  strata.reserve(numbers.size());
  for (const double number : numbers) strata.push_back(static_cast<std::uint64_t>(number * count));
  return strata;
}

void expect_each_once(std::vector<std::uint64_t> strata, const std::string& what) {
  std::sort(strata.begin(), strata.end());
  for (std::size_t i = 0; i < strata.size(); ++i) ASSERT_EQ(strata[i], i) << what;
}

std::vector<Design> designs() {
  std::vector<Design> designs{grid_of({7, 1, 3, 11})};
  for (const Sampling sampling : without_grid) {
    designs.push_back(design_of(sampling, 4, 300));
    designs.push_back(design_of(sampling, 1, 301, true));
    designs.push_back(design_of(sampling, 4, 1003, true));  // the last group is incomplete
  }
  return designs;
}

TEST(Sampler, PointOfARunDoesNotDependOnHowManyAreAskedFor) {
  for (const Design& design : designs()) {
    const std::vector<double> all = all_points(design);
    const std::size_t variables = design.variables.size();
    const Sampler sampler(design);
    for (const std::uint64_t block : {1U, 2U, 5U, 64U, 100U}) {
      std::vector<double> again(all.size());
      for (std::uint64_t first = 0; first < design.runs; first += block) {
        const std::uint64_t count = std::min(block, design.runs - first);
        sampler.points(first, count, again.data() + first * variables);
      }
      EXPECT_EQ(all, again) << static_cast<int>(design.sampling) << ' ' << design.saltelli << ' ' << block;
    }
  }
}

TEST(Sampler, FillsOnlyWhatIsAskedFor) {
  for (const Design& design : designs()) {
    const std::size_t variables = design.variables.size();
    std::vector<double> out(3 * variables, -1);
    Sampler(design).points(17, 0, out.data());
    EXPECT_EQ(out, std::vector<double>(3 * variables, -1));
    Sampler(design).points(17, 2, out.data());
    EXPECT_EQ(std::vector<double>(out.end() - static_cast<std::ptrdiff_t>(variables), out.end()),
              std::vector<double>(variables, -1));
  }
}

TEST(Sampler, HasNoPointsBeyondItsRuns) {
  double out[3] = {};
  const Sampler sampler(design_of(Sampling::latin_hypercube, 1, 10));
  EXPECT_NO_THROW(sampler.points(10, 0, out));
  EXPECT_THROW(sampler.points(9, 2, out), std::out_of_range);
  EXPECT_THROW(sampler.points(11, 0, out), std::out_of_range);
  EXPECT_THROW(sampler.points(1, ~std::uint64_t{0}, out), std::out_of_range);
}

TEST(Sampler, StaysInTheOpenIntervalForAnyNumberOfRuns) {
  for (const std::uint64_t runs : {std::uint64_t{1}, std::uint64_t{3}, (std::uint64_t{1} << 52) + 1,
                                   (std::uint64_t{1} << 53) - 1, std::uint64_t{1} << 53}) {
    std::vector<Design> designs{grid_of({runs})};
    for (const Sampling sampling : without_grid) designs.push_back(design_of(sampling, 3, runs));
    for (const Design& design : designs) {
      const std::uint64_t count = std::min<std::uint64_t>(runs, 1000);
      for (const std::uint64_t first : {std::uint64_t{0}, runs - count}) {
        for (const double number : points_of(design, first, count)) {
          ASSERT_TRUE(0 < number && number < 1) << runs << ' ' << static_cast<int>(design.sampling);
        }
      }
    }
  }
}

TEST(Sampler, HasOtherPointsForOtherSeeds) {
  for (const Sampling sampling : without_grid) {
    Design design = design_of(sampling, 2, 100);
    const std::vector<double> points = all_points(design);
    design.seed = 43;
    const std::vector<double> others = all_points(design);
    for (std::size_t i = 0; i < points.size(); ++i) EXPECT_NE(points[i], others[i]);
  }
}

TEST(Sampler, NumbersOfAVariableDoNotDependOnTheOthers) {
  for (const Sampling sampling : {Sampling::random, Sampling::latin_hypercube}) {
    const Design design = design_of(sampling, 5, 100);
    Design alone = design;
    alone.variables = {"v3"};
    EXPECT_EQ(column(all_points(design), 5, 3), all_points(alone));
  }
}

TEST(Sampler, RandomPointsDoNotDependOnTheNumberOfRuns) {
  EXPECT_EQ(points_of(design_of(Sampling::random, 3, 1000), 0, 100),
            all_points(design_of(Sampling::random, 3, 100)));
}

TEST(Sampler, LatinHypercubeHasOnePointInEachStratum) {
  for (const std::uint64_t runs : {1U, 2U, 7U, 1000U}) {
    const std::vector<double> points = all_points(design_of(Sampling::latin_hypercube, 3, runs));
    for (std::size_t j = 0; j < 3; ++j) {
      expect_each_once(strata_of(column(points, 3, j), static_cast<double>(runs)), std::to_string(runs));
    }
  }
}

TEST(Sampler, LatinHypercubeHasItsPointsAnywhereInTheStratum) {
  constexpr int runs = 10000;
  double sum = 0;
  for (const double number : all_points(design_of(Sampling::latin_hypercube, 1, runs))) {
    sum += number * runs - std::floor(number * runs);
  }
  EXPECT_NEAR(sum / runs, 0.5, 5 / std::sqrt(12.0 * runs));  // 5 deviations of the mean
}

TEST(Sampler, NumbersAreUniformAndIndependent) {
  constexpr std::uint64_t runs = 50000;
  constexpr double bins = 100;
  for (const Sampling sampling : {Sampling::random, Sampling::latin_hypercube}) {
    const std::vector<double> points = all_points(design_of(sampling, 2, runs));
    double covariance = 0;
    for (std::size_t i = 0; i < points.size(); i += 2)
      covariance += (points[i] - 0.5) * (points[i + 1] - 0.5);
    // 5 deviations: the product of two independent numbers has the variance 1/144.
    EXPECT_NEAR(covariance / runs, 0, 5 / 12.0 / std::sqrt(runs));
    for (std::size_t j = 0; j < 2; ++j) {
      const std::vector<double> numbers = column(points, 2, j);
      std::vector<double> counts(static_cast<std::size_t>(bins));
      for (const std::uint64_t bin : strata_of(numbers, bins)) ++counts[bin];
      double chi_squared = 0;
      for (const double count : counts) chi_squared += std::pow(count - runs / bins, 2) / (runs / bins);
      // bins - 1 degrees of freedom; 5 deviations.
      EXPECT_LE(chi_squared, bins - 1 + 5 * std::sqrt(2 * (bins - 1)));
      double serial = 0;
      for (std::size_t i = 1; i < numbers.size(); ++i) serial += (numbers[i] - 0.5) * (numbers[i - 1] - 0.5);
      EXPECT_NEAR(serial / runs, 0, 5 / 12.0 / std::sqrt(runs));
    }
  }
}

/// The 52 bits that a number was made of.
std::uint64_t bits_of(double number) { return static_cast<std::uint64_t>(number * 0x1p52 - 0.5); }

TEST(Sampler, SobolPointsAreThoseOfBoostAfterTheOriginButForAShift) {
  constexpr std::size_t variables = 40;
  const Design design = design_of(Sampling::sobol, variables, std::uint64_t{1} << 53);
  const std::vector<double> origin = points_of(design, 0, 1);
  for (const std::uint64_t first :
       {std::uint64_t{1}, std::uint64_t{1000}, (std::uint64_t{1} << 40) - 3, (std::uint64_t{1} << 53) - 40}) {
    boost::random::sobol engine(variables);
    engine.discard((first - 1) * variables);
    const std::vector<double> points = points_of(design, first, 40);
    for (std::size_t i = 0; i < points.size(); ++i) {
      ASSERT_EQ(bits_of(points[i]) ^ bits_of(origin[i % variables]), engine() >> 12) << first;
    }
  }
}

TEST(Sampler, SobolPointsAreShiftedByTheSeedAndTheVariable) {
  const std::vector<double> origin = points_of(design_of(Sampling::sobol, 2, 8, true), 0, 2);
  for (std::size_t part = 0; part < 2; ++part) {
    for (std::size_t j = 0; j < 2; ++j) {
      const Stream stream{42, fnv1a("v" + std::to_string(j))};
      EXPECT_EQ(bits_of(origin[2 * part + j]), stream.word(0, part, Purpose::shift) >> 12);
    }
  }
}

TEST(Sampler, SobolPointsAreANetInTwoDimensions) {
  // One point in each elementary interval of the volume 2^-k, for 2^k points from a multiple of it on.
  constexpr int k = 10;
  constexpr std::uint64_t count = 1 << k;
  const Design design = design_of(Sampling::sobol, 2, 8 * count);
  for (const std::uint64_t first : {std::uint64_t{0}, count, 6 * count}) {
    const std::vector<double> points = points_of(design, first, count);
    for (int a = 0; a <= k; ++a) {
      const std::vector<std::uint64_t> rows = strata_of(column(points, 2, 0), std::ldexp(1, a));
      const std::vector<std::uint64_t> columns = strata_of(column(points, 2, 1), std::ldexp(1, k - a));
      std::vector<std::uint64_t> intervals(count);
      for (std::size_t i = 0; i < count; ++i) intervals[i] = (rows[i] << (k - a)) + columns[i];
      expect_each_once(intervals, std::to_string(a));
    }
  }
}

TEST(Sampler, SobolPointsAreInEachStratumOfEachVariableOnce) {
  constexpr std::size_t variables = 50;
  const std::vector<double> points = all_points(design_of(Sampling::sobol, variables, 256));
  for (std::size_t j = 0; j < variables; ++j) {
    expect_each_once(strata_of(column(points, variables, j), 256), std::to_string(j));
  }
}

TEST(Sampler, GridHasEveryCombinationWithTheLastVariableFastest) {
  EXPECT_EQ(all_points(grid_of({2, 1, 4})),
            (std::vector<double>{0.25, 0.5, 0.125, 0.25, 0.5, 0.375, 0.25, 0.5, 0.625, 0.25, 0.5, 0.875,  //
                                 0.75, 0.5, 0.125, 0.75, 0.5, 0.375, 0.75, 0.5, 0.625, 0.75, 0.5, 0.875}));
}

TEST(Sampler, GroupsAreAAndBAndAWithEachComponentOfB) {
  constexpr std::size_t d = 3;
  for (const Sampling sampling : without_grid) {
    const std::vector<double> all = all_points(design_of(sampling, d, 100 * (d + 2), true));
    for (const double* group = all.data(); group != all.data() + all.size(); group += (d + 2) * d) {
      const double* a = group;
      const double* b = group + d;
      for (std::size_t member = 0; member < d; ++member) {
        const double* mixed = group + (2 + member) * d;
        for (std::size_t j = 0; j < d; ++j) EXPECT_EQ(mixed[j], j == member ? b[j] : a[j]);
      }
    }
  }
}

/// The points A and B of all groups as points of twice as many variables.
std::vector<double> of_both(const std::vector<double>& points, std::size_t d) {
  std::vector<double> both;
  for (std::size_t i = 0; i < points.size(); i += (d + 2) * d) {
    both.insert(both.end(), points.begin() + static_cast<std::ptrdiff_t>(i),
                points.begin() + static_cast<std::ptrdiff_t>(i + 2 * d));
  }
  return both;
}

TEST(Sampler, GroupsHaveTheStrataOfALatinHypercubeInAAndInB) {
  const std::vector<double> both = of_both(all_points(design_of(Sampling::latin_hypercube, 2, 400, true)), 2);
  for (std::size_t j = 0; j < 4; ++j) expect_each_once(strata_of(column(both, 4, j), 100), std::to_string(j));
  EXPECT_NE(strata_of(column(both, 4, 0), 100), strata_of(column(both, 4, 2), 100));
}

TEST(Sampler, GroupsTakeAllDimensionsOfSobolsSequence) {
  const std::vector<double> both = of_both(all_points(design_of(Sampling::sobol, 2, 256, true)), 2);
  boost::random::sobol engine(4);
  for (std::size_t i = 4; i < both.size(); ++i) {
    EXPECT_EQ(bits_of(both[i]) ^ bits_of(both[i % 4]), engine() >> 12);
  }
}

TEST(Sampler, GroupsHaveAAndBIndependentOfEachOther) {
  constexpr std::size_t groups = 20000;
  for (const Sampling sampling : {Sampling::random, Sampling::latin_hypercube}) {
    const std::vector<double> both = of_both(all_points(design_of(sampling, 1, 3 * groups, true)), 1);
    double covariance = 0;
    for (std::size_t i = 0; i < both.size(); i += 2) covariance += (both[i] - 0.5) * (both[i + 1] - 0.5);
    EXPECT_NEAR(covariance / groups, 0, 5 / 12.0 / std::sqrt(groups));  // 5 deviations
  }
}

}  // namespace
}  // namespace hybrid_sphere::testing::sampler_test

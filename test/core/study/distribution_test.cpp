// Against numbers computed with 60 digits, closed forms, and the inverse.

#include "study/distribution.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <limits>

namespace hybrid_sphere::testing::distribution_test {
namespace {

using namespace study;

constexpr double least_share = 0x1p-53;  // that a sampler makes
constexpr double spacing = 0x1p-52;

const Distribution distributions[] = {
    Uniform{-1, 3},
    Uniform{1e15, 1e15 + 1},
    LogUniform{0.5, 8},
    LogUniform{1, 1 + 1e-9},
    LogUniform{1e-300, 1e300},
    Normal{0, 1},
    Normal{-7, 0.25},
    TruncatedNormal{0, 1, -1, 2},
    TruncatedNormal{1, 0.05, 0.9, 1.1},
    TruncatedNormal{0, 1, 8, 9},
    TruncatedNormal{0, 1, -9, -8},
    TruncatedNormal{0, 1, 35, 36},
    TruncatedNormal{0, 1, -100, -40},
    TruncatedNormal{0, 1, 1, 1 + 1e-8},
    TruncatedNormal{0, 1, -1e-9, 1e-9},
    Lognormal{2, 0.5},
    Lognormal{1e-9, 3},
    Triangular{-1, 0, 4},
    Triangular{0, 0, 1},
    Triangular{-2, 5, 5},
};

/// The greatest number that is rounded on the way to x.
double magnitude(const Distribution& distribution, double x) {
  double most = std::abs(x);
  if (const auto* d = std::get_if<Uniform>(&distribution)) {
    most = std::max({most, std::abs(d->low), std::abs(d->high)});
  }
  if (const auto* d = std::get_if<Normal>(&distribution))
    most = std::max({most, std::abs(d->mean), d->deviation});
  if (const auto* d = std::get_if<TruncatedNormal>(&distribution)) {
    most = std::max({most, std::abs(d->mean), d->deviation});
  }
  if (const auto* d = std::get_if<Triangular>(&distribution)) most = std::max({most, -d->low, d->high});
  // The exponent, rounded, is exp()'s absolute error: 690 at most, of numbers from 1e-300 to 1e300.
  if (std::holds_alternative<LogUniform>(distribution)) most *= 700;
  if (std::holds_alternative<Lognormal>(distribution)) most *= 30;  // 3 * 8.3
  return most;
}

std::vector<double> shares() {
  std::vector<double> shares{least_share, 3 * least_share, 0x1p-40, 1e-9, 1 - 0x1p-30, 1 - least_share};
  for (int i = 1; i < 200; ++i) shares.push_back(i / 200.0);
  std::sort(shares.begin(), shares.end());
  return shares;
}

TEST(Quantile, OfTheNormalDistributionHasThePublishedValues) {
  const struct {
    double u, z;
  } cases[] = {{0.5, 0},
               {0.625, 0.31863936396437516302},
               {0.75, 0.6744897501960817432},
               {0.9, 1.2815515655446005935},
               {0.975, 1.9599639845400538556},
               {0.995, 2.5758293035489004539},
               {1e-10, -6.3613409024040561991},
               {0x1p-53, -8.2095361516013868556},
               {1e-300, -37.047096299361199237},
               {5e-324, -38.467405617144346251}};
  for (const auto& c : cases) {
    // The inverse of erfc to 2 roundings, the root of 2, and the product.
    EXPECT_NEAR(quantile(Normal{0, 1}, c.u), c.z, 2 * DBL_EPSILON * std::abs(c.z)) << c.u;
    const double x = 3 + 0.5 * c.z;
    EXPECT_NEAR(quantile(Normal{3, 0.5}, c.u), x, 2 * DBL_EPSILON * std::max(3.0, std::abs(c.z))) << c.u;
  }
}

TEST(Quantile, OfTheNormalDistributionIsOddAboutOneHalf) {
  for (const double u : {0x1p-53, 0x1p-30, 0.125, 0.25, 0.375, 0.4375}) {
    EXPECT_EQ(quantile(Normal{0, 1}, u), -quantile(Normal{0, 1}, 1 - u)) << u;
  }
}

TEST(Quantile, InvertsTheCumulativeDistribution) {
  for (const Distribution& distribution : distributions) {
    for (const double u : shares()) {
      const double x = quantile(distribution, u);
      // The true quantile is within a few roundings of x, so u is between the shares at these two numbers,
      // which are themselves rounded: a few operations, and erfc to 2 roundings.
      const double step = 4 * DBL_EPSILON * magnitude(distribution, x);
      EXPECT_LE(cumulative(distribution, x - step), u * (1 + 8 * DBL_EPSILON))
          << distribution.index() << ' ' << u;
      EXPECT_GE(cumulative(distribution, x + step), u * (1 - 8 * DBL_EPSILON))
          << distribution.index() << ' ' << u;
    }
  }
}

struct TruncatedCase {
  TruncatedNormal distribution;
  double u, x;
};

const TruncatedCase truncated_cases[] = {
    {{0, 1, 8, 9}, 0x1p-40, 8.000000000000111968},
    {{0, 1, 8, 9}, 0.125, 8.016422424846436395},
    {{0, 1, 8, 9}, 0.9375, 8.334276342332126046},
    {{0, 1, -9, -8}, 0x1p-40, -8.999999999449705367},
    {{0, 1, -9, -8}, 0.125, -8.25203368138726898},
    {{0, 1, -9, -8}, 0.9375, -8.007941438445009476},
    {{0, 1, 40, 50}, 0x1p-40, 40.00000000000002272},
    {{0, 1, 40, 50}, 0.125, 40.00333606334435076},
    {{0, 1, 40, 50}, 0.9375, 40.06921167370759985},
    {{0, 1, 29.75, 31}, 0x1p-40, 29.75000000000003054},
    {{0, 1, 29.75, 31}, 0.125, 29.75448305890922992},
    {{0, 1, 29.75, 31}, 0.9375, 29.84294644735987913},
    {{0, 1, 30.25, 31}, 0x1p-40, 30.25000000000003003},
    {{0, 1, 30.25, 31}, 0.125, 30.25440913201171086},
    {{0, 1, 30.25, 31}, 0.9375, 30.34141815176752373},
    {{1, 0.0625, 0.75, 1.25}, 0x1p-40, 0.7500000004247158455},
    {{1, 0.0625, 0.75, 1.25}, 0.125, 0.9281103751206417703},
    {{1, 0.0625, 0.75, 1.25}, 0.9375, 1.095868453145516486},
    {{0, 1, -1, 20}, 0x1p-40, -0.9999999999968376398},
    {{0, 1, -1, 20}, 0.125, -0.6316024360170257426},
    {{0, 1, -1, 20}, 0.9375, 1.620298862003576929},
    {{0, 1, -20, 1.5}, 0x1p-40, -7.057318071620339205},
    {{0, 1, -20, 1.5}, 0.125, -1.191905759289614746},
    {{0, 1, -20, 1.5}, 0.9375, 1.149709591875718598},
    {{0, 0x1p-10, 1, 2}, 0x1p-40, 1.000000000000000001},
    {{0, 0x1p-10, 1, 2}, 0.125, 1.000000127345330026},
    {{0, 0x1p-10, 1, 2}, 0.9375, 1.000002644140636977},
    {{0, 1, -0x1p-12, 0x1p-11}, 0x1p-40, -0.0002441406249993338662},
    {{0, 1, -0x1p-12, 0x1p-11}, 0.125, -0.0001525878915202837876},
    {{0, 1, -0x1p-12, 0x1p-11}, 0.9375, 0.000442504879215377273},
    {{3, 2, -1000, 1000}, 0x1p-40, -11.09540051332881745},
    {{3, 2, -1000, 1000}, 0.125, 0.6993012392479836434},
    {{3, 2, -1000, 1000}, 0.9375, 6.068241088705092623},
    {{0, 1, 2, 2 + 0x1p-30}, 0.125, 2.000000000116415322},
    {{0, 1, 2, 2 + 0x1p-30}, 0.9375, 2.000000000873114914},
    {{0, 1, -45, -45 + 0x1p-25}, 0.125, -44.99999999627470752},
    {{0, 1, -45, -45 + 0x1p-25}, 0.9375, -44.99999997206032159},
};

TEST(Quantile, OfATruncatedNormalDistributionIsRightFarOutAndBetweenCloseLimits) {
  for (const auto& [d, u, x] : truncated_cases) {
    // Three functions good to 1 or 2 roundings, where the quantile's slope is below that of its argument, and
    // the last product and sum.
    const double tolerance = 2 * DBL_EPSILON * std::max({std::abs(d.mean), d.deviation, std::abs(x)});
    EXPECT_NEAR(quantile(d, u), x, tolerance) << d.low << ' ' << d.high << ' ' << u;
  }
}

TEST(Quantile, OfATruncatedNormalDistributionIsMirroredWithItsLimits) {
  for (const auto& c : truncated_cases) {
    const TruncatedNormal& d = c.distribution;
    const TruncatedNormal mirrored{-d.mean, d.deviation, -d.high, -d.low};
    EXPECT_EQ(quantile(mirrored, 1 - c.u), -quantile(d, c.u)) << d.low << ' ' << d.high << ' ' << c.u;
  }
}

TEST(Quantile, OfATruncatedNormalDistributionIsExponentialBeyondAllProbability) {
  // The density falls off with the rate a; the next term of its logarithm is t^2/2 < 1e-13 of the first.
  const double a = 1e8;
  const TruncatedNormal beyond{-a, 1, 0, 1e9};  // so that no figure of the distance is lost
  for (const double u : {0x1p-53, 1e-6, 0.25, 0.5, 0.75, 1 - 1e-6}) {
    const double t = -std::log1p(-u) / a;
    EXPECT_NEAR(quantile(beyond, u), t, 1e-12 * t) << u;
    EXPECT_NEAR(cumulative(beyond, t), u, 1e-12 * u) << u;
  }
}

TEST(Quantile, OfATruncatedNormalDistributionIsThatOfTheWholeOneBetweenFarLimits) {
  for (const double u : shares()) {
    const double z = quantile(Normal{0, 1}, u);
    EXPECT_NEAR(quantile(TruncatedNormal{0, 1, -1e300, 1e300}, u), z,
                4 * DBL_EPSILON * std::max(1.0, std::abs(z)));
  }
}

TEST(Quantile, StaysWithinTheLimitsWhateverTheyAre) {
  const double numbers[] = {-1e300, -1e15,           -40, -1,  -1e-300, 0, 1e-300, 1e-9,
                            1,      1 + DBL_EPSILON, 9,   1e9, 1e300};
  for (const double mean : {-1e300, 0.0, 1.0, 1e300}) {
    for (const double deviation : {1e-300, 1e-9, 1.0, 1e9, 1e300}) {
      for (const double low : numbers) {
        for (const double high : numbers) {
          if (low >= high) continue;
          for (const double u : {least_share, 0.3, 1 - least_share}) {
            const double x = quantile(TruncatedNormal{mean, deviation, low, high}, u);
            ASSERT_TRUE(low <= x && x <= high)
                << mean << ' ' << deviation << ' ' << low << ' ' << high << ' ' << x;
            const double share = cumulative(TruncatedNormal{mean, deviation, low, high}, x);
            ASSERT_TRUE(0 <= share && share <= 1) << mean << ' ' << deviation << ' ' << low << ' ' << high;
          }
        }
      }
    }
  }
}

TEST(Quantile, IsFiniteForAnyShare) {
  const Distribution extreme[] = {Uniform{-1e300, 1e300}, LogUniform{1e-300, 1e300},
                                  Normal{1e300, 1e300},   Lognormal{1e300, 100},
                                  Lognormal{1e-300, 100}, Triangular{-1e300, 0, 1e300}};
  for (const double u : {5e-324, 1e-300, 1e-17, least_share, 0.5, 1 - least_share}) {
    for (const Distribution& distribution : extreme)
      EXPECT_TRUE(std::isfinite(quantile(distribution, u))) << u;
    for (const Distribution& distribution : distributions)
      EXPECT_TRUE(std::isfinite(quantile(distribution, u)));
  }
}

TEST(Quantile, DoesNotDecrease) {
  for (const Distribution& distribution : distributions) {
    double before = -std::numeric_limits<double>::infinity();
    for (const double u : shares()) {
      const double x = quantile(distribution, u);
      EXPECT_LE(before, x) << distribution.index() << ' ' << u;
      before = x;
    }
  }
}

TEST(Quantile, OfTheNormalDistributionDoesNotDecreaseAtNeighbours) {
  // Where the approximations of erfc's inverse meet: q = 0.5, 0.25, exp(-9), exp(-36).
  for (const double q : {1.0, 0.5, 0.25, std::exp(-9), std::exp(-36)}) {
    for (const double meeting : {q / 2, 1 - q / 2}) {
      const double start = std::max(std::floor(meeting / spacing) - 200, 0.0);
      double before = -std::numeric_limits<double>::infinity();
      for (int i = 0; i < 400; ++i) {
        const double u = (start + i + 0.5) * spacing;
        if (u >= 1) break;
        const double z = quantile(Normal{0, 1}, u);
        EXPECT_LE(before, z) << u;
        before = z;
      }
    }
  }
}

TEST(Quantile, HasItsClosedForms) {
  for (const double u : {0.125, 0.5, 0.8}) {
    EXPECT_DOUBLE_EQ(quantile(Uniform{2, 6}, u), 2 + 4 * u);
    EXPECT_DOUBLE_EQ(quantile(LogUniform{2, 32}, u), 2 * std::pow(16, u));
    // A square root's distribution, and a minimum's of two.
    EXPECT_DOUBLE_EQ(quantile(Triangular{0, 3, 3}, u), 3 * std::sqrt(u));
    EXPECT_DOUBLE_EQ(quantile(Triangular{0, 0, 3}, u), 3 - 3 * std::sqrt(1 - u));
  }
  EXPECT_DOUBLE_EQ(quantile(Triangular{0, 1, 4}, 0.25), 1);
  EXPECT_EQ(quantile(Lognormal{3, 2}, 0.5), 3);
  // The exponent 1.96 is rounded twice.
  EXPECT_NEAR(quantile(Lognormal{1, 1}, 0.975), 7.0990713842313336, 4 * DBL_EPSILON * 7.1);
}

TEST(Quantile, OfValuesIsEachOfThemForItsShare) {
  const Distribution values = Values{{1, 2, 5, 8}, {0, 0.25, 0.75, 1}};
  EXPECT_EQ(quantile(values, 5e-324), 2);  // 1 has no weight
  EXPECT_EQ(quantile(values, 0.25), 2);
  EXPECT_EQ(quantile(values, std::nextafter(0.25, 1)), 5);
  EXPECT_EQ(quantile(values, 0.75), 5);
  EXPECT_EQ(quantile(values, 0.9), 8);
  EXPECT_EQ(quantile(values, std::nextafter(1, 0)), 8);
}

TEST(Cumulative, OfValuesIsAStairway) {
  const Distribution values = Values{{1, 2, 2, 8}, {0.125, 0.25, 0.75, 1}};
  const struct {
    double x, share;
  } cases[] = {{0.9, 0}, {1, 0.125}, {1.9, 0.125}, {2, 0.75}, {7, 0.75}, {8, 1}, {9, 1}};
  for (const auto& c : cases) EXPECT_EQ(cumulative(values, c.x), c.share) << c.x;
}

TEST(Cumulative, IsZeroBelowAndOneAboveAllSamples) {
  for (const Distribution& distribution : distributions) {
    EXPECT_EQ(cumulative(distribution, -1e301), 0) << distribution.index();
    EXPECT_EQ(cumulative(distribution, 1e301), 1) << distribution.index();
  }
  EXPECT_EQ(cumulative(Lognormal{1, 1}, 0), 0);
  EXPECT_EQ(cumulative(LogUniform{1, 2}, 0.5), 0);
}

}  // namespace
}  // namespace hybrid_sphere::testing::distribution_test

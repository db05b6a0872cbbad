#include "study/permutation.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <vector>

namespace hybrid_sphere::testing::permutation_test {
namespace {

using namespace study;

std::vector<std::uint64_t> all_of(std::uint64_t size, std::uint64_t seed, std::uint64_t part = 0) {
  const Permutation permutation(size, Stream{seed, fnv1a("sphere.mass")}, part);
  std::vector<std::uint64_t> all(size);
  for (std::uint64_t i = 0; i < size; ++i) all[i] = permutation(i);
  return all;
}

TEST(Permutation, HasEachNumberOnce) {
  std::vector<std::uint64_t> sizes(130);
  std::iota(sizes.begin(), sizes.end(), 1);
  sizes.insert(sizes.end(), {1000, 1024, 1025, 65535, 65536, 65537});
  for (const std::uint64_t size : sizes) {
    std::vector<std::uint64_t> all = all_of(size, size);
    std::sort(all.begin(), all.end());
    for (std::uint64_t i = 0; i < size; ++i) ASSERT_EQ(all[i], i) << size;
  }
}

TEST(Permutation, StaysBelowAnySize) {
  for (int bits = 1; bits <= 63; ++bits) {
    const std::uint64_t power = std::uint64_t{1} << bits;
    for (const std::uint64_t size : {power - 1, power, bits == 63 ? power : power + 1}) {
      const Permutation permutation(size, Stream{1, 2}, 0);
      std::vector<std::uint64_t> some;
      for (std::uint64_t i = 0; i < std::min<std::uint64_t>(size, 50); ++i) {
        some.push_back(permutation(i % 2 == 0 ? i / 2 : size - 1 - i / 2));
        ASSERT_LT(some.back(), size);
      }
      std::sort(some.begin(), some.end());
      EXPECT_TRUE(std::adjacent_find(some.begin(), some.end()) == some.end()) << size;
    }
  }
}

TEST(Permutation, IsAnyOfAFewNumbersWithTheSameProbability) {
  constexpr int trials = 24000;
  for (const std::uint64_t size : {2U, 3U, 4U}) {
    std::map<std::vector<std::uint64_t>, int> seen;
    for (std::uint64_t seed = 0; seed < trials; ++seed) ++seen[all_of(size, seed)];
    const double kinds = size == 2 ? 2 : size == 3 ? 6 : 24;
    ASSERT_EQ(static_cast<double>(seen.size()), kinds);
    // Each is binomial with the deviation sqrt(trials/kinds): 5 of them are left by one in 10^6.
    const double mean = trials / kinds;
    for (const auto& [order, count] : seen) EXPECT_NEAR(count, mean, 5 * std::sqrt(mean)) << size;
  }
}

TEST(Permutation, MovesANumberToAnyPlaceWithTheSameProbability) {
  constexpr int trials = 20000;
  constexpr std::uint64_t size = 1000;
  for (const std::uint64_t index : {0U, 1U, 500U, 999U}) {
    std::vector<int> counts(size);
    for (std::uint64_t seed = 0; seed < trials; ++seed) {
      ++counts[Permutation(size, Stream{seed, 3}, 0)(index)];
    }
    double chi_squared = 0;
    constexpr double mean = trials / static_cast<double>(size);
    for (const int count : counts) chi_squared += (count - mean) * (count - mean) / mean;
    // size - 1 degrees of freedom, and 5 deviations of sqrt(2 (size - 1)).
    EXPECT_NEAR(chi_squared, size - 1, 5 * std::sqrt(2 * (size - 1.0)));
  }
}

TEST(Permutation, DependsOnSeedNameAndPart) {
  const std::vector<std::uint64_t> one = all_of(100, 1);
  EXPECT_EQ(one, all_of(100, 1));
  EXPECT_NE(one, all_of(100, 2));
  EXPECT_NE(one, all_of(100, 1, 1));
  const Permutation other(100, Stream{1, fnv1a("sphere.radius")}, 0);
  std::uint64_t same = 0;
  for (std::uint64_t i = 0; i < 100; ++i) same += other(i) == one[i] ? 1U : 0U;
  EXPECT_LT(same, 8);  // Poisson with the mean 1: one in 10^5
}

}  // namespace
}  // namespace hybrid_sphere::testing::permutation_test

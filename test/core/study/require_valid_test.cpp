// Which designs are refused, and with which words.

#include <gtest/gtest.h>

#include <stdexcept>

#include "study/sampler.hpp"

namespace hybrid_sphere::testing::require_valid_test {
namespace {

using namespace study;

Design design_of(Sampling sampling, std::size_t variables, std::uint64_t runs) {
  Design design;
  design.sampling = sampling;
  design.runs = runs;
  for (std::size_t i = 0; i < variables; ++i) design.variables.push_back("v" + std::to_string(i));
  return design;
}

Design grid_of(const std::vector<std::uint64_t>& levels, std::uint64_t runs) {
  Design design = design_of(Sampling::grid, levels.size(), runs);
  design.levels = levels;
  return design;
}

Design for_indices(Design design) {
  design.saltelli = true;
  return design;
}

std::string refusal(const Design& design) {
  try {
    require_valid(design);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "accepted";
}

TEST(RequireValid, AcceptsDesigns) {
  for (const Sampling sampling : {Sampling::random, Sampling::latin_hypercube, Sampling::sobol}) {
    EXPECT_EQ(refusal(design_of(sampling, 1, 1)), "accepted");
    EXPECT_EQ(refusal(design_of(sampling, 3, std::uint64_t{1} << 53)), "accepted");
    EXPECT_EQ(refusal(for_indices(design_of(sampling, 3, 5000))), "accepted");
  }
  EXPECT_EQ(refusal(grid_of({1}, 1)), "accepted");
  EXPECT_EQ(refusal(grid_of({3, 5, 7}, 105)), "accepted");
  EXPECT_EQ(refusal(grid_of({1 << 26, 1 << 27}, std::uint64_t{1} << 53)), "accepted");
}

TEST(RequireValid, RefusesNoVariablesAndRepeatedOnes) {
  EXPECT_EQ(refusal(design_of(Sampling::random, 0, 1)), "variables: none is refused; allowed: at least one");
  Design design = design_of(Sampling::random, 3, 1);
  design.variables[2] = "v0";
  EXPECT_EQ(refusal(design), "variables: v0 twice is refused; allowed: each variable once");
}

TEST(RequireValid, RefusesNoneOrTooManyRuns) {
  EXPECT_EQ(refusal(design_of(Sampling::random, 1, 0)), "runs: 0 is refused; allowed: 1 to 9007199254740992");
  EXPECT_EQ(refusal(design_of(Sampling::random, 1, (std::uint64_t{1} << 53) + 1)),
            "runs: 9007199254740993 is refused; allowed: 1 to 9007199254740992");
}

TEST(RequireValid, RefusesMoreVariablesThanSobolsSequenceHas) {
  EXPECT_EQ(refusal(design_of(Sampling::sobol, 3667, 1)), "accepted");
  EXPECT_EQ(
      refusal(design_of(Sampling::sobol, 3668, 1)),
      "variables: 3668 with the sampling sobol is refused; allowed: at most 3667; the samplings random and "
      "latin_hypercube have any number");
  EXPECT_EQ(refusal(for_indices(design_of(Sampling::sobol, 1833, 1835))), "accepted");
  EXPECT_EQ(
      refusal(for_indices(design_of(Sampling::sobol, 1834, 1836))),
      "variables: 1834 with the sampling sobol is refused; allowed: at most 1833 for Sobol' indices; the "
      "samplings random and latin_hypercube have any number");
  EXPECT_EQ(refusal(design_of(Sampling::random, 5000, 1)), "accepted");
}

TEST(RequireValid, RefusesGridsOfOtherLevelsThanRuns) {
  EXPECT_EQ(refusal(grid_of({3, 5}, 14)),
            "runs: 14 with the sampling grid is refused; allowed: 15, the product of the levels");
  EXPECT_EQ(refusal(grid_of({3, 0}, 1)), "levels: 0 of v1 is refused; allowed: at least 1");
  // 2^64 combinations, which would be 0.
  EXPECT_EQ(refusal(grid_of({std::uint64_t{1} << 32, std::uint64_t{1} << 32}, 1)),
            "levels: a product above 9007199254740992 is refused; allowed: at most so many combinations");
  Design design = grid_of({3, 5}, 15);
  design.levels.pop_back();
  EXPECT_EQ(refusal(design), "levels: 1 numbers is refused; allowed: 2, one of each variable");
}

TEST(RequireValid, RefusesAGridForSobolIndices) {
  EXPECT_EQ(refusal(for_indices(grid_of({2, 2}, 4))),
            "sampling: grid for Sobol' indices is refused; allowed: random, latin_hypercube, sobol");
}

TEST(RequireValid, NamesTheNearestRunsForSobolIndices) {
  const std::string allowed =
      " for Sobol' indices is refused; allowed: a multiple of 5, the number of "
      "variables and 2, such as ";
  EXPECT_EQ(refusal(for_indices(design_of(Sampling::sobol, 3, 1003))),
            "runs: 1003" + allowed + "1000 or 1005");
  EXPECT_EQ(refusal(for_indices(design_of(Sampling::sobol, 3, 3))), "runs: 3" + allowed + "5");
  // 2^53 mod 5 is 2.
  EXPECT_EQ(refusal(for_indices(design_of(Sampling::sobol, 3, std::uint64_t{1} << 53))),
            "runs: 9007199254740992" + allowed + "9007199254740990");
}

}  // namespace
}  // namespace hybrid_sphere::testing::require_valid_test

// Laws that every system with contacts, friction, events and resets keeps, on random ones (fuzz/).
// HYBRID_SPHERE_TEST_FACTOR=500 looks at 100,000 of them.
#include "../fuzz/random_systems.hpp"

#include <gtest/gtest.h>

#include <exception>

#include "../fuzz/draw_seeded.hpp"
#include "../fuzz/judge_systems.hpp"
#include "support/case_count.hpp"

namespace hybrid_sphere::mechanics::random_systems_property_test {
namespace {

constexpr std::uint64_t seed = 2005;
constexpr int in_block = 25;

using Judge = fuzz::SystemVerdict (*)(const fuzz::RandomSystem&);

void expect_no_faults_of(int system, Judge judge) {
  fuzz::begin_draws(seed, static_cast<std::uint64_t>(system));
  const fuzz::RandomSystem random = fuzz::draw_random_system();
  try {
    for (const std::string& fault : judge(random).faults) {
      ADD_FAILURE() << "system " << system << ": " << fault << '\n' << random.text();
    }
  } catch (const std::exception& error) {
    ADD_FAILURE() << "system " << system << " throws: " << error.what() << '\n' << random.text();
  }
}

/// Blocks of systems, so that no test takes long.
class RandomSystems : public ::testing::TestWithParam<int> {
 protected:
  void expect_no_faults(Judge judge) const {
    const int systems = hybrid_sphere::testing::case_count(in_block);
    for (int i = GetParam() * systems; i < (GetParam() + 1) * systems; ++i) expect_no_faults_of(i, judge);
  }
};

TEST_P(RandomSystems, KeepTheLawsOfContactsFrictionsAndEvents) { expect_no_faults(fuzz::judge_laws); }

TEST_P(RandomSystems, MoveAlikeInAnyPeriodsAndAfterBeingPutBack) { expect_no_faults(fuzz::judge_plant); }

TEST_P(RandomSystems, MoveAlikeInOtherUnits) { expect_no_faults(fuzz::judge_units); }

INSTANTIATE_TEST_SUITE_P(InBlocks, RandomSystems, ::testing::Range(0, 8));

/// Systems beyond these blocks that have broken a law.
class RareSystems : public ::testing::TestWithParam<int> {};

TEST_P(RareSystems, KeepTheLawsOfContactsFrictionsAndEvents) {
  expect_no_faults_of(GetParam(), fuzz::judge_laws);
}

INSTANTIATE_TEST_SUITE_P(
    , RareSystems,
    ::testing::Values(301,    // a slip turns at once when bounces have come to rest
                      390,    // a contact opens whose velocity closes it by rounding
                      1251,   // two frictions with many reactions reach their limits
                      1278,   // a slip that a bounce below the resolution has left
                      2052,   // an impulse opens a contact more slowly than the error
                      2734,   // a bounce that friction at another contact makes short
                      3354,   // a contact and its friction lose their load together
                      3684,   // two frictions leave a thin choice of reactions
                      3782,   // a motion begins on the edge of a guard, away from it
                      3807,   // the slip of a brake begins where constraints leave it one direction
                      4833,   // a contact carries nothing, and its friction rounding
                      5096,   // a slip begins where its contact carries nothing
                      5098,   // two solutions of an impulse take turns
                      7106,   // one division of the load lets a friction slide, the motion's does not
                      7572,   // the same with a static coefficient
                      8334,   // a gap touches 0 and opens again
                      14444,  // a motion at rest on the edge of a guard leaves it
                      25873,  // a wedged contact loses its load and its friction, rounding apart
                      26036   // a guard has changed by less than its rounding
                      ));

}  // namespace
}  // namespace hybrid_sphere::mechanics::random_systems_property_test

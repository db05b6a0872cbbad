#include "html/recording.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace hybrid_sphere::testing::recording_test {
namespace {

using html::Recording;

State at(double time, std::string_view region = "base") {
  State state;
  state.time = time;
  state.region = region;
  return state;
}

TEST(Recording, KeepsAllOfWhatIsNotMore) {
  Recording recording;
  for (std::size_t i = 0; i < Recording::max_states; ++i) recording.add(at(static_cast<double>(i)));
  const std::vector<State> states = recording.states();
  ASSERT_EQ(states.size(), Recording::max_states);
  for (std::size_t i = 0; i < states.size(); ++i) ASSERT_EQ(states[i].time, static_cast<double>(i));
}

TEST(Recording, OfManyStatesKeepsAnEvenChoiceWithBothEnds) {
  for (const int count : {10'002, 80'007, 80'008, 80'009, 160'017, 1'234'567}) {
    Recording recording;
    for (int i = 0; i < count; ++i) recording.add(at(i));
    const std::vector<State> states = recording.states();
    ASSERT_LE(states.size(), Recording::max_states);
    ASSERT_GE(states.size(), Recording::max_states - 1);
    EXPECT_EQ(states.front().time, 0);
    EXPECT_EQ(states.back().time, count - 1);
    EXPECT_EQ(recording.states_in_all(), static_cast<std::uint64_t>(count));
    const double mean = static_cast<double>(count - 1) / static_cast<double>(states.size() - 1);
    for (std::size_t i = 1; i < states.size(); ++i) {
      const double gap = states[i].time - states[i - 1].time;
      ASSERT_GT(gap, 0) << count;
      // Each is at most one kept state, a quarter of the gap or one output, from its even place.
      ASSERT_LE(gap, mean + std::max(1.0, 0.5 * mean)) << count << " at " << i;
    }
  }
}

TEST(Recording, KeepsTheFirstSwitchesAndCountsAll) {
  Recording recording;
  Switch event;
  for (std::size_t i = 0; i < 3 * Recording::max_switches; ++i) {
    event.time = static_cast<double>(i);
    recording.add(event);
  }
  ASSERT_EQ(recording.switches().size(), Recording::max_switches);
  EXPECT_EQ(recording.switches().back().time, static_cast<double>(Recording::max_switches - 1));
  EXPECT_EQ(recording.switches_in_all(), 3 * Recording::max_switches);
}

TEST(Recording, HoldsTheNames) {
  Recording recording;
  {
    const std::string name = "a name that is gone when the page is written";
    recording.add(at(1, name));
    Switch event;
    event.from_region = name;
    event.to_region = name;
    recording.add(event);
  }
  EXPECT_EQ(recording.states().front().region, "a name that is gone when the page is written");
  EXPECT_EQ(recording.switches().front().to_region, "a name that is gone when the page is written");
}

TEST(Recording, OfNothingIsEmpty) {
  const Recording recording;
  EXPECT_TRUE(recording.states().empty());
  EXPECT_TRUE(recording.switches().empty());
}

}  // namespace
}  // namespace hybrid_sphere::testing::recording_test

// A motion goes on from any of its states as if it had not been interrupted: a Plant that is advanced in any
// periods, and a new solve() from a state.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "catalogue/catalogue.hpp"
#include "hybrid_sphere/mechanics/plant.hpp"

namespace hybrid_sphere::mechanics::restart_test {
namespace {

struct Whole {
  catalogue::Example example;
  double duration;
  Solution solution;
};

Whole whole(const catalogue::Entry& entry, const Options& options = {}) {
  catalogue::Example example = entry.build(catalogue::Values(entry.parameters));
  Solution solution = solve(example.model, example.initial, entry.duration, options);
  return {std::move(example), entry.duration, std::move(solution)};
}

/// The same constraints, and instants that differ by no more than the accuracy makes of a motion.
void expect_same_switches(const std::vector<Switch>& found, const std::vector<Switch>& expected,
                          double duration, const std::string& what) {
  ASSERT_EQ(found.size(), expected.size()) << what;
  for (std::size_t i = 0; i < found.size(); ++i) {
    EXPECT_EQ(found[i].applied, expected[i].applied) << what << ", switch " << i;
    EXPECT_EQ(found[i].released, expected[i].released) << what << ", switch " << i;
    EXPECT_NEAR(found[i].time, expected[i].time, 1e-6 * duration) << what << ", switch " << i;
  }
}

/// Periods from 1e-4 s to 10 s, as many as fit: of the shortest ones a part of the motion.
class Periods {
 public:
  Periods(unsigned seed, double duration) : random_(seed), duration_(duration) {}
  double next() {
    std::uniform_real_distribution<double> exponent(-4, 1);
    return std::max(std::pow(10.0, exponent(random_)), duration_ / 400);
  }

 private:
  std::mt19937 random_;
  double duration_;
};

TEST(Plant, MovesInAnyPeriodsAsSolveDoesToTheBit) {
  for (const catalogue::Entry& entry : catalogue::entries()) {
    const Whole all = whole(entry);
    for (unsigned seed = 0; seed < 5; ++seed) {
      Periods periods(seed, all.duration);
      Plant plant(all.example.model, all.example.initial, {}, all.duration);
      std::vector<Switch> switches;
      const double begin = all.solution.begin();
      for (double t = begin; t < begin + all.duration;) {
        t = std::min(t + periods.next(), begin + all.duration);
        const Status status = plant.advance(t, [&](const Switch& event) { switches.push_back(event); });
        ASSERT_EQ(status.stop, Stop::reached_end) << entry.name << ": " << status.message;
        EXPECT_EQ(plant.time(), t);
      }
      ASSERT_EQ(switches.size(), all.solution.switches().size()) << entry.name;
      for (std::size_t i = 0; i < switches.size(); ++i) {
        EXPECT_EQ(switches[i].time, all.solution.switches()[i].time) << entry.name;
        EXPECT_EQ(switches[i].v_after, all.solution.switches()[i].v_after) << entry.name;
        EXPECT_EQ(switches[i].index, i) << entry.name;
      }
      const State last = all.solution.at(all.solution.end());
      // The last step of solve() is shorter: it ends at the end.
      EXPECT_LT((plant.state().q - last.q).norm(), 1e-9 * (1 + last.q.norm())) << entry.name;
    }
  }
}

void expect_continued(const catalogue::Entry& entry, bool tells_active) {
  const Whole all = whole(entry);
  for (unsigned seed = 0; seed < 4; ++seed) {
    Periods periods(seed, all.duration);
    Initial now = all.example.initial;
    std::vector<Switch> switches;
    const double end = all.solution.begin() + all.duration;
    while (now.time < end) {
      const double period = std::min(periods.next(), end - now.time);
      const Solution part = solve(all.example.model, now, period);
      ASSERT_EQ(part.status().stop, Stop::reached_end)
          << entry.name << " from " << now.time << ": " << part.status().message;
      switches.insert(switches.end(), part.switches().begin(), part.switches().end());
      const State state = part.at(part.end());
      now = {std::min(state.time, end), state.q, state.v, std::nullopt};
      if (tells_active) now.active = state.active;
    }
    expect_same_switches(switches, all.solution.switches(), all.duration,
                         entry.name + ", seed " + std::to_string(seed));
  }
}

TEST(RestartOfTheCatalogue, FromAStateWithItsConstraintsChangesNoSwitch) {
  for (const catalogue::Entry& entry : catalogue::entries()) expect_continued(entry, true);
}

TEST(RestartOfTheCatalogue, FromAStateAloneChangesNoSwitch) {
  for (const catalogue::Entry& entry : catalogue::entries()) expect_continued(entry, false);
}

}  // namespace
}  // namespace hybrid_sphere::mechanics::restart_test

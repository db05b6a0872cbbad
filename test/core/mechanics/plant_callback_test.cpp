// What on_switch may do: the plant is at the switch.
#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "hybrid_sphere/mechanics/event.hpp"
#include "hybrid_sphere/mechanics/plant.hpp"
#include "hybrid_sphere/mechanics/system.hpp"

namespace hybrid_sphere::mechanics::plant_callback_test {
namespace {

/// x'' = input, with an event at x = 1.
Model pushed(const Vector& input) {
  const double push = input[0];
  return System<1>(
             {"x"}, [](auto, const auto&, const auto& v) { return v[0] * v[0] / 2; },
             [push](auto, const auto&, const auto&) { return push; })
      .event("line", [](double, const Vector& q, const Vector&) { return q[0] - 1; });
}

const double crossing = std::sqrt(3) - 1;  // of x = t + t^2/2 = 1
const double speed = std::sqrt(3);         // there

class OnSwitch : public ::testing::Test {
 protected:
  Plant plant{pushed, {1.0}, {0, {0.0}, {1.0}}};
};

TEST_F(OnSwitch, SeesThePlantAtTheSwitch) {
  plant.advance(0.5);
  int calls = 0;
  plant.advance(2, [&](const Switch& event) {
    ++calls;
    EXPECT_NEAR(plant.time(), crossing, 1e-14);
    EXPECT_EQ(plant.time(), event.time);
    const State state = plant.state();
    EXPECT_EQ(state.time, event.time);
    EXPECT_EQ(state.q, event.q);
    EXPECT_EQ(state.v, event.v_after);
  });
  EXPECT_EQ(calls, 1);
  EXPECT_NEAR(plant.state().q[0], 4, 1e-12);
}

TEST_F(OnSwitch, MaySetAnInputThatActsFromTheSwitchOn) {
  int calls = 0;
  plant.advance(1.5, [&](const Switch&) {
    ++calls;
    plant.set_input({-3.0});
  });
  EXPECT_EQ(calls, 1);
  const double rest = 1.5 - crossing;
  EXPECT_NEAR(plant.state().q[0], 1 + speed * rest - 1.5 * rest * rest, 1e-12);
  EXPECT_NEAR(plant.state().v[0], speed - 3 * rest, 1e-12);
  EXPECT_EQ(plant.switches(), 1u);
}

TEST_F(OnSwitch, MaySaveThePlant) {
  std::vector<Plant::Snapshot> saved;
  plant.advance(2, [&](const Switch&) { saved.push_back(plant.save()); });
  const State end = plant.state();
  ASSERT_EQ(saved.size(), 1u);
  plant.restore(saved[0]);
  EXPECT_NEAR(plant.time(), crossing, 1e-14);
  int calls = 0;
  plant.advance(2, [&](const Switch&) { ++calls; });
  EXPECT_EQ(calls, 0) << "the switch has happened";
  EXPECT_NEAR(plant.state().q[0], end.q[0], 1e-12);
}

TEST_F(OnSwitch, MayNotAdvanceOrRestoreThePlant) {
  const Plant::Snapshot start = plant.save();
  const auto refusal = [&](const SwitchSink& on_switch) -> std::string {
    try {
      plant.advance(2, on_switch);
    } catch (const std::logic_error& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(refusal([&](const Switch&) { plant.advance(3); }).find("advance() is called in on_switch"), 0u);
  EXPECT_NEAR(plant.time(), crossing, 1e-14);
  plant.restore(start);
  EXPECT_EQ(refusal([&](const Switch&) { plant.restore(start); }).find("restore() is called in on_switch"),
            0u);
  plant.advance(2);
  EXPECT_NEAR(plant.state().q[0], 4, 1e-12);
}

TEST_F(OnSwitch, LeavesThePlantAtTheSwitchIfItThrows) {
  EXPECT_THROW(plant.advance(2, [](const Switch&) { throw std::runtime_error("full"); }), std::runtime_error);
  EXPECT_NEAR(plant.time(), crossing, 1e-14);
  EXPECT_NEAR(plant.state().q[0], 1, 1e-14);
  EXPECT_NEAR(plant.state().v[0], speed, 1e-14);
  plant.restore(plant.save());
  int calls = 0;
  EXPECT_EQ(plant.advance(2, [&](const Switch&) { ++calls; }).stop, Stop::reached_end);
  EXPECT_EQ(calls, 0);
  EXPECT_NEAR(plant.state().q[0], 4, 1e-12);
}

}  // namespace
}  // namespace hybrid_sphere::mechanics::plant_callback_test

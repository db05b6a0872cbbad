#include "hybrid_sphere/mechanics/plant.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <vector>

#include "core/mechanics/particle.hpp"

namespace hybrid_sphere::mechanics::plant_test {
namespace {

/// x'' = input on the first axis.
Model pushed(const Vector& input) {
  const double push = input[0];
  return System<1>(
      {"x"}, [](auto, const auto&, const auto& v) { return v[0] * v[0] / 2; },
      [push](auto, const auto&, const auto&) { return push; });
}

/// A sledge on a runner that moves along itself at the speed that is asked for.
Model driven(const Vector& input) {
  const double speed = input[0];
  return System<2>({"x", "y"}, [](auto, const auto&, const auto& v) { return v.squaredNorm() / 2; })
      .constrain(
          "drive", [speed](auto, const auto&, const auto& v) { return v[0] - speed; }, always());
}

/// A ball over ground at y = 0, which holds it as long as it is not above.
Model dropped() {
  return System<2>({"x", "y"},
                   [](auto, const auto& q, const auto& v) { return v.squaredNorm() / 2 - 9.81 * q[1]; })
      .constrain(
          "ground", [](auto, const auto&, const auto& v) { return v[1]; },
          while_positive([](auto, const auto& q) { return -q[1]; }));
}

TEST(Plant, HoldsItsInputUntilTheNextOne) {
  Plant plant(pushed, {0.0}, {0, {0.0}, {1.0}});
  double x = 0;
  double v = 1;
  for (int i = 1; i <= 20; ++i) {
    const double push = std::sin(i);
    plant.set_input({push});
    EXPECT_EQ(plant.input()[0], push);
    plant.advance(0.1 * i);
    x += 0.1 * v + 0.005 * push;
    v += 0.1 * push;
    EXPECT_NEAR(plant.state().q[0], x, 1e-12);
    EXPECT_NEAR(plant.state().v[0], v, 1e-12);
  }
  EXPECT_EQ(plant.switches(), 0u);
}

TEST(Plant, JumpsByAnImpulseWhereAnInputMovesAConstraint) {
  Plant plant(driven, {1.0}, {0, {0.0, 0.0}, {1.0, 0.5}});
  std::vector<Switch> switches;
  const auto keep = [&](const Switch& event) { switches.push_back(event); };
  plant.advance(1, keep);
  plant.set_input({3.0});
  EXPECT_EQ(plant.state().v[0], 1);
  plant.advance(2, keep);
  ASSERT_EQ(switches.size(), 1u);
  EXPECT_EQ(switches[0].time, 1);
  EXPECT_TRUE(switches[0].applied.empty());
  EXPECT_TRUE(switches[0].released.empty());
  EXPECT_EQ(switches[0].active, ActiveSet{0});
  EXPECT_NEAR(switches[0].impulse[0], 2, 1e-14);
  EXPECT_NEAR(plant.state().q[0], 1 + 3, 1e-12);
  EXPECT_NEAR(plant.state().q[1], 1, 1e-12);
}

TEST(Plant, TellsASwitchWhenItsTimeIsReached) {
  Plant plant(dropped(), {0, {0.0, 1.0}, {1.0, 0.0}});
  const double landing = std::sqrt(2 / 9.81);
  int told = 0;
  const auto count = [&](const Switch& event) {
    ++told;
    EXPECT_NEAR(event.time, landing, 1e-14);
  };
  EXPECT_EQ(plant.advance(landing - 1e-9, count).stop, Stop::reached_end);
  EXPECT_EQ(told, 0);
  EXPECT_EQ(plant.state().stage, 1);
  plant.advance(landing + 1e-9, count);
  EXPECT_EQ(told, 1);
  EXPECT_EQ(plant.state().stage, 3);
  EXPECT_EQ(plant.state().active, ActiveSet{0});
  plant.advance(10, count);
  EXPECT_EQ(told, 1);
  EXPECT_NEAR(plant.state().q[0], 10, 1e-9);
}

TEST(Plant, GoesOnAfterASwitchThatItsCallerCouldNotTake) {
  Plant plant(dropped(), {0, {0.0, 1.0}, {1.0, 0.0}});
  const auto refuse = [](const Switch&) { throw std::runtime_error("full"); };
  EXPECT_THROW(plant.advance(1, refuse), std::runtime_error);
  EXPECT_EQ(plant.switches(), 1u);
  int told = 0;
  EXPECT_EQ(plant.advance(1, [&](const Switch&) { ++told; }).stop, Stop::reached_end);
  EXPECT_EQ(told, 0);
  EXPECT_NEAR(plant.state().q[0], 1, 1e-12);
}

TEST(Plant, IsPutBackToWhatItWas) {
  Plant plant(pushed, {0.5}, {0, {0.0}, {1.0}});
  plant.advance(0.7);
  const Plant::Snapshot then = plant.save();
  const State state = plant.state();
  std::vector<State> ends;
  for (int i = 0; i < 2; ++i) {
    plant.set_input({-3.0});
    plant.advance(2);
    plant.restore(then);
    EXPECT_EQ(plant.time(), 0.7);
    EXPECT_EQ(plant.input()[0], 0.5);
    EXPECT_EQ(plant.state().q, state.q);
    EXPECT_EQ(plant.state().v, state.v);
    plant.advance(1.3);
    ends.push_back(plant.state());
  }
  EXPECT_EQ(ends[0].q, ends[1].q);
  EXPECT_EQ(ends[0].v, ends[1].v);
  EXPECT_NEAR(ends[0].q[0], 1.3 + 0.25 * 1.3 * 1.3, 1e-12);
}

TEST(Plant, OnAGuardsEdgeIsPutBackWithItsConstraint) {
  Plant plant(dropped(), {0, {0.0, 1.0}, {1.0, 0.0}});
  plant.advance(1);
  const Plant::Snapshot landed = plant.save();
  plant.advance(3);
  plant.restore(landed);
  int told = 0;
  plant.advance(3, [&](const Switch&) { ++told; });
  EXPECT_EQ(told, 0);
  EXPECT_EQ(plant.switches(), 1u);
  EXPECT_EQ(plant.state().active, ActiveSet{0});
}

TEST(Plant, GoesOnWhereItWasCancelled) {
  bool goes_on = false;
  Options options;
  options.monitor = [&](const Progress&) { return goes_on; };
  Plant plant(dropped(), {0, {0.0, 1.0}, {1.0, 0.0}}, options);
  EXPECT_EQ(plant.advance(2).stop, Stop::cancelled);
  EXPECT_LT(plant.time(), 2);
  goes_on = true;
  EXPECT_EQ(plant.advance(2).stop, Stop::reached_end);
  EXPECT_NEAR(plant.state().q[0], 2, 1e-12);
}

TEST(Plant, IsCancelledNoLaterThanItWasToAdvance) {
  Options options;
  options.monitor = [](const Progress&) { return false; };
  Plant plant(pushed({0.0}), {0, {0.0}, {1.0}}, options);
  for (const double t : {1e-6, 1e-3, 1.0}) {
    const Status status = plant.advance(t);
    EXPECT_LE(plant.time(), t);
    EXPECT_EQ(status.time, plant.time());
  }
}

TEST(Plant, StaysWhereItsMotionEnds) {
  const Model pole = System<1>({"x"}, [](auto, const auto& q, const auto& v) {
    using std::sqrt;
    return v[0] * v[0] / 2 - sqrt(1 - q[0]);
  });
  Plant plant(pole, {0, {0.0}, {1.0}});
  const Status status = plant.advance(5);
  EXPECT_EQ(status.stop, Stop::not_finite) << status.message;
  EXPECT_EQ(plant.time(), status.time);
  EXPECT_LE(plant.state().q[0], 1);
  const Status again = plant.advance(6);
  EXPECT_EQ(again.stop, Stop::not_finite);
  EXPECT_EQ(again.time, status.time);
}

TEST(Plant, TakesHardlyLongerInManyPeriods) {
  const Initial start{0, {0.0, 1.0}, {1.0, 0.0}};
  Plant often(dropped(), start);
  for (int i = 1; i <= 1000; ++i) often.advance(1e-3 * i);
  Plant once(dropped(), start);
  once.advance(1);
  EXPECT_EQ(often.steps(), once.steps());
}

TEST(Plant, RefusesWhatItCannotTakeAndStaysAsItWas) {
  Plant plant(pushed, {0.5}, {0, {0.0}, {1.0}});
  plant.advance(1);
  const State before = plant.state();
  EXPECT_THROW(plant.advance(0.5), std::invalid_argument);
  EXPECT_THROW(plant.advance(NAN), std::invalid_argument);
  EXPECT_THROW(plant.set_input({1.0, 2.0}), std::invalid_argument);
  EXPECT_THROW(plant.set_input({NAN}), std::invalid_argument);
  EXPECT_EQ(plant.state().q, before.q);
  EXPECT_EQ(plant.input()[0], 0.5);
  Plant plain(dropped(), {0, {0.0, 1.0}, {1.0, 0.0}});
  EXPECT_THROW(plain.set_input({1.0}), std::invalid_argument);
  EXPECT_THROW(Plant(dropped(), {0, {0.0, 1.0}, {1.0, 0.0}}, {}, 0), std::invalid_argument);
  EXPECT_THROW(Plant(dropped(), {0, {0.0, 1.0}, {1.0, 0.0}, ActiveSet{1}}), std::invalid_argument);
  const auto changes_names = [](const Vector& input) {
    return System<1>({input[0] > 0 ? "x" : "y"},
                     [](auto, const auto&, const auto& v) { return v[0] * v[0] / 2; });
  };
  Plant other(changes_names, {1.0}, {0, {0.0}, {1.0}});
  EXPECT_THROW(other.set_input({-1.0}), std::invalid_argument);
  EXPECT_EQ(other.model().coordinates[0], "x");
}

}  // namespace
}  // namespace hybrid_sphere::mechanics::plant_test

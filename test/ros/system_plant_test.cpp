// Any system as a plant: the bits of solve(), the input, where it takes long, and where it fails.

#include "ros/system/system_plant.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <limits>
#include <vector>

#include "catalogue/catalogue.hpp"
#include "hybrid_sphere/mechanics/system.hpp"
#include "mechanics/generalised_forces.hpp"
#include "ros/system/catalogue_system.hpp"
#include "support/patience.hpp"

namespace hybrid_sphere::ros_interface::system_plant_test {
namespace {

using mechanics::Initial;
using mechanics::Model;
using mechanics::System;
using mechanics::Vector;

struct Driven {
  explicit Driven(const std::shared_ptr<const SystemPlugin>& system, double timeout = 0)
      : plant(
            system, mechanics::Options().accuracy, system->duration(), timeout,
            [this](const mechanics::Switch& event) { switches.push_back(event); }, [this] { ++ended; }) {}

  /// Goes there, however long it takes.
  void go(double time) {
    while (!plant.advance_to(time)) {
      testing::wait_until([this] { return plant.collect(); });
    }
  }

  std::vector<mechanics::Switch> switches;
  std::atomic<int> ended{0};
  SystemPlant plant;
};

std::shared_ptr<CatalogueSystem> of_catalogue(const std::string& name) {
  return std::make_shared<CatalogueSystem>(mechanics::catalogue::entry(name));
}

void expect_equal(const mechanics::Switch& a, const mechanics::Switch& b) {
  EXPECT_EQ(a.index, b.index);
  EXPECT_EQ(a.time, b.time);
  EXPECT_EQ(a.applied, b.applied);
  EXPECT_EQ(a.released, b.released);
  EXPECT_EQ(a.q, b.q);
  EXPECT_EQ(a.v_before, b.v_before);
  EXPECT_EQ(a.v_after, b.v_after);
  EXPECT_EQ(a.multipliers, b.multipliers);
  EXPECT_EQ(a.impulse, b.impulse);
  EXPECT_EQ(a.energy_before, b.energy_before);
  EXPECT_EQ(a.energy_after, b.energy_after);
}

TEST(SystemPlant, SwitchesOfTheCatalogueAreThoseOfSolveToTheBit) {
  for (const mechanics::catalogue::Entry& entry : mechanics::catalogue::entries()) {
    SCOPED_TRACE(entry.name);
    const mechanics::catalogue::Values values(entry.parameters);
    const mechanics::catalogue::Example example = entry.build(values);
    const mechanics::Solution solution = mechanics::solve(example.model, example.initial, entry.duration);
    Driven driven(of_catalogue(entry.name));
    for (int tick = 1; tick <= 40; ++tick) driven.go(entry.duration * tick / 40);
    ASSERT_EQ(driven.switches.size(), solution.switches().size());
    ASSERT_FALSE(driven.switches.empty());
    for (std::size_t i = 0; i < driven.switches.size(); ++i)
      expect_equal(driven.switches[i], solution.switches()[i]);
    EXPECT_FALSE(driven.plant.halted());
  }
}

TEST(SystemPlant, GeneralisedForcesActAsForcesOfTheModel) {
  const auto lagrangian = [](auto /*t*/, const auto& q, const auto& v) {
    return v[0] * v[0] + v[0] * v[1] + v[1] * v[1] - q[0] * q[0] / 2;
  };
  const Vector forces = {0.25, -1.5};
  const auto own = [&](double /*t*/, const auto& /*q*/, const auto& /*v*/) {
    return Eigen::Vector2d(forces[0], forces[1]);
  };
  const Model with = System<2>({"a", "b"}, lagrangian, own);
  const Model without = System<2>({"a", "b"}, lagrangian);
  const Initial start{0, {0.3, -0.2}, {1.0, 0.5}};
  const auto end_of = [&](const Model& model) { return mechanics::solve(model, start, 2).at(2); };
  const mechanics::State a = end_of(with), b = end_of(with_generalised_forces(without, forces));
  EXPECT_LT((a.q - b.q).norm(), 1e-14);  // the same sums in another order
  EXPECT_LT((a.v - b.v).norm(), 1e-14);
  const mechanics::State c = end_of(without), d = end_of(with_generalised_forces(without, Vector::Zero(2)));
  EXPECT_EQ(c.q, d.q);
  EXPECT_GT((a.v - c.v).norm(), 0.1);
}

// A free particle under the force u: v = u t/m from when it acts on.
TEST(SystemPlant, AnInputActsFromTheTimeReachedOnUntilAReset) {
  Driven driven(of_catalogue("constant_speed"));
  driven.go(0.125);
  const Vector before = driven.plant.state()->v;
  driven.plant.take_input({3.0, 10.0});  // m = 2, g = 5: nothing falls
  driven.plant.apply_input(driven.plant.time());
  EXPECT_EQ(driven.plant.input(), Vector({3.0, 10.0}));
  driven.go(0.375);
  const Vector after = driven.plant.state()->v;
  EXPECT_NEAR(after[0] - before[0], 3.0 / 2 * 0.25, 1e-12);
  EXPECT_NEAR(after[1] - before[1], 0, 1e-12);
  driven.plant.reset();
  EXPECT_EQ(driven.plant.input(), Vector({0.0, 0.0}));
  EXPECT_EQ(driven.plant.time(), 0);
}

TEST(SystemPlant, AnInputThatIsTooOldGivesWayToTheInitialOne) {
  Driven driven(of_catalogue("constant_speed"), 0.5);
  const auto go = [&](double time) {
    driven.go(time);
    driven.plant.apply_input(time);
  };
  driven.plant.take_input({3.0, 10.0});
  for (const double time : {1.0, 1.25, 1.5}) {
    go(time);
    EXPECT_EQ(driven.plant.input(), Vector({3.0, 10.0})) << time;
  }
  EXPECT_EQ(driven.plant.dropped_inputs(), 0U);
  for (const double time : {1.75, 2.0}) {
    go(time);
    EXPECT_EQ(driven.plant.input(), Vector({0.0, 0.0})) << time;
  }
  EXPECT_EQ(driven.plant.dropped_inputs(), 1U);
}

TEST(SystemPlant, WhatIsNoInputIsDroppedAndChangesNothing) {
  Driven driven(of_catalogue("chaplygin_sleigh"));
  driven.plant.take_input({1.0, 2.0, 3.0});
  driven.plant.apply_input(driven.plant.time());
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const Vector& wrong :
       {Vector({1.0, 2.0}), Vector(0), Vector({1.0, nan, 3.0}), Vector({1.0, 2.0, 3.0, 4.0})}) {
    driven.plant.take_input(wrong);
    driven.plant.apply_input(driven.plant.time());
    EXPECT_EQ(driven.plant.input(), Vector({1.0, 2.0, 3.0}));
  }
  driven.go(1);
  EXPECT_FALSE(driven.plant.halted());
}

TEST(SystemPlant, ConstraintForcesDoWhatTheMotionShows) {
  Driven driven(of_catalogue("chaplygin_sleigh"));
  driven.go(1);
  const mechanics::State& state = *driven.plant.state();
  const double lambda = state.multipliers[0], theta = state.q[2];
  ASSERT_EQ(state.stage, 3);
  EXPECT_GT(std::abs(lambda), 1e-3);
  const Vector expected = {-lambda * std::sin(theta), lambda * std::cos(theta), 0.0};
  EXPECT_LT((driven.plant.constraint_forces() - expected).norm(), 1e-15 + 1e-15 * std::abs(lambda));
}

/// A particle whose Lagrangian is not finite behind x = 1; its clock begins at t = 5.
class Wall : public SystemPlugin {
 public:
  Model model(const Vector& /*input*/) const override {
    return System<1>({"x"}, [](auto /*t*/, const auto& q, const auto& v) {
      using std::sqrt;
      return v[0] * v[0] / 2 - sqrt(1 - q[0]);
    });
  }
  Initial initial() const override { return {5, {0.0}, {1.0}}; }
};

TEST(SystemPlant, WhereTheMotionCannotGoOnItHaltsUntilAReset) {
  Driven driven(std::make_shared<Wall>());
  EXPECT_EQ(driven.plant.time(), 0);
  driven.go(0.5);
  EXPECT_EQ(driven.plant.state()->time, 5.5);
  driven.go(10);
  ASSERT_TRUE(driven.plant.halted());
  EXPECT_NE(driven.plant.halt().find("halted at t = "), std::string::npos) << driven.plant.halt();
  ASSERT_NE(driven.plant.state(), nullptr);
  EXPECT_LE(driven.plant.state()->q[0], 1);
  driven.plant.reset();
  EXPECT_FALSE(driven.plant.halted());
  EXPECT_EQ(driven.plant.state()->q[0], 0);
}

TEST(SystemPlant, WhatTakesLongIsUnderWayAndComesToTheSameBits) {
  Driven slow(of_catalogue("visiting_particle"));
  Driven quick(of_catalogue("visiting_particle"));
  constexpr double long_time = 2000;  // thousands of switches: more than a moment
  bool was_under_way = false;
  while (!slow.plant.advance_to(long_time)) {
    was_under_way = true;
    const mechanics::State* shown = slow.plant.state();
    ASSERT_NE(shown, nullptr);
    EXPECT_EQ(shown->time, slow.plant.time());
    testing::wait_until([&] { return slow.plant.collect(); });
  }
  EXPECT_TRUE(was_under_way);
  for (int tick = 1; tick <= 4000; ++tick) quick.go(long_time * tick / 4000);
  EXPECT_EQ(slow.plant.state()->q, quick.plant.state()->q);
  EXPECT_EQ(slow.plant.state()->v, quick.plant.state()->v);
  ASSERT_EQ(slow.switches.size(), quick.switches.size());
  for (std::size_t i = 0; i < slow.switches.size(); ++i) {
    EXPECT_EQ(slow.switches[i].index, i);
    ASSERT_EQ(slow.switches[i].time, quick.switches[i].time);
  }
}

}  // namespace
}  // namespace hybrid_sphere::ros_interface::system_plant_test

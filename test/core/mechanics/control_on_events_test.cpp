// Controllers with a memory: an event changes the input, which holds their discrete state.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "hybrid_sphere/mechanics/plant.hpp"
#include "hybrid_sphere/mechanics/system.hpp"

namespace hybrid_sphere::mechanics::control_on_events_test {
namespace {

// The horizon of a plant's errors is 10 s; a crossing of x has the error of x divided by its speed, 1 or
// more.
constexpr double tolerance = 1e-8;

/// x'' = u, with events where x leaves the band from -1 to 1.
Model cart(const Vector& input) {
  const double u = input[0];
  System<1> cart(
      {"x"}, [](auto, const auto&, const auto& v) { return v[0] * v[0] / 2; },
      [u](auto, const auto&, const auto&) { return u; });
  cart.event(
      "above", [](double, const Vector& q, const Vector&) { return q[0] - 1; }, Crossing::rising);
  cart.event(
      "below", [](double, const Vector& q, const Vector&) { return q[0] + 1; }, Crossing::falling);
  return cart;
}

/// Between two switches the speed v grows to w = sqrt(v^2 + 4), in the time v + w.
TEST(ControlOnEvents, OfAThermostatSwitchesAtTheInstantsOfItsFormula) {
  Plant plant(cart, {1.0}, {0, {0.0}, {0.0}});
  std::vector<double> instants;
  const auto thermostat = [&](const Switch& event) {
    instants.push_back(event.time);
    plant.set_input({event.events[0] == 0 ? -1.0 : 1.0});
  };
  ASSERT_EQ(plant.advance(30, thermostat).stop, Stop::reached_end);
  double expected = std::sqrt(2);
  double speed = std::sqrt(2);
  ASSERT_GE(instants.size(), 5u);
  for (const double instant : instants) {
    EXPECT_NEAR(instant, expected, tolerance * (1 + expected));
    const double next = std::sqrt(speed * speed + 4);
    expected += speed + next;
    speed = next;
  }
  EXPECT_GT(expected, 30);
}

/// A mass on a spring; the input is the stiffness and how often x has risen through 0.
Model counted(const Vector& input) {
  const double stiffness = input[0];
  System<1> mass({"x"}, [stiffness](auto, const auto& q, const auto& v) {
    return v[0] * v[0] / 2 - stiffness / 2 * q[0] * q[0];
  });
  mass.event(
      "zero", [](double, const Vector& q, const Vector&) { return q[0]; }, Crossing::rising);
  return mass;
}

/// The spring ends with the third crossing.
SwitchSink counter(Plant& plant) {
  return [&plant](const Switch&) {
    const double count = plant.input()[1] + 1;
    plant.set_input({count < 3 ? 1.0 : 0.0, count});
  };
}

TEST(ControlOnEvents, EndsASpringAfterThreeCrossings) {
  Plant plant(counted, {1, 0}, {0, {1.0}, {0.0}});
  plant.advance(20, counter(plant));
  EXPECT_EQ(plant.input()[1], 3);
  EXPECT_NEAR(plant.state().q[0], 20 - 11 * M_PI / 2, 3 * tolerance);
  EXPECT_NEAR(plant.state().v[0], 1, tolerance);
}

TEST(ControlOnEvents, HasItsMemoryInTheSnapshot) {
  Plant plant(counted, {1, 0}, {0, {1.0}, {0.0}});
  plant.advance(12, counter(plant));
  ASSERT_EQ(plant.input()[1], 2);
  const Plant::Snapshot between = plant.save();
  std::vector<State> ends;
  for (int i = 0; i < 2; ++i) {
    plant.restore(between);
    EXPECT_EQ(plant.input()[1], 2);
    plant.advance(20, counter(plant));
    ends.push_back(plant.state());
  }
  EXPECT_EQ(ends[0].q[0], ends[1].q[0]);
  EXPECT_EQ(ends[0].v[0], ends[1].v[0]);
  EXPECT_NEAR(ends[0].q[0], 20 - 11 * M_PI / 2, 3 * tolerance);
}

}  // namespace
}  // namespace hybrid_sphere::mechanics::control_on_events_test

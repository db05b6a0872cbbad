// Numbers of any magnitude, drawn by RapidCheck: a motion, or a reason why there is none; nothing that comes
// out is infinite or NaN, within a bounded time.

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <cmath>

#include "hybrid_sphere/mechanics/solve.hpp"
#include "hybrid_sphere/mechanics/system.hpp"

namespace hybrid_sphere::mechanics::magnitude_property_test {
namespace {

/// +-10^k, k from -most to most in steps of a tenth.
double some_number(int most) {
  const double size = std::pow(10.0, *rc::gen::inRange(-10 * most, 10 * most + 1) / 10.0);
  return *rc::gen::arbitrary<bool>() ? size : -size;
}

double some_number_or_zero(int most) { return *rc::gen::arbitrary<bool>() ? some_number(most) : 0; }

/// Two masses, one on a spring, the other drawn by a force; their velocities are tied from the start on, from
/// the middle on besides, or while the first one is beyond a point.
System<2> some_system(int most, double duration) {
  const double m1 = std::abs(some_number(most)), m2 = std::abs(some_number(most));
  const double k = std::abs(some_number(most)), force = some_number_or_zero(most);
  System<2> system(
      {"x", "y"},
      [=](auto, const auto& q, const auto& v) {
        return m1 / 2 * v[0] * v[0] + m2 / 2 * v[1] * v[1] - k / 2 * q[0] * q[0];
      },
      [=](double, const auto&, const auto&) { return Eigen::Vector2d(0, force); });
  const double a = some_number(most), b = some_number(most), c = some_number_or_zero(most);
  const auto tie = [=](auto, const auto&, const auto& v) { return a * v[0] + b * v[1] + c; };
  if (*rc::gen::arbitrary<bool>()) {
    system.constrain("tie", tie, from(0));
    system.constrain(
        "turn", [=](auto, const auto& q, const auto& v) { return b * v[0] * q[1] - a; }, from(duration / 2));
  } else {
    const double border = some_number(most);
    system.constrain("tie", tie, while_positive([=](auto, const auto& q) { return b * (q[0] - border); }));
  }
  return system;
}

void expect_finite(const State& state) {
  RC_ASSERT(state.q.allFinite() && state.v.allFinite());
  RC_ASSERT(state.multipliers.allFinite());
  RC_ASSERT(std::isfinite(state.energy) && std::isfinite(state.kinetic_energy));
  RC_ASSERT(std::isfinite(state.residual));
}

void expect_finite(const Switch& event) {
  RC_ASSERT(event.q.allFinite() && event.v_before.allFinite() && event.v_after.allFinite());
  RC_ASSERT(event.multipliers.allFinite() && event.impulse.allFinite());
  RC_ASSERT(std::isfinite(event.energy_before) && std::isfinite(event.energy_after));
  RC_ASSERT(std::isfinite(event.kinetic_energy_before) && std::isfinite(event.kinetic_energy_after));
}

void expect_finite(const Solution& solution) {
  RC_ASSERT(std::isfinite(solution.end()) && std::isfinite(solution.regularity()));
  RC_ASSERT(!solution.status().message.empty());
  for (const Switch& event : solution.switches()) expect_finite(event);
  for (int i = 0; i <= 8; ++i) {
    const double part = (solution.end() - solution.begin()) * i / 8;
    try {
      expect_finite(solution.at(std::min(solution.begin() + part, solution.end())));
    } catch (const NumericalError&) {
      // Where equations overflow between two steps, or from the start on, at() says so.
      RC_ASSERT(solution.status().stop != Stop::reached_end || i < 8);
    }
  }
}

void expect_finite_motion(int most) {
  const double duration = std::abs(some_number(most / 3));
  const System<2> system = some_system(most, duration);
  Options options;
  options.project_initial = true;
  options.max_steps = 300;
  std::uint64_t asked = 0;
  options.monitor = [&](const Progress&) { return ++asked < 100000; };
  const Initial initial{
      0, {some_number(most), some_number(most)}, {some_number(most), some_number_or_zero(most)}};
  const Solution solution = solve(system, initial, duration, options);
  expect_finite(solution);
  RC_ASSERT(asked + 1 >= solution.steps());
  RC_ASSERT(solution.status().stop != Stop::cancelled);
}

RC_GTEST_PROP(Magnitudes, OfUsualNumbersGiveFiniteMotions, ()) { expect_finite_motion(20); }
RC_GTEST_PROP(Magnitudes, OfLargeNumbersGiveFiniteMotions, ()) { expect_finite_motion(60); }
RC_GTEST_PROP(Magnitudes, ThatOverflowEndTheMotion, ()) { expect_finite_motion(150); }

}  // namespace
}  // namespace hybrid_sphere::mechanics::magnitude_property_test

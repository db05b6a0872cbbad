#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

#include "core/solver/random_equations.hpp"
#include "hybrid_sphere/geometry/certified_root.hpp"
#include "hybrid_sphere/solver/numeric_motion.hpp"
#include "hybrid_sphere/solver/trajectory.hpp"

namespace hybrid_sphere::testing {

constexpr solver::Regime regimes[] = {solver::Regime::free,     solver::Regime::rolling,
                                      solver::Regime::sliding,  solver::Regime::resisted,
                                      solver::Regime::skidding, solver::Regime::scrubbing};
constexpr int stretches = 150;  // of each regime
constexpr int samples = 60;     // of each step
constexpr scene::Solver fine{scene::Solver::Method::dopri87, 1e-12};
constexpr double error = 1e-8;  // of the samples, relative: far above that of the integration

/// Calls use(equations, trajectory, random) for the first steps of random motions.
template <class Use>
void for_steps(unsigned seed, solver::Regime regime, const Use& use) {
  RandomStretches random(seed);
  for (int n = 0; n < stretches; ++n) {
    const RandomStretch stretch = random.next(regime);
    const solver::Equations equations = stretch.equations();
    solver::Trajectory trajectory(fine);
    trajectory.begin(equations, stretch.start(equations));
    try {
      for (int i = 0; i < 12; ++i) trajectory.extend();
    } catch (const std::runtime_error&) {
      continue;  // it dies
    }
    SCOPED_TRACE(n);
    use(equations, trajectory, random);
    if (::testing::Test::HasFailure()) return;
  }
}

/// How close what is bounded comes to its bound: a bound that is far off everywhere tests nothing.
class Sharpness {
 public:
  /// Fails if the value is above the bound, but for its relative error and noise.
  void hold(double value, double bound, double noise = 0) {
    ASSERT_LE(value, bound * (1 + error) + noise);
    if (bound > 0) largest_ = std::max(largest_, (value - noise) / bound);
  }
  /// The largest part of its bound that a value had.
  double largest() const { return largest_; }

 private:
  double largest_ = 0;
};

/// The slope of the margin changes between two places by no more than the curvature there allows; and it is
/// that of the margin.
/// @param rate  of what is rounded, by x: both are held as far as the rounding of the margin tells; 0: to the
/// error of the integration alone
inline void expect_curvature(const std::function<geometry::Jet(double)>& margin, double length,
                             double curvature, Sharpness& sharpness, double rate = 0) {
  double scale = 0;
  for (int k = 0; k <= samples; ++k) scale = std::max(scale, std::abs(margin(length * k / samples).value));
  for (int k = 0; k < samples; ++k) {
    const double h = length / samples;
    const geometry::Jet a = margin(k * h);
    const geometry::Jet b = margin((k + 1) * h);
    const double noise = error * std::max({std::abs(a.slope), std::abs(b.slope), scale / length});
    const double rounding = rate > 0 ? a.noise + b.noise : 0;
    sharpness.hold(std::abs(b.slope - a.slope), curvature * h, noise + rate * rounding);
    ASSERT_NEAR(b.value - a.value, 0.5 * (a.slope + b.slope) * h,
                curvature * h * h / 6 + noise * h + error * scale + rounding);
    if (::testing::Test::HasFatalFailure()) return;
  }
}

/// Begins as the stretch says.
inline void begin(NumericMotion& motion, const RandomStretch& stretch) {
  using solver::Regime;
  const NormalSpin spin(1);
  const Vector2d& r = stretch.position;
  const Vector2d& v = stretch.velocity;
  switch (stretch.regime) {
    case Regime::free: motion.begin_free(r, {v, {1, 2, 1}}, spin); break;
    case Regime::rolling: motion.begin_rolling(stretch.ground, r, v, spin); break;
    case Regime::resisted: motion.begin_resisted(stretch.ground, r, v, spin); break;
    case Regime::skidding: motion.begin_skidding(stretch.ground, r, v, stretch.slip, spin); break;
    case Regime::scrubbing:
      motion.begin_scrubbing(stretch.ground, r, v, stretch.slip, stretch.nu, spin);
      break;
    case Regime::sliding:
      const Vector2d sigma = stretch.slip + ground_velocity(stretch.ground, r);
      motion.begin_sliding(stretch.ground, r, v - stretch.dynamics.kappa * sigma, stretch.slip, spin);
      break;
  }
}

}  // namespace hybrid_sphere::testing

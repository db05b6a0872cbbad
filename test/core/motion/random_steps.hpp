#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

#include "core/motion/random_equations.hpp"
#include "geometry/certified_root.hpp"
#include "motion/numeric_motion.hpp"
#include "motion/trajectory.hpp"

namespace hybrid_sphere::testing {

constexpr numeric::EquationForm forms[] = {
    numeric::EquationForm::free,     numeric::EquationForm::rolling,
    numeric::EquationForm::sliding,  numeric::EquationForm::resisted_rolling,
    numeric::EquationForm::skidding, numeric::EquationForm::resisted_sliding};
constexpr int segments = 150;  // of each form
constexpr int samples = 60;    // of each step
constexpr scene::Solver fine{scene::Solver::Method::dopri87, 1e-12};
constexpr double error = 1e-8;  // of the samples, relative: far above that of the integration

/// Calls use(equations, trajectory, random) for the first steps of random motions.
template <class Use>
void for_steps(unsigned seed, numeric::EquationForm form, const Use& use) {
  RandomSegments random(seed);
  for (int n = 0; n < segments; ++n) {
    const RandomSegment segment = random.next(form);
    const numeric::Equations equations = segment.equations();
    numeric::Trajectory trajectory(fine);
    trajectory.begin(equations, segment.start(equations));
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

/// Begins as the segment says.
inline void begin(NumericMotion& motion, const RandomSegment& segment) {
  using numeric::EquationForm;
  const NormalSpin spin(1);
  const Vector2d& r = segment.position;
  const Vector2d& v = segment.velocity;
  switch (segment.form) {
    case EquationForm::free: motion.begin_free(r, {v, {1, 2, 1}}, spin); break;
    case EquationForm::rolling: motion.begin_rolling(segment.ground, r, v, spin); break;
    case EquationForm::resisted_rolling: motion.begin_resisted_rolling(segment.ground, r, v, spin); break;
    case EquationForm::skidding: motion.begin_skidding(segment.ground, r, v, segment.slip, spin); break;
    case EquationForm::resisted_sliding:
      motion.begin_resisted_sliding(segment.ground, r, v, segment.slip, segment.nu, spin);
      break;
    case EquationForm::sliding:
      const Vector2d sigma = segment.slip + ground_velocity(segment.ground, r);
      motion.begin_sliding(segment.ground, r, v - segment.dynamics.kappa * sigma, segment.slip, spin);
      break;
  }
}

}  // namespace hybrid_sphere::testing

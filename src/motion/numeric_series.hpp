#pragma once

#include "motion/halved_interval.hpp"
#include "motion/numeric_motion.hpp"
#include "motion/series_of.hpp"
#include "motion/state_polynomial.hpp"

namespace hybrid_sphere {

/// Dense output of a motion that is integrated with an estimate of the error: the same to rounding, from
/// polynomials in time for each step or part of it. Where dry friction acts, the step's own are in a variable
/// that depends on the time (motion/equations.hpp). The states depend on the motion alone, and are the same
/// to the last bit however often they are requested. A part costs 16 evaluations of the motion. Source:
/// docs/theory.md 4.8.
class NumericSeries final : public SeriesOf<NumericMotion> {
 public:
  /// @param motion  must outlive this object, or its next begin()
  void begin(NumericMotion& motion);

  MotionState at(double tau) override;
  RapidChange rapid_change(double from, double until) override { return motion_->rapid_change(from, until); }

 private:
  bool cover(double from, double width);
  bool fit(double from, double width);

  double kink_ = never;  // of the angular velocity [s]
  NumericMotion::Step step_{0, 0};
  HalvedInterval interval_;
  StatePolynomial polynomial_;
};

}  // namespace hybrid_sphere

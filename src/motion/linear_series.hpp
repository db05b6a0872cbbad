#pragma once

#include "motion/linear_motion.hpp"
#include "motion/series_of.hpp"

namespace hybrid_sphere {

/// Dense output of a linear motion with exponentials: the same to rounding, from Taylor polynomials on
/// intervals [i, i + 1) 2^k s, which depend on the motion alone; the states are therefore the same to the
/// last bit however often they are requested. An interval costs three or four evaluations of the motion.
/// Source: docs/theory.md 4.4.
class LinearSeries final : public SeriesOf<LinearMotion> {
 public:
  /// @param motion  must outlive this object, or its next begin()
  void begin(LinearMotion& motion);

  MotionState at(double tau) override;

 private:
  double width_ = 1;       // of the intervals, a power of two [s]
  double until_ = -never;  // of the present one [s]
  LinearMotion::Expansion expansion_{0, 0, {}};
};

}  // namespace hybrid_sphere

#pragma once

#include "motion/dry_friction_motion.hpp"
#include "motion/halved_interval.hpp"
#include "motion/series_of.hpp"

namespace hybrid_sphere {

/// Dense output of a motion under dry friction that turns: the same to rounding, from Taylor polynomials. An
/// interval is one of [i, i + 1) 2^k s, the longest that the polynomials cover and none of whose parents they
/// do; the states are therefore the same to the last bit however often they are requested. Source:
/// docs/theory.md 4.4.
class DryFrictionSeries final : public SeriesOf<DryFrictionMotion> {
 public:
  /// No interval goes over a kink or the end of the motion, and over a corner only as its width allows.
  /// @param motion  must outlive this object, or its next begin()
  /// @param scale   time in which it changes, > 0 [s]
  void begin(DryFrictionMotion& motion, double scale);

  MotionState at(double tau) override;

 private:
  bool is_allowed(double from, double width) const;
  bool cover(double from, double width);

  SpinProfile profile_;
  double longest_ = 0;  // width of a whole interval, a power of two [s]
  HalvedInterval interval_;
  StatePolynomial expansion_;
};

}  // namespace hybrid_sphere

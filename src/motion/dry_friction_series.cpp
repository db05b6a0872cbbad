#include "motion/dry_friction_series.hpp"

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <iterator>

#include "integration/power_of_two.hpp"
#include "interrupt/interrupt.hpp"

namespace hybrid_sphere {

void DryFrictionSeries::begin(DryFrictionMotion& motion, double scale) {
  constexpr double longest = 16;  // of the scale: rarely covered
  motion_ = &motion;
  profile_ = motion.spin_profile();
  longest_ = integration::power_of_two(std::clamp(longest * scale, 0x1p-900, 0x1p+60));
  interval_.clear();
}

MotionState DryFrictionSeries::at(double tau) {
  constexpr int last_level = 12;  // where that is not covered, the motion itself is evaluated
  if (!interval_.contains(tau)) {
    interval_.find(
        tau, {longest_ * std::floor(tau / longest_), longest_}, last_level,
        [this](double from, double width) { return is_allowed(from, width) && cover(from, width); });
  }
  return interval_.is_covered() ? expansion_.at(tau) : motion_->at(tau);
}

/// What happens at a corner may not be seen from beside it.
bool DryFrictionSeries::is_allowed(double from, double width) const {
  constexpr double widths = 4;
  const double until = from + width;
  for (const double border : {profile_.kink, profile_.end}) {
    if (from < border && until > border) return false;
  }
  const double distance = std::max({profile_.corner - until, from - profile_.corner, 0.0});
  return width <= std::max(distance, widths * profile_.corner_width);
}

/// @return whether the polynomials leave out of no vector more than rounding of its size
bool DryFrictionSeries::cover(double from, double width) {
  constexpr double rounding = 4 * DBL_EPSILON;
  expansion_ = motion_->expand(from, width);
  constexpr auto& judged = StatePolynomial::judged;
  return std::all_of(std::begin(judged), std::end(judged), [this](const StatePolynomial::Part& part) {
    double size = expansion_.sum_of_sizes(part);
    if (part.first == 0) size = std::max(size, expansion_.position.cwiseAbs().maxCoeff());
    return polynomials::left_out<12>(expansion_.powers, part.first, part.count) <= rounding * size;
  });
}

}  // namespace hybrid_sphere

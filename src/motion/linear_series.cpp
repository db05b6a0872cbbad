#include "motion/linear_series.hpp"

#include <algorithm>
#include <cmath>

#include "integration/power_of_two.hpp"

namespace hybrid_sphere {

void LinearSeries::begin(LinearMotion& motion) {
  constexpr double longest = 0.7;  // of 1/rate
  motion_ = &motion;
  const double width = std::clamp(longest / motion.fastest_rate(), 0x1p-900, 0x1p+60);
  width_ = integration::power_of_two(width);
  until_ = -never;
}

MotionState LinearSeries::at(double tau) {
  if (tau >= until_ || tau < expansion_.from) {
    expansion_ = motion_->expand(width_ * std::floor(tau / width_), width_);
    until_ = expansion_.from + width_;
  }
  return motion_->at(expansion_, tau);
}

}  // namespace hybrid_sphere

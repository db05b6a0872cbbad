#include "motion/dry_friction_series.hpp"

#include <algorithm>
#include <cfloat>
#include <cmath>

#include "interrupt/interrupt.hpp"

namespace hybrid_sphere {
namespace {

/// A vector in the rows of an expansion.
struct Part {
  Eigen::Index first;
  Eigen::Index count;
};
// The acceleration is smooth where the velocity is, and no output.
constexpr Part judged_parts[] = {{0, 2}, {2, 2}, {6, 2}, {8, 2}, {10, 1}};

/// The interval of this width, a power of two, in which a time lies.
double start_of(double tau, double width) { return width * std::floor(tau / width); }

}  // namespace

void DryFrictionSeries::begin(DryFrictionMotion& motion, double scale) {
  constexpr double longest = 16;  // of the scale: rarely covered
  motion_ = &motion;
  profile_ = motion.spin_profile();
  longest_ = std::exp2(std::floor(std::log2(std::clamp(longest * scale, 0x1p-900, 0x1p+60))));
  level_ = none;
  from_ = until_ = 0;
}

double DryFrictionSeries::width(int level) const { return std::ldexp(longest_, -level); }

MotionState DryFrictionSeries::at(double tau) {
  if (!(tau >= from_ && tau < until_)) find_interval(tau);
  return is_covered_ ? expansion_.at(tau) : motion_->at(tau);
}

/// Goes up to the first interval with the time that contains the last one, for that is not covered, and down
/// from there.
void DryFrictionSeries::find_interval(double tau) {
  int level = 0;
  if (level_ != none && start_of(tau, longest_) == start_of(from_, longest_)) {
    level = level_;
    while (level > 0 && start_of(tau, width(level - 1)) != start_of(from_, width(level - 1))) --level;
  }
  level_ = none;  // should this be interrupted
  until_ = from_;
  for (;; ++level) {
    interruption_point();
    const double from = start_of(tau, width(level));
    is_covered_ = is_allowed(from, width(level)) && cover(from, width(level));
    if (is_covered_ || level == last_level || from + 0.5 * width(level) == from) {
      from_ = from;
      until_ = from + width(level);
      level_ = level;
      return;
    }
  }
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
  return std::all_of(std::begin(judged_parts), std::end(judged_parts), [this](const Part& part) {
    double size = expansion_.powers.middleRows(part.first, part.count).cwiseAbs().colwise().maxCoeff().sum();
    if (part.first == 0) size = std::max(size, expansion_.position.cwiseAbs().maxCoeff());
    return polynomials::left_out<12>(expansion_.powers, part.first, part.count) <= rounding * size;
  });
}

}  // namespace hybrid_sphere

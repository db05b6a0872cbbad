#pragma once

#include <functional>
#include <vector>

namespace hybrid_sphere::mechanics {

/// The value and rate of a guard at one instant of a step.
struct GuardSample {
  double x = 0;
  double value = 0;     ///< g
  double rate = 0;      ///< dg/dx
  double roundoff = 0;  ///< bound on a value that can be due to round-off; 0: unknown
};

/// Finds the instants of a step at which a guard must be evaluated so that no sign change is missed: both
/// ends of a piece in which it is monotone and changes its sign, and extrema that come near 0. Value and rate
/// at two instants define a cubic; an instant between them shows whether the guard is near it, and if not,
/// both parts are searched. A piece whose ends and middle are round-off is not searched. Source:
/// docs/theory.md 7.6.
/// @param sample   g and its rate at x from low.x to high.x, on the interpolant of the step
/// @param found  receives the instants, ascending
void search_guard(const std::function<GuardSample(double x)>& sample, const GuardSample& low,
                  const GuardSample& high, std::vector<double>& found);

}  // namespace hybrid_sphere::mechanics

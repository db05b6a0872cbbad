#include "mechanics/segment.hpp"

#include <algorithm>
#include <cfloat>
#include <cmath>

#include "hybrid_sphere/numerical_error.hpp"

namespace hybrid_sphere::mechanics {

double Segment::resolution(double x) const { return 16 * DBL_EPSILON * std::max(std::abs(start + x), x); }

Node state_at(const Segment& segment, double x, MotionStep& motion) {
  const auto later = [](double at, const Node& node) { return at < node.x; };
  const auto next = std::upper_bound(segment.nodes.begin(), segment.nodes.end(), x, later);
  try {
    return motion.reach(segment.start, next == segment.nodes.begin() ? *next : *(next - 1), x);
  } catch (const NumericalError&) {
    if (next != segment.nodes.end() && next->x - x <= segment.resolution(x)) return *next;
    throw;
  }
}

}  // namespace hybrid_sphere::mechanics

#include "mechanics/segment.hpp"

#include <algorithm>
#include <cfloat>
#include <cmath>

#include "hybrid_sphere/numerical_error.hpp"
#include "integration/runge_kutta.hpp"

namespace hybrid_sphere::mechanics {

double Segment::resolution(double x) const { return 16 * DBL_EPSILON * std::max(std::abs(start + x), x); }

Node step_from(const Segment& segment, const Node& node, double x, ConstrainedMotion& motion) {
  if (x == node.x) return node;
  const Index coordinates = motion.model().equations->coordinates();
  const Index velocities = motion.model().equations->velocities();
  Vector q(coordinates);
  Vector v(velocities);
  const auto derivative = [&](double at, const Vector& y) {
    q = y.head(coordinates);
    v = y.tail(velocities);
    motion.evaluate_stage(segment.start + at, q, v);
    Vector rate(y.size());
    rate << motion.terms().rate, motion.acceleration();
    return rate;
  };
  Node reached{x, integration::runge_kutta().step(derivative, node.x, node.y, x - node.x)};
  q = reached.y.head(coordinates);
  v = reached.y.tail(velocities);
  motion.project(segment.start + x, q, v);
  reached.y << q, v;
  return reached;
}

Node state_at(const Segment& segment, double x, ConstrainedMotion& motion) {
  const auto later = [](double at, const Node& node) { return at < node.x; };
  const auto next = std::upper_bound(segment.nodes.begin(), segment.nodes.end(), x, later);
  try {
    return step_from(segment, next == segment.nodes.begin() ? *next : *(next - 1), x, motion);
  } catch (const NumericalError&) {
    if (next != segment.nodes.end() && next->x - x <= segment.resolution(x)) return *next;
    throw;
  }
}

}  // namespace hybrid_sphere::mechanics

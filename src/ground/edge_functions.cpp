#include "ground/edge_functions.hpp"

#include <algorithm>
#include <limits>
#include <utility>

namespace hybrid_sphere {
namespace {

using exact::Bounded;
using exact::Difference;
using geometry::Jet;
using geometry::Root;

/// Angles at which a circle of radius a meets what lies at the signed depth where +-acos(h/a) is asked for,
/// by half angles: 2 atan2(sqrt(a - h), sqrt(a + h)). The error is that of the two differences.
double half_angle(double below, double above) { return 2 * std::atan2(std::sqrt(below), std::sqrt(above)); }

double error_of_half_angle(double below, double above, double noise) {
  // d(angle) = d(h)/sqrt((a - h)(a + h)), and not more than the angle itself near a tangent
  const double product = std::max(below, noise) * std::max(above, noise);
  return std::min(M_PI, noise / std::sqrt(product)) + 4 * DBL_EPSILON * M_PI;
}

/// Bound on the error of 2 atan(sqrt(below/above)) where below = near far and above = sum inner, each of the
/// four within `noise`: twice the differential, as the root of what is next to 0 changes by up to twice that.
double error_of_half_angle(double near, double far, double sum, double inner, double noise) {
  const auto at_least = [noise](double length) { return std::max(length, noise); };
  const double below = at_least(near) * at_least(far);
  const double above = at_least(sum) * at_least(inner);
  const double below_error = noise * (at_least(near) + at_least(far));
  const double above_error = noise * (at_least(sum) + at_least(inner));
  // sqrt(below above) as a product of roots: next to the largest numbers it does not overflow
  const double mean = std::sqrt(below) * std::sqrt(above);
  const double share = above / (above + below);
  const double change = 2 * (share * below_error + (1 - share) * above_error) / mean;
  return std::min(M_PI, change) + 4 * DBL_EPSILON * M_PI;
}

}  // namespace

LineFunction LineFunction::through(const Vector2d& a, const Vector2d& b) {
  const bool swap = std::make_pair(b.x(), b.y()) < std::make_pair(a.x(), a.y());
  const Vector2d& first = swap ? b : a;
  const Vector2d& second = swap ? a : b;
  LineFunction line(first, turned(second - first));
  line.other_ = second;
  return line;
}

Jet LineFunction::jet(const PointState& at) const {
  const Vector2d offset = at.position - anchor_;
  const Vector2d size = at.position.cwiseAbs() + anchor_.cwiseAbs();
  // Below the normal numbers each operation may lose a whole unit.
  constexpr double unit = 4 * std::numeric_limits<double>::denorm_min();
  const double noise = normal_.cwiseAbs().dot(4 * DBL_EPSILON * size + Vector2d::Constant(unit));
  return {normal_.dot(offset), normal_.dot(at.velocity), noise};
}

bool LineFunction::may_hold(const PointState& found, double error) const {
  const Vector2d side = *other_ - point_;
  const double along = side.dot(found.position - point_);
  const double length = side.squaredNorm();
  const double slack =
      side.norm() * (2 * error * found.velocity.norm() +
                     16 * DBL_EPSILON * (found.position.norm() + point_.norm() + side.norm()));
  return -slack <= along && along <= length + slack;
}

bool LineFunction::is_on_line_of(const LineFunction& line) const {
  const auto holds = [](const LineFunction& on, const Vector2d& point) {
    return (on.other_ ? exact::orientation(on.point_, *on.other_, point)
                      : exact::sign_of_dot(on.normal_, point, on.point_)) == 0;
  };
  if (other_) return holds(line, point_) && holds(line, *other_);
  if (line.other_) return line.is_on_line_of(*this);
  return holds(line, point_) && exact::sign_of_cross(normal_, line.normal_, Vector2d::Zero()) == 0;
}

/// Of a polygon's side the difference of its ends, without the rounding of normal_: on which side of it a
/// point is has to be what the exact signs say.
Difference LineFunction::exact_normal() const {
  return other_ ? Difference(*other_, point_).turned() : Difference(normal_);
}

LineFunction::Quadratic LineFunction::along(const Curve& curve) const {
  const Difference normal = exact_normal();
  return {exact::dot(normal, Difference(curve.start, anchor_)),
          exact::dot(normal, Difference(curve.velocity)), exact::dot(normal, Difference(curve.acceleration))};
}

// r = r_0 + (v sin(W t) + J v (1 - cos(W t)))/W with sin(W t) = 2 W u/(1 + W^2 u^2) and
// 1 - cos(W t) = 2 W^2 u^2/(1 + W^2 u^2).
LineFunction::Quadratic LineFunction::along_arc(const Curve& arc) const {
  const Difference normal = exact_normal();
  const double w = arc.rate;
  const Bounded g = exact::dot(normal, Difference(arc.start, anchor_));
  const Bounded slope = exact::dot(normal, Difference(arc.velocity));
  const Bounded across = exact::dot(normal, Difference(turned(arc.velocity)));
  const double bend = 4 * w * across.value + 2 * w * w * g.value;
  const double bend_error =
      std::abs(4 * w) * across.error + 2 * w * w * g.error +
      4 * DBL_EPSILON * (std::abs(4 * w * across.value) + std::abs(2 * w * w * g.value));
  return {g, {2 * slope.value, 2 * slope.error}, {bend, bend_error}};
}

bool LineFunction::Quadratic::may_vanish(double until) const {
  const double way = (std::abs(c1.value) + c1.error) * until;
  const double bend = 0.5 * (std::abs(c2.value) + c2.error) * until * until;
  return std::abs(c0.value) - c0.error <= (1 + 8 * DBL_EPSILON) * (way + bend);
}

// q = -(c1 + sign(c1) sqrt(disc)), roots q/c2 and 2 c0/q ... with disc = c1^2 - 2 c0 c2.
int LineFunction::Quadratic::solve(Root (&roots)[2]) const {
  const double a = c2.value;
  const double b = c1.value;
  const double c = c0.value;
  const double disc = exact::difference_of_products(b, b, 2 * c, a);
  const double noise = 2 * std::abs(b) * c1.error + 2 * (std::abs(a) * c0.error + std::abs(c) * c2.error) +
                       4 * DBL_EPSILON * std::abs(disc);
  if (disc < -noise) return 0;
  const double root = std::sqrt(std::max(disc, 0.0));
  const double spread = std::sqrt(std::max(disc, 0.0) + noise) - std::sqrt(std::max(0.0, disc - noise));
  const double q = -(b + std::copysign(root, b));
  int count = 0;
  // The quadratic is so small there, and has another root next to it at best: no root is farther off, however
  // much rounding makes of a slope that is hardly any.
  const auto farthest = [&](double t) {
    const double rounding = 8 * DBL_EPSILON * (std::abs(c) + std::abs(b * t) + 0.5 * std::abs(a) * t * t);
    const double value = c0.error + c1.error * std::abs(t) + 0.5 * c2.error * t * t + rounding;
    const double bend = std::abs(a) - c2.error;
    if (!(bend > 0)) return never;
    const double of_sum = (c1.error + std::abs(b / a) * c2.error) / bend;
    return 4 * std::sqrt(2 * value / bend) + 2 * of_sum;
  };
  const auto add = [&](double numerator, double denominator, double numerator_error) {
    const double t = numerator / denominator;
    if (!std::isfinite(t)) return;
    const double error = std::min(numerator_error / std::abs(denominator), farthest(t));
    roots[count++] = {t, error + 4 * DBL_EPSILON * std::abs(t)};
  };
  if (a != 0) add(q, a, spread + c1.error + std::abs(q / a) * c2.error);
  if (q != 0) add(2 * c, q, 2 * c0.error + std::abs(2 * c / q) * (spread + c1.error));
  return count;
}

bool LineFunction::meets_circle(const Vector2d& center, double radius, double (&angles)[2],
                                double& error) const {
  const double length = normal_.norm();
  const double height = normal_.dot(anchor_ - center) / length;
  const double noise = 8 * DBL_EPSILON * (std::abs(height) + radius + anchor_.norm() + center.norm());
  const double below = radius - height;
  const double above = radius + height;
  error = 0;
  if (below < -noise || above < -noise) return false;
  const double alpha = half_angle(std::max(below, 0.0), std::max(above, 0.0));
  const double normal_angle = std::atan2(normal_.y(), normal_.x());
  angles[0] = normal_angle - alpha;
  angles[1] = normal_angle + alpha;
  error = error_of_half_angle(below, above, noise);
  return true;
}

Jet CircleFunction::jet(const PointState& at) const {
  const Vector2d p = at.position - circle_.center;
  const double distance = p.norm();
  const double sum = distance + circle_.radius;
  const double noise = 4 * DBL_EPSILON * (at.position.norm() + circle_.center.norm() + sum) * sum;
  return {(distance - circle_.radius) * sum, 2 * p.dot(at.velocity), noise};
}

// g'' = 2 (v.v + p.a)
double CircleFunction::curvature(Motion& motion, const PointState& middle, double from, double until) const {
  const double half = 0.5 * (until - from);
  const double acceleration = motion.acceleration_bound(from, until);
  const double speed = middle.velocity.norm() + acceleration * half;
  const double distance = (middle.position - circle_.center).norm() + speed * half;
  return 2 * speed * speed + 2 * distance * acceleration;
}

// The same for abs(p)^2 - rho^2, p = r - c.
LineFunction::Quadratic CircleFunction::along_arc(const Curve& arc) const {
  const Difference p(arc.start, circle_.center);
  const double w = arc.rate;
  const Jet start = jet({arc.start, arc.velocity, arc.acceleration});
  const Bounded slope = exact::dot(p, Difference(arc.velocity));
  const Bounded across = exact::dot(p, Difference(turned(arc.velocity)));
  const double square = arc.velocity.squaredNorm();
  const double bend = 8 * square + 8 * w * across.value + 2 * w * w * start.value;
  const double size = 8 * square + std::abs(8 * w * across.value) + std::abs(2 * w * w * start.value);
  const double bend_error = std::abs(8 * w) * across.error + 2 * w * w * start.noise + 4 * DBL_EPSILON * size;
  return {{start.value, start.noise}, {4 * slope.value, 4 * slope.error}, {bend, bend_error}};
}

// Two circles: by half angles from the differences of the three lengths.
bool CircleFunction::meets_circle(const Vector2d& center, double radius, double (&angles)[2],
                                  double& error) const {
  const Vector2d between = circle_.center - center;
  const double distance = between.norm();
  const double edge = circle_.radius;
  const double noise = 8 * DBL_EPSILON * (distance + radius + edge + center.norm() + circle_.center.norm());
  error = 0;
  // Both lie on each other, as well as can be known.
  if (distance <= noise && std::abs(edge - radius) <= noise) {
    error = -1;
    return false;
  }
  const double near = edge - distance + radius;  // > 0: the orbit reaches in
  const double far = edge + distance - radius;   // > 0: it is not round the edge
  const double inner = distance + radius - edge;
  if (near < -noise || far < -noise || inner < -noise) return false;
  const double below = std::max(near, 0.0) * std::max(far, 0.0);
  const double sum = distance + edge + radius;
  const double above = sum * std::max(inner, 0.0);
  const double alpha = half_angle(below, above);
  const double direction = std::atan2(between.y(), between.x());
  angles[0] = direction - alpha;
  angles[1] = direction + alpha;
  error = error_of_half_angle(near, far, sum, inner, noise);
  return true;
}

}  // namespace hybrid_sphere

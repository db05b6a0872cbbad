#include <utility>

#include "ground/crossing.hpp"
#include "ground/exact_time.hpp"

namespace hybrid_sphere::detail {
namespace {

using exact::Bounded;
using exact::Difference;
using exact::DoubleDouble;
using scene::Circle;

struct Chord {
  bool exists = false;
  Bounded first{0, 0};
  Bounded second{0, 0};
};

Chord chord_exactly(const Path& path, const scene::Shape& shape) {
  const auto& circle = std::get<Circle>(shape);
  if (!line_cuts_circle(path, circle)) return {};
  const auto rounded = [&](EdgePiece::Kind kind) {
    const double t = exact_time(path, shape, {kind, 0});
    return Bounded{t, DBL_EPSILON * std::abs(t)};
  };
  return {true, rounded(EdgePiece::Kind::circle_first), rounded(EdgePiece::Kind::circle_second)};
}

/// |p + v t|^2 - rho^2 next to the circle, where it is much smaller than its terms: compensated.
double height_squared(const Difference& p, const Vector2d& v, double t, double radius, Vector2d& offset) {
  Vector2d remainder = p.remainder;
  for (int i = 0; i < 2; ++i) {
    const DoubleDouble step = exact::two_product(v[i], t);
    const DoubleDouble place = exact::two_sum(p.value[i], step.value);
    remainder[i] += step.remainder + place.remainder;
    offset[i] = place.value;
  }
  const DoubleDouble x2 = exact::two_product(offset.x(), offset.x());
  const DoubleDouble y2 = exact::two_product(offset.y(), offset.y());
  const DoubleDouble r2 = exact::two_product(radius, radius);
  const DoubleDouble sum = exact::two_sum(x2.value, y2.value);
  const double lost = sum.remainder + x2.remainder + y2.remainder - r2.remainder;
  return (sum.value - r2.value) + (lost + 2 * offset.dot(remainder));
}

/// One step of Newton's method: what is left is the rounding of the result.
Bounded polished(const Difference& p, const Vector2d& v, double t, double radius) {
  Vector2d offset;
  const double height = height_squared(p, v, t, radius, offset);
  const double slope = 2 * offset.dot(v);
  const double step = height / slope;
  const double noise =
      64 * DBL_EPSILON * DBL_EPSILON * (radius * radius + p.value.squaredNorm()) / std::abs(slope);
  return {t - step, DBL_EPSILON * std::abs(t) + DBL_EPSILON * std::abs(step) + noise};
}

// Roots of (v.v) t^2 + 2 (p.v) t + p.p - rho^2 without cancellation, docs/theory.md 5.1.
Chord chord_of(const Path& path, const scene::Shape& shape) {
  const auto& circle = std::get<Circle>(shape);
  const Difference p(path.start, circle.center);
  const Difference v(path.velocity);
  const double speed = v.value.norm();
  const double reach = circle.radius * speed;
  const double across = std::abs(exact::cross(p, v).value);
  const double spare = reach - across;
  if (spare < -8 * DBL_EPSILON * reach) return {};
  const double distance = p.value.norm();
  const double height = distance - circle.radius;
  // Next to a tangent, or on the circle to rounding, the differences below would lose too many digits.
  if (spare < 0x1p-10 * reach || std::abs(height) < 0x1p-40 * circle.radius)
    return chord_exactly(path, shape);

  const double v2 = speed * speed;
  const double pv = exact::dot(p, v).value;
  const double root = std::sqrt(spare * (reach + across));
  const double outer = height * (distance + circle.radius);
  const double q = -(pv + std::copysign(root, pv));
  Bounded near = polished(p, path.velocity, outer / q, circle.radius);
  Bounded far = polished(p, path.velocity, q / v2, circle.radius);
  if (far.value < near.value) std::swap(far, near);
  return {true, near, far};
}

/// Whether a path from a circle leads into it by no more than the rounding of its place tells.
bool is_tangential(const Path& path, const Circle& circle) {
  const Vector2d place = path.start.cwiseAbs() + circle.center.cwiseAbs();
  const double told = 4 * DBL_EPSILON * place.dot(path.velocity.cwiseAbs());
  return std::abs((path.start - circle.center).dot(path.velocity)) <= told;
}

}  // namespace

Side trace_circle(const Path& path, RegionId id, const scene::Shape& shape, const EdgePiece* contact,
                  std::vector<Crossing>& crossings) {
  const auto& circle = std::get<Circle>(shape);
  const Side within = circle.outside ? Side::outside : Side::inside;
  const Side without = circle.outside ? Side::inside : Side::outside;
  const int height = contact ? 0 : exact::side_of_circle(path.start, circle.center, circle.radius);
  if (height >= 0) {
    const int recede = exact::sign_of_dot(path.velocity, path.start, circle.center);
    if (recede >= 0 || (contact && is_tangential(path, circle))) return without;
  }
  if (height == 0) {
    const EdgePiece piece{EdgePiece::Kind::circle_return, 0};
    const Difference v(path.velocity);
    const Bounded pv = exact::dot(Difference(circle.center, path.start), v);
    const Bounded time = quotient({2 * pv.value, 2 * pv.error}, exact::dot(v, v),
                                  [&] { return exact_time(path, shape, piece); });
    crossings.push_back({time.value, time.error, id, without, piece, -1});
    return within;
  }
  const Chord chord = chord_of(path, shape);
  if (!chord.exists) return without;
  const EdgePiece second{EdgePiece::Kind::circle_second, 0};
  if (height < 0) {
    crossings.push_back({chord.second.value, chord.second.error, id, without, second, -1});
    return within;
  }
  const EdgePiece first{EdgePiece::Kind::circle_first, 0};
  crossings.push_back({chord.first.value, chord.first.error, id, within, first, -1});
  crossings.push_back({chord.second.value, chord.second.error, id, without, second, -1});
  return without;
}

}  // namespace hybrid_sphere::detail

// A straight path under a constant acceleration: its instants have formulas.
#include <algorithm>
#include <cfloat>
#include <cmath>

#include "ground/edge_functions.hpp"
#include "ground/straight_run.hpp"

namespace hybrid_sphere {

void StraightRun::run_parabola(double from, double until, std::vector<Crossing>& crossings) {
  const Vector2d& d = line_->direction();
  const double square = d.squaredNorm();
  const double speed = curve_.velocity.dot(d) / square;
  const double pull = curve_.acceleration.dot(d) / square;
  const auto at = [&](double time) {
    const double way = time * (speed + 0.5 * pull * time);
    return Sample{start_ + way, speed + pull * time, 8 * DBL_EPSILON * (std::abs(start_) + std::abs(way))};
  };
  if (from < turn_) cross(way_, at(std::min(turn_, until)), from, std::min(turn_, until), crossings);
  if (until > turn_) cross(-way_, at(until), std::max(turn_, from), until, crossings);
}

geometry::Root StraightRun::time_on_parabola(const LineCrossing& level, double from) const {
  using exact::Difference;
  const auto quadratic = [&]() -> LineFunction::Quadratic {
    const scene::Shape& edge = shape(level);
    const Vector2d& d = line_->direction();
    if (const auto* half_plane = std::get_if<scene::HalfPlane>(&edge)) {
      return LineFunction(half_plane->point, half_plane->normal).along(curve_);
    }
    if (const auto* polygon = std::get_if<scene::Polygon>(&edge)) {
      const auto k = static_cast<std::size_t>(level.piece.index);
      const Vector2d& a = polygon->vertices[k];
      if (level.piece.kind == EdgePiece::Kind::vertex) return LineFunction(a, d).along(curve_);
      const Vector2d& b = polygon->vertices[k + 1 < polygon->vertices.size() ? k + 1 : 0];
      return LineFunction::through(a, b).along(curve_);
    }
    LineFunction::Quadratic along = LineFunction(curve_.start, d).along(curve_);
    const double square = d.squaredNorm();
    const double off = start_ - level.lambda;
    along.c0 = {off * square, (level.error + 4 * DBL_EPSILON * (std::abs(off) + std::abs(start_))) * square};
    return along;
  };
  LineFunction::Quadratic g = quadratic();
  if (level.lambda == start_) g.c0 = {0, g.c0.error};
  geometry::Root roots[2];
  const int count = g.solve(roots);
  if (count == 0) return {turn_ < never ? turn_ : from, 0};
  if (count == 1) return roots[0];
  // An acceleration that is no more than rounding need not be along the line: one of the roots may be another
  // than that of the place.
  const double guess = guess_time(level.lambda, from);
  return std::abs(roots[1].time - guess) < std::abs(roots[0].time - guess) ? roots[1] : roots[0];
}

/// When a parabola comes to a place of the line, after a time and before or after it turns as that is.
double StraightRun::guess_time(double lambda, double from) const {
  const Vector2d& d = line_->direction();
  const double speed = curve_.velocity.dot(d) / d.squaredNorm();
  const double pull = curve_.acceleration.dot(d) / d.squaredNorm();
  const double way = lambda - start_;
  const double disc = speed * speed + 2 * pull * way;
  if (!(disc > 0)) return turn_ < never ? turn_ : from;
  const double q = -(speed + std::copysign(std::sqrt(disc), speed));
  const double first = q / pull;
  const double second = -2 * way / q;
  if (!std::isfinite(first)) return second;
  if (!std::isfinite(second)) return first;
  const bool later = turn_ == never || from >= turn_;
  return later ? std::max(first, second) : std::min(first, second);
}

}  // namespace hybrid_sphere

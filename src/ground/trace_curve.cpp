#include "ground/trace_curve.hpp"

#include <algorithm>

#include "ground/piece_tracer.hpp"
#include "ground/region_index.hpp"
#include "interrupt/interrupt.hpp"

namespace hybrid_sphere {
namespace {

using Kind = EdgePiece::Kind;

bool overlaps(const CurvedPath& path, const Vector2d& a, const Vector2d& b) {
  const Vector2d low = a.cwiseMin(b);
  const Vector2d high = a.cwiseMax(b);
  return meet({low, high}, {path.low, path.high});
}

bool is_contact(const EdgePiece& contact, std::int32_t side, std::int32_t sides) {
  if (contact.kind == Kind::line) return contact.index == side;
  return contact.index == side || contact.index == (side + 1 < sides ? side + 1 : 0);
}

/// Where a path that runs along the line of a side passes the ends of the side. Returns until when it is
/// on the side itself: path.from if it starts beside it.
double trace_ends(const CurvedPath& path, const Vector2d& a, const Vector2d& b, std::int32_t side,
                  std::int32_t sides, Candidates& candidates) {
  const Vector2d along = b - a;
  const std::size_t first = candidates.size();
  PieceTracer(path, {Kind::vertex, side}, candidates).run(LineFunction(a, along), false);
  PieceTracer(path, {Kind::vertex, side + 1 < sides ? side + 1 : 0}, candidates)
      .run(LineFunction(b, along), false);
  double left = path.until;
  for (std::size_t i = first; i < candidates.size(); ++i) {
    const bool is_start = candidates[i].time - candidates[i].error <= path.from;
    if (!is_start) left = std::min(left, candidates[i].time);
  }
  const Vector2d between = path.place_at(path.from + 0.5 * (left - path.from));
  const bool on_side = along.dot(between - a) > 0 && along.dot(between - b) < 0;
  return on_side ? left : path.from;
}

/// The corner in which a path begins, or -1.
std::int32_t corner_of(const Contact* begin, const Contact* end, std::int32_t sides) {
  if (begin == end) return -1;
  if (begin->piece.kind == Kind::vertex) return begin->piece.index;
  const std::int32_t first = begin->piece.index;
  for (const Contact* other = begin + 1; other != end; ++other) {
    const std::int32_t second = other->piece.index;
    if (second == (first + 1) % sides) return second;
    if (first == (second + 1) % sides) return first;
  }
  return -1;
}

/// Whether a path cannot be told from the place at which it begins: forces on it cancel up to rounding.
bool stays(const CurvedPath& path) {
  const double pull = path.motion.acceleration_bound(path.from, path.until);
  const double speed = path.velocity.norm() + path.contact_velocity.norm() + path.reference_velocity.norm();
  const double noise = 4 * DBL_EPSILON * (path.start.norm() + (speed + pull * path.until) * path.until);
  const auto is_there = [&](double time) { return (path.place_at(time) - path.start).norm() <= noise; };
  return is_there(path.until) && is_there(path.from + 0.5 * (path.until - path.from));
}

EdgeInterval trace_sides(const CurvedPath& path, const scene::Polygon& polygon, const Contact* begin,
                         const Contact* end, StartLines& lines, Candidates& candidates) {
  EdgeInterval interval{path.from, false};
  const auto sides = static_cast<std::int32_t>(polygon.vertices.size());
  const std::int32_t corner = corner_of(begin, end, sides);
  if (corner >= 0 && stays(path)) return {path.until, true, EdgePiece{Kind::vertex, corner}};
  for (std::int32_t i = 0; i < sides; ++i) {
    interruption_point();
    const Vector2d& a = polygon.vertices[static_cast<std::size_t>(i)];
    const Vector2d& b = polygon.vertices[static_cast<std::size_t>(i + 1 < sides ? i + 1 : 0)];
    const bool contact =
        std::any_of(begin, end, [&](const Contact& c) { return is_contact(c.piece, i, sides); });
    if (!contact && !overlaps(path, a, b)) continue;
    const bool followed = contact && begin->followed && begin->piece.index == i;
    const std::size_t first = candidates.size();
    LineFunction line = LineFunction::through(a, b);
    line.anchor_near(path.start);
    double left = path.until;
    if (!followed) {
      left = PieceTracer(path, {Kind::line, i}, candidates).run(contact ? lines.shared(line) : line, contact);
    }
    const auto beside = [&](const Candidate& candidate) {
      return !line.may_hold(path.at(std::clamp(candidate.time, path.from, path.until)), candidate.error);
    };
    candidates.erase(
        std::remove_if(candidates.begin() + static_cast<std::ptrdiff_t>(first), candidates.end(), beside),
        candidates.end());
    if (contact && left >= path.until) {
      left = trace_ends(path, a, b, i, sides, candidates);
      if (left > path.from) {
        interval.on_edge = true;
        if (!interval.piece || left > interval.until) interval.piece = EdgePiece{Kind::line, i};
      }
    }
    interval.until = std::max(interval.until, left);
  }
  return interval;
}

}  // namespace

CurvedPath::CurvedPath(Motion& of_motion, const Curve& of_curve, double from_time, double until_time)
    : motion(of_motion), curve(of_curve), from(from_time), until(until_time) {
  const double half = 0.5 * (until - from);
  const PointState middle = at(from + half);
  const double bend = 0.5 * motion.acceleration_bound(from, until) * half * half;
  const Vector2d reach = middle.velocity.cwiseAbs() * half + Vector2d(bend, bend);
  const Vector2d rounding = 8 * DBL_EPSILON * (middle.position.cwiseAbs() + reach);
  low = middle.position - reach - rounding;
  high = middle.position + reach + rounding;
  const MotionState begin = motion.at(from);
  start = begin.center.position;
  velocity = begin.center.velocity;
  contact_velocity = begin.contact_velocity;
  reference_velocity = motion.reference_velocity();
  is_integrated = motion.is_integrated();
  if (!is_integrated) return;
  first = at(from);
  last = at(until);
  for (const PointState* end : {&first, &last}) {
    const Vector2d off = (end->position - middle.position).cwiseAbs() - reach;
    const Vector2d margin = 4 * off.cwiseMax(0) + rounding;
    low = low.cwiseMin(end->position) - margin;
    high = high.cwiseMax(end->position) + margin;
  }
}

const PointState& CurvedPath::at(double time) const {
  for (const Sample& sample : remembered_) {
    if (sample.time == time) return sample.state;
  }
  Sample& sample = remembered_[oldest_];
  oldest_ = (oldest_ + 1) % remembered_.size();
  sample.time = -1;  // where the evaluation throws nothing is remembered
  sample.state = motion.path(time);
  sample.time = time;
  return sample.state;
}

LineFunction StartLines::shared(const LineFunction& own) {
  const auto known = std::find_if(lines_.begin(), lines_.end(),
                                  [&](const LineFunction& line) { return own.is_on_line_of(line); });
  if (known != lines_.end()) return *known;
  lines_.push_back(own);
  return own;
}

EdgeInterval find_candidates(const CurvedPath& path, const scene::Shape& shape, const Contact* begin,
                             const Contact* end, StartLines& lines, Candidates& candidates) {
  const bool contact = begin != end;
  const auto interval_until = [&](double left) { return EdgeInterval{left, contact && left >= path.until}; };
  if (const auto* half_plane = std::get_if<scene::HalfPlane>(&shape)) {
    if (contact && begin->followed) return {path.until, true};
    const LineFunction own(half_plane->point, half_plane->normal);
    const LineFunction line = contact ? lines.shared(own) : own;
    return interval_until(PieceTracer(path, {Kind::line, 0}, candidates).run(line, contact));
  }
  if (const auto* circle = std::get_if<scene::Circle>(&shape)) {
    const Vector2d reach = Vector2d::Constant(circle->radius * (1 + 4 * DBL_EPSILON));
    if (!contact && !overlaps(path, circle->center - reach, circle->center + reach))
      return {path.from, false};
    return interval_until(
        PieceTracer(path, {Kind::circle_first, 0}, candidates).run(CircleFunction(*circle), contact));
  }
  return trace_sides(path, std::get<scene::Polygon>(shape), begin, end, lines, candidates);
}

void pieces_at(const scene::Shape& shape, RegionId id, const Vector2d& point, Contacts& pieces) {
  if (std::holds_alternative<scene::HalfPlane>(shape)) {
    insert({id, {Kind::line, 0}}, pieces);
  } else if (std::holds_alternative<scene::Circle>(shape)) {
    insert({id, {Kind::circle_first, 0}}, pieces);
  } else {
    const auto& vertices = std::get<scene::Polygon>(shape).vertices;
    for (std::size_t i = 0; i < vertices.size(); ++i) {
      const Vector2d& a = vertices[i];
      const Vector2d& b = vertices[i + 1 < vertices.size() ? i + 1 : 0];
      const Vector2d low = a.cwiseMin(b);
      const Vector2d high = a.cwiseMax(b);
      const bool in_box = (low.array() <= point.array()).all() && (point.array() <= high.array()).all();
      if (in_box && exact::orientation(a, b, point) == 0) {
        insert({id, {Kind::line, static_cast<std::int32_t>(i)}}, pieces);
      }
    }
  }
}

}  // namespace hybrid_sphere

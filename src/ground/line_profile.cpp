#include "ground/line_profile.hpp"

#include <algorithm>

#include "ground/trace_curve.hpp"
#include "motion/curve.hpp"

namespace hybrid_sphere {
namespace {

bool operator!=(const Section& a, const Section& b) { return a.side != b.side || a.along != b.along; }

Section section(Side side, const EdgePiece& piece) { return {side, side == Side::edge ? piece.index : -1}; }

/// Of the edge on which a point lies; a corner where it is one.
EdgePiece piece_at(const scene::Shape& shape, const EdgePiece* contact, const Vector2d& point,
                   Contacts& room) {
  if (const auto* polygon = std::get_if<scene::Polygon>(&shape)) {
    const auto corner = std::find(polygon->vertices.begin(), polygon->vertices.end(), point);
    const auto index = static_cast<std::int32_t>(corner - polygon->vertices.begin());
    if (corner != polygon->vertices.end()) return {EdgePiece::Kind::vertex, index};
  }
  if (contact) return *contact;
  room.clear();
  pieces_at(shape, 0, point, room);
  return room.empty() ? EdgePiece{} : room.front().piece;
}

}  // namespace

bool Line::holds(const Vector2d& start, const Vector2d& other, double size, double reach) const {
  const Vector2d& d = direction();
  if (!parallel_to_pull(d, other, size)) return false;
  if (d.x() == 0) return start.x() == anchor().x();
  if (d.y() == 0) return start.y() == anchor().y();
  const Vector2d offset = start - anchor();
  const Vector2d places = (start.cwiseAbs() + anchor().cwiseAbs()).cwiseMax(reach);
  const double off = std::abs(exact::difference_of_products(d.x(), offset.y(), d.y(), offset.x()));
  return off <= 8 * DBL_EPSILON * (std::abs(d.x()) * places.y() + std::abs(d.y()) * places.x());
}

int compare(const Line& line, const scene::Shape& shape_a, const LineCrossing& a, const scene::Shape& shape_b,
            const LineCrossing& b) {
  const int side = exact::sign(a.lambda);
  if (side != exact::sign(b.lambda) || side == 0) return exact::sign(a.lambda - b.lambda);
  const auto half = [](const LineCrossing& c) {
    return Crossing{std::abs(c.lambda), c.error, c.region, Side::outside, c.piece, -1};
  };
  return side * compare(line.half(a.lambda), shape_a, half(a), shape_b, half(b));
}

Section trace_line(const Line& line, RegionId id, const scene::Shape& shape, const Contact* contact,
                   std::vector<LineCrossing>& crossings, LineRoom& room) {
  const EdgePiece* piece = contact ? &contact->piece : nullptr;
  const bool followed = contact && contact->followed;
  EdgePiece here;
  room.crossings.clear();
  const Side back = trace(line.half(-1), id, shape, piece, room.crossings, here, followed);
  const Section before = section(back, here);
  for (auto c = room.crossings.rbegin(); c != room.crossings.rend(); ++c) {
    crossings.push_back({-c->time, c->error, id, c->piece, {c->after, c->along}});
  }
  room.crossings.clear();
  const Side ahead = trace(line.half(1), id, shape, piece, room.crossings, here, followed);
  Section last = section(ahead, here);
  if (before != last) {
    crossings.push_back({0, 0, id, piece_at(shape, piece, line.anchor(), room.contacts), before});
  }
  for (const Crossing& c : room.crossings) {
    crossings.push_back({c.time, c.error, id, c.piece, last});
    last = {c.after, c.along};
  }
  return last;
}

}  // namespace hybrid_sphere

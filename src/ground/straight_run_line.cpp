// Which line a motion begins on.
#include <algorithm>
#include <array>

#include "geometry/exact.hpp"
#include "ground/straight_run.hpp"
#include "ground/trace_curve.hpp"

namespace hybrid_sphere {
namespace {

Vector2d edge_vector(const scene::Polygon& polygon, std::size_t k) {
  const std::size_t next = k + 1 < polygon.vertices.size() ? k + 1 : 0;
  return polygon.vertices[next] - polygon.vertices[k];
}

/// Directions of the straight edges that meet in a place.
/// @return  their number
std::size_t edges_at(const scene::Shape& shape, const EdgePiece& piece, std::array<Vector2d, 2>& edges) {
  if (const auto* half_plane = std::get_if<scene::HalfPlane>(&shape)) {
    edges[0] = turned(half_plane->normal);
    return 1;
  }
  const auto* polygon = std::get_if<scene::Polygon>(&shape);
  if (!polygon) return 0;
  const auto k = static_cast<std::size_t>(piece.index);
  edges[0] = edge_vector(*polygon, k);
  if (piece.kind != EdgePiece::Kind::vertex) return 1;
  edges[1] = edge_vector(*polygon, (k == 0 ? polygon->vertices.size() : k) - 1);
  return 2;
}

}  // namespace

bool StraightRun::begin(Motion& motion, const Contacts& contacts) {
  const Vector2d before = curve_.start;
  see_reach();
  curve_ = motion.curve();
  const bool same_place = curve_.start == before;
  motion_ = nullptr;
  if (curve_.line.isZero(0)) {
    line_.reset();
    return false;
  }
  motion_ = &motion;
  LineCrossing anchor;
  if (follow(contacts)) {
    start_place_.reset();
  } else if (goes_on()) {
    start_place_ = place_ ? place_ : same_place ? start_place_ : std::nullopt;
  } else {
    line_.emplace(curve_.start, direction_from(contacts));
    reach_ = 0;
    contacts_.assign(contacts.begin(), contacts.end());
    profiles_.clear();
    levels_.clear();
    start_place_ = anchor;
  }
  place_.reset();
  start_ = start_place_ ? start_place_->lambda : line_->along(curve_.start - line_->anchor());
  const double speed = curve_.velocity.dot(line_->direction());
  const double pull = curve_.acceleration.dot(line_->direction());
  way_ = (speed != 0 ? speed : pull) < 0 ? -1 : 1;
  turn_ = is_parabola() && speed * pull < 0 ? -speed / pull : never;
  for (Profile& profile : profiles_) place_at_start(profile);
  return true;
}

/// Of a line that begins at the start: that of the motion or, of a sphere at rest on edges none of which is
/// exactly parallel to all that acts, that of the topmost one which is, as far as rounding tells.
Vector2d StraightRun::direction_from(const Contacts& contacts) {
  if (!curve_.velocity.isZero(0)) return curve_.line;
  room_.contacts.assign(contacts.begin(), contacts.end());
  if (contacts.empty()) {  // it was placed here
    for (const RegionId region : ground_->edges_seen_at(curve_.start))
      pieces_at(ground_->shape(region), region, curve_.start, room_.contacts);
  }
  std::array<Vector2d, 2> edges;
  Vector2d topmost = curve_.line;
  RegionId region = base_region;
  for (const Contact& contact : room_.contacts) {
    const std::size_t count = edges_at(ground_->shape(contact.region), contact.piece, edges);
    for (std::size_t i = 0; i < count; ++i) {
      const Vector2d& edge = edges[i];
      if (!parallel_to_pull(edge, curve_.line, curve_.line_size)) continue;
      if (exact::difference_of_products(edge.x(), curve_.line.y(), edge.y(), curve_.line.x()) == 0)
        return curve_.line;
      if (contact.region <= region) continue;
      region = contact.region;
      topmost = edge.dot(curve_.line) < 0 ? Vector2d(-edge) : edge;
    }
  }
  return topmost;
}

/// The line of the edge that a motion is known to follow.
bool StraightRun::follow(const Contacts& contacts) {
  const auto followed =
      std::find_if(contacts.begin(), contacts.end(), [](const Contact& contact) { return contact.followed; });
  if (followed == contacts.end()) return false;
  Vector2d anchor;
  Vector2d direction;
  const scene::Shape& edge = ground_->shape(followed->region);
  if (const auto* half_plane = std::get_if<scene::HalfPlane>(&edge)) {
    anchor = half_plane->point;
    direction = turned(half_plane->normal);
  } else if (const auto* polygon = std::get_if<scene::Polygon>(&edge);
             polygon && followed->piece.kind == EdgePiece::Kind::line) {
    const auto k = static_cast<std::size_t>(followed->piece.index);
    anchor = polygon->vertices[k];
    direction = edge_vector(*polygon, k);
  } else {
    return false;
  }
  line_.emplace(anchor, direction.dot(curve_.line) < 0 ? Vector2d(-direction) : direction);
  contacts_.clear();
  for (const Contact& contact : contacts) {
    if (contact.followed) contacts_.push_back(contact);
  }
  profiles_.clear();
  levels_.clear();
  return true;
}

/// How far from 0 the motion before has come on the line, at its start and where a parabola turned round.
void StraightRun::see_reach() {
  if (!runs()) return;
  reach_ = std::max(reach_, curve_.start.cwiseAbs().maxCoeff());
  if (turn_ < never)
    reach_ = std::max(reach_, (curve_.start + 0.5 * turn_ * curve_.velocity).cwiseAbs().maxCoeff());
}

bool StraightRun::goes_on() const {
  return line_ && line_->holds(curve_.start, curve_.line, curve_.line_size, reach_);
}

}  // namespace hybrid_sphere

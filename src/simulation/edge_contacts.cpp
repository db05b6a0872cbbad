#include "simulation/edge_contacts.hpp"

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <iterator>

#include "ground/trace_curve.hpp"
#include "simulation/constraint.hpp"
#include "simulation/edge_line.hpp"

namespace hybrid_sphere {

void EdgeContacts::reserve(const Ground& ground) {
  constexpr std::size_t usual = 4096;
  contacts_.reserve(std::min(ground.surface().regions.size(), usual));
}

void EdgeContacts::add(RegionId region, const Vector2d& position) {
  const auto [known, end] = contacts_of(contacts_, region);
  if (known != end || region == base_region) return;
  const scene::Shape& shape = ground_->shape(region);
  if (locate(shape, position) == Side::edge) pieces_at(shape, region, position, contacts_);
}

void EdgeContacts::add_seen_at(const Vector2d& position) {
  for (const RegionId region : ground_->edges_seen_at(position)) add(region, position);
}

void EdgeContacts::add_pieces_seen_at(const Vector2d& position) {
  for (const RegionId region : ground_->edges_seen_at(position))
    pieces_at(ground_->shape(region), region, position, contacts_);
}

bool EdgeContacts::add_nearest(RegionId region, const Vector2d& position) {
  constexpr double rounding = 0x1p-40;
  const scene::Shape& shape = ground_->shape(region);
  EdgePiece piece{EdgePiece::Kind::line, 0};
  double least = never;
  if (const auto* circle = std::get_if<scene::Circle>(&shape)) {
    piece.kind = EdgePiece::Kind::circle_first;
    least = std::abs((position - circle->center).norm() - circle->radius);
  } else if (const auto* half_plane = std::get_if<scene::HalfPlane>(&shape)) {
    least = std::abs((position - half_plane->point).dot(stable_normalized(half_plane->normal)));
  } else {
    const auto* polygon = std::get_if<scene::Polygon>(&shape);
    for (std::int32_t i = 0; i < static_cast<std::int32_t>(polygon->vertices.size()); ++i) {
      const double distance = distance_to_side(*polygon, i, position);
      if (!(distance < least)) continue;
      least = distance;
      piece.index = i;
    }
  }
  if (!(least <= rounding * (position.norm() + size_of(shape)))) return false;
  insert({region, piece}, contacts_);
  return true;
}

void EdgeContacts::add_corner(RegionId region, const Vector2d& corner) {
  const auto* polygon =
      region == base_region ? nullptr : std::get_if<scene::Polygon>(&ground_->shape(region));
  if (polygon) {
    const auto found = std::find(polygon->vertices.begin(), polygon->vertices.end(), corner);
    const auto index = static_cast<std::int32_t>(found - polygon->vertices.begin());
    if (found != polygon->vertices.end()) {
      insert({region, {EdgePiece::Kind::vertex, index}}, contacts_);
      return;
    }
  }
  add(region, corner);
}

void EdgeContacts::snap_to_corners(const Motion& motion, double way, Vector2d& position) {
  const Vector2d ways = Vector2d::Constant(way);
  for (Contact& contact : contacts_) {
    const auto* polygon = std::get_if<scene::Polygon>(&ground_->shape(contact.region));
    if (!polygon || contact.followed || contact.piece.kind != EdgePiece::Kind::line) continue;
    const Vector2d start = motion.curve().start;
    const auto size = static_cast<std::int32_t>(polygon->vertices.size());
    for (const std::int32_t i : {contact.piece.index, contact.piece.index + 1}) {
      const std::int32_t corner = i < size ? i : 0;
      const Vector2d& vertex = polygon->vertices[static_cast<std::size_t>(corner)];
      const Vector2d off = (position - vertex).cwiseAbs();
      const Vector2d rounding = 4 * DBL_EPSILON * (vertex.cwiseAbs() + start.cwiseAbs() + ways);
      if ((off.array() > rounding.array()).any()) continue;
      contact.piece = {EdgePiece::Kind::vertex, corner};
      position = vertex;
    }
  }
}

bool EdgeContacts::in_corner() const {
  std::optional<EdgeLine> first;
  bool on_circle = false;
  for (const Contact& contact : contacts_) {
    if (contact.piece.kind == EdgePiece::Kind::vertex) return true;
    const std::optional<EdgeLine> line = line_of(ground_->shape(contact.region), contact.piece);
    if (line && first && !are_parallel(*first, *line)) return true;
    if (line) first = line;
    if (!line) on_circle = true;
  }
  return first && on_circle;
}

std::optional<SharedEdge> EdgeContacts::edge_between(RegionId first, RegionId second,
                                                     const Vector2d& position) const {
  for (const Contact& contact : contacts_) {
    if (contact.region != first && contact.region != second) continue;
    const scene::Shape& shape = ground_->shape(contact.region);
    const std::optional<LocalEdge> edge = local_edge(shape, contact.piece, position);
    if (!edge) continue;
    const int side = contact.region == first ? 1 : -1;
    return SharedEdge{contact, first, second, side * edge->normal, side * edge->bend};
  }
  return std::nullopt;
}

bool EdgeContacts::are_crossed(const Vector2d& velocity, double rounding) const {
  for (const Contact& contact : contacts_) {
    if (contact.piece.kind != EdgePiece::Kind::line) return false;
    const scene::Shape& shape = ground_->shape(contact.region);
    const auto* half_plane = std::get_if<scene::HalfPlane>(&shape);
    const Vector2d normal =
        half_plane ? half_plane->normal : turned(line_of(shape, contact.piece)->direction);
    const double size = std::abs(normal.x()) + std::abs(normal.y());  // >= its length
    if (!(std::abs(velocity.dot(normal)) > rounding * size)) return false;
  }
  return !contacts_.empty();
}

bool EdgeContacts::has(RegionId region) const {
  const auto [first, last] = contacts_of(contacts_, region);
  return first != last;
}

/// Sides in contact along which a velocity leads, to within rounding.
/// @param act  called with a region, a side of it, and its unit normal into the region
template <class Act>
void EdgeContacts::for_each_side_along(const Vector2d& velocity, double rounding, const Act& act) const {
  const auto consider = [&](RegionId region, std::int32_t index, double sense) {
    const EdgePiece side{EdgePiece::Kind::line, index};
    const scene::Shape& shape = ground_->shape(region);
    const std::optional<EdgeLine> line = line_of(shape, side);
    if (!line || sense * velocity.dot(line->direction) < 0) return;
    const Vector2d inwards = local_edge(shape, side, line->point)->normal;
    if (std::abs(velocity.dot(inwards)) <= rounding) act(region, side, inwards);
  };
  for (const auto& [region, piece, followed] : contacts_) {
    if (piece.kind == EdgePiece::Kind::line) consider(region, piece.index, 0);
    if (piece.kind != EdgePiece::Kind::vertex) continue;
    const auto size =
        static_cast<std::int32_t>(std::get<scene::Polygon>(ground_->shape(region)).vertices.size());
    consider(region, piece.index, 1);
    consider(region, piece.index > 0 ? piece.index - 1 : size - 1, -1);
  }
}

std::optional<Vector2d> EdgeContacts::normal_of_rounded_exit(RegionId ground, const Vector2d& velocity,
                                                             double rounding) const {
  std::optional<Vector2d> found;
  bool is_unique = true;
  for_each_side_along(velocity, rounding, [&](RegionId region, EdgePiece, const Vector2d& inwards) {
    const Vector2d normal = region == ground ? inwards : Vector2d(-inwards);
    if (found && std::abs(found->dot(turned(normal))) > 0x1p-40) is_unique = false;
    if (!found) found = normal;
  });
  return is_unique ? found : std::nullopt;
}

bool EdgeContacts::leads_over(RegionId ground, RegionId next, const Vector2d& velocity,
                              double rounding) const {
  bool enters = false;  // over all of its sides: in a corner there are two
  bool stays_out = false;
  for (const Contact& contact : contacts_) {
    const bool is_of_these = contact.region == ground || contact.region == next;
    if (!is_of_these || contact.piece.kind != EdgePiece::Kind::line) continue;
    const scene::Shape& shape = ground_->shape(contact.region);
    const double inwards = velocity.dot(local_edge(shape, contact.piece, Vector2d::Zero())->normal);
    if (contact.region == ground && inwards < -rounding) return true;
    if (contact.region == next) (inwards > rounding ? enters : stays_out) = true;
  }
  return enters && !stays_out;
}

void EdgeContacts::follow_along(const Vector2d& velocity, double rounding) {
  for_each_side_along(velocity, rounding, [&](RegionId region, EdgePiece side, const Vector2d&) {
    const auto is_of_region = [&](const Contact& contact) { return contact.region == region; };
    *std::find_if(contacts_.begin(), contacts_.end(), is_of_region) = {region, side, true};
  });
  const auto is_replaced = [&](const Contact& contact) {
    return !contact.followed && std::any_of(contacts_.begin(), contacts_.end(), [&](const Contact& other) {
      return other.region == contact.region && other.followed;
    });
  };
  for (auto contact = contacts_.begin(); contact != contacts_.end();)
    contact = is_replaced(*contact) ? contacts_.erase(contact) : std::next(contact);
}

void EdgeContacts::follow_none() {
  for (Contact& contact : contacts_) contact.followed = false;
}

bool EdgeContacts::is_like(RegionId region, const scene::Material& material) const {
  return same_ground(ground_->material(region), material);
}

/// How far beside an edge to look for the grounds on its two sides, as a fraction of the way along it:
/// between the edge and a circle that touches it.
/// @param ahead  along the edge, of length 1
/// @param step   the way along it, from a place on all the contacts [m]
double EdgeContacts::part_aside(const Vector2d& place, const Vector2d& ahead, double step) const {
  constexpr double usual = 0x1p-18;
  double part = usual;
  for (const Contact& contact : contacts_) {
    const auto* circle = std::get_if<scene::Circle>(&ground_->shape(contact.region));
    if (!circle) continue;
    const bool touches = std::abs((place - circle->center).dot(ahead)) <= usual * circle->radius;
    if (touches) part = std::min(part, 0.25 * step / circle->radius);
  }
  return part;
}

std::optional<SharedEdge> EdgeContacts::edge_ahead(RegionId first, RegionId second, const Sphere& sphere,
                                                   const Segment::Start& state) const {
  const Vector2d& corner = state.position;
  const scene::Material& a = ground_->material(first);
  const scene::Material& b = ground_->material(second);
  const Vector2d conserved = sphere.conserved_velocity(state.twist);
  const Vector2d of_first = conserved + sphere.kappa() * a.belt;
  const Vector2d of_second = conserved + sphere.kappa() * b.belt;
  for (const Contact& piece : contacts_) {
    const scene::Shape& shape = ground_->shape(piece.region);
    const std::optional<EdgeLine> line = line_of(shape, piece.piece);
    if (!line) continue;
    for (const double sense : {1.0, -1.0}) {
      const Vector2d ahead = sense * line->direction.normalized();
      // A short way along the edge the two grounds lie on its two sides, and only there, even if another edge
      // leaves the corner at a small angle, or a circle touches it.
      const double step = 0x1p-24 * (corner.norm() + size_of(shape) + sphere.radius());
      const Vector2d aside = part_aside(corner, ahead, step) * turned(ahead);
      const RegionId left = ground_->top_region(corner + step * (ahead + aside));
      const RegionId right = ground_->top_region(corner + step * (ahead - aside));
      const bool first_is_left = is_like(left, a) && is_like(right, b);
      const bool first_is_right = is_like(left, b) && is_like(right, a);
      if (!first_is_left && !first_is_right) continue;
      const Vector2d normal = (first_is_left ? 1 : -1) * turned(ahead);
      const double away = of_first.dot(normal);
      const double back = of_second.dot(normal);
      if (!(away < 0 && back > 0)) continue;
      if (!((back * of_first - away * of_second).dot(ahead) > 0)) continue;
      return SharedEdge{piece, first_is_left ? left : right, first_is_left ? right : left, normal};
    }
  }
  return std::nullopt;
}

void EdgeContacts::follow(const SharedEdge& edge) {
  const EdgeLine line = *line_of(ground_->shape(edge.piece.region), edge.piece.piece);
  const auto is_piece = [&](const Contact& contact) {
    return contact.region == edge.piece.region && contact.piece.kind == EdgePiece::Kind::line &&
           contact.piece.index == edge.piece.piece.index;
  };
  if (std::none_of(contacts_.begin(), contacts_.end(), is_piece)) insert(edge.piece, contacts_);
  for (Contact& contact : contacts_) {
    const bool of_these =
        contact.region == edge.first || contact.region == edge.second || contact.region == edge.piece.region;
    contact.followed = of_these && turn_along(line, contact);
  }
}

/// Whether a contact is a side that is parallel to a line. A contact in a corner becomes that side, if the
/// corner has one.
bool EdgeContacts::turn_along(const EdgeLine& line, Contact& contact) const {
  const scene::Shape& shape = ground_->shape(contact.region);
  const auto is_along = [&](const EdgePiece& piece) {
    const std::optional<EdgeLine> side = line_of(shape, piece);
    return side && are_parallel(*side, line);
  };
  if (is_along(contact.piece)) return true;
  if (contact.piece.kind != EdgePiece::Kind::vertex) return false;
  const auto size = static_cast<std::int32_t>(std::get<scene::Polygon>(shape).vertices.size());
  const std::int32_t corner = contact.piece.index;
  for (const std::int32_t index : {corner, corner > 0 ? corner - 1 : size - 1}) {
    const EdgePiece side{EdgePiece::Kind::line, index};
    if (!is_along(side)) continue;
    contact.piece = side;
    return true;
  }
  return false;
}

}  // namespace hybrid_sphere

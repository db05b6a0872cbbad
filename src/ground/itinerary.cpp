#include "hybrid_sphere/ground/itinerary.hpp"

#include <algorithm>
#include <utility>

namespace hybrid_sphere {
namespace {

/// A coordinate that an axis-parallel edge fixes.
void settle_on_line(const Vector2d& point, const Vector2d& direction, Vector2d& position) {
  if (direction.x() == 0) position.x() = point.x();
  if (direction.y() == 0) position.y() = point.y();
}

}  // namespace

Itinerary::Itinerary(std::shared_ptr<const Ground> ground) { set_ground(std::move(ground)); }

void Itinerary::set_ground(std::shared_ptr<const Ground> ground) {
  ground_ = std::move(ground);
  const std::size_t regions = ground_->surface().regions.size();
  crossings_.clear();
  crossings_.reserve(ground_->max_crossings());
  standing_.assign(regions, Standing{});
  contacts_.clear();
  contacts_.reserve(regions);
  next_ = group_ = 0;
}

int Itinerary::compare_crossings(const Crossing& a, const Crossing& b) const {
  return compare(path_, ground_->shape(a.region), a, ground_->shape(b.region), b);
}

void Itinerary::begin(const Vector2d& start, const Vector2d& velocity, const Contacts& contacts) {
  const double size = velocity.cwiseAbs().maxCoeff();
  const int exponent = size > 0 ? std::ilogb(size) : 0;
  // A power of two is exact, and keeps squares of the velocity in the range of binary64.
  path_ = {start, Vector2d(std::ldexp(velocity.x(), -exponent), std::ldexp(velocity.y(), -exponent))};
  time_exponent_ = -exponent;
  crossings_.clear();
  auto contact = contacts.begin();
  for (RegionId id = 0; id < ground_->size(); ++id) {
    const EdgePiece* piece = nullptr;
    if (contact != contacts.end() && contact->region == id) piece = &(contact++)->piece;
    Standing& standing = standing_[static_cast<std::size_t>(id)];
    standing.side = trace(path_, id, ground_->shape(id), piece, crossings_, standing.along);
  }
  std::sort(crossings_.begin(), crossings_.end(),
            [this](const Crossing& a, const Crossing& b) { return compare_crossings(a, b) < 0; });
  agree_on_times();
  next_ = group_ = 0;
}

/// Crossings of one instant take the time of the one that is known best.
void Itinerary::agree_on_times() {
  for (std::size_t begin = 0, end = 0; begin < crossings_.size(); begin = end) {
    std::size_t best = begin;
    for (end = begin + 1;
         end < crossings_.size() && compare_crossings(crossings_[begin], crossings_[end]) == 0; ++end) {
      if (crossings_[end].error < crossings_[best].error) best = end;
    }
    for (std::size_t i = begin; i < end; ++i) {
      crossings_[i].error += std::abs(crossings_[i].time - crossings_[best].time);
      crossings_[i].time = crossings_[best].time;
    }
  }
}

void Itinerary::pass_instant() {
  group_ = next_;
  do {
    const Crossing& crossing = crossings_[next_++];
    Standing& standing = standing_[static_cast<std::size_t>(crossing.region)];
    standing.side = crossing.after;
    standing.along = {EdgePiece::Kind::line, crossing.along};
  } while (next_ != crossings_.size() && compare_crossings(crossings_[group_], crossings_[next_]) == 0);
}

RegionId Itinerary::forward_region(RegionId in_force) const {
  RegionId top = no_region;
  for (RegionId id = ground_->size() - 1; id >= base_region; --id) {
    const Side side = id == base_region ? Side::inside : standing_[static_cast<std::size_t>(id)].side;
    if (side == Side::outside) continue;
    if (id == in_force) return id;
    if (top == no_region) top = id;
    if (side == Side::inside) break;
  }
  return top;
}

const Contacts& Itinerary::contacts() {
  contacts_.clear();
  for (RegionId id = 0; id < ground_->size(); ++id) {
    const Standing& standing = standing_[static_cast<std::size_t>(id)];
    const auto crossed = std::find_if(crossings_.begin() + static_cast<std::ptrdiff_t>(group_),
                                      crossings_.begin() + static_cast<std::ptrdiff_t>(next_),
                                      [id](const Crossing& crossing) { return crossing.region == id; });
    if (crossed != crossings_.begin() + static_cast<std::ptrdiff_t>(next_)) {
      contacts_.push_back({id, crossed->piece});
    } else if (standing.side == Side::edge) {
      contacts_.push_back({id, standing.along});
    }
  }
  return contacts_;
}

Vector2d Itinerary::settle(Vector2d position) const {
  for (std::size_t i = group_; i < next_; ++i) {
    const Crossing& crossing = crossings_[i];
    const scene::Shape& shape = ground_->shape(crossing.region);
    if (const auto* half_plane = std::get_if<scene::HalfPlane>(&shape)) {
      settle_on_line(half_plane->point, Vector2d(-half_plane->normal.y(), half_plane->normal.x()), position);
    } else if (const auto* polygon = std::get_if<scene::Polygon>(&shape)) {
      const auto k = static_cast<std::size_t>(crossing.piece.index);
      const Vector2d& a = polygon->vertices[k];
      if (crossing.piece.kind == EdgePiece::Kind::vertex) return a;
      const Vector2d& b = polygon->vertices[k + 1 < polygon->vertices.size() ? k + 1 : 0];
      settle_on_line(a, b - a, position);
    }
  }
  return position;
}

}  // namespace hybrid_sphere

#include "ground/edge_events.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <tuple>
#include <utility>

#include "integration/power_of_two.hpp"
#include "interrupt/interrupt.hpp"

namespace hybrid_sphere {
namespace {

constexpr std::size_t max_kept = 4096;   // crossings for which room is kept from the beginning
constexpr std::size_t few_changes = 16;  // of one instant

/// A coordinate that an axis-parallel edge fixes.
void snap_to_line(const Vector2d& point, const Vector2d& direction, Vector2d& position) {
  if (direction.x() == 0) position.x() = point.x();
  if (direction.y() == 0) position.y() = point.y();
}

}  // namespace

EdgeEvents::EdgeEvents(std::shared_ptr<const Ground> ground) { set_ground(std::move(ground)); }

void EdgeEvents::set_ground(std::shared_ptr<const Ground> ground) {
  // What may find no memory comes first: nothing has changed then.
  const std::size_t near = std::min(ground->surface().regions.size(), max_kept);
  const std::size_t crossings = std::min(ground->max_crossings(), max_kept);
  for (auto* list : {&crossings_, &crossings_before_}) list->reserve(crossings);
  for (auto* list : {&statuses_, &statuses_before_}) list->reserve(near);
  covering_.reserve(near);
  near_.reserve(near);
  near_bounded_.reserve(near);
  found_.reserve(near);
  contacts_.reserve(near);
  start_contacts_.reserve(near);
  crossed_.reserve(near);
  candidates_.reserve(64);
  region_contacts_.reserve(64);
  start_lines_.reserve(64);
  run_.set_ground(*ground);
  ground_ = std::move(ground);
  clear();
}

void EdgeEvents::clear() {
  crossings_.clear();
  statuses_.clear();
  statuses_before_.clear();
  covering_.clear();
  next_ = group_ = 0;
  traced_until_ = 0;
  end_ = never;
  quiet_from_ = 0;
  at_start_ = true;
}

void EdgeEvents::begin(const Vector2d& start, const Vector2d& velocity, const Contacts& contacts) {
  start_contacts_.assign(contacts.begin(), contacts.end());
  clear();
  motion_ = nullptr;
  run_.end();
  const double size = velocity.cwiseAbs().maxCoeff();
  // A power of two is exact, and keeps squares of the velocity in the range of binary64.
  time_unit_ = size > 0 ? 1 / integration::power_of_two(size) : 1;
  path_ = {start, velocity * time_unit_};
  const RegionIndex& index = ground_->index();
  span_ = !index.is_small() && path_.moves() ? 4 * index.spacing() / path_.velocity.norm() : never;
  extend();
}

void EdgeEvents::begin(Motion& motion, double scale, double first, const Contacts& contacts) {
  scale_ = scale;
  start_contacts_.assign(contacts.begin(), contacts.end());
  clear();
  motion_ = &motion;
  time_unit_ = 1;
  span_ = run_.begin(motion, start_contacts_) ? choose_line_span() : choose_curved_span();
  if (run_.curve().form == CurveForm::general) span_ = std::min(span_, first);
  extend();
}

void EdgeEvents::extend() {
  if (at_start_) {
    begin_piece();
    return;
  }
  crossings_.erase(crossings_.begin(), crossings_.begin() + static_cast<std::ptrdiff_t>(next_));
  next_ = group_ = 0;
  statuses_before_.assign(statuses_.begin(), statuses_.end());
  crossings_before_.assign(crossings_.begin(), crossings_.end());
  const auto before = std::tuple(traced_until_, span_, end_, quiet_from_);
  try {
    find_piece();
  } catch (...) {  // the same call can be made again
    statuses_.swap(statuses_before_);
    crossings_.swap(crossings_before_);
    find_covering();
    std::tie(traced_until_, span_, end_, quiet_from_) = before;
    throw;
  }
}

/// Where that fails the path begins again, or another one begins there: on the same edges.
void EdgeEvents::begin_piece() {
  try {
    find_piece();
  } catch (...) {
    clear();
    for (const Contact& contact : start_contacts_) {
      const bool is_known = !statuses_.empty() && statuses_.back().region == contact.region;
      if (!is_known) add_status({contact.region, Side::edge, contact.piece, contact.followed});
    }
    throw;
  }
  at_start_ = false;
}

void EdgeEvents::find_piece() {
  if (run_.runs()) {
    extend_line();
    return;
  }
  if (motion_) {
    extend_curved();
  } else {
    extend_straight();
  }
  std::sort(crossings_.begin(), crossings_.end(), [this](const Crossing& a, const Crossing& b) {
    interruption_point();
    return compare_crossings(a, b) < 0;
  });
  agree_on_times();
}

/// Makes room for the regions that a box may touch; those that were near before keep their status.
void EdgeEvents::activate(const Box& box) {
  near_bounded_.clear();
  ground_->index().query(box, near_bounded_);
  const std::vector<RegionId>& unbounded = ground_->index().unbounded();
  near_.resize(near_bounded_.size() + unbounded.size());
  std::merge(near_bounded_.begin(), near_bounded_.end(), unbounded.begin(), unbounded.end(), near_.begin());
}

EdgeEvents::RegionStatus* EdgeEvents::status_of(RegionId region) {
  const auto found =
      std::lower_bound(statuses_.begin(), statuses_.end(), region,
                       [](const RegionStatus& status, RegionId id) { return status.region < id; });
  return found != statuses_.end() && found->region == region ? &*found : nullptr;
}

/// The part of a straight path that is traced next; false when nothing bounded lies ahead of it any more.
bool EdgeEvents::choose_straight_piece(double& until) const {
  const Box& extent = ground_->extent();
  double enter = traced_until_;
  double leave = never;
  for (int i = 0; i < 2; ++i) {
    const double slack =
        8 * DBL_EPSILON * (std::abs(extent.low[i]) + std::abs(extent.high[i]) + std::abs(path_.start[i]));
    const double low = extent.low[i] - slack - path_.start[i];
    const double high = extent.high[i] + slack - path_.start[i];
    const double v = path_.velocity[i];
    if (v == 0) {
      if (low > 0 || high < 0) return false;
      continue;
    }
    enter = std::max(enter, std::min(low / v, high / v) * (1 - 4 * DBL_EPSILON));
    leave = std::min(leave, std::max(low / v, high / v) * (1 + 4 * DBL_EPSILON));
  }
  if (enter > leave) return false;
  until = enter + span_;
  return true;
}

void EdgeEvents::extend_straight() {
  double until = never;
  const bool piecewise = !std::isinf(span_) && path_.moves();
  if (piecewise && !choose_straight_piece(until)) until = never;
  const double from = traced_until_;
  Box box{Vector2d::Constant(-never), Vector2d::Constant(never)};
  if (!std::isinf(until)) {
    const Vector2d a = path_.start + from * path_.velocity;
    const Vector2d b = path_.start + until * path_.velocity;
    const Vector2d rounding = 8 * DBL_EPSILON * (path_.start.cwiseAbs() + until * path_.velocity.cwiseAbs());
    box = {a.cwiseMin(b) - rounding, a.cwiseMax(b) + rounding};
  } else if (!path_.moves()) {
    const Vector2d rounding = 8 * DBL_EPSILON * path_.start.cwiseAbs();
    box = {path_.start - rounding, path_.start + rounding};
  } else if (piecewise) {
    box = {Vector2d::Constant(never), Vector2d::Constant(never)};  // only what has no box
  }
  for (RegionStatus& status : statuses_) status.crosses_ahead = false;
  for (const Crossing& crossing : crossings_) status_of(crossing.region)->crosses_ahead = true;
  activate(box);
  statuses_before_.swap(statuses_);
  statuses_.clear();
  covering_.clear();
  auto before = statuses_before_.begin();
  const auto keep_until = [&](RegionId region) {
    for (; before != statuses_before_.end() && before->region < region; ++before) {
      // What lies behind is dropped.
      if (before->side != Side::outside || before->crosses_ahead) add_status(*before);
    }
  };
  std::size_t fresh = 0;
  for (const RegionId region : near_) {
    keep_until(region);
    if (before != statuses_before_.end() && before->region == region) {
      add_status(*before++);
      continue;
    }
    statuses_.push_back({region, Side::outside, {}, false});
    interruption_point();
    trace_straight(statuses_.back());
    note_cover();
    ++fresh;
  }
  keep_until(std::numeric_limits<RegionId>::max());
  traced_until_ = until;
  if (fresh < 4) span_ *= 2;
  if (fresh > 32) span_ /= 2;
}

void EdgeEvents::trace_straight(RegionStatus& status) {
  const auto [first, last] = contacts_of(start_contacts_, status.region);
  const EdgePiece* piece = first != last ? &std::prev(last)->piece : nullptr;
  status.side = trace(path_, status.region, ground_->shape(status.region), piece, crossings_, status.along);
  if (piece && status.side == Side::edge) status.followed = std::prev(last)->followed;
}

int EdgeEvents::compare_crossings(const Crossing& a, const Crossing& b) const {
  if (!motion_) return compare(path_, ground_->shape(a.region), a, ground_->shape(b.region), b);
  return exact::sign(a.time - b.time);
}

/// Of crossings that have agreed on their times.
bool EdgeEvents::is_same_instant(const Crossing& before, const Crossing& next) const {
  return motion_ ? before.time == next.time : next.joins;
}

/// Crossings of one instant take the time of the one that is known best.
void EdgeEvents::agree_on_times() {
  if (crossings_.size() == 1) {
    Crossing& only = crossings_.front();
    only.joins = false;
    only.doubt = only.error;
    if (motion_) only.error = 0;
    return;
  }
  for (std::size_t begin = 0, end = 0; begin < crossings_.size(); begin = end) {
    std::size_t best = begin;
    double until = crossings_[begin].time + crossings_[begin].error;
    const auto is_same = [&](const Crossing& crossing) {
      interruption_point();
      return motion_ ? crossing.time - crossing.error <= until
                     : compare_crossings(crossings_[begin], crossing) == 0;
    };
    for (end = begin + 1; end < crossings_.size() && is_same(crossings_[end]); ++end) {
      if (!(crossings_[end].error < crossings_[best].error)) continue;
      best = end;
      until = crossings_[end].time + crossings_[end].error;
    }
    const double doubt = crossings_[best].error;
    for (std::size_t i = begin; i < end; ++i) {
      crossings_[i].joins = i > begin;
      crossings_[i].doubt = doubt;
      if (!motion_) crossings_[i].error += std::abs(crossings_[i].time - crossings_[best].time);
      if (motion_) crossings_[i].error = 0;  // the time of the instant is agreed on
      crossings_[i].time = crossings_[best].time;
    }
  }
}

/// A path that ends where it begins leads nowhere: the sphere is where it is.
void EdgeEvents::locate_at(const Vector2d& position) {
  activate({position, position});
  statuses_.clear();
  covering_.clear();
  for (const RegionId region : near_) {
    const auto [contact, last] = contacts_of(start_contacts_, region);
    if (contact != last) {
      add_status({region, Side::edge, contact->piece, contact->followed});
    } else {
      add_status({region, locate(ground_->shape(region), position), {EdgePiece::Kind::vertex, 0}, false});
    }
  }
}

/// The path comes to a region that it was outside of, or the other way round.
void EdgeEvents::change_covering(std::size_t i) {
  const auto place = std::lower_bound(covering_.begin(), covering_.end(), i);
  if (place != covering_.end() && *place == i) {
    covering_.erase(place);
  } else {
    covering_.insert(place, i);
  }
}

void EdgeEvents::find_covering() {
  covering_.clear();
  for (std::size_t i = 0; i < statuses_.size(); ++i) {
    if (statuses_[i].side != Side::outside) covering_.push_back(i);
  }
}

void EdgeEvents::pass_instant() {
  group_ = next_;
  std::size_t changes = 0;
  do {
    const Crossing& crossing = crossings_[next_++];
    RegionStatus* status = status_of(crossing.region);
    const bool changes_cover = (status->side == Side::outside) != (crossing.after == Side::outside);
    if (changes_cover && ++changes <= few_changes) {
      change_covering(static_cast<std::size_t>(status - statuses_.data()));
    }
    status->side = crossing.after;
    status->along = crossing.piece;
    if (crossing.along >= 0) status->along = {EdgePiece::Kind::line, crossing.along};
    status->followed = false;
    if (run_.runs()) run_.pass(crossing);
  } while (next_ != crossings_.size() && is_same_instant(crossings_[group_], crossings_[next_]));
  if (changes > few_changes) find_covering();
}

/// The side on which a path runs that lies on a region's edge. Cells of an image or a grid are half open, as
/// a look-up of the cell at a place has them: a path along the line between two cells runs in the upper one,
/// or in that on the right.
Side EdgeEvents::side_on_edge(const RegionStatus& status) const {
  const bool is_open = ground_->is_cell(status.region) && !status.followed &&
                       status.along.kind == EdgePiece::Kind::line && status.along.index >= 0;
  if (!is_open) return Side::edge;
  const auto& vertices = std::get<scene::Polygon>(ground_->shape(status.region)).vertices;
  const auto k = static_cast<std::size_t>(status.along.index);
  // The corners run counter-clockwise: the lower side to the right, the left one down.
  const Vector2d along = vertices[k + 1 < vertices.size() ? k + 1 : 0] - vertices[k];
  return along.x() > 0 || along.y() < 0 ? Side::inside : Side::outside;
}

RegionId EdgeEvents::forward_region(RegionId in_force) const {
  RegionId top = no_region;
  for (auto i = covering_.rbegin(); i != covering_.rend(); ++i) {
    const RegionStatus& status = statuses_[*i];
    const Side side = status.side == Side::inside ? Side::inside : side_on_edge(status);
    if (side == Side::outside) continue;
    if (status.region == in_force) return in_force;
    if (top == no_region) top = status.region;
    if (side == Side::inside) return top;
  }
  return top == no_region || in_force == base_region ? base_region : top;
}

const Contacts& EdgeEvents::contacts() {
  contacts_.clear();
  crossed_.clear();
  for (std::size_t i = group_; i < next_; ++i) crossed_.emplace_back(crossings_[i].region, i);
  std::sort(crossed_.begin(), crossed_.end());
  auto crossed = crossed_.begin();
  for (const RegionStatus& status : statuses_) {
    while (crossed != crossed_.end() && crossed->first < status.region) ++crossed;
    if (crossed != crossed_.end() && crossed->first == status.region) {
      contacts_.push_back({status.region, crossings_[crossed->second].piece});
    } else if (status.side == Side::edge) {
      contacts_.push_back({status.region, status.along});
    }
  }
  return contacts_;
}

Contact EdgeEvents::crossed_edge(RegionId a, RegionId b) const {
  for (std::size_t i = next_; i > group_; --i) {
    const Crossing& crossing = crossings_[i - 1];
    if (crossing.region == a || crossing.region == b) return {crossing.region, crossing.piece};
  }
  return {no_region, {}};
}

Vector2d EdgeEvents::snap_to_edge(Vector2d position) const {
  if (run_.runs()) run_.snap_to_edge(position);
  for (std::size_t i = group_; i < next_; ++i) {
    const Crossing& crossing = crossings_[i];
    const scene::Shape& shape = ground_->shape(crossing.region);
    if (const auto* half_plane = std::get_if<scene::HalfPlane>(&shape)) {
      snap_to_line(half_plane->point, Vector2d(-half_plane->normal.y(), half_plane->normal.x()), position);
    } else if (const auto* polygon = std::get_if<scene::Polygon>(&shape)) {
      const auto k = static_cast<std::size_t>(crossing.piece.index);
      const Vector2d& a = polygon->vertices[k];
      if (crossing.piece.kind == EdgePiece::Kind::vertex) return a;
      const Vector2d& b = polygon->vertices[k + 1 < polygon->vertices.size() ? k + 1 : 0];
      snap_to_line(a, b - a, position);
    }
  }
  return position;
}

}  // namespace hybrid_sphere

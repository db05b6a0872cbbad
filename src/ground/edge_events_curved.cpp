// Pieces of a curved path: docs/theory.md 5.3.
#include <algorithm>
#include <array>
#include <cfloat>
#include <cmath>

#include "ground/edge_events.hpp"
#include "interrupt/interrupt.hpp"

namespace hybrid_sphere {
namespace {

bool overlap(const Candidate& before, const Candidate& after) {
  return after.time - after.error <= before.time + before.error;
}

/// Takes away, from the one that is known worst on, those that overlap a neighbour in time, and tells them by
/// a negative error. @param first  ascending in time
void drop_worse(Candidate* first, std::size_t size) {
  constexpr std::size_t few = 16;
  struct Link {
    std::size_t next_worst;  // of all, in that order
    std::size_t before;      // neighbours that are left, counted from 1
    std::size_t after;
  };
  std::array<Link, few + 2> some;
  std::vector<Link> many;
  if (size > few) many.resize(size + 2);
  Link* links = size > few ? many.data() : some.data();
  for (std::size_t i = 1; i <= size; ++i) links[i] = {i, i - 1, i + 1};
  std::sort(links + 1, links + size + 1, [&](const Link& a, const Link& b) {
    return std::pair(first[a.next_worst - 1].error, first[a.next_worst - 1].time) >
           std::pair(first[b.next_worst - 1].error, first[b.next_worst - 1].time);
  });
  for (std::size_t i = 1; i <= size; ++i) {
    links[i].before = i - 1;
    links[i].after = i + 1;
  }
  for (std::size_t k = 1; k <= size; ++k) {
    interruption_point();
    const std::size_t i = links[k].next_worst;
    const std::size_t before = links[i].before;
    const std::size_t after = links[i].after;
    const bool is_told = (before == 0 || !overlap(first[before - 1], first[i - 1])) &&
                         (after > size || !overlap(first[i - 1], first[after - 1]));
    if (is_told) continue;
    links[before].after = after;
    links[after].before = before;
    first[i - 1].error = -1;
  }
}

/// Candidates that rounding cannot tell apart become one, that which is known best; ascending in time. One
/// that is hardly known, as where the path runs within rounding of a line, joins no others that are apart.
void merge(Candidates& candidates, std::size_t begin) {
  std::sort(candidates.begin() + static_cast<std::ptrdiff_t>(begin), candidates.end(),
            [](const Candidate& a, const Candidate& b) { return a.time < b.time; });
  std::size_t kept = begin;
  std::size_t end = begin;
  for (std::size_t first = begin; first < candidates.size(); first = end) {
    double until = -never;
    for (end = first; end < candidates.size(); ++end) {
      const Candidate& candidate = candidates[end];
      if (end > first && candidate.time - candidate.error > until) break;
      until = std::max(until, candidate.time + candidate.error);
    }
    if (end - first > 1) drop_worse(candidates.data() + first, end - first);
    for (std::size_t i = first; i < end; ++i) {
      if (!(candidates[i].error < 0)) candidates[kept++] = candidates[i];
    }
  }
  candidates.resize(kept);
}

/// From a corner the path also starts on the side beside its contact.
void drop_start(double start, Candidates& candidates, std::size_t begin) {
  const auto first = candidates.begin() + static_cast<std::ptrdiff_t>(begin);
  const auto is_start = [&](const Candidate& candidate) { return candidate.time - candidate.error <= start; };
  candidates.erase(std::remove_if(first, candidates.end(), is_start), candidates.end());
}

}  // namespace

/// Whether regions are so many that a path from a place is not traced over all of them; away from a short
/// list it is.
bool EdgeEvents::meets_many_from(const Vector2d& place) const {
  const RegionIndex& index = ground_->index();
  if (std::isinf(index.spacing())) return false;
  const Box& extent = ground_->extent();
  return !index.is_small() || meet(extent, {place, place});
}

/// Long enough that the path has left the map or turned round, as far as its beginning tells; where regions
/// are many, until it has met a few.
double EdgeEvents::choose_curved_span() const {
  // A piece of many revolutions meets each edge as often.
  const double round = run_.curve().form == CurveForm::arc ? 2 * M_PI / std::abs(run_.curve().rate) : never;
  const PointState start = motion_->center(traced_until_);
  const bool is_among_many = meets_many_from(start.position);
  if (round < never && !is_among_many) return round;
  const Box& extent = ground_->extent();
  const double speed = start.velocity.norm();
  const double acceleration = start.acceleration.norm();
  const double spacing = ground_->index().spacing();
  // What is not accelerated now may be at any later time; and what oscillates in little room comes to no edge
  // for long: not all of that is searched at once.
  const double most = run_.curve().form == CurveForm::general ? scale_ : never;
  if (is_among_many) {
    constexpr double many = 64;
    const double way = ground_->index().is_small() ? 0.5 * spacing : 4 * spacing;
    return std::min({round, speed > 0 ? way / speed : never,
                     acceleration > 0 ? std::sqrt(2 * way / acceleration) : never, many * most});
  }
  const double far = ground_->size() == 0 ? 0
                                          : std::max((extent.high - start.position).norm(),
                                                     (extent.low - start.position).norm());
  if (acceleration > 0) {
    // Where the path begins next to all that there is, rounding would not tell which way it goes.
    const bool is_placed = at_start_ && (start_contacts_.empty() || speed == 0);
    const double size = start.position.norm() + far;
    const double told = is_placed ? 64 * std::sqrt(DBL_EPSILON * size / acceleration) : 0;
    const double least = std::max(most < never ? 0x1p-20 * most : 0, told);
    const double way_back = 2 * speed / acceleration + std::sqrt(2 * far / acceleration);
    // What hardly bends has long left the map by then, which would be lost in the rounding of that time.
    const bool has_size = far > 0 && speed > 0 && extent.low != extent.high;
    const double way_out = has_size ? 2 * far / speed : never;
    return std::min({std::max(way_back / 8, least), most, way_out});
  }
  return std::min(speed > 0 && far > 0 ? 2 * far / speed : 1, most);
}

/// A circle that has met nothing in more than a whole revolution never will.
bool EdgeEvents::repeats_itself() const {
  if (run_.curve().form != CurveForm::arc || end_ < never) return false;
  const double period = 2 * M_PI / std::abs(run_.curve().rate);
  return traced_until_ - quiet_from_ > period * (1 + 0x1p-40);
}

/// End of the piece that is traced next; that of the motion if it ends within, or no later time can be asked
/// for.
double EdgeEvents::choose_until() {
  if (!(span_ > 0) || std::isinf(span_)) span_ = 1;
  const double until = std::min({traced_until_ + span_, motion_->last_time(), max_time});
  const double end = motion_->end_before(until);
  if (end <= until) end_ = end;
  return std::min(until, end);
}

/// Pieces become longer where they are cheap, and shorter where they are expensive, down to the time in which
/// the forces change the motion: what is expensive there is so however short a piece is.
/// @param cost  samples of the last piece, and steps of the motion
void EdgeEvents::adapt_span(std::size_t cost) {
  constexpr std::size_t many = 4096;
  span_ *= cost > many && span_ > scale_ ? 0.5 : 2;
}

void EdgeEvents::extend_curved() {
  const double from = traced_until_;
  const double until = choose_until();
  const double end = end_;
  if (!(until > from)) {  // the motion has ended, or no later time can be asked for: nothing lies ahead
    if (at_start_) locate_at(motion_->center(from).position);
    traced_until_ = never;
    return;
  }
  const CurvedPath path(*motion_, run_.curve(), from, until);
  activate({path.low, path.high});
  find_curved_candidates(path);
  const double few = end_of_few(until);
  const bool is_cut = few < until;
  traced_until_ = is_cut ? few : end <= until ? never : end_of_certainty(until);
  for (std::size_t i = 0; i < statuses_.size(); ++i) {
    trace_curved(path, statuses_[i], found_[i]);
  }
  if (!candidates_.empty()) quiet_from_ = traced_until_;
  if (repeats_itself()) traced_until_ = never;
  if (traced_until_ == never) return;
  const std::size_t cost = path.samples + 2 * motion_->steps(from, path.until);
  if (is_cut) {
    span_ = traced_until_ - from;
  } else if (meets_many_from(motion_->center(traced_until_).position)) {
    span_ = choose_curved_span() * (near_.size() < 4 + ground_->index().unbounded().size() ? 2 : 1);
  } else if (run_.curve().form != CurveForm::arc) {
    adapt_span(cost);
  } else {
    span_ = std::min(2 * span_, choose_curved_span());
  }
}

/// Fills statuses_ with the regions of near_, and candidates_ and found_ with what the path meets of each.
void EdgeEvents::find_curved_candidates(const CurvedPath& path) {
  statuses_.clear();
  covering_.clear();
  candidates_.clear();
  found_.clear();
  start_lines_.clear();
  auto before = statuses_before_.begin();
  for (const RegionId region : near_) {
    interruption_point();
    while (before != statuses_before_.end() && before->region < region) ++before;
    const bool is_known = before != statuses_before_.end() && before->region == region;
    RegionStatus status = is_known ? *before : RegionStatus{region, Side::outside, {}, false};
    const scene::Shape& shape = ground_->shape(region);
    region_contacts_.clear();
    if (at_start_) {
      const auto [first, last] = contacts_of(start_contacts_, region);
      region_contacts_.assign(first, last);
      if (region_contacts_.empty() && locate(shape, path.start) == Side::edge) {
        pieces_at(shape, region, path.start, region_contacts_);
      }
    } else if (status.side == Side::edge) {
      region_contacts_.push_back({region, status.along, status.followed});
    }
    const std::size_t begin = candidates_.size();
    const Contact* contacts = region_contacts_.data();
    const EdgeInterval interval =
        find_candidates(path, shape, contacts, contacts + region_contacts_.size(), start_lines_, candidates_);
    if (at_start_ && !region_contacts_.empty()) drop_start(path.from, candidates_, begin);
    merge(candidates_, begin);
    if (!region_contacts_.empty()) {
      const Contact& contact = region_contacts_.front();
      status.along = interval.piece.value_or(contact.piece);
      status.followed = contact.followed && status.along.index == contact.piece.index;
    }
    // Whether an edge is followed, or left at once, is told by the first point that can tell: a place on an
    // edge is rounded, another one is not.
    const double first = candidates_.size() > begin ? candidates_[begin].time : path.until;
    const double next = std::clamp(first, path.from, path.until);
    if (interval.on_edge) {
      status.side = side_of_short_path(path, status).value_or(Side::edge);
    } else if (at_start_ && start_contacts_.empty() && region_contacts_.empty()) {
      status.side = locate(shape, path.start);
    } else if (at_start_ || !region_contacts_.empty()) {
      status.side = locate(shape, path.place_at(interval.until + 0.5 * (next - interval.until)));
    }
    add_status(status);
    found_.push_back({begin, candidates_.size(), interval.until});
  }
}

/// A motion that ends before it has come away from the line between two cells does not run along that line:
/// its velocity tells to which cell it leads.
std::optional<Side> EdgeEvents::side_of_short_path(const CurvedPath& path, const RegionStatus& status) const {
  constexpr double rounding = 32 * DBL_EPSILON;
  if (!ground_->is_cell(status.region) || status.followed || status.along.kind != EdgePiece::Kind::line)
    return std::nullopt;
  const auto& vertices = std::get<scene::Polygon>(ground_->shape(status.region)).vertices;
  const auto k = static_cast<std::size_t>(status.along.index);
  const Vector2d inwards = turned(vertices[k + 1 < vertices.size() ? k + 1 : 0] - vertices[k]);
  const double across = path.velocity.dot(inwards);
  const double speed = path.velocity.norm() + path.contact_velocity.norm() + path.reference_velocity.norm();
  if (std::abs(across) <= rounding * speed * inwards.norm()) return std::nullopt;
  return across > 0 ? Side::inside : Side::outside;
}

/// Where a path may meet very many edges, the time after the first few of them: what lies between two is told
/// by a look at all corners of a region, and a switch makes all that lies ahead of it void. Else `until`.
double EdgeEvents::end_of_few(double until) {
  constexpr std::size_t few = 64;
  if (candidates_.size() <= 2 * few) return until;
  times_.clear();
  for (const Candidate& candidate : candidates_) times_.push_back(candidate.time);
  const auto last = times_.begin() + few;
  std::nth_element(times_.begin(), last, times_.end());
  double left = traced_until_;
  for (const Found& found : found_) left = std::max(left, found.left);
  const double certain = certain_before(std::max(left, *last));
  // A piece that ends before all of them would be made again, shorter and shorter.
  const bool meets_some = *std::min_element(times_.begin(), last) < certain;
  return meets_some && certain > traced_until_ && left <= certain && certain < until ? certain : until;
}

/// What is met within rounding of the end of the piece is left to the next piece, with all that happens at
/// the same instant.
double EdgeEvents::end_of_certainty(double until) const {
  const double certain = certain_before(until);
  return certain > traced_until_ ? certain : until;
}

/// The last time, `time` or before, that is told from those at which an edge may be met.
double EdgeEvents::certain_before(double time) const {
  double certain = time;
  for (bool again = true; again;) {
    again = false;
    for (const Candidate& candidate : candidates_) {
      if (candidate.time - candidate.error < certain && certain <= candidate.time + candidate.error) {
        certain = candidate.time - candidate.error;
        again = true;
      }
    }
  }
  return certain;
}

/// The sides between the times at which a region's edge may be met, each told by a point in between.
void EdgeEvents::trace_curved(const CurvedPath& path, const RegionStatus& status, const Found& found) {
  constexpr std::uint32_t corners_a_turn = 256;
  const scene::Shape& shape = ground_->shape(status.region);
  const auto corners = static_cast<std::uint32_t>(max_crossings(shape));
  Side side = status.side;
  for (std::size_t i = found.begin; i < found.end; ++i) {
    const Candidate& candidate = candidates_[i];
    // What is within rounding of the end of a piece that is shorter than that belongs to it: the next one
    // begins behind it.
    if (candidate.time + candidate.error < found.left || candidate.time >= traced_until_) continue;
    interruption_point(1 + corners / corners_a_turn);
    const double from = std::clamp(candidate.time, path.from, path.until);
    const double until = i + 1 < found.end ? std::min(candidates_[i + 1].time, path.until) : path.until;
    const Vector2d between = path.place_at(from + 0.5 * (until - from));
    const Side after = locate(shape, between);
    if (after == side) continue;
    std::int32_t along = -1;
    if (after == Side::edge) {
      region_contacts_.clear();
      pieces_at(shape, status.region, between, region_contacts_);
      along = region_contacts_.empty() ? -1 : region_contacts_.front().piece.index;
    }
    crossings_.push_back(
        {std::max(from, path.from), candidate.error, status.region, after, candidate.piece, along});
    side = after;
  }
}

}  // namespace hybrid_sphere

#include "ground/straight_run.hpp"

#include <algorithm>
#include <array>
#include <iterator>

#include "ground/edge_functions.hpp"
#include "interrupt/interrupt.hpp"

namespace hybrid_sphere {
namespace {

constexpr std::size_t usual_levels = 256;
constexpr std::size_t max_samples = 4096;  // of a path, for one piece of it

}  // namespace

void StraightRun::set_ground(const Ground& ground) {
  const std::size_t near = std::min(ground.surface().regions.size(), usual_levels);
  for (auto* list : {&profiles_, &profiles_before_}) list->reserve(near);
  for (auto* list : {&levels_, &levels_before_}) list->reserve(usual_levels);
  met_.reserve(near);
  room_.crossings.reserve(usual_levels);
  room_.contacts.reserve(usual_levels);
  ground_ = &ground;
  line_.reset();
  motion_ = nullptr;
  profiles_.clear();
  levels_.clear();
}

int StraightRun::order(const LineCrossing& a, const LineCrossing& b) const {
  if (a.region == no_region || b.region == no_region) return exact::sign(a.lambda - b.lambda);
  return compare(*line_, shape(a), a, shape(b), b);
}

/// What the motion begins at lies behind it.
void StraightRun::place_at_start(Profile& profile) const {
  profile.found = profile.passed;
  if (start_place_) {
    profile.found = 0;
    while (profile.found < profile.size) {
      const int ahead = order(level(profile, profile.found), *start_place_);
      if (ahead > 0 || (ahead == 0 && way_ < 0)) break;
      ++profile.found;
    }
  }
  profile.passed = profile.found;
}

void StraightRun::trace(Profile& profile, double from) {
  const auto [first, last] = contacts_of(contacts_, profile.region);
  const Contact* contact = first != last ? &*std::prev(last) : nullptr;
  profile.begin = levels_.size();
  profile.last = trace_line(*line_, profile.region, ground_->shape(profile.region), contact, levels_, room_);
  profile.size = levels_.size() - profile.begin;
  profile.found = profile.passed = 0;
  if (from == 0 && start_place_) return place_at_start(profile);
  const Sample now = sample(from);
  const int way = from == 0 ? way_ : 0;
  const auto is_behind = [&](const LineCrossing& crossing) {
    return crossing.lambda < now.place + way * (now.noise + crossing.error);
  };
  while (profile.found < profile.size && is_behind(level(profile, profile.found))) ++profile.found;
  profile.passed = profile.found;
}

void StraightRun::keep(const std::vector<RegionId>& regions, double from) {
  const bool same = profiles_.size() == regions.size() &&
                    std::equal(regions.begin(), regions.end(), profiles_.begin(),
                               [](RegionId id, const Profile& profile) { return profile.region == id; });
  if (!same) {
    profiles_before_.swap(profiles_);
    levels_before_.swap(levels_);
    try {
      collect(regions, from);
    } catch (...) {  // the same call can be made again
      profiles_.swap(profiles_before_);
      levels_.swap(levels_before_);
      throw;
    }
  }
  find_nearest();
}

void StraightRun::collect(const std::vector<RegionId>& regions, double from) {
  profiles_.clear();
  levels_.clear();
  auto known = profiles_before_.begin();
  for (const RegionId region : regions) {
    interruption_point();
    known = std::lower_bound(known, profiles_before_.end(), region);
    if (known != profiles_before_.end() && known->region == region) {
      profiles_.push_back(*known);
      profiles_.back().begin = levels_.size();
      const auto first = levels_before_.begin() + static_cast<std::ptrdiff_t>(known->begin);
      levels_.insert(levels_.end(), first, first + static_cast<std::ptrdiff_t>(known->size));
    } else {
      profiles_.emplace_back();
      profiles_.back().region = region;
      trace(profiles_.back(), from);
    }
  }
}

Section StraightRun::section_ahead(RegionId region) const {
  const auto profile = std::lower_bound(profiles_.begin(), profiles_.end(), region);
  return profile->passed < profile->size ? level(*profile, profile->passed).below : profile->last;
}

const LineCrossing* StraightRun::ahead(const Profile& profile, int way) const {
  if (way > 0) return profile.found < profile.size ? &level(profile, profile.found) : nullptr;
  return profile.found > 0 ? &level(profile, profile.found - 1) : nullptr;
}

void StraightRun::find_nearest() {
  above_ = never;
  below_ = -never;
  for (const Profile& profile : profiles_) {
    if (const LineCrossing* next = ahead(profile, 1)) above_ = std::min(above_, next->lambda - next->error);
    if (const LineCrossing* next = ahead(profile, -1)) below_ = std::max(below_, next->lambda + next->error);
  }
}

/// The velocity of the centre is no better than the rounding of that of the contact, nor is the way, also
/// where the place has no rounding, at 0.
StraightRun::Sample StraightRun::sample(double time) const {
  ++samples_;
  const PointState now = motion_->path(time);
  const Vector2d& d = line_->direction();
  const double square = d.squaredNorm();
  const Vector2d size = now.position.cwiseAbs() + curve_.start.cwiseAbs() + line_->anchor().cwiseAbs();
  constexpr double unit = 8 * std::numeric_limits<double>::denorm_min();
  const double of_place = (4 * DBL_EPSILON * size + Vector2d::Constant(unit)).dot(d.cwiseAbs()) / square;
  const double of_way = 4 * DBL_EPSILON * (speed_ + pull_ * time) * time / square;
  return {start_ + (now.position - curve_.start).dot(d) / square, now.velocity.dot(d) / square,
          std::max(of_place, of_way)};
}

void StraightRun::find_crossings(double from, double until, bool ended, std::vector<Crossing>& crossings) {
  samples_ = 0;
  const MotionState start = motion_->at(from);
  const Vector2d& d = line_->direction();
  speed_ = std::abs(start.center.velocity.dot(d)) + std::abs(start.contact_velocity.dot(d));
  pull_ = is_parabola() ? 0 : motion_->acceleration_bound_along(d, from, from);
  profiles_before_.assign(profiles_.begin(), profiles_.end());
  const std::size_t known = crossings.size();
  try {
    if (is_parabola()) {
      run_parabola(from, until, crossings);
    } else {
      sweep(from, until, crossings);
    }
    if (ended) stop_on_edges(until, crossings);
  } catch (...) {  // the same call can be made again
    profiles_.swap(profiles_before_);
    crossings.resize(known);
    find_nearest();
    throw;
  }
}

/// An interval of time in which the motion can reach no edge, or keeps its direction, is done with; others
/// are halved, down to those in which it moves by no more than rounding.
void StraightRun::sweep(double from, double until, std::vector<Crossing>& crossings) {
  const Vector2d measure = line_->direction() / line_->direction().squaredNorm();
  std::array<geometry::Interval, 1100> stack;  // a double can be halved so often
  std::size_t size = 0;
  stack[size++] = {from, until};
  while (size > 0) {
    interruption_point();
    const geometry::Interval interval = stack[--size];
    const double half = 0.5 * (interval.high - interval.low);
    const double middle = interval.low + half;
    const Sample now = sample(middle);
    double bend = motion_->acceleration_bound_along(measure, interval.low, interval.high) * half;
    if (samples_ > max_samples) {
      const double low = sample(interval.low).speed;
      const double high = sample(interval.high).speed;
      bend = std::min(bend, 16 * std::max(std::abs(high - now.speed), std::abs(now.speed - low)));
    }
    const double reach = std::abs(now.speed) * half + 0.5 * bend * half + now.noise;
    if (below_ < now.place - reach && now.place + reach < above_) continue;
    if (std::abs(now.speed) > bend) {
      cross(exact::sign(now.speed), sample(interval.high), interval.low, interval.high, crossings);
      continue;
    }
    const bool finest = half <= 2 * DBL_EPSILON * std::abs(middle) || middle == interval.low ||
                        middle == interval.high || reach <= 2 * now.noise;
    if (finest) continue;
    stack[size++] = {middle, interval.high};
    stack[size++] = {interval.low, middle};
  }
}

/// Crosses what lies before the limit, as far as rounding tells, and with it all that is not beyond the last
/// of it.
void StraightRun::cross(int way, const Sample& limit, double from, double until,
                        std::vector<Crossing>& crossings) {
  met_.clear();
  const LineCrossing* farthest = nullptr;
  const auto meet = [&](const auto& is_met) {
    for (Profile& profile : profiles_) {
      for (const LineCrossing* next = ahead(profile, way); next && is_met(*next);
           next = ahead(profile, way)) {
        interruption_point();
        if (way > 0) ++profile.found;
        const bool is_last = profile.found == profile.size;
        const Section after = way < 0   ? next->below
                              : is_last ? profile.last
                                        : level(profile, profile.found).below;
        if (way < 0) --profile.found;
        met_.push_back({next, after});
      }
    }
  };
  meet([&](const LineCrossing& next) {
    if (!(way * (limit.place - next.lambda) > limit.noise + next.error)) return false;
    if (!farthest || way * order(*farthest, next) < 0) farthest = &next;
    return true;
  });
  if (!farthest) return;
  meet([&](const LineCrossing& next) { return way * order(next, *farthest) <= 0; });
  std::sort(met_.begin(), met_.end(), [&](const Met& a, const Met& b) {
    interruption_point();
    return way * order(*a.level, *b.level) < 0;
  });
  for (std::size_t begin = 0, end = 0; begin < met_.size(); begin = end) {
    std::size_t best = begin;
    for (end = begin + 1; end < met_.size() && order(*met_[begin].level, *met_[end].level) == 0; ++end) {
      interruption_point();
      if (met_[end].level->error < met_[best].level->error) best = end;
    }
    geometry::Root root = time_of(*met_[best].level, way, from, until);
    // Two instants have two times, and their order.
    const double least = crossings.empty() ? from : std::nextafter(crossings.back().time, never);
    root.time = std::max(root.time, least);
    from = std::clamp(root.time, from, until);
    for (std::size_t i = begin; i < end; ++i) {
      const LineCrossing& level = *met_[i].level;
      crossings.push_back({root.time, 0, level.region, met_[i].after.side, level.piece, met_[i].after.along,
                           static_cast<std::int8_t>(way), root.error});
    }
  }
  find_nearest();
}

geometry::Root StraightRun::time_of(const LineCrossing& level, int way, double from, double until) const {
  if (is_parabola()) return time_on_parabola(level, from);
  const auto height = [&](double time) {
    const Sample now = sample(time);
    return geometry::Jet{way * (now.place - level.lambda), way * now.speed, now.noise + level.error};
  };
  const geometry::Jet low = height(from);
  const geometry::Jet high = height(until);
  const double width = until - from;
  if (low.value >= 0) {
    return {from, std::min(low.noise / std::abs(low.slope), width) + DBL_EPSILON * from};
  }
  if (high.value <= 0) {
    return {until, std::min(high.noise / std::abs(high.slope), width) + DBL_EPSILON * until};
  }
  return geometry::refined_root(height, from, until, low.value, high.value);
}

/// A motion that ends on an edge, as far as rounding tells, is on it.
void StraightRun::stop_on_edges(double end, std::vector<Crossing>& crossings) {
  const Sample there = sample(end);
  for (const Profile& profile : profiles_) {
    interruption_point();
    for (const int way : {1, -1}) {
      const LineCrossing* next = ahead(profile, way);
      if (!next || std::abs(next->lambda - there.place) > there.noise + next->error) continue;
      const bool passed_there =
          std::any_of(crossings.begin(), crossings.end(), [&](const Crossing& crossing) {
            return crossing.region == profile.region && crossing.time >= end;
          });
      if (passed_there) continue;
      const double error = there.speed != 0 ? there.noise / std::abs(there.speed) : 0;
      crossings.push_back({end, 0, profile.region, Side::edge, next->piece, -1, 0, error});
      break;
    }
  }
}

void StraightRun::pass(const Crossing& crossing) {
  place_.reset();
  if (crossing.way == 0) return;
  const auto profile = std::lower_bound(profiles_.begin(), profiles_.end(), crossing.region);
  if (crossing.way < 0) --profile->passed;
  place_ = level(*profile, profile->passed);
  if (crossing.way > 0) ++profile->passed;
}

void StraightRun::snap_to_edge(Vector2d& position) const {
  if (line_->direction().x() == 0) position.x() = line_->anchor().x();
  if (line_->direction().y() == 0) position.y() = line_->anchor().y();
}

}  // namespace hybrid_sphere

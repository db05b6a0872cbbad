// Pieces of a path on a straight line that is not run along at constant speed: docs/theory.md 5.3.
#include <algorithm>

#include "ground/edge_events.hpp"
#include "interrupt/interrupt.hpp"

namespace hybrid_sphere {

/// Where a constant acceleration has a formula and regions are few, all is found at once.
double EdgeEvents::choose_line_span() const {
  const bool at_once = run_.is_parabola() && ground_->index().is_small();
  return at_once ? max_time : choose_curved_span();
}

void EdgeEvents::extend_line() {
  const double from = traced_until_;
  const double until = choose_until();
  if (!(until > from)) {
    if (at_start_) locate_at(motion_->center(from).position);
    traced_until_ = never;
    return;
  }
  const bool few = ground_->index().is_small();
  Box box{Vector2d::Constant(-never), Vector2d::Constant(never)};
  if (!few) {
    const CurvedPath path(*motion_, run_.curve(), from, until);
    box = {path.low, path.high};
  }
  activate(box);
  run_.keep(near_, from);
  statuses_.clear();
  covering_.clear();
  auto before = statuses_before_.begin();
  for (const RegionId region : near_) {
    while (before != statuses_before_.end() && before->region < region) ++before;
    if (before != statuses_before_.end() && before->region == region) {
      add_status(*before);
      continue;
    }
    const Section ahead = run_.section_ahead(region);
    const auto [first, last] = contacts_of(start_contacts_, region);
    const bool followed = std::any_of(first, last, [](const Contact& contact) { return contact.followed; });
    add_status({region, ahead.side, {EdgePiece::Kind::line, ahead.along}, followed});
  }
  const bool ended = end_ <= until;
  run_.find_crossings(from, until, ended, crossings_);
  traced_until_ = ended ? never : until;
  // What has been found is passed before the next piece.
  if (!crossings_.empty() && crossings_.back().time >= until && !ended) {
    traced_until_ = std::nextafter(crossings_.back().time, never);
  }
  if (traced_until_ == never) return;
  const std::size_t cost = run_.samples() + 2 * motion_->steps(from, until);
  if (few) {
    adapt_span(cost);
  } else {
    span_ = choose_line_span() * (near_.size() < 4 + ground_->index().unbounded().size() ? 2 : 1);
  }
}

}  // namespace hybrid_sphere

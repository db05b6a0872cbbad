#include "simulation/zeno_detector.hpp"

#include <algorithm>
#include <cmath>

namespace hybrid_sphere {
namespace {

bool is_same(const ZenoDetector::Arrival& a, const ZenoDetector::Arrival& b) {
  return a.entered == b.entered && a.left == b.left && a.reached == b.reached;
}

/// Compares to the bit: the motion from there on is the same.
bool is_unchanged(const ZenoDetector::Arrival& a, const ZenoDetector::Arrival& b) {
  return a.position == b.position && a.twist.velocity == b.twist.velocity &&
         a.twist.angular_velocity == b.twist.angular_velocity && is_same(a, b);
}

/// A circle has a single piece.
bool is_same(const EdgePiece& a, const EdgePiece& b) {
  const auto round = [](EdgePiece::Kind kind) {
    return kind != EdgePiece::Kind::line && kind != EdgePiece::Kind::vertex;
  };
  return (round(a.kind) && round(b.kind)) || (a.kind == b.kind && a.index == b.index);
}

}  // namespace

void ZenoDetector::add() {
  ++count_;
  monitor_chatter();
  monitor_state();
}

void ZenoDetector::monitor_state() {
  if (unchanged_ > 0 && is_unchanged(before(0), before(cycle_))) {
    ++unchanged_;
    return;
  }
  unchanged_ = 0;
  for (std::size_t length = 1; length <= longest_cycle && length < count_; ++length) {
    if (!is_unchanged(before(0), before(length))) continue;
    unchanged_ = 1;
    cycle_ = length;
    return;
  }
}

// If a ground throws the sphere back, a geometric series shows by its ratio: only what shrinks like a power
// of n is a chatter. If a slip ends on the edge, the sphere crosses back over it without arriving there.
void ZenoDetector::monitor_chatter() {
  constexpr double half = 0.625;
  constexpr double slowly = 0.2;
  constexpr double longer = 1.25;
  const bool comes_again = count_ > 1 && is_same(before(0), before(1));
  const bool comes_in_turn = count_ > 2 && is_same(before(0), before(2));
  const bool thrown_again = comes_again && is_thrown_back(0);
  const bool slips_back = comes_again && !before(0).struck;
  const bool in_turn = comes_in_turn && !comes_again && is_thrown_back(0) && is_thrown_back(1);
  const bool crosses_again = comes_in_turn && !before(0).struck && before(0).entered == before(1).left &&
                             before(0).left == before(1).entered;
  if (!thrown_again && !in_turn && !slips_back && !crosses_again) {
    same_ = halvings_ = even_ = on_piece_ = 0;
    interval_ = never;
    since_ = {before(0).time, before(0).remainder};
    return;
  }
  thrown_ = thrown_again || in_turn;
  period_ = crosses_again || in_turn ? 2 : 1;
  ++same_;
  on_piece_ = is_same(before(0).contact.piece, before(period_).contact.piece) ? on_piece_ + 1 : 0;
  if ((same_ & (same_ - 1)) != 0) return;  // no power of two
  const double now = interval(before(period_), before(0));
  const bool halved = now <= half * interval_ && !(thrown_ && now < slowly * interval_);
  const bool is_lost = !thrown_ && on_piece_ > 0 && now <= before(0).unseen + before(1).unseen;
  halvings_ = halved || is_lost ? halvings_ + 1 : 0;
  even_ = now <= longer * interval_ ? even_ + 1 : 0;
  interval_ = now;
}

/// Infinite if the last arrivals are no cycle [s].
double ZenoDetector::last_excursion() const {
  if (same_ >= few) return interval(before(period_), before(0));
  for (std::size_t length = 2; length <= longest_cycle; ++length) {
    if (repeats(length, 3)) return interval(before(length), before(0));
  }
  return never;
}

bool ZenoDetector::chatters(double scale, bool is_integrated) const {
  if (thrown_) return halvings_ >= 5 && same_ >= many_throws;
  double longest = 0;  // interval
  if (on_piece_ >= many) longest = 0x1p-10 * scale;
  if (on_piece_ >= very_many && is_integrated) longest = 0x1p-6 * scale;
  const bool brief = even_ >= 5 && interval_ <= longest;
  return same_ >= many && (halvings_ >= 5 || brief);
}

bool ZenoDetector::stands(double scale) const {
  constexpr double nothing = 0x1p-30;
  const double no_time = scale < never ? nothing * scale : 0;
  if (unchanged_ >= many_unchanged && interval(before(cycle_), before(0)) <= no_time) return true;
  return on_piece_ >= many && scale < never && !throws_in_turn() &&
         (before(0).time - since_.time) + (before(0).remainder - since_.remainder) <= no_time;
}

/// Whether the last arrivals have completed a cycle of this length so many times.
bool ZenoDetector::repeats(std::size_t length, std::size_t times) const {
  if (count_ < times * length + 1) return false;
  for (std::size_t i = 0; i + length < times * length + 1; ++i) {
    if (!is_same(before(i), before(i + length))) return false;
  }
  return true;
}

ZenoDetector::Throws ZenoDetector::throws_to_and_fro() const {
  if (!repeats(2, 3) || !before(0).struck || !before(1).struck || is_same(before(0), before(1))) return {};
  if (before(0).contact.region == no_region || before(1).contact.region == no_region) return {};
  return {&before(0), &before(1), &before(6)};
}

std::optional<ZenoDetector::Cycle> ZenoDetector::cycle() const {
  for (std::size_t length = 1; length <= longest_cycle; ++length) {
    if (!repeats(length, 3)) continue;
    const double last = interval(before(length), before(0));
    const double middle = interval(before(2 * length), before(length));
    const double first = interval(before(3 * length), before(2 * length));
    if (!(last > 0 && last < middle && middle < first)) return std::nullopt;
    const double ratio = last / middle;
    const double ratio_before = middle / first;
    const bool steady = std::abs(ratio - ratio_before) <= 0.25 * (1 - std::max(ratio, ratio_before));
    return steady ? std::optional(cycle_of(length, ratio, true)) : std::nullopt;
  }
  constexpr double fast = 0x1p-6;  // rounding leaves no third cycle of those that shrink like that
  if (!repeats(2, 2)) return std::nullopt;
  const double last = interval(before(2), before(0));
  const double ratio = last / interval(before(4), before(2));
  return last > 0 && ratio <= fast ? std::optional(cycle_of(2, ratio, false)) : std::nullopt;
}

ZenoDetector::Cycle ZenoDetector::cycle_of(std::size_t length, double ratio, bool is_steady) const {
  const double last = interval(before(length), before(0));
  const double sum = ratio / (1 - ratio);
  const Vector2d way = before(0).position - before(length).position;
  const Vector2d limit = before(0).position + sum * way;
  return {length, last, ratio, last * sum, limit, is_steady, &before(0), &before(1)};
}

bool ZenoDetector::shrinks_towards(const Vector2d& corner, double ratio, double rounding) const {
  const auto distance = [&](std::size_t k) { return (before(k).position - corner).norm(); };
  return distance(0) <= 4 * ratio * distance(2) + rounding &&
         distance(1) <= 4 * ratio * distance(3) + rounding;
}

}  // namespace hybrid_sphere

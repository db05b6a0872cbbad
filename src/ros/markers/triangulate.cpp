#include "ros/markers/triangulate.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <set>
#include <utility>

#include "geometry/exact.hpp"
#include "interrupt/interrupt.hpp"

namespace hybrid_sphere::ros_interface {
namespace {

using Eigen::Vector2d;
using exact::orientation;
using Index = std::uint32_t;

/// From left to right, and upwards where that does not decide.
bool before(const Vector2d& a, const Vector2d& b) {
  return a.x() < b.x() || (a.x() == b.x() && a.y() < b.y());
}

/// The corners of all rings from left to right; side i runs from corner i to the next one of its ring.
struct Corners {
  explicit Corners(const std::vector<std::vector<Vector2d>>& rings) {
    std::vector<Ringed> sorted;
    for (const std::vector<Vector2d>& ring : rings) {
      const auto first = static_cast<Index>(sorted.size());
      const auto n = static_cast<Index>(ring.size());
      for (Index i = 0; i < n; ++i) sorted.push_back({ring[i], first + i, first + (i + 1) % n});
    }
    std::sort(sorted.begin(), sorted.end(),
              [](const Ringed& a, const Ringed& b) { return before(a.at, b.at); });
    std::vector<Index> place(sorted.size());
    for (Index i = 0; i < sorted.size(); ++i) place[sorted[i].index] = i;
    at.reserve(sorted.size());
    next.reserve(sorted.size());
    previous.resize(sorted.size());
    for (Index i = 0; i < sorted.size(); ++i) {
      at.push_back(sorted[i].at);
      next.push_back(place[sorted[i].next]);
      previous[next[i]] = i;
    }
  }

  const Vector2d& left(Index side) const { return at[std::min(side, next[side])]; }
  const Vector2d& right(Index side) const { return at[std::max(side, next[side])]; }
  bool below(Index side, const Vector2d& p) const { return orientation(left(side), right(side), p) > 0; }

  std::vector<Vector2d> at;
  std::vector<Index> next;
  std::vector<Index> previous;

 private:
  struct Ringed {
    Vector2d at;
    Index index;
    Index next;
  };
};

/// Of the two chains of a piece, the one below its inside or the one above.
enum class Chain : bool { lower, upper };

/// A piece that every vertical line meets once, as far as it has been swept: of what is not cut off yet, the
/// corners of one chain; the first of them may be of the other one.
class Piece {
 public:
  Piece(Index first, std::vector<Vector2d>& triangles) : open_{first}, triangles_(&triangles) {}
  /// Begins with a side between two corners, whose second one is of a chain.
  Piece(Index first, Index second, Chain chain, std::vector<Vector2d>& triangles)
      : open_{first, second}, chain_(chain), triangles_(&triangles) {}

  Index last() const { return open_.back(); }
  Chain chain() const { return chain_; }

  /// The next corner from the left.
  void add(Index corner, Chain chain, const Corners& corners) {
    if (open_.size() == 1 || chain == chain_) {
      while (open_.size() > 1 && cut(open_[open_.size() - 2], open_.back(), corner, corners))
        open_.pop_back();
    } else {
      for (Index i = 1; i < open_.size(); ++i) cut(open_[i - 1], open_[i], corner, corners);
      open_.assign(1, open_.back());
    }
    open_.push_back(corner);
    chain_ = chain;
  }

  /// The last corner, where both chains end.
  void finish(Index corner, const Corners& corners) {
    for (Index i = 1; i < open_.size(); ++i) cut(open_[i - 1], open_[i], corner, corners);
    open_.clear();
  }

 private:
  /// Cuts off a triangle of two corners of the chain and a third one, if it lies inside.
  bool cut(Index a, Index b, Index c, const Corners& corners) {
    if (chain_ == Chain::upper) std::swap(a, b);
    const Vector2d& p = corners.at[a];
    const Vector2d& q = corners.at[b];
    const Vector2d& r = corners.at[c];
    if (orientation(p, q, r) <= 0) return false;
    triangles_->insert(triangles_->end(), {p, q, r});
    return true;
  }

  std::vector<Index> open_;
  Chain chain_ = Chain::lower;
  std::vector<Vector2d>* triangles_;
};

struct Interval;

/// Order from below of intervals, by their lower sides.
struct Below {
  using is_transparent = void;
  const Corners* corners;

  bool operator()(const Interval* a, const Interval* b) const;
  bool operator()(const Vector2d& p, const Interval* b) const;
};
using Crossing = std::set<Interval*, Below>;

/// What lies inside on the sweep line between two sides that cross it one over the other.
struct Interval {
  Index lower_side;
  Index upper_side;
  Piece piece;
  /// Where a corner that points to the right has joined two intervals, the piece above it; the corner is the
  /// last one of both, and the next one to come is joined to it.
  std::optional<Piece> above{};
  Crossing::const_iterator place{};
};

bool Below::operator()(const Interval* a, const Interval* b) const {
  const Index i = a->lower_side;
  const Index j = b->lower_side;
  const Index begin_i = std::min(i, corners->next[i]);
  const Index begin_j = std::min(j, corners->next[j]);
  // Of two sides, the one that begins later is compared with the line of the other.
  if (begin_i < begin_j) return corners->below(i, corners->at[begin_j]);
  return orientation(corners->left(j), corners->right(j), corners->at[begin_i]) < 0;
}

bool Below::operator()(const Vector2d& p, const Interval* b) const {
  return !corners->below(b->lower_side, p);
}

class Sweep {
 public:
  explicit Sweep(const std::vector<std::vector<Vector2d>>& rings)
      : corners_(rings), crossing_(Below{&corners_}), of_side_(corners_.at.size(), nullptr) {}

  std::vector<Vector2d> triangles() {
    triangles_.reserve(3 * corners_.at.size());
    for (Index corner = 0; corner < corners_.at.size(); ++corner) {
      interruption_point();
      if (!pass(corner)) return {};
    }
    return std::move(triangles_);
  }

 private:
  /// @return false where this is not the edge of a region
  bool pass(Index v) {
    const Index p = corners_.previous[v];
    const Index n = corners_.next[v];
    const bool from_left = p < v;
    const bool to_left = n < v;
    if (from_left && !to_left) return go_on_below(v, p);
    if (!from_left && to_left) return go_on_above(v, p);
    const int turn = orientation(corners_.at[p], corners_.at[v], corners_.at[n]);
    if (turn == 0) return false;
    if (from_left) return turn > 0 ? end(v, p) : merge(v, p);
    return turn > 0 ? start(v, p) : split(v, p);
  }

  /// An interval begins: above the side that begins at the corner, below the one that ends there.
  bool start(Index v, Index p) {
    return open({v, p, Piece(v, triangles_)}, crossing_.upper_bound(corners_.at[v]));
  }

  bool split(Index v, Index p) {
    const auto after = crossing_.upper_bound(corners_.at[v]);
    if (after == crossing_.begin()) return false;
    Interval& lower = **std::prev(after);
    Interval upper{v, lower.upper_side, lower.piece, {}};
    if (lower.above) {
      upper.piece = std::move(*lower.above);
      lower.above.reset();
      lower.piece.add(v, Chain::upper, corners_);
      upper.piece.add(v, Chain::lower, corners_);
    } else {
      const Index visible = lower.piece.last();
      if (lower.piece.chain() == Chain::lower) {
        upper.piece.add(v, Chain::lower, corners_);
        lower.piece = Piece(visible, v, Chain::upper, triangles_);
      } else {
        lower.piece.add(v, Chain::upper, corners_);
        upper.piece = Piece(visible, v, Chain::lower, triangles_);
      }
    }
    lower.upper_side = p;
    of_side_[p] = &lower;
    return open(std::move(upper), after);
  }

  bool merge(Index v, Index p) {
    Interval* const lower = of_side_[v];
    Interval* const upper = of_side_[p];
    if (lower == nullptr || upper == nullptr || lower == upper) return false;
    reach_above(*lower, v);
    reach_below(*upper, v);
    lower->above = std::move(upper->piece);
    lower->upper_side = upper->upper_side;
    of_side_[lower->upper_side] = lower;
    close(upper);
    return true;
  }

  bool end(Index v, Index p) {
    Interval* const interval = of_side_[v];
    if (interval == nullptr || interval != of_side_[p]) return false;
    interval->piece.finish(v, corners_);
    if (interval->above) interval->above->finish(v, corners_);
    close(interval);
    return true;
  }

  bool go_on_below(Index v, Index p) {
    Interval* const interval = of_side_[p];
    if (interval == nullptr) return false;
    reach_below(*interval, v);
    interval->lower_side = v;
    of_side_[v] = interval;
    return true;
  }

  bool go_on_above(Index v, Index p) {
    Interval* const interval = of_side_[v];
    if (interval == nullptr) return false;
    reach_above(*interval, v);
    interval->upper_side = p;
    of_side_[p] = interval;
    return true;
  }

  /// A corner on the lower side of an interval.
  void reach_below(Interval& interval, Index v) {
    if (interval.above) {
      interval.piece.finish(v, corners_);
      interval.piece = std::move(*interval.above);
      interval.above.reset();
    }
    interval.piece.add(v, Chain::lower, corners_);
  }

  /// A corner on the upper side of an interval.
  void reach_above(Interval& interval, Index v) {
    if (interval.above) {
      interval.above->finish(v, corners_);
      interval.above.reset();
    }
    interval.piece.add(v, Chain::upper, corners_);
  }

  bool open(Interval interval, Crossing::const_iterator after) {
    if (unused_.empty()) {
      unused_.push_back(&intervals_.emplace_back(std::move(interval)));
    } else {
      *unused_.back() = std::move(interval);
    }
    Interval* const kept = unused_.back();
    unused_.pop_back();
    const std::size_t before = crossing_.size();
    kept->place = crossing_.emplace_hint(after, kept);
    of_side_[kept->lower_side] = of_side_[kept->upper_side] = kept;
    return crossing_.size() == before + 1;
  }

  void close(Interval* interval) {
    crossing_.erase(interval->place);
    unused_.push_back(interval);
  }

  Corners corners_;
  std::vector<Vector2d> triangles_;
  std::deque<Interval> intervals_;
  std::vector<Interval*> unused_;  // of them
  Crossing crossing_;
  std::vector<Interval*> of_side_;
};

}  // namespace

std::vector<Vector2d> triangulate(const std::vector<std::vector<Vector2d>>& rings) {
  for (const std::vector<Vector2d>& ring : rings) {
    if (ring.size() < 3) return {};
  }
  return Sweep(rings).triangles();
}

}  // namespace hybrid_sphere::ros_interface

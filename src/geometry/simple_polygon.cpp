#include "geometry/simple_polygon.hpp"

#include <algorithm>
#include <array>
#include <iterator>
#include <numeric>
#include <set>
#include <utility>

#include "geometry/exact.hpp"

namespace hybrid_sphere::geometry {
namespace {

using Eigen::Vector2d;
using exact::orientation;

/// Up to so many corners, all pairs of sides are compared: cheaper than a sweep, and without memory of its
/// own.
constexpr std::size_t max_pairwise_edges = 16;

std::string number(std::size_t i) { return std::to_string(i); }

/// From left to right, and upwards where that does not decide.
bool before(const Vector2d& a, const Vector2d& b) {
  return a.x() < b.x() || (a.x() == b.x() && a.y() < b.y());
}

bool ranges_meet(double a, double b, double c, double d) {
  return std::min(a, b) <= std::max(c, d) && std::min(c, d) <= std::max(a, b);
}

/// The corners of a closed line; side i runs from corner i to the next one.
class ClosedLine {
 public:
  explicit ClosedLine(const std::vector<Vector2d>& vertices) : vertices_(vertices) {}

  std::size_t size() const { return vertices_.size(); }
  std::size_t next(std::size_t i) const { return i + 1 < size() ? i + 1 : 0; }
  std::size_t previous(std::size_t i) const { return i > 0 ? i - 1 : size() - 1; }
  const Vector2d& start(std::size_t side) const { return vertices_[side]; }
  const Vector2d& end(std::size_t side) const { return vertices_[next(side)]; }

  bool are_neighbours(std::size_t i, std::size_t j) const { return next(i) == j || next(j) == i; }

  bool meet(std::size_t i, std::size_t j) const {
    const Vector2d& a = start(i);
    const Vector2d& b = end(i);
    const Vector2d& c = start(j);
    const Vector2d& d = end(j);
    return ranges_meet(a.x(), b.x(), c.x(), d.x()) && ranges_meet(a.y(), b.y(), c.y(), d.y()) &&
           orientation(a, b, c) * orientation(a, b, d) <= 0 &&
           orientation(c, d, a) * orientation(c, d, b) <= 0;
  }

 private:
  const std::vector<Vector2d>& vertices_;
};

using Pair = std::pair<std::size_t, std::size_t>;

/// Pairs by the left ends of their sides.
std::optional<Pair> meeting_pair_of_few(const ClosedLine& line) {
  const auto left = [&line](std::size_t i) { return std::min(line.start(i).x(), line.end(i).x()); };
  std::array<std::size_t, max_pairwise_edges> sides{};
  const auto end = sides.begin() + static_cast<std::ptrdiff_t>(line.size());
  std::iota(sides.begin(), end, std::size_t{0});
  std::sort(sides.begin(), end, [&left](std::size_t i, std::size_t j) { return left(i) < left(j); });
  for (auto i = sides.begin(); i != end; ++i) {
    for (auto j = i + 1; j != end; ++j) {
      if (!line.are_neighbours(*i, *j) && line.meet(*i, *j)) return Pair{*i, *j};
    }
  }
  return std::nullopt;
}

/// A sweep over the corners (Shamos and Hoey 1976) with exact signs: the sides that cross the sweep line are
/// kept in the order in which they cross it, and sides are compared when they come to lie side by side there.
/// That order is right up to the first point where sides that are no neighbours meet, and before that point
/// is reached two of them lie side by side or one begins on the other. Neighbours must not run back over each
/// other.
class Sweep {
 public:
  explicit Sweep(const ClosedLine& line) : line_(line), crossing_(Below{&line}), place_(line.size()) {}

  std::optional<Pair> meeting_pair() {
    std::vector<std::size_t> order(line_.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(),
              [this](std::size_t i, std::size_t j) { return before(line_.start(i), line_.start(j)); });
    for (std::size_t k = 0; k < order.size(); ++k) {
      if (k > 0 && line_.start(order[k - 1]) == line_.start(order[k])) return Pair{order[k - 1], order[k]};
      pass(order[k]);
      if (found_) return found_;
    }
    return std::nullopt;
  }

 private:
  /// Order from below of two sides that cross one sweep line. Equivalent ones meet.
  struct Below {
    const ClosedLine* line;

    const Vector2d& left(std::size_t i) const {
      return before(line->start(i), line->end(i)) ? line->start(i) : line->end(i);
    }
    const Vector2d& right(std::size_t i) const {
      return before(line->start(i), line->end(i)) ? line->end(i) : line->start(i);
    }
    bool operator()(std::size_t i, std::size_t j) const {
      if (i == j) return false;
      if (left(i) == left(j)) return orientation(left(i), right(i), right(j)) > 0;
      // Of two sides, the one that begins later is compared with the line of the other.
      return before(left(i), left(j)) ? orientation(left(i), right(i), left(j)) > 0
                                      : orientation(left(j), right(j), left(i)) < 0;
    }
  };
  using Crossing = std::set<std::size_t, Below>;

  void pass(std::size_t corner) {
    const std::size_t sides[] = {line_.previous(corner), corner};
    const bool begins[] = {before(line_.start(corner), line_.start(sides[0])),
                           before(line_.start(corner), line_.end(corner))};
    for (const int k : {0, 1}) {
      if (!begins[k]) remove(sides[k]);
    }
    for (const int k : {0, 1}) {
      if (begins[k]) insert(sides[k]);
    }
  }

  void insert(std::size_t side) {
    const auto [place, is_new] = crossing_.insert(side);
    if (!is_new) {
      found_ = Pair{*place, side};
      return;
    }
    place_[side] = place;
    if (place != crossing_.begin()) compare(*std::prev(place), side);
    if (std::next(place) != crossing_.end()) compare(side, *std::next(place));
  }

  void remove(std::size_t side) {
    const auto after = crossing_.erase(place_[side]);
    if (after != crossing_.begin() && after != crossing_.end()) compare(*std::prev(after), *after);
  }

  void compare(std::size_t i, std::size_t j) {
    if (!line_.are_neighbours(i, j) && line_.meet(i, j)) found_ = Pair{i, j};
  }

  const ClosedLine& line_;
  Crossing crossing_;
  std::vector<Crossing::const_iterator> place_;  // by side, valid while it is in the set
  std::optional<Pair> found_;
};

}  // namespace

std::optional<std::string> fault_of_polygon(const std::vector<Vector2d>& vertices) {
  const std::size_t n = vertices.size();
  if (n < 3) return number(n) + " corners";
  const ClosedLine line(vertices);
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t j = line.next(i);
    if (line.start(i) == line.end(i)) return "corners " + number(i) + " and " + number(j) + " coincide";
    const bool turns_back = before(line.start(i), line.end(i)) != before(line.start(j), line.end(j));
    if (turns_back && orientation(line.start(i), line.end(i), line.end(j)) == 0 &&
        line.start(j) != line.end(j)) {
      return "the sides at corner " + number(j) + " overlap";
    }
  }
  const auto pair = n <= max_pairwise_edges ? meeting_pair_of_few(line) : Sweep(line).meeting_pair();
  if (!pair) return std::nullopt;
  const auto [i, j] = std::minmax(pair->first, pair->second);
  return "sides " + number(i) + " and " + number(j) + " meet";
}

bool is_counter_clockwise(const std::vector<Vector2d>& vertices) {
  const std::size_t n = vertices.size();
  const auto i =
      static_cast<std::size_t>(std::min_element(vertices.begin(), vertices.end(), before) - vertices.begin());
  return orientation(vertices[(i + n - 1) % n], vertices[i], vertices[(i + 1) % n]) > 0;
}

}  // namespace hybrid_sphere::geometry

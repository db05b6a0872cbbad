#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "ground/crossing.hpp"
#include "motion/motion.hpp"

/// Switches that come to an end in time, but not in number. Source: docs/theory.md 5.5.
namespace hybrid_sphere {

/// Detects whether arrivals at edges recur in a cycle whose intervals shrink by a constant factor: the limit
/// time is then that of a geometric series.
class ZenoDetector {
 public:
  /// An instant at which the sphere came to an edge.
  struct Arrival {
    RegionId left = no_region;     ///< the previous ground
    RegionId entered = no_region;  ///< the first one entered
    RegionId reached = no_region;  ///< the one on which the motion continues
    bool struck = false;           ///< with an impulse
    double time = 0;               ///< time + remainder [s]
    double remainder = 0;
    Vector2d position = Vector2d::Zero();  ///< of the centre [m]
    Twist twist{};                         ///< before [m/s, rad/s]
    Contact contact{no_region, {}};        ///< the edge
    double unseen = 0;  ///< an excursion as short as this is lost in the rounding of places [s]
  };

  /// A cycle of arrivals that shrinks geometrically, as of its last arrival.
  struct Cycle {
    std::size_t length;  ///< number of arrivals in it
    double interval;     ///< d: duration of the last one [s]
    double ratio;        ///< q < 1 of successive durations
    double remaining;    ///< t* - t = d q/(1 - q) [s]
    Vector2d limit;      ///< of the places, by the same series [m]
    bool is_steady;      ///< gone through three times; otherwise twice, and the intervals shrink fast
    const Arrival* last = nullptr;
    const Arrival* opposite = nullptr;  ///< the other one of a cycle of two
  };

  /// Arrivals at two known edges that throw the sphere back in turn; null if there are none.
  struct Throws {
    const Arrival* last = nullptr;
    const Arrival* other = nullptr;
    const Arrival* before = nullptr;  ///< at the edge of the last one, three cycles ago
  };

  void clear() {
    count_ = 0;
    same_ = 0;
    halvings_ = 0;
    unchanged_ = 0;
  }
  /// The arrival that add() will count, to be filled in.
  Arrival& next() { return ring_[count_ % kept]; }
  void add();

  /// The shortest cycle that the last arrivals have gone through three times with a steady ratio; or one of
  /// two arrivals whose second time is so much shorter than the first that rounding leaves no third.
  std::optional<Cycle> cycle() const;
  /// Whether the places of a cycle of two come nearer to a corner as its intervals shrink, to a factor of 4.
  bool shrinks_towards(const Vector2d& corner, double ratio, double rounding) const;

  Throws throws_to_and_fro() const;

  /// Two grounds drive the sphere across one edge, or one throws it back to the other, or two throw it back
  /// in turn, in intervals that shrink like a power of 1/n: they have at least halved at each of the last
  /// five doublings of n, or have reached the resolution of rounding; and n is large. Or they were that short
  /// from the beginning, on one piece of the edge, and do not grow.
  /// @param scale          time in which the forces change the motion [s]
  /// @param is_integrated  whether the last paths are
  bool chatters(double scale, bool is_integrated) const;
  /// Whether two grounds throw the sphere back in turn: if their edges do not meet, it may pass between them.
  bool throws_in_turn() const { return thrown_ && period_ == 2; }
  /// Whether one piece of edge, or a few edges in turn, have been crossed again and again in no time and the
  /// state has returned to itself, to the bit.
  /// @param scale  time in which the forces change the motion [s]
  bool stands(double scale) const;
  /// Expected time until the sphere returns to an edge that it keeps coming back to, or to a few of them in
  /// turn: the duration of the last excursion, or infinite [s].
  double expected() const { return count_ > few ? last_excursion() : never; }
  /// Number of crossings of one edge that make a chatter: each takes 1e-3 of the time in which the forces
  /// change the motion, so that the sphere leaves the edge by 1e-7 of its way in that time.
  static constexpr std::uint64_t many = 1 << 12;
  /// Number of crossings of one piece of edge on integrated paths, whose errors keep the intervals from
  /// becoming shorter than 1e-2 of that time.
  static constexpr std::uint64_t very_many = 1 << 15;
  /// Throws may end after thousands of them, as the slip between two of them dies out.
  static constexpr std::uint64_t many_throws = 1 << 16;
  /// What has changed nothing this many times never will.
  static constexpr std::uint64_t many_unchanged = 1 << 6;

 private:
  static constexpr std::uint64_t few = 4;
  static constexpr std::size_t longest_cycle = 4;
  static constexpr std::size_t kept = 16;  // >= 3 longest_cycle + 2: next() is one of them

  static double interval(const Arrival& from, const Arrival& until) {
    return (until.time - from.time) + (until.remainder - from.remainder);
  }
  const Arrival& before(std::size_t k) const { return ring_[(count_ - 1 - k) % kept]; }
  double last_excursion() const;
  bool repeats(std::size_t length, std::size_t times) const;
  Cycle cycle_of(std::size_t length, double ratio, bool is_steady) const;
  bool is_thrown_back(std::size_t k) const { return before(k).struck && before(k).reached == before(k).left; }
  void monitor_chatter();
  void monitor_state();

  std::array<Arrival, kept> ring_{};
  std::uint64_t count_ = 0;
  std::uint64_t unchanged_ = 0;  // arrivals in a row like the one a cycle before, in the same state
  std::size_t cycle_ = 1;        // arrivals in that cycle
  std::uint64_t same_ = 0;       // arrivals in a row at one edge (or two in turn), each with a way back
  std::uint64_t on_piece_ = 0;   // number of these in a row at one piece of it
  struct {
    double time;
    double remainder;
  } since_{};                   // the first of them [s]
  bool thrown_ = false;         // back by one ground, or by two in turn
  std::size_t period_ = 1;      // arrivals from one at that edge to the next one like it
  double interval_ = never;     // at the last doubling of that number [s]
  std::uint64_t halvings_ = 0;  // doublings in a row at which it was half of that before, or less
  std::uint64_t even_ = 0;      // doublings in a row at which it was hardly longer
};

/// Detects accumulations that are not geometric, as in the cusp between a belt's edge and a circle that
/// touches it: the time of the n-th instant falls short of the limit by a power of 1/n, so that binary64
/// separates billions of instants. The sign is how far the clock advances while their number doubles.
class SlowZenoDetector {
 public:
  void begin(double now) {
    instants_ = 0;
    counted_from_ = looked_at_ = now;
    blocks_ = falls_ = 0;
    next_ = 1;
    advance_ = never;
  }

  /// Counts an instant; returns true after every many_instants instants.
  bool count() { return ++instants_ == many_instants; }

  /// To be called after every many_instants instants.
  void count_block(double now) {
    instants_ = 0;
    counted_from_ = now;
    if (++blocks_ < next_) return;
    const double advance = now - looked_at_;
    falls_ = advance <= 0.75 * advance_ ? falls_ + 1 : 0;
    looked_at_ = now;
    advance_ = advance;
    next_ *= 2;
  }

  /// When the last block began [s].
  double counted_from() const { return counted_from_; }

  /// Whether the clock advanced less at each of the last five doublings.
  bool suspected() const { return falls_ >= 5; }
  /// The same, and the edges have been crossed again and again: a path that goes on comes to new ones.
  /// @param edges  of the whole ground
  bool seen(std::uint64_t edges) const { return suspected() && blocks_ * many_instants >= 8 * edges; }

  /// Edges that are crossed one after another do not give this many instants closer, on average, than the
  /// clock resolves.
  static constexpr int many_instants = 4096;

 private:
  int instants_ = 0;  // number since counted_from_
  double counted_from_ = 0;
  std::uint64_t blocks_ = 0;
  std::uint64_t next_ = 1;   // number of blocks at which to look again
  std::uint64_t falls_ = 0;  // doublings in a row that took less time than the one before
  double looked_at_ = 0;     // [s]
  double advance_ = never;   // of the last doubling [s]
};

/// Detects instants between which the sphere does not move at all: its displacements are lost in the rounding
/// of its place, so that it would never leave, whatever its speed.
class StandstillDetector {
 public:
  void begin() { count_ = 0; }

  /// @param now    the place at an instant [m]
  /// @param stays  whether the preceding motion was at this place halfway, too @return whether this has
  /// happened many times in a row
  template <class Stays>
  bool count(const Vector2d& now, const Stays& stays) {
    count_ = now == place_ && stays() ? count_ + 1 : 0;
    place_ = now;
    return count_ >= many;
  }

 private:
  static constexpr std::uint64_t many = 1 << 12;
  Vector2d place_ = Vector2d::Constant(never);  // at the last instant [m]
  std::uint64_t count_ = 0;
};

}  // namespace hybrid_sphere

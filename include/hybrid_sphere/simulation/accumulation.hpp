#pragma once

#include <cstdint>

#include "hybrid_sphere/sphere/motion.hpp"

namespace hybrid_sphere {

/// Switches that come to an end in time, but not in number, as in the cusp between a belt's edge and a circle
/// that touches it: the time of the n-th falls short of the last time by a power of 1/n, so that binary64
/// tells them apart for thousands of millions of switches. Seen from how far the clock comes while their
/// number doubles. Source: docs/theory.md 5.4.
class Accumulation {
 public:
  void begin(double now) {
    blocks_ = falls_ = 0;
    next_ = 1;
    looked_at_ = now;
    advance_ = never;
  }

  /// After each many_instants of them.
  void count_block(double now) {
    if (++blocks_ < next_) return;
    const double advance = now - looked_at_;
    falls_ = advance <= 0.75 * advance_ ? falls_ + 1 : 0;
    looked_at_ = now;
    advance_ = advance;
    next_ *= 2;
  }

  /// Whether the clock has come less and less far at each of the last five doublings.
  bool suspected() const { return falls_ >= 5; }
  /// The same, and the edges have been crossed again and again: a path that goes on comes to new ones.
  /// @param edges  of the whole ground
  bool seen(std::uint64_t edges) const { return suspected() && blocks_ * many_instants >= 8 * edges; }

  /// So many instants, on average closer than the clock resolves, do not come from edges that are crossed one
  /// after another.
  static constexpr int many_instants = 4096;

 private:
  std::uint64_t blocks_ = 0;
  std::uint64_t next_ = 1;   // number of blocks at which to look again
  std::uint64_t falls_ = 0;  // doublings in a row that took less time than the one before
  double looked_at_ = 0;     // [s]
  double advance_ = never;   // of the last doubling [s]
};

}  // namespace hybrid_sphere

#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "interrupt/interrupt.hpp"

namespace hybrid_sphere {

/// The interval of time on which polynomials are valid at present: a whole one, or a part of it by repeated
/// halving, the longest that they cover. It depends on the time that it has to contain and on the whole, not
/// on the times before.
class HalvedInterval {
 public:
  struct Whole {
    double from;   ///< [s]
    double width;  ///< [s]
  };

  /// Contains nothing.
  void clear() {
    level_ = none;
    from_ = 0;
    until_ = 0;
    is_covered_ = false;
  }
  bool contains(double tau) const { return tau >= from_ && tau < until_; }
  /// Whether the polynomials are valid; otherwise the part that is left is too short to be halved.
  bool is_covered() const { return is_covered_; }

  /// Goes up from the present part to the first one with the time that contains it, for that is not covered,
  /// and down from there.
  /// @param tau         in the whole [s]
  /// @param last_level  number of halvings at most
  /// @param cover       bool(double from, double width): finds polynomials, and whether they cover a part
  template <class Cover>
  void find(double tau, const Whole& whole, int last_level, const Cover& cover) {
    int level = 0;
    if (level_ != none && whole.from == whole_.from && whole.width == whole_.width) {
      level = level_;
      while (level > 0 && start_of(tau, whole, level - 1) != start_of(from_, whole, level - 1)) --level;
    }
    clear();  // should this be interrupted
    for (;; ++level) {
      interruption_point();
      const double width = std::ldexp(whole.width, -level);
      const double from = start_of(tau, whole, level);
      const bool is_covered = cover(from, width);
      if (!is_covered && level < last_level && from + 0.5 * width > from) continue;
      whole_ = whole;
      level_ = level;
      from_ = from;
      until_ = from + width;
      is_covered_ = is_covered;
      return;
    }
  }

 private:
  static constexpr int none = -1;

  /// Of the part that contains a time: the last one also where that rounds to the end of the whole.
  static double start_of(double tau, const Whole& whole, int level) {
    const double width = std::ldexp(whole.width, -level);
    const double last = std::ldexp(1.0, level) - 1;
    return whole.from + width * std::min(std::floor((tau - whole.from) / width), last);
  }

  Whole whole_{0, 0};
  int level_ = none;
  double from_ = 0;
  double until_ = 0;
  bool is_covered_ = false;
};

}  // namespace hybrid_sphere

#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "study/statistics.hpp"

namespace hybrid_sphere::testing {

/// The same numbers on every machine. Source: G. L. Steele, D. Lea, C. H. Flood, OOPSLA 2014, SplitMix.
class SplitMix {
 public:
  explicit SplitMix(std::uint64_t seed) : state_(seed) {}

  std::uint64_t bits() {
    state_ += 0x9e3779b97f4a7c15U;
    std::uint64_t z = state_;
    z = (z ^ (z >> 30U)) * 0xbf58476d1ce4e5b9U;
    z = (z ^ (z >> 27U)) * 0x94d049bb133111ebU;
    return z ^ (z >> 31U);
  }
  /// In [0, 1), a multiple of 2^-53.
  double uniform() { return static_cast<double>(bits() >> 11U) * 0x1p-53; }
  std::size_t below(std::size_t n) { return static_cast<std::size_t>(bits() % n); }

 private:
  std::uint64_t state_;
};

inline study::Blocks in_one_block(const std::vector<double>& values) {
  return [&values](const auto& take) { take(values.data(), values.size()); };
}

/// Cut at random, with empty blocks among the others; each pass is cut in another way.
/// @param longest  > 0
inline study::Blocks in_random_blocks(const std::vector<double>& values, std::size_t longest,
                                      SplitMix& random) {
  return [&values, longest, &random](const auto& take) {
    for (std::size_t i = 0; i < values.size();) {
      const std::size_t count = std::min(random.below(longest + 1), values.size() - i);
      take(values.data() + i, count);
      i += count;
    }
  };
}

}  // namespace hybrid_sphere::testing

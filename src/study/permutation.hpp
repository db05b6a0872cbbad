#pragma once

#include <array>
#include <cstdint>

#include "study/stream.hpp"

namespace hybrid_sphere::study {

/// A pseudo-random permutation of 0 .. size - 1 that takes no memory: a Feistel network on pairs of numbers
/// below nearly the root of the size; what comes out too large goes in again. Source: J. Black, P. Rogaway,
/// Ciphers with arbitrary finite domains, CT-RSA 2002, 114-130.
class Permutation {
 public:
  /// @param size  1 to 2^63
  /// @param part  of the stream that it is keyed by
  Permutation(std::uint64_t size, const Stream& stream, std::uint64_t part);

  /// @param index  below the size
  std::uint64_t operator()(std::uint64_t index) const;

 private:
  static constexpr std::size_t rounds = 8;

  std::uint64_t size_;
  std::uint64_t columns_;  // the numbers are row columns_ + column
  std::uint64_t rows_;
  std::array<std::uint64_t, rounds> keys_{};
};

}  // namespace hybrid_sphere::study

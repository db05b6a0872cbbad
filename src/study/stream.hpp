#pragma once

#include <Random123/philox.h>

#include <array>
#include <cstdint>

#include "study/fnv1a.hpp"

/// Pseudo-random words as a function of a seed, a name and a place in the stream of both.
namespace hybrid_sphere::study {

/// Words for different purposes are independent of each other.
enum class Purpose : std::uint64_t { place, shift, permutation };

struct Stream {
  std::uint64_t seed;
  std::uint64_t name;  ///< fnv1a of it

  /// The four words of a place. Source: J. K. Salmon et al., Parallel random numbers: as easy as 1, 2, 3,
  /// Proc. SC11 (2011), Philox4x64-10.
  /// @param part  a stream has independent parts
  std::array<std::uint64_t, 4> words(std::uint64_t index, std::uint64_t part, Purpose purpose) const {
    const r123::Philox4x64::ctr_type counter{{index, part, 0, static_cast<std::uint64_t>(purpose)}};
    const r123::Philox4x64::key_type key{{seed, name}};
    const r123::Philox4x64::ctr_type words = r123::Philox4x64()(counter, key);
    return {words[0], words[1], words[2], words[3]};
  }

  std::uint64_t word(std::uint64_t index, std::uint64_t part, Purpose purpose) const {
    return words(index, part, purpose)[0];
  }
};

/// A number in the open interval (0, 1) from the upper 52 bits of a word; exact.
inline double in_unit_interval(std::uint64_t word) {
  return (static_cast<double>(static_cast<std::int64_t>(word >> 12)) + 0.5) * 0x1p-52;
}

}  // namespace hybrid_sphere::study

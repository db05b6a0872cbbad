#pragma once

#include <algorithm>
#include <cstdint>
#include <cstring>

namespace hybrid_sphere::integration {

/// The largest power of two that is at most x > 0, limited to 2^-1000 to 2^1000: multiplying or dividing by
/// it is exact.
inline double power_of_two(double x) {
  constexpr std::uint64_t exponent = 0x7ff0000000000000;
  std::uint64_t bits = 0;
  std::memcpy(&bits, &x, sizeof bits);
  bits &= exponent;
  std::memcpy(&x, &bits, sizeof bits);
  return std::clamp(x, 0x1p-1000, 0x1p+1000);
}

}  // namespace hybrid_sphere::integration

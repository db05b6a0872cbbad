#pragma once

#include <cstdint>
#include <string_view>

namespace hybrid_sphere::study {

/// 64-bit FNV-1a. Source: IETF draft-eastlake-fnv.
constexpr std::uint64_t fnv1a(std::string_view text) {
  std::uint64_t hash = 0xcbf29ce484222325;
  for (const char character : text) {
    hash = (hash ^ static_cast<unsigned char>(character)) * 0x100000001b3;
  }
  return hash;
}

}  // namespace hybrid_sphere::study

#pragma once

#include <cmath>
#include <cstdlib>

namespace hybrid_sphere::testing {

/// Returns the number of cases that a test draws from its fixed seed: the usual number, multiplied by the
/// environment variable HYBRID_SPHERE_TEST_FACTOR. A campaign sets it to 4 or more.
inline int case_count(int usual) noexcept {
  const char* const factor = std::getenv("HYBRID_SPHERE_TEST_FACTOR");
  return factor == nullptr ? usual : static_cast<int>(std::ceil(usual * std::atof(factor)));
}

}  // namespace hybrid_sphere::testing

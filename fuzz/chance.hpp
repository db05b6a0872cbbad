#pragma once

#include "support/random_scenes.hpp"

namespace hybrid_sphere::fuzz {

/// True once in so many times.
inline bool chance(int one_in) { return testing::integer(1, one_in) == 1; }

}  // namespace hybrid_sphere::fuzz

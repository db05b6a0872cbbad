#pragma once

#include <cstdint>

namespace hybrid_sphere::fuzz {

/// Begins the numbers of testing::integer anew: the same seed and number, the same scene on every machine.
void begin_draws(std::uint64_t seed, std::uint64_t number);

}  // namespace hybrid_sphere::fuzz

#pragma once

#include <cstddef>
#include <cstdint>

namespace hybrid_sphere::fuzz {

/// The numbers of testing::integer come from these bytes, which must outlive them; the least ones when they
/// are used up.
void draw_from(const std::uint8_t* bytes, std::size_t size);

/// Any binary64 number: finite or not, often a short one.
double draw_double();

}  // namespace hybrid_sphere::fuzz

#pragma once

#include "geometry/hundred_digits.hpp"
#include "ground/crossing.hpp"

namespace hybrid_sphere {

/// Time at which a path meets a piece of edge, in a hundred digits. See exact_time.hpp, which is cheaper to
/// include.
exact::Real hundred_digit_time(const Path& path, const scene::Shape& shape, const EdgePiece& piece);

}  // namespace hybrid_sphere

#pragma once

#include <limits>

#include "geometry/vectors.hpp"
#include "hybrid_sphere/sphere/twist.hpp"

namespace hybrid_sphere {

/// No later time can be asked for [s].
inline constexpr double max_time = 1e15;

/// No speed is larger, so that squares and products of it stay numbers [m/s].
inline constexpr double max_speed = 1e100;

inline constexpr double never = std::numeric_limits<double>::infinity();

/// J: a turn by +90 degrees.
inline Vector2d turned(const Vector2d& v) { return {-v.y(), v.x()}; }

}  // namespace hybrid_sphere

#pragma once

#include "ground/crossing.hpp"

/// Times in a hundred digits, for the cases that binary64 does not decide, without the headers of
/// Boost.Multiprecision, which are expensive to compile.
namespace hybrid_sphere {

/// Time at which a path meets a piece of edge, rounded to binary64.
double exact_time(const Path& path, const scene::Shape& shape, const EdgePiece& piece);

/// Order of the times at which a path meets two pieces of edge: -1, 0 or 1.
int compare_exact_times(const Path& path, const scene::Shape& shape_a, const EdgePiece& piece_a,
                        const scene::Shape& shape_b, const EdgePiece& piece_b);

/// Whether the line of a path passes through the inside of a circle.
bool line_cuts_circle(const Path& path, const scene::Circle& circle);

}  // namespace hybrid_sphere

#pragma once

#include "hybrid_sphere/mechanics/model.hpp"

namespace hybrid_sphere::mechanics {

/// Where more reactions hold a body than its motion determines, as those of a ladder on rough ground against
/// a rough wall: ones near lambda with the same effect on the motion for which unilateral constraints press
/// and frictions are within their limits, not on the edge of that. Source: docs/theory.md 7.8.
/// @param directions  of the reactions (n x g): the motion depends on directions lambda
/// @param rank        of directions
/// @param lambda      of the constraints that hold, stacked (g)
/// @return            lambda itself where it is so, or where there are none
Vector within_limits(const Model& model, const ActiveSet& active, double t, const Vector& q, const Vector& v,
                     const Matrix& directions, Index rank, const Vector& lambda);

}  // namespace hybrid_sphere::mechanics

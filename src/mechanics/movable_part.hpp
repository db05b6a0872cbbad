#pragma once

#include "hybrid_sphere/mechanics/equations_of_motion.hpp"

namespace hybrid_sphere::mechanics {

/// The part of a push on a slip of two components along the directions in which the slip can change.
/// @param effect  the change of the slip's rate by a unit force along each component (a column each); of rank
///                1 if other constraints leave the slip a single direction
/// @param push    (2)
/// @return        the push itself if the slip can change in all directions, in none, or only across the push
Vector movable_part(const Eigen::Matrix2d& effect, const Vector& push);

}  // namespace hybrid_sphere::mechanics

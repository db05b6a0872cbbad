#pragma once

#include "catalogue/catalogue.hpp"

namespace hybrid_sphere::mechanics::catalogue {

/// The paper's sphere on a half-plane in Euler angles: (12), (13), (21).
Entry paper_sphere();

/// The same sphere in quasi-velocities, its orientation a quaternion: (14), (15).
Entry paper_sphere_quasi();

/// A ball on a turntable in Euler angles: an affine constraint.
Entry turntable_ball();

/// Chaplygin's ball: three moments of inertia, quasi-velocities on the body axes.
Entry chaplygin_ball();

/// A carriage on two independent wheels, mass centre ahead of the axle: three constraints at once.
Entry chaplygin_carriage();

}  // namespace hybrid_sphere::mechanics::catalogue

#pragma once

#include <Eigen/Core>

/// What the shared libraries show. All else in them is hidden: code of a user with other flags, such as
/// -march=native, takes no part in what they compute.
#define HYBRID_SPHERE_EXPORT __attribute__((visibility("default")))

// Eigen aligns its types by the compiler's flags; the libraries are built with 16 bytes.
#if EIGEN_MAX_ALIGN_BYTES != 16 || EIGEN_MAX_STATIC_ALIGN_BYTES != 16
#error \
    "hybrid_sphere needs Eigen's alignment of 16 bytes: link hybrid_sphere::sphere or hybrid_sphere::mechanics (CMake) or compile everything with -DEIGEN_MAX_ALIGN_BYTES=16 -DEIGEN_MAX_STATIC_ALIGN_BYTES=16"
#endif

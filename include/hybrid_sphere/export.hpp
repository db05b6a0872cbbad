#pragma once

#include <Eigen/Core>

/// Exports a symbol from the shared libraries. All other symbols are hidden, so that user code compiled with
/// other flags, such as -march=native, takes no part in what they compute.
#define HYBRID_SPHERE_EXPORT __attribute__((visibility("default")))

// Eigen's alignment depends on the compiler flags; the libraries are built with 16 bytes.
#if EIGEN_MAX_ALIGN_BYTES != 16 || EIGEN_MAX_STATIC_ALIGN_BYTES != 16
#error \
    "hybrid_sphere needs Eigen's alignment of 16 bytes: link hybrid_sphere::sphere or hybrid_sphere::mechanics (CMake) or compile everything with -DEIGEN_MAX_ALIGN_BYTES=16 -DEIGEN_MAX_STATIC_ALIGN_BYTES=16"
#endif

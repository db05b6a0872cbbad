#include "geometry/vectors.hpp"

namespace hybrid_sphere {

double stable_norm(const Eigen::Vector2d& a) { return a.stableNorm(); }

// The result depends on the alignment.
double stable_norm(const Eigen::Vector3d& a) {
  return Eigen::Vector4d(a.x(), a.y(), a.z(), 0).head<3>().stableNorm();
}

Eigen::Vector2d stable_normalized(const Eigen::Vector2d& a) { return a.stableNormalized(); }

}  // namespace hybrid_sphere

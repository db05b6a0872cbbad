#pragma once

#include <Eigen/Geometry>
#include <string>

/// Points and directions in the world on the axes of bodies at their placements.
namespace hybrid_sphere::mechanics {

inline Eigen::Vector3d point_on(const Eigen::Isometry3d& placement, const Eigen::Vector3d& point) {
  return placement.linear().transpose() * (point - placement.translation());
}

inline Eigen::Vector3d direction_on(const Eigen::Isometry3d& placement, const Eigen::Vector3d& direction) {
  return placement.linear().transpose() * direction;
}

/// How refusals name a constraint.
inline std::string subject_of(const std::string& constraint) { return "constraint \"" + constraint + "\""; }

}  // namespace hybrid_sphere::mechanics

#pragma once

#include <Eigen/Core>
#include <string>

#include "hybrid_sphere/mechanics/rigid_body.hpp"
#include "hybrid_sphere/mechanics/vector.hpp"

/// What a MultibodySystem refuses, by std::invalid_argument with `subject`, the value and what is allowed.
namespace hybrid_sphere::mechanics {

[[noreturn]] void refuse_part(const std::string& subject, const std::string& what,
                              const std::string& allowed);

void check_positive(const std::string& subject, const std::string& what, double value);
void check_finite(const std::string& subject, const std::string& what, const Eigen::Vector3d& value);

/// Refuses a vector of another size. @param name  "q"
void check_size(const std::string& name, const Vector& vector, Index size);

/// The vector scaled to unit length. Refuses 0 and what is not finite.
Eigen::Vector3d checked_direction(const std::string& subject, const std::string& what,
                                  const Eigen::Vector3d& value);

/// The matrix, symmetric to the bit. Refuses what no rigid body has, beyond rounding: a matrix that is not
/// symmetric, a principal moment that is not > 0, one larger than the sum of the two others.
Eigen::Matrix3d checked_inertia(const std::string& subject, const Inertia& inertia);

/// The placement with a rotation that is one to rounding. Refuses a matrix that is none by more than 1e-9.
Eigen::Isometry3d checked_placement(const std::string& subject, const Eigen::Isometry3d& placement);

}  // namespace hybrid_sphere::mechanics

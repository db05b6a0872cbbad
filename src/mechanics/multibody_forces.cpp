// Forces between the bodies of a MultibodySystem.
#include <cmath>

#include "hybrid_sphere/mechanics/multibody_system.hpp"
#include "mechanics/check_body.hpp"
#include "mechanics/interaction.hpp"
#include "mechanics/joint_constraint.hpp"
#include "text/refusal.hpp"

namespace hybrid_sphere::mechanics {
namespace {

/// A point given in the world, on the axes of a body at its placement.
Eigen::Vector3d on_axes_of(const Eigen::Isometry3d& placement, const Eigen::Vector3d& point) {
  return placement.linear().transpose() * (point - placement.translation());
}

void check_line(const std::string& subject, const Eigen::Vector3d& first, const Eigen::Vector3d& second) {
  check_finite(subject, "point", first);
  check_finite(subject, "point", second);
}

void check_distance(const std::string& subject, const Eigen::Vector3d& first, const Eigen::Vector3d& second) {
  check_positive(subject, "distance of its points", (second - first).norm());
}

/// The joint that acts on the same rotations as a force between two points.
JointConstraint joint_at(Index first, Index second, const LinePoints& points) {
  JointGeometry geometry;
  geometry.first_point = points.first;
  geometry.second_point = points.second;
  geometry.has_point = true;
  return {"points", first, second, std::move(geometry)};
}

}  // namespace

MultibodySystem& MultibodySystem::apply(const std::string& first, const std::string& second,
                                        PairWrenchFunction wrench) {
  const std::string subject = "wrench between \"" + first + "\" and \"" + second + "\"";
  const auto [one, other] = pair_of(subject, first, second);
  if (!wrench) refuse_part(subject, "no function", "a function");
  return add(std::make_shared<AppliedInteraction>("wrench between " + first + " and " + second, one, other,
                                                  std::move(wrench)));
}

MultibodySystem& MultibodySystem::spring(const std::string& name, const std::string& first,
                                         const std::string& second, const Eigen::Vector3d& point_of_first,
                                         const Eigen::Vector3d& point_of_second, double stiffness,
                                         double natural_length) {
  const std::string subject = "spring \"" + name + "\"";
  const auto [one, other] = pair_of(subject, first, second);
  check_line(subject, point_of_first, point_of_second);
  check_positive(subject, "stiffness", stiffness);
  if (!(natural_length >= 0 && std::isfinite(natural_length))) {
    refuse_part(subject, "natural length = " + text::shortest(natural_length), "a number >= 0");
  }
  if (natural_length > 0) check_distance(subject, point_of_first, point_of_second);
  const LinePoints points{on_axes_of(placement(one), point_of_first),
                          on_axes_of(placement(other), point_of_second)};
  refuse_unseen_rotations(subject, joint_at(one, other, points));
  return add(
      std::make_shared<SpringInteraction>("spring " + name, one, other, points, stiffness, natural_length));
}

MultibodySystem& MultibodySystem::damper(const std::string& name, const std::string& first,
                                         const std::string& second, const Eigen::Vector3d& point_of_first,
                                         const Eigen::Vector3d& point_of_second, double coefficient) {
  const std::string subject = "damper \"" + name + "\"";
  const auto [one, other] = pair_of(subject, first, second);
  check_line(subject, point_of_first, point_of_second);
  check_positive(subject, "coefficient", coefficient);
  check_distance(subject, point_of_first, point_of_second);
  const LinePoints points{on_axes_of(placement(one), point_of_first),
                          on_axes_of(placement(other), point_of_second)};
  refuse_unseen_rotations(subject, joint_at(one, other, points));
  return add(std::make_shared<DamperInteraction>("damper " + name, one, other, points, coefficient));
}

}  // namespace hybrid_sphere::mechanics

#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "catalogue/catalogue.hpp"
#include "hybrid_sphere/ros/system_plugin.hpp"

/// What the systems of the catalogue look like: balls, a disk, and bodies on a plane, by the names of their
/// coordinates. A particle is drawn as a small ball, a body whose size is no number of its system as a small
/// box.
namespace hybrid_sphere::ros_interface {

/// @param name  of the entry: that of the frame, too; further bodies have something appended
std::vector<Body> bodies_of(const std::string& name, const mechanics::Model& model,
                            const mechanics::catalogue::Values& values);

/// Their poses (SI units); the ground is z = 0.
std::vector<Eigen::Isometry3d> poses_of(const mechanics::Model& model,
                                        const mechanics::catalogue::Values& values,
                                        const mechanics::Vector& q);

}  // namespace hybrid_sphere::ros_interface

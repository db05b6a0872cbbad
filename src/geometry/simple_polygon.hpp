#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

namespace hybrid_sphere::geometry {

/// Why a closed line through these corners is not the edge of a simple polygon, or nothing when it is: fewer
/// than three corners, two equal corners in a row, a side that runs back over the one before, sides that
/// cross or touch. Exact.
std::optional<std::string> fault_of_polygon(const std::vector<Eigen::Vector2d>& vertices);

/// Whether the corners of a simple polygon run counter-clockwise.
bool is_counter_clockwise(const std::vector<Eigen::Vector2d>& vertices);

}  // namespace hybrid_sphere::geometry

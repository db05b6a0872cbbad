#pragma once

#include <algorithm>
#include <cmath>
#include <string>

#include "hybrid_sphere/scene/scene.hpp"

/// The allowed numbers of a scene: within these ranges no product in the computation leaves the range of
/// binary64. Source: docs/scene_files.md.
namespace hybrid_sphere::scene {

/// Least magnitude of numbers other than 0: products of a few smaller ones would underflow.
inline constexpr double least_size = 1e-60;

/// An interval of allowed numbers and their unit.
struct Range {
  double low;
  double high;
  const char* unit;
  double least = least_size;  ///< of a number other than 0
  std::string describe() const;
  /// Describes the allowed small numbers.
  std::string describe_least() const;
  bool holds(double number) const {
    return low <= number && number <= high && (number == 0 || number >= least || number <= -least);
  }
};

inline constexpr Range coordinate_range{-1e15, 1e15, "[m]"};

inline constexpr Range mass_range{1e-60, 1e60, "[kg]"};
inline constexpr Range radius_range{1e-12, 1e12, "[m]"};
inline Range gyration_range(double radius) {
  constexpr double thinnest = 1e-9;  // least k/R
  // A shell's own k is still accepted after rounding.
  const double most = radius * std::sqrt(2. / 3) * (1 + 1e-15);
  return {thinnest * radius, most, "[m] (R sqrt(2/3))"};
}

inline constexpr Range velocity_range{-1e15, 1e15, "[m/s]"};
inline constexpr Range spin_range{-1e15, 1e15, "[rad/s]"};
inline constexpr Range quaternion_range{-1.01, 1.01, "", 0};
inline constexpr double unit_slack = 0.01;  // of the length of a quaternion typed by hand

inline constexpr Range accuracy_range{1e-14, 1, ""};
inline constexpr Range step_range{1e-9, 1e6, "[s]"};

inline constexpr double most_acceleration = 1e15;  // by each force [m/s^2, rad/s^2]
inline constexpr Range in_plane_range{-most_acceleration, most_acceleration, "[m/s^2]"};
inline constexpr Range normal_range{-most_acceleration, 0,
                                    "[m/s^2], as gravity must not pull the sphere off the ground"};
/// For forces, which may be equally small relative to a light sphere.
inline double least_for(double inertia) { return least_size * std::min(1.0, inertia); }
/// m k^2.
inline double inertia(const SphereBody& sphere) {
  return sphere.mass * sphere.gyration_radius * sphere.gyration_radius;
}
inline Range force_range(const SphereBody& sphere) {
  const double bound = most_acceleration * sphere.mass;
  return {-bound, bound, "[N] (1e15 m)", least_for(sphere.mass)};
}
inline Range torque_range(const SphereBody& sphere) {
  const double bound = most_acceleration * inertia(sphere);
  return {-bound, bound, "[N m] (1e15 m k^2)", least_for(inertia(sphere))};
}
// A faster drag than this leaves velocities below the rounding of others, which it then turns into a force
// [1/s].
inline constexpr double fastest_drag = 1e12;
inline Range translational_drag_range(const SphereBody& sphere) {
  return {0, fastest_drag * sphere.mass, "[N s/m] (1e12 m)", least_for(sphere.mass)};
}
inline Range rotational_drag_range(const SphereBody& sphere) {
  return {0, fastest_drag * inertia(sphere), "[N m s] (1e12 m k^2)", least_for(inertia(sphere))};
}
inline Range quadratic_drag_range(const SphereBody& sphere) {
  return {0, most_acceleration * sphere.mass, "[N s^2/m^2] (1e15 m)", least_for(sphere.mass)};
}
inline Range stiffness_range(const SphereBody& sphere) {
  return {0, most_acceleration * sphere.mass, "[N/m] (1e15 m)", least_for(sphere.mass)};
}

inline constexpr Range coefficient_range{0, 1e9, ""};
inline constexpr Range belt_range{-1e15, 1e15, "[m/s]"};
inline constexpr Range rate_range{-1e15, 1e15, "[rad/s]"};
inline constexpr Range edge_normal_range{-1e15, 1e15, ""};
inline constexpr Range circle_radius_range{1e-12, 1e15, "[m]"};
inline constexpr std::size_t longest_name = 100;

}  // namespace hybrid_sphere::scene

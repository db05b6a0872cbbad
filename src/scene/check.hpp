#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "hybrid_sphere/scene/scene.hpp"
#include "hybrid_sphere/scene/scene_error.hpp"

/// Checks of the parts of a scene, whatever their source. Each throws SceneError with the field's full path,
/// the value and the allowed range.
namespace hybrid_sphere::scene {

void check_sphere(const SphereBody& sphere, const std::string& path);
/// Refuses a quaternion whose length is not 1 to within 1 %.
void check_unit(const Quaterniond& orientation, const std::string& path);
void check_initial_state(const InitialState& state, const std::string& path);
void check_solver(const Solver& solver, const std::string& path);

/// The sphere bounds the forces: none of its accelerations may exceed the range of the velocities.
/// @param path  of the scene, or empty
void check_forces(const Forces& forces, const SphereBody& sphere, const std::string& path);
void check_wrench(const Wrench& wrench, const SphereBody& sphere, const std::string& path);

/// Checks the coefficients and the motion that the law of a ground may have.
void check_material(const Material& material, const std::string& path);
/// Describes the allowed names of a region.
std::string allowed_names();
inline constexpr const char* allowed_corners =
    "a list of at least 3 corners [x, y] whose sides neither cross nor touch";

/// Checks that a text may be the name of a region.
void check_name(std::string_view name, const std::string& path);
void check_half_plane(const HalfPlane& half_plane, const std::string& path);
void check_circle(const Circle& circle, const std::string& path);
/// The polygon with these corners, which may be given in either direction.
Polygon polygon_of(std::vector<Vector2d> corners, const std::string& path);
/// Refuses corners that form no simple polygon in either direction.
void check_corners(const std::vector<Vector2d>& corners, const std::string& path);
/// Its shapes, materials and names.
void check_surface(const Surface& surface, const std::string& path);
/// Refuses a name that another region already has.
void check_names(const Surface& surface, const std::string& path);

/// Refuses a ground whose friction needs a normal force if gravity does not press the sphere onto the ground.
/// @param path  of the surface
void check_pressure(const Surface& surface, const Forces& forces, const std::string& path);
/// The same for one material, such as that of a grid's cells.
/// @param path  of the keys law, rolling_resistance and spin_friction
void check_pressure(const Material& material, const Forces& forces, const std::string& path);

}  // namespace hybrid_sphere::scene

#pragma once

#include <Eigen/Geometry>
#include <string>
#include <variant>
#include <vector>

namespace hybrid_sphere {

using Eigen::Quaterniond;
using Eigen::Vector2d;
using Eigen::Vector3d;

}  // namespace hybrid_sphere

/// What the user asked for: plain data, validated once when it is read (read_scene.hpp), SI units,
/// right-handed world frame with z up. Nothing here moves.
namespace hybrid_sphere::scene {

/// A sphere whose mass is distributed with spherical symmetry.
struct SphereBody {
  double mass;             ///< m [kg], > 0
  double radius;           ///< R [m], > 0
  double gyration_radius;  ///< k [m], 0 < k <= R sqrt(2/3); the moment of inertia about every axis is m k^2
};

/// State of the sphere at time 0.
struct InitialState {
  Vector2d position = Vector2d::Zero();               ///< of the centre in the plane [m]
  Quaterniond orientation = Quaterniond::Identity();  ///< body to world, unit
  Vector2d velocity = Vector2d::Zero();               ///< of the centre [m/s]
  Vector3d angular_velocity = Vector3d::Zero();       ///< omega_1..3 on the fixed axes [rad/s]
};

/// What a piece of ground does to the point of the sphere that touches it.
enum class Law {
  smooth,  ///< no tangential force: stage 1, holonomic
  rough,   ///< no slip, equation (21) of the paper: stage 3, nonholonomic
};

/// The side of a line that its normal points into.
struct HalfPlane {
  Vector2d point;   ///< of the edge [m]
  Vector2d normal;  ///< into the region; any length but 0
};

/// A disc, or all that lies outside of it.
struct Circle {
  Vector2d center;  ///< [m]
  double radius;    ///< [m], > 0
  bool outside = false;
};

/// The inside of a simple closed polygon, or all that lies outside of it.
struct Polygon {
  std::vector<Vector2d> vertices;  ///< counter-clockwise [m]; the last one is joined to the first
  bool outside = false;
};

using Shape = std::variant<HalfPlane, Circle, Polygon>;

struct Region {
  std::string name;
  Shape shape;
  Law law;
};

/// The ground: closed regions over a base that has no edge; later regions lie over earlier ones.
struct Surface {
  Law base = Law::smooth;
  std::vector<Region> regions;
};

/// Name of the ground where no region lies; no region may have it.
inline constexpr const char* base_name = "base";

/// How the trajectory is computed.
struct Solver {
  enum class Method { automatic, exact };
  Method method = Method::automatic;
  double accuracy = 1e-9;  ///< relative error wanted at every output
};

struct Scene {
  SphereBody sphere;
  InitialState initial_state;
  Surface surface;
  Solver solver;
};

/// Acceleration with which gravity presses the sphere on the ground [m/s^2].
inline constexpr double gravity = 9.81;

const char* to_string(Law law);

}  // namespace hybrid_sphere::scene

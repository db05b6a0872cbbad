#pragma once

#include <Eigen/Geometry>
#include <string>
#include <variant>
#include <vector>

#include "hybrid_sphere/export.hpp"

namespace hybrid_sphere {

using Eigen::Quaterniond;
using Eigen::Vector2d;
using Eigen::Vector3d;

}  // namespace hybrid_sphere

/// What the user asked for: plain data, validated once on reading (read_scene.hpp), in SI units and a
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

/// How a piece of ground acts on the contact point of the sphere.
enum class Law {
  smooth,   ///< no tangential force: stage 1, holonomic
  rough,    ///< no slip, equation (21) of the paper: stage 3, nonholonomic
  rubber,   ///< no slip and no spin about the normal relative to the ground: stage 3
  coulomb,  ///< slides under the friction mu N, rolls while the reaction does not exceed it
};

/// The ground at one place: its law, its coefficients and its own velocity
/// u(r) = belt + turntable_rate J (r - turntable_center), J being the rotation by +90 degrees.
struct Material {
  Material(Law of_law = Law::smooth) : law(of_law) {}  // NOLINT(google-explicit-constructor)

  Law law;
  double friction = 0;               ///< mu of the law coulomb [1], >= 0
  double rolling_resistance = 0;     ///< arm of the couple against rolling, over R [1], >= 0
  double spin_friction = 0;          ///< arm of the couple against spin about the normal, over R [1], >= 0
  Vector2d belt = Vector2d::Zero();  ///< [m/s]
  double turntable_rate = 0;         ///< W [rad/s]
  Vector2d turntable_center = Vector2d::Zero();  ///< [m]
};

/// The side of a line to which its normal points.
struct HalfPlane {
  Vector2d point;   ///< of the edge [m]
  Vector2d normal;  ///< into the region; of any nonzero length
};

/// A disc, or everything outside it.
struct Circle {
  Vector2d center;  ///< [m]
  double radius;    ///< [m], > 0
  bool outside = false;
};

/// The interior of a simple closed polygon, or everything outside it.
struct Polygon {
  std::vector<Vector2d> vertices;  ///< counter-clockwise [m]; the last one is joined to the first
  bool outside = false;
};

using Shape = std::variant<HalfPlane, Circle, Polygon>;

struct Region {
  std::string name;
  Shape shape;
  Material material;
};

/// What happens to a sphere that two grounds throw at each other endlessly (docs/theory.md 5.4).
enum class Livelock {
  slide,  ///< it slides along the edge between them, where such a motion exists
  stop,   ///< the computation ends there
};

/// The ground: closed regions over an unbounded base; later regions lie on top of earlier ones.
struct Surface {
  Material base;
  std::vector<Region> regions;
  Livelock livelock = Livelock::slide;
  std::size_t image_regions =
      0;  ///< number of leading regions that are made of the cells of an image or a grid
};

/// Name of the ground where no region lies; no region may use it.
inline constexpr const char* base_name = "base";

/// A force on the centre and a torque, on the fixed axes.
struct Wrench {
  Vector2d force = Vector2d::Zero();   ///< [N]
  Vector3d torque = Vector3d::Zero();  ///< [N m]
};

/// Air drag: the forces -c v and -c abs(v) v on the centre, and the couple -c omega.
struct Drag {
  double translational = 0;  ///< [N s/m]
  double rotational = 0;     ///< [N m s]
  double quadratic = 0;      ///< [N s^2/m^2]
};

/// The force -stiffness (r - center) on the centre.
struct Spring {
  Vector2d center = Vector2d::Zero();  ///< [m]
  double stiffness = 0;                ///< [N/m]
};

/// Default acceleration with which gravity presses the sphere onto the ground [m/s^2].
inline constexpr double default_gravity = 9.81;

/// All forces on the sphere except those of the ground.
struct Forces {
  Vector3d gravity{0, 0, -default_gravity};  ///< in the frame of the ground [m/s^2]; z <= 0
  Wrench wrench;
  Drag drag;
  Spring spring;
};

/// How the trajectory is computed. All methods except the first two integrate every motion that is not at
/// rest.
struct Solver {
  enum class Method {
    automatic,     ///< closed forms where they exist, otherwise the cheapest method for the accuracy
    exact,         ///< closed forms only: other motions are refused
    euler,         ///< Euler's method, fixed step
    rk4,           ///< the classical Runge-Kutta method, fixed step
    lie_midpoint,  ///< the midpoint rule, in its Lie form on the rotation group, fixed step
    rkmk4,         ///< Runge-Kutta-Munthe-Kaas of order 4, fixed step
    cvode_adams,   ///< SUNDIALS' CVODE, Adams-Moulton
    cvode_bdf,     ///< SUNDIALS' CVODE, backward differentiation
    arkode_erk3,   ///< SUNDIALS' ARKODE, Bogacki-Shampine 3(2)
    arkode_erk5,   ///< SUNDIALS' ARKODE, Dormand-Prince 5(4)
    arkode_erk,    ///< SUNDIALS' ARKODE, Prince-Dormand 8(7)
    dopri5,        ///< Dormand and Prince, order 5(4)
    dopri87        ///< Prince and Dormand, order 8(7)
  };
  Method method = Method::automatic;
  double accuracy = 1e-9;  ///< relative error requested at every output, for adaptive methods
  double step = 1e-3;      ///< of the fixed-step methods [s]

  bool has_fixed_step() const {
    return method == Method::euler || method == Method::rk4 || method == Method::lie_midpoint ||
           method == Method::rkmk4;
  }
  bool uses_closed_forms() const { return method == Method::automatic || method == Method::exact; }
};

struct MethodName {
  Solver::Method method;
  const char* name;
};

/// The values that solver.method may have.
inline constexpr MethodName method_names[] = {{Solver::Method::automatic, "auto"},
                                              {Solver::Method::exact, "exact"},
                                              {Solver::Method::euler, "euler"},
                                              {Solver::Method::rk4, "rk4"},
                                              {Solver::Method::lie_midpoint, "lie_midpoint"},
                                              {Solver::Method::rkmk4, "rkmk4"},
                                              {Solver::Method::cvode_adams, "cvode_adams"},
                                              {Solver::Method::cvode_bdf, "cvode_bdf"},
                                              {Solver::Method::arkode_erk3, "arkode_erk3"},
                                              {Solver::Method::arkode_erk5, "arkode_erk5"},
                                              {Solver::Method::arkode_erk, "arkode_erk"},
                                              {Solver::Method::dopri5, "dopri5"},
                                              {Solver::Method::dopri87, "dopri87"}};

/// The name as in solver.method.
HYBRID_SPHERE_EXPORT const char* to_string(Solver::Method method);

/// @code
/// scene::Scene scene{};
/// scene.sphere = {1, 0.5, 0.5 * std::sqrt(0.4)};
/// scene.initial_state.velocity = {1, 0};
/// scene.surface.regions.push_back({"carpet", scene::HalfPlane{{2, 0}, {1, 0}}, scene::Law::rough});
/// @endcode
struct Scene {
  SphereBody sphere;
  InitialState initial_state;
  Surface surface;
  Forces forces;
  Solver solver;
  std::vector<std::string> warnings;  ///< what the reader of a file has ignored, such as keys of a map
};

HYBRID_SPHERE_EXPORT const char* to_string(Law law);

}  // namespace hybrid_sphere::scene

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "catalogue/catalogue.hpp"
#include "hybrid_sphere/mechanics/constraint.hpp"
#include "hybrid_sphere/mechanics/equations_of_motion.hpp"

/// What the catalogue's spheres share: the impulse by formula, orientations, and Euler angles.
namespace hybrid_sphere::mechanics::catalogue {

using Eigen::Quaterniond;
using Eigen::Vector2d;
using Eigen::Vector3d;

/// Velocities of a sphere on the fixed axes.
struct Velocities {
  Vector2d center;  ///< (xd, yd) [m/s]
  Vector3d spin;    ///< omega [rad/s]
};

/// Refuses a radius of gyration that no sphere of this radius has, 0 < k <= R sqrt(2/3).
/// Throws std::invalid_argument.
void check_gyration_radius(double R, double k);

/// The parameters k, and edge: the ground is rough where x > edge.
Parameter gyration_radius(double value);
Parameter rough_edge(double value);

/// After the impulse of rough ground that moves with u: the slip s = (xd - R w2, yd + R w1) - u is gone.
/// Source: (20) with (22), the corrected (23); docs/theory.md 3.
Velocities after_impulse(double R, double k, const Velocities& before, const Vector2d& u);

/// A sphere that comes over smooth ground, at rest as all of it, to the rough half-plane x > edge: up to the
/// edge, and from it on, both velocities are constant. Source: (18), and (23), (27) corrected;
/// docs/theory.md 2.
struct HalfPlaneMotion {
  Vector2d start;     ///< centre at t = 0, not on the rough side [m]
  Velocities before;  ///< the edge
  Velocities after;   ///< the edge, thrown back or not
  double edge_time;   ///< when it is met; infinite if never [s]
  HalfPlaneMotion(double R, double k, double edge, const Vector2d& at, const Velocities& initial);

  double before_edge(double t) const { return std::min(t, edge_time); }  ///< so long until t [s]
  double behind_edge(double t) const { return t - before_edge(t); }      ///< the rest of t [s]
  const Velocities& velocities(double t) const { return t < edge_time ? before : after; }
  Vector2d center(double t) const {
    return start + before.center * before_edge(t) + after.center * behind_edge(t);
  }
};

/// exp(rotation/2): the turn by abs(rotation) about it. Exact for small rotations as well.
Quaterniond turn(const Vector3d& rotation);

/// A sphere in the coordinates x, y, psi, theta, phi: z-x-z Euler angles, from the body's axes to the fixed
/// ones.
namespace euler {

/// The constants of an entry, and after them the coordinates and velocities at the start.
std::vector<Parameter> with_initial_values(std::vector<Parameter> constants, const Initial& as_a_rule);

/// (13): omega on the fixed axes. @param q (5) @param v (5)
template <class Q, class V>
Eigen::Matrix<typename Q::Scalar, 3, 1> spin(const Q& q, const V& v) {
  using std::cos;
  using std::sin;
  Eigen::Matrix<typename Q::Scalar, 3, 1> w;
  w[0] = v[3] * cos(q[2]) + v[4] * sin(q[3]) * sin(q[2]);
  w[1] = v[3] * sin(q[2]) - v[4] * sin(q[3]) * cos(q[2]);
  w[2] = v[2] + v[4] * cos(q[3]);
  return w;
}

/// (12). @param m  [kg] @param k  [m]
template <class Q, class V>
typename Q::Scalar lagrangian(double m, double k, const Q& q, const V& v) {
  using std::cos;
  return m / 2 * (v[0] * v[0] + v[1] * v[1]) +
         m * k * k / 2 * (v[2] * v[2] + v[3] * v[3] + v[4] * v[4] + 2 * v[4] * v[2] * cos(q[3]));
}

/// (21) on ground that turns at the rate W about the origin: the slip. @param R  [m] @param W  [rad/s]
template <class Q, class V>
Eigen::Matrix<typename Q::Scalar, 2, 1> slip(double R, double W, const Q& q, const V& v) {
  const auto w = spin(q, v);
  Eigen::Matrix<typename Q::Scalar, 2, 1> f;
  f[0] = v[0] - R * w[1] + W * q[1];
  f[1] = v[1] + R * w[0] - W * q[0];
  return f;
}

/// The terms of (12) and of the slip, differentiated by hand.
std::shared_ptr<const EquationsOfMotion> equations_by_hand(double m, double k);
std::shared_ptr<const ConstraintFunction> slip_by_hand(double R, double W);

/// (psid, thetad, phid) of an angular velocity on the fixed axes: (13) solved. @param angles  sin(theta) != 0
Vector3d rates(const Vector3d& angles, const Vector3d& spin);

/// The angles (psi, theta, phi) that a rotation goes through, without jumps. Empty where they come nearer
/// than 1e-9 to sin(theta) = 0, behind which they have no continuation, where it takes more than 100,000
/// steps, and where end < begin.
/// @param angles  at the time begin; 0 < theta < pi
/// @param spin    omega(t) on the fixed axes
/// @param step    for an error of rounding 0.02 over the sum of abs(omega) and the rate at which it turns;
///                0.25/abs(omega) where omega is constant [s]
/// Source: Magnus' method of sixth order (Iserles, Munthe-Kaas, Norsett and Zanna, Acta Numerica 9, 2000).
std::optional<Vector3d> continued(const Vector3d& angles, const std::function<Vector3d(double)>& spin,
                                  double begin, double end, double step);
/// The same for a constant angular velocity.
std::optional<Vector3d> continued(const Vector3d& angles, const Vector3d& spin, double time);

}  // namespace euler
}  // namespace hybrid_sphere::mechanics::catalogue

#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "geometry/vectors.hpp"
#include "hybrid_sphere/sphere/twist.hpp"

namespace hybrid_sphere {

/// Curves of the centre whose intersections with an edge have a formula.
enum class CurveForm : std::uint8_t {
  parabola,  ///< start + velocity tau + acceleration tau^2/2; a straight line where the last is 0
  arc,       ///< a circle, traversed at a constant rate
  general,
};

struct Curve {
  CurveForm form = CurveForm::general;
  Vector2d start = Vector2d::Zero();         ///< [m]
  Vector2d velocity = Vector2d::Zero();      ///< at the start [m/s]
  Vector2d acceleration = Vector2d::Zero();  ///< at the start; constant for a parabola [m/s^2]
  Vector2d orbit_center = Vector2d::Zero();  ///< of an arc [m]
  Vector2d arm = Vector2d::Zero();           ///< of an arc: from orbit_center to start [m]
  double rate = 0;                           ///< of an arc: angular, counter-clockwise [rad/s]
  /// Direction of the straight line on which the whole path lies, whatever its form: the initial direction of
  /// motion, of any length. 0 if the path bends or nothing moves.
  Vector2d line = Vector2d::Zero();
  double line_size = 0;  ///< of the terms that line is the sum of, where velocity is 0
};

/// Whether two vectors are parallel: exactly if one of them lies along an axis, otherwise to the rounding of
/// a few operations. The null vector is parallel to all.
/// @param size  of the terms that b is the sum of, if that is more than abs(b) [that of b]
inline bool parallel(const Vector2d& a, const Vector2d& b, double size = 0) {
  constexpr double rounding = 8 * std::numeric_limits<double>::epsilon();
  if (a.x() == 0) return b.x() == 0 || a.y() == 0;
  if (a.y() == 0) return b.y() == 0;
  const bool on_axis = b.x() == 0 || b.y() == 0;
  if (on_axis && std::hypot(b.x(), b.y()) > rounding * size) return false;
  const double x = std::ldexp(a.x(), -std::ilogb(a.x()));
  const double y = std::ldexp(a.y(), -std::ilogb(a.x()));
  return std::abs(x * b.y() - y * b.x()) <=
         rounding * std::hypot(x, y) * std::max(std::hypot(b.x(), b.y()), size);
}

/// The same of the direction in which a sphere at rest begins to move: where its terms nearly cancel, what is
/// left of them is not known well enough.
inline bool parallel_to_pull(const Vector2d& a, const Vector2d& pull, double size) {
  constexpr double most = 0x1p-20 / (8 * std::numeric_limits<double>::epsilon());  // an angle of 2^-20
  return parallel(a, pull, std::min(size, most * std::hypot(pull.x(), pull.y())));
}

/// A sum of terms of a given size: 0 if it is no more than their rounding.
inline Vector2d without_rounding(const Vector2d& sum, double size) {
  const double rounding = 4 * std::numeric_limits<double>::epsilon() * size;
  return sum.cwiseAbs().maxCoeff() <= rounding ? Vector2d(Vector2d::Zero()) : sum;
}

/// Direction of the line on which a motion with this initial velocity stays if everything that accelerates it
/// is parallel to `pull`: its initial direction. 0 if it stays on no line.
/// @param size  of the terms that pull is the sum of
inline Vector2d line_of(const Vector2d& velocity, const Vector2d& pull, double size = 0) {
  if (velocity.isZero(0)) return pull;
  return parallel(velocity, pull, size) ? velocity : Vector2d(Vector2d::Zero());
}

}  // namespace hybrid_sphere

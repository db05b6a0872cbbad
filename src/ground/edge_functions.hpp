#pragma once

#include <optional>

#include "geometry/certified_root.hpp"
#include "geometry/exact.hpp"
#include "hybrid_sphere/scene/scene.hpp"
#include "motion/motion.hpp"

/// Equations of edges, g(r) = 0, along a path. Source: docs/theory.md 5.1, 5.3.
namespace hybrid_sphere {

/// g(r) = n.(r - a).
class LineFunction {
 public:
  static constexpr bool is_line = true;

  LineFunction(const Vector2d& point, const Vector2d& normal)
      : point_(point), anchor_(point), normal_(normal) {}

  /// The line through the two end points of a side. The same numbers in either order.
  static LineFunction through(const Vector2d& a, const Vector2d& b);
  /// Has the function of a side, made by through(), computed from the end that is nearer to where a path
  /// begins: the rounding of how far away the other one is does not matter there.
  void anchor_near(const Vector2d& start) {
    const Vector2d middle = 0.5 * (point_ + *other_);
    if ((start - middle).dot(*other_ - point_) > 0) anchor_ = *other_;
  }

  geometry::Jet jet(const PointState& at) const;
  /// grad g . v
  double rate(const Vector2d& /*position*/, const Vector2d& velocity) const { return normal_.dot(velocity); }
  /// Bound on the length of g'' between two times.
  double curvature(Motion& motion, const PointState& /*middle*/, double from, double until) const {
    return motion.acceleration_bound_along(normal_, from, until);
  }

  /// Whether a point found on the line may lie on the segment; true in close cases.
  /// @param error  of the time at which the point was found [s]
  bool may_hold(const PointState& found, double error) const;

  /// g along a parabola: c0 + c1 t + c2 t^2/2.
  struct Quadratic {
    exact::Bounded c0;
    exact::Bounded c1;
    exact::Bounded c2;
    /// Real roots in any order, including those that rounding does not exclude; returns their number.
    int solve(geometry::Root (&roots)[2]) const;
    /// Whether it may be 0 anywhere in [0, until]: the error of a root far outside may span all that.
    bool may_vanish(double until) const;
  };
  Quadratic along(const Curve& parabola) const;
  /// (1 + W^2 u^2) g along an arc, as a function of u = tan(W t/2)/W: accurate even if W is near 0.
  Quadratic along_arc(const Curve& arc) const;
  /// Size of the numbers that the function is computed from [m].
  double size() const { return anchor_.norm(); }
  /// Whether both are functions of exactly the same line.
  bool is_on_line_of(const LineFunction& line) const;

  /// Where a circle meets the line: two angles about its centre, and a bound on their error. If it does not:
  /// false, with an error < 0 if the circle lies on the line.
  bool meets_circle(const Vector2d& center, double radius, double (&angles)[2], double& error) const;

 private:
  exact::Difference exact_normal() const;

  Vector2d point_;
  Vector2d anchor_;  // a: point_ or other_
  Vector2d normal_;
  std::optional<Vector2d> other_;  // end of the segment from point_, if any
};

/// g(r) = |r - c|^2 - rho^2.
class CircleFunction {
 public:
  static constexpr bool is_line = false;

  explicit CircleFunction(const scene::Circle& circle) : circle_(circle) {}

  geometry::Jet jet(const PointState& at) const;
  double rate(const Vector2d& position, const Vector2d& velocity) const {
    return 2 * (position - circle_.center).dot(velocity);
  }
  /// @param middle  of the path, half way between the two times
  double curvature(Motion& motion, const PointState& middle, double from, double until) const;
  bool meets_circle(const Vector2d& center, double radius, double (&angles)[2], double& error) const;
  LineFunction::Quadratic along_arc(const Curve& arc) const;
  double size() const { return circle_.center.norm() + circle_.radius; }

 private:
  const scene::Circle& circle_;
};

}  // namespace hybrid_sphere

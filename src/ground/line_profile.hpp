#pragma once

#include <cmath>
#include <vector>

#include "ground/crossing.hpp"

/// Which regions lie along a straight line, and where on it they begin and end: exact, whatever the motion
/// along the line. Source: docs/theory.md 5.1, 5.3.
namespace hybrid_sphere {

/// r = anchor + lambda direction. The larger component of the direction is of order one.
class Line {
 public:
  Line() = default;
  /// @param direction  of any length but 0
  Line(const Vector2d& anchor, const Vector2d& direction) {
    const int exponent = std::ilogb(direction.cwiseAbs().maxCoeff());
    const Vector2d unit(std::ldexp(direction.x(), -exponent), std::ldexp(direction.y(), -exponent));
    ahead_ = {anchor, unit};
    back_ = {anchor, -unit};
  }

  const Vector2d& anchor() const { return ahead_.start; }
  const Vector2d& direction() const { return ahead_.velocity; }
  /// The half from the anchor on; for lambda < 0, against the direction.
  const Path& half(double lambda) const { return lambda < 0 ? back_ : ahead_; }

  /// Whether another path lies on the line: exactly along an axis, else to rounding.
  /// @param size   of the terms that the direction is the sum of
  /// @param reach  greatest coordinate of a place on the line from which the path's start was computed
  bool holds(const Vector2d& start, const Vector2d& direction, double size, double reach) const;
  /// lambda of the foot of a vector that is measured from lambda = 0.
  double along(const Vector2d& from_anchor) const {
    return from_anchor.dot(direction()) / direction().squaredNorm();
  }

 private:
  Path ahead_;
  Path back_;
};

/// A section of a line, between two crossings of one region's edge.
struct Section {
  Side side = Side::outside;
  std::int32_t along = -1;  ///< side of the polygon that is followed, if side is Side::edge
};

/// A place at which a line changes its side of a region's edge.
struct LineCrossing {
  double lambda = 0;
  double error = 0;  ///< bound on the error of lambda
  RegionId region = no_region;
  EdgePiece piece;  ///< as the half of the line meets it on which lambda lies
  Section below;    ///< before it, in the direction of lambda
};

/// Order of two crossings on a line: -1, 0 or 1, decided exactly.
int compare(const Line& line, const scene::Shape& shape_a, const LineCrossing& a, const scene::Shape& shape_b,
            const LineCrossing& b);

/// Lists reused from call to call.
struct LineRoom {
  std::vector<Crossing> crossings;
  Contacts contacts;
};

/// Traces a line both ways over a region.
/// @param contact    piece of this region's edge on which the anchor lies, or null; where it is followed, the
/// whole line lies on it
/// @param crossings  those of the region are appended here, ascending in lambda
/// @return           what comes after the last crossing
Section trace_line(const Line& line, RegionId id, const scene::Shape& shape, const Contact* contact,
                   std::vector<LineCrossing>& crossings, LineRoom& room);

}  // namespace hybrid_sphere

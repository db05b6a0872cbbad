#pragma once

#include "motion/motion.hpp"

namespace hybrid_sphere {

/// A vector in the plane under a constant drive b and dry friction of constant size A against it,
///   w' = b - A w/abs(w),
/// the slip on coulomb ground, or the rolling velocity under a rolling resistance. In closed form: in the
/// regular time M with dt = abs(w) dM the two components of sqrt(w), as a complex number, are exponentials.
/// Source: docs/theory.md 4.4.
class DryFriction {
 public:
  DryFriction() = default;

  /// w_0 = 0 slides off along b if abs(b) > A, and ends at once otherwise.
  /// @param start     w_0
  /// @param drive     b
  /// @param friction  A >= 0
  DryFriction(const Vector2d& start, const Vector2d& drive, double friction);

  /// When w becomes 0; `never` if it does not. If abs(b) > A and w_0 is opposite to b, it passes through 0
  /// there and continues as a new one that starts at 0.
  double end() const { return end_; }

  struct Value {
    Vector2d value;       ///< w; exactly 0 from end() on
    Vector2d direction;   ///< w/abs(w), at the end its limit; 0 if w is 0 all the time
    Vector2d integral;    ///< of w over the time
    Vector2d derivative;  ///< b - A direction
  };
  /// @param time  >= 0; beyond the end all values stay as they are there
  Value at(double time) const;

  /// Taylor polynomial of w in (time - origin)/length. Where it does not converge, its coefficients do not
  /// fall.
  /// @param now  at the origin, before the end
  polynomials::Powers<2> expand(const Value& now, double length) const;

  /// Whether w' is constant: w_0 is parallel to b to 1e-105, or one of w_0, b and A is 0.
  bool straight() const { return straight_; }
  struct Corner {
    double time;   ///< at which w is perpendicular to b; 0 if it is past that from the start
    double width;  ///< least time in which w turns there, abs(w)/(abs(b) + A); `never` where it does not turn
  };
  /// Where w' changes fastest; the shorter w is there, the more sudden the change.
  Corner corner() const;
  /// w_0 and b.
  const Vector2d& start() const { return start_; }
  const Vector2d& drive() const { return drive_; }
  /// w' at the start.
  const Vector2d& start_derivative() const { return start_derivative_; }

 private:
  void begin_straight(const Vector2d& direction, double rate);
  void note_inflection();
  double regular_time(double time) const;
  double early_regular_time(double time) const;
  double late_regular_time(double remaining) const;

  Vector2d start_ = Vector2d::Zero();
  Vector2d drive_ = Vector2d::Zero();
  double friction_ = 0;
  double end_ = 0;
  bool straight_ = true;
  Vector2d start_derivative_ = Vector2d::Zero();

  // Straight.
  Vector2d direction_ = Vector2d::Zero();
  double size_ = 0;  // abs(w_0)
  /// Of a w that turns, with theta the angle from b to w_0.
  struct Curved {
    Vector2d along = Vector2d::Zero();   ///< b/abs(b)
    Vector2d across = Vector2d::Zero();  ///< normal to it, on the side of w_0
    double across_size = 0;              ///< component of w_0
    double cosine = 0;                   ///< cos^2(theta/2)
    double sine = 0;                     ///< sin^2(theta/2)
    double gap = 0;                      ///< A - abs(b)
    double sum = 0;                      ///< A + abs(b)
    double inflection = 0;               ///< M where t(M) has one, if gap < 0
    double inflection_time = 0;          ///< t there over abs(w_0)
  };
  Curved curved_;
};

}  // namespace hybrid_sphere

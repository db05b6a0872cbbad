#pragma once

#include "integration/integrator.hpp"
#include "motion/equations.hpp"

namespace hybrid_sphere::numeric {

using integration::Node;

/// The path over one fixed-length step: place and time are the cubics in x with the values and slopes at both
/// ends. Its time derivative is not the velocity of the state, and it bends as no force would: with Euler's
/// method, under a constant acceleration a, from -2 a to 4 a. Source: docs/theory.md 5.3.
class StepPath {
 public:
  /// @param dry  whether x is not the time
  StepPath(const Node& from, const Node& to, bool dry);

  /// Whether the step is long enough for its end differences to survive rounding; in a shorter step, forces
  /// change the place by no more than the rounding of the distance covered.
  bool is_told() const { return is_told_; }
  /// dd/dtau [m/s]
  /// @param x  from the beginning of the step
  Vector2d velocity(double x) const;
  /// Bound on the length of d^2d/dtau^2 over the step; 0 where that is not told [m/s^2].
  double bend() const;

 private:
  // The derivatives by x/step, as polynomials of Bernstein: bounded by their coefficients.
  Vector2d way_[3];
  double time_[3];
  double step_;
  bool is_told_;
};

}  // namespace hybrid_sphere::numeric

#pragma once

#include "integration/integrator.hpp"
#include "motion/equations.hpp"

namespace hybrid_sphere::numeric {

using integration::Node;

/// The way over one step of a fixed length: place and time are the cubics in x with the values and slopes at
/// both ends. Its derivative by the time is not the velocity of the state, and it bends as no force does: by
/// Euler's method, under a constant acceleration a, from -2 a to 4 a. Source: docs/theory.md 5.3.
class StepPath {
 public:
  /// @param dry  whether x is not the time
  StepPath(const Node& from, const Node& to, bool dry);

  /// Whether the step is not so short that rounding spoils the differences of its ends: within it, forces
  /// then change the place by no more than the rounding of the way that they have made.
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

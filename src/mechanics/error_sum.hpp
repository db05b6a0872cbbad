#pragma once

#include "hybrid_sphere/mechanics/vector.hpp"

namespace hybrid_sphere::mechanics {

/// The estimated error of a motion: errors of its steps, summed, with the growth that step control assumes.
/// The error of a velocity, as part of the speed, becomes that part of a phase in each turning time that
/// follows, so that errors grow linearly with the number of turning times. A growth beyond that, the
/// conditioning of the motion, is not included. Source: docs/theory.md 7.5.
class ErrorSum {
 public:
  /// @param size  of the state, q and v (N + n)
  explicit ErrorSum(Eigen::Index size) : local_(Vector::Zero(size)), total_(local_) {}

  /// An error of component i of the state.
  void add(Eigen::Index i, double error) {
    local_[i] += error;
    total_[i] += error;
  }
  /// Time passes. @param turns  change of the velocity, relative to the greatest speed @param scale  of
  /// motion
  void pass(double turns, const Vector& scale) { total_ += turns * largest(local_, scale) * scale; }

  /// The largest component relative to the scale of motion (N + n).
  double value(const Vector& scale) const { return largest(total_, scale); }

 private:
  static double largest(const Vector& errors, const Vector& scale) {
    return (errors.array() / scale.array()).maxCoeff();
  }

  Vector local_;  // without growth
  Vector total_;
};

}  // namespace hybrid_sphere::mechanics

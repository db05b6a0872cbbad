#pragma once

#include "motion/motion.hpp"

namespace hybrid_sphere {

/// The state of a motion for some time, as polynomials in x = (tau - origin)/width.
struct StatePolynomial {
  double origin = 0;                     ///< [s]
  double width = 1;                      ///< [s]
  Vector2d position = Vector2d::Zero();  ///< from which that of the centre is counted [m]
  /// Of position less that, velocity, acceleration, contact velocity and angular velocity; the last row is 0.
  polynomials::Powers<12> powers = polynomials::Powers<12>::Zero();

  /// A vector in the rows.
  struct Part {
    Eigen::Index first;
    Eigen::Index count;
  };
  /// Those by which the polynomials are judged: position, velocity, contact velocity, angular velocity in the
  /// plane and about the normal. The acceleration is smooth where the velocity is, and no output.
  static constexpr Part judged[] = {{0, 2}, {2, 2}, {6, 2}, {8, 2}, {10, 1}};

  /// Of the coefficients of a vector, in the maximum norm.
  double sum_of_sizes(const Part& part) const {
    return powers.middleRows(part.first, part.count).cwiseAbs().colwise().maxCoeff().sum();
  }

  MotionState at(double tau) const {
    const auto now = polynomials::values<12>(powers, (tau - origin) / width);
    return {{position + now.head<2>(), now.segment<2>(2), now.segment<2>(4)},
            now.segment<2>(6),
            now.segment<3>(8)};
  }
};

}  // namespace hybrid_sphere

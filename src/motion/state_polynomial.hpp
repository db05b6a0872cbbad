#pragma once

#include <algorithm>
#include <cmath>

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
    double sum = 0;
    for (Eigen::Index k = 0; k < polynomials::size; ++k) {
      double size = std::abs(powers(part.first, k));
      for (Eigen::Index i = part.first + 1; i < part.first + part.count; ++i) {
        size = std::max(size, std::abs(powers(i, k)));
      }
      sum += size;
    }
    return sum;
  }

  MotionState at(double tau) const {
    const auto now = polynomials::values<12>(powers, (tau - origin) / width);
    return {{position + Vector2d(now[0], now[1]), {now[2], now[3]}, {now[4], now[5]}},
            {now[6], now[7]},
            {now[8], now[9], now[10]}};
  }
};

}  // namespace hybrid_sphere

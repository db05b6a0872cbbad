#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <string>
#include <vector>

#include "catalogue/catalogue.hpp"

/// Bodies whose coordinates are x, y, qw, qx, qy, qz: the quaternion q turns the body's axes into the fixed
/// ones. Where q is an argument here it is these four numbers, w first.
namespace hybrid_sphere::mechanics::catalogue {

template <class Derived>
using Components4 = Eigen::Matrix<typename Derived::Scalar, 4, 1>;
template <class Derived>
using Components3 = Eigen::Matrix<typename Derived::Scalar, 3, 1>;

/// q' = (0, w) q / 2: w on the fixed axes.
template <class Q, class W>
Components4<Q> space_rate(const Eigen::MatrixBase<Q>& q, const Eigen::MatrixBase<W>& w) {
  Components4<Q> rate;
  rate[0] = -(w[0] * q[1] + w[1] * q[2] + w[2] * q[3]) / 2;
  rate[1] = (w[0] * q[0] + w[1] * q[3] - w[2] * q[2]) / 2;
  rate[2] = (w[1] * q[0] + w[2] * q[1] - w[0] * q[3]) / 2;
  rate[3] = (w[2] * q[0] + w[0] * q[2] - w[1] * q[1]) / 2;
  return rate;
}

/// q' = q (0, w) / 2: w on the body's axes.
template <class Q, class W>
Components4<Q> body_rate(const Eigen::MatrixBase<Q>& q, const Eigen::MatrixBase<W>& w) {
  Components4<Q> rate;
  rate[0] = -(q[1] * w[0] + q[2] * w[1] + q[3] * w[2]) / 2;
  rate[1] = (q[0] * w[0] + q[2] * w[2] - q[3] * w[1]) / 2;
  rate[2] = (q[0] * w[1] + q[3] * w[0] - q[1] * w[2]) / 2;
  rate[3] = (q[0] * w[2] + q[1] * w[1] - q[2] * w[0]) / 2;
  return rate;
}

/// A vector on the body's axes, on the fixed ones.
template <class Q, class W>
Components3<Q> to_space(const Eigen::MatrixBase<Q>& q, const Eigen::MatrixBase<W>& w) {
  Components3<Q> result;
  result[0] = (q[0] * q[0] + q[1] * q[1] - q[2] * q[2] - q[3] * q[3]) * w[0] +
              2 * (q[1] * q[2] - q[0] * q[3]) * w[1] + 2 * (q[1] * q[3] + q[0] * q[2]) * w[2];
  result[1] = 2 * (q[1] * q[2] + q[0] * q[3]) * w[0] +
              (q[0] * q[0] - q[1] * q[1] + q[2] * q[2] - q[3] * q[3]) * w[1] +
              2 * (q[2] * q[3] - q[0] * q[1]) * w[2];
  result[2] = 2 * (q[1] * q[3] - q[0] * q[2]) * w[0] + 2 * (q[2] * q[3] + q[0] * q[1]) * w[1] +
              (q[0] * q[0] - q[1] * q[1] - q[2] * q[2] + q[3] * q[3]) * w[2];
  return result;
}

/// The quaternion in the coordinates.
Eigen::Quaterniond orientation(const Vector& q);

/// Model::normalize.
void normalize_orientation(Vector& q);

/// The constants of an entry, and after them x, y, an orientation of any length but 0, x_dot, y_dot, w1, w2,
/// w3. @param axes  what w1, w2, w3 are about
std::vector<Parameter> with_initial_values(std::vector<Parameter> constants, const Initial& as_a_rule,
                                           const std::array<std::string, 3>& axes);

/// The start at t = 0 with the quaternion of the values scaled to unit length. Throws std::invalid_argument
/// where that has none.
Initial initial_state_of_unit_length(const Model& model, const Values& values);

}  // namespace hybrid_sphere::mechanics::catalogue

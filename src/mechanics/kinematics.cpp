#include "hybrid_sphere/mechanics/kinematics.hpp"

#include <Eigen/Cholesky>
#include <cfloat>
#include <cmath>
#include <stdexcept>

namespace hybrid_sphere::mechanics {
namespace {

// Far above round-off, and far below what an invalid function produces.
constexpr double max_relative_error = 1e-6;

using GivenMatrix = Eigen::Map<const Matrix>;
using GivenVector = Eigen::Map<const Eigen::VectorXd>;
using FilledMatrix = Eigen::Map<Matrix>;

void check_finite(const QuasiVelocityArrays& arrays) {
  const Index count = arrays.coordinates * arrays.velocities;
  user_function::check_derivative(user_function::are_finite(arrays.directions, count) &&
                                      user_function::are_finite(arrays.change, count) &&
                                      user_function::are_finite(arrays.variation, count),
                                  "rate");
}

/// Throws std::invalid_argument if W is not B v.
void check_linear(const QuasiVelocityArrays& arrays) {
  for (Index i = 0; i < arrays.coordinates; ++i) {
    double difference = arrays.rate[i], size = std::abs(arrays.rate[i]);
    for (Index j = 0; j < arrays.velocities; ++j) {
      const double part = arrays.directions[j * arrays.coordinates + i] * arrays.v[j];
      difference -= part;
      size += std::abs(part);
    }
    if (!std::isfinite(size)) return;  // reported elsewhere
    if (std::abs(difference) > max_relative_error * size + DBL_MIN) {
      throw std::invalid_argument("the rate of the coordinates is not linear in the velocities");
    }
  }
}

/// B^+ (change - variation), by least squares: B^+ = (B^T B)^-1 B^T.
void set_brackets(const QuasiVelocityArrays& arrays) {
  const Index N = arrays.coordinates, n = arrays.velocities;
  const GivenMatrix directions(arrays.directions, N, n);
  const GivenMatrix change(arrays.change, N, n);
  const GivenMatrix variation(arrays.variation, N, n);
  FilledMatrix difference(arrays.difference, N, n);
  difference = change - variation;
  FilledMatrix square(arrays.square, n, n);
  square.noalias() = directions.transpose().lazyProduct(directions);
  Eigen::Ref<Matrix> in_place(square);
  const Eigen::LLT<Eigen::Ref<Matrix>> cholesky(in_place);
  FilledMatrix brackets(arrays.brackets, n, n);
  brackets.noalias() = directions.transpose().lazyProduct(difference);
  cholesky.solveInPlace(brackets);
  user_function::check_value(
      cholesky.info() == Eigen::Success && user_function::are_finite(arrays.brackets, n * n),
      "inverse of rate");
  if (N == n) return;
  difference.noalias() -= directions.lazyProduct(brackets);
  if (difference.norm() > max_relative_error * (change.norm() + variation.norm())) {
    throw std::invalid_argument(
        "the directions in which the velocities move the coordinates are not closed under brackets");
  }
}

}  // namespace

void complete_quasi_velocities(const QuasiVelocityArrays& arrays) {
  check_finite(arrays);
  Eigen::Map<Eigen::VectorXd>(arrays.drift, arrays.coordinates).noalias() =
      GivenMatrix(arrays.change, arrays.coordinates, arrays.velocities)
          .lazyProduct(GivenVector(arrays.v, arrays.velocities));
  check_linear(arrays);
  set_brackets(arrays);
}

}  // namespace hybrid_sphere::mechanics

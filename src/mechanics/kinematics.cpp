#include "hybrid_sphere/mechanics/kinematics.hpp"

#include <Eigen/Cholesky>
#include <cfloat>
#include <cmath>
#include <stdexcept>

namespace hybrid_sphere::mechanics {
namespace {

// Far above round-off, and far below what an invalid function produces.
constexpr double max_relative_error = 1e-6;

using FilledMatrix = Eigen::Map<Matrix>;

void check_finite(const QuasiVelocityArrays& arrays) {
  const Index count = arrays.coordinates * arrays.velocities;
  user_function::check_derivative(are_finite(arrays.directions, count) && are_finite(arrays.change, count) &&
                                      are_finite(arrays.variation, count),
                                  "rate");
}

void set_drift(const QuasiVelocityArrays& arrays) {
  for (Index i = 0; i < arrays.coordinates; ++i) {
    double sum = 0;
    for (Index j = 0; j < arrays.velocities; ++j)
      sum += arrays.change[j * arrays.coordinates + i] * arrays.v[j];
    arrays.drift[i] = sum;
  }
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

double norm(const double* numbers, Index count) {
  return Eigen::Map<const Eigen::VectorXd>(numbers, count).norm();
}

/// B^+ D, by the Cholesky decomposition of B^T B.
void solve(const QuasiVelocityArrays& arrays) {
  const Index n = arrays.velocities;
  FilledMatrix square(arrays.square, n, n);
  Eigen::Ref<Matrix> in_place(square);
  const Eigen::LLT<Eigen::Ref<Matrix>> cholesky(in_place);
  FilledMatrix brackets(arrays.brackets, n, n);
  cholesky.solveInPlace(brackets);
  user_function::check_value(cholesky.info() == Eigen::Success && are_finite(arrays.brackets, n * n),
                             "inverse of rate");
}

}  // namespace

void complete_quasi_velocities(const QuasiVelocityArrays& arrays) {
  check_finite(arrays);
  set_drift(arrays);
  check_linear(arrays);
  solve(arrays);
}

void check_closed(const QuasiVelocityArrays& arrays, const double* remainder) {
  const Index count = arrays.coordinates * arrays.velocities;
  if (norm(remainder, count) >
      max_relative_error * (norm(arrays.change, count) + norm(arrays.variation, count))) {
    throw std::invalid_argument(
        "the directions in which the velocities move the coordinates are not closed under brackets");
  }
}

}  // namespace hybrid_sphere::mechanics

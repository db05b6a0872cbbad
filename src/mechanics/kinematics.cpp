#include "hybrid_sphere/mechanics/kinematics.hpp"

#include <Eigen/Cholesky>
#include <stdexcept>

namespace hybrid_sphere::mechanics {
namespace {

double norm(const double* numbers, Index count) {
  return Eigen::Map<const Eigen::VectorXd>(numbers, count).norm();
}

}  // namespace

void refuse_nonlinear_rate() {
  throw std::invalid_argument("the rate of the coordinates is not linear in the velocities");
}

void solve_for_brackets(Index n, double* square, double* right_sides) {
  Eigen::Map<Matrix> matrix(square, n, n);
  Eigen::Ref<Matrix> in_place(matrix);
  const Eigen::LLT<Eigen::Ref<Matrix>> cholesky(in_place);
  Eigen::Map<Matrix> solution(right_sides, n, n);
  cholesky.solveInPlace(solution);
  user_function::check_value(cholesky.info() == Eigen::Success && are_finite(right_sides, n * n),
                             "inverse of rate");
}

void check_closed(const double* remainder, const double* change, const double* variation, Index count) {
  if (norm(remainder, count) > max_relative_rate_error * (norm(change, count) + norm(variation, count))) {
    throw std::invalid_argument(
        "the directions in which the velocities move the coordinates are not closed under brackets");
  }
}

}  // namespace hybrid_sphere::mechanics

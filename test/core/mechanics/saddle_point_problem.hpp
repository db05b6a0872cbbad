#pragma once

#include <Eigen/Core>
#include <random>
#include <vector>

#include "mechanics/saddle_point.hpp"

namespace hybrid_sphere::testing {

/// M x - C^T y = h, C x = gamma.
struct SaddlePointProblem {
  mechanics::Matrix mass;
  mechanics::Matrix gradient;
  mechanics::Vector h;
  mechanics::Vector gamma;
};

struct SaddlePointAnswer {
  mechanics::SaddlePoint::Outcome outcome;
  mechanics::Vector x;
  mechanics::Vector y;
  mechanics::Index rank;
  double regularity;
  std::vector<mechanics::Index> conflict;
};

inline SaddlePointAnswer answer_to(const SaddlePointProblem& problem) {
  mechanics::SaddlePoint saddle_point;
  SaddlePointAnswer answer;
  answer.outcome =
      saddle_point.solve(problem.mass, problem.gradient, problem.h, problem.gamma, answer.x, answer.y);
  answer.rank = saddle_point.rank();
  answer.regularity = saddle_point.regularity();
  answer.conflict = saddle_point.conflict();
  return answer;
}

/// The problem that x and y solve.
inline SaddlePointProblem with_solution(const mechanics::Matrix& mass, const mechanics::Matrix& gradient,
                                        const mechanics::Vector& x, const mechanics::Vector& y) {
  return {mass, gradient, mass * x - gradient.transpose() * y, gradient * x};
}

/// Normally distributed numbers, the same in every run.
class RandomMatrices {
 public:
  mechanics::Matrix matrix(mechanics::Index rows, mechanics::Index columns) {
    return mechanics::Matrix::NullaryExpr(rows, columns, [this] { return normal_(engine_); });
  }
  mechanics::Vector vector(mechanics::Index size) { return matrix(size, 1); }
  /// Symmetric, positive definite; eigenvalues from 1 to about 4 size.
  mechanics::Matrix mass(mechanics::Index size) {
    const mechanics::Matrix root = matrix(size, size);
    return root * root.transpose() + mechanics::Matrix::Identity(size, size);
  }

 private:
  std::mt19937 engine_{20050717};
  std::normal_distribution<double> normal_;
};

}  // namespace hybrid_sphere::testing

#pragma once

#include <vector>

#include "hybrid_sphere/solver/equations.hpp"

namespace hybrid_sphere::solver {

/// The explicit Runge-Kutta method of ArkodeStepper (Fehlberg's of order 8, 13 stages), with a length of step
/// of one's own: what a trajectory is between two steps.
class RungeKutta {
 public:
  static constexpr int stages = 13;
  static constexpr int order = 8;

  /// Takes the coefficients from SUNDIALS. Throws std::runtime_error if it cannot give them.
  RungeKutta();

  /// y(x + h) from y = y(x); the error is that of one step of the method. Evaluates `stages` right-hand
  /// sides.
  State step(const Equations& equations, const State& y, double h) const;

 private:
  struct Term {
    int stage;
    double weight;
  };
  using Row = std::vector<Term>;  // coefficients that are not 0

  std::vector<Row> rows_;
  Row result_;
};

}  // namespace hybrid_sphere::solver

#pragma once

#include <array>
#include <vector>

#include "hybrid_sphere/integration/prince_dormand.hpp"

namespace hybrid_sphere::integration {

/// The explicit Runge-Kutta method of Arkode, PrinceDormand's, with a length of step of one's own: what a
/// trajectory is between two steps.
class RungeKutta {
 public:
  static constexpr int stages = PrinceDormand::stages;

  RungeKutta();

  /// y(x + h) from y = y(x); the error is that of one step of the method. Evaluates `stages` right-hand
  /// sides.
  /// @param derivative  Y(double x, const Y& y)
  /// @param y           an Eigen array or vector
  template <class Y, class Derivative>
  Y step(const Derivative& derivative, double x, const Y& y, double h) const {
    std::array<Y, stages> slopes;
    const auto sum = [&](const Row& row) {
      Y total = Y::Zero(y.size());
      for (const Term& term : row) total += term.weight * slopes[term.stage];
      return total;
    };
    for (std::size_t i = 0; i < slopes.size(); ++i) {
      slopes[i] =
          i == 0 ? derivative(x, y) : derivative(x + prince_dormand.nodes[i] * h, Y(y + h * sum(rows_[i])));
    }
    return y + h * sum(result_);
  }

 private:
  struct Term {
    std::size_t stage;
    double weight;
  };
  using Row = std::vector<Term>;  // coefficients that are not 0

  std::vector<Row> rows_;
  Row result_;
};

/// The one that all share; it has no state.
const RungeKutta& runge_kutta();

}  // namespace hybrid_sphere::integration

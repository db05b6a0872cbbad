#pragma once

#include <array>
#include <vector>

#include "integration/tableau.hpp"

namespace hybrid_sphere::integration {

/// An explicit Runge-Kutta method with a step length chosen by the caller: gives the trajectory of Arkode
/// between two steps.
class RungeKutta {
 public:
  static constexpr std::size_t max_stages = 13;

  /// Throws std::invalid_argument for more stages than that.
  explicit RungeKutta(const Tableau& tableau);

  std::size_t stages() const { return rows_.size(); }

  /// y(x + h) from y = y(x); the error is that of one step of the method. Evaluates `stages()`
  /// right-hand sides.
  /// @param derivative  Y(double x, const Y& y)
  /// @param y           an Eigen array or vector
  template <class Y, class Derivative>
  Y step(const Derivative& derivative, double x, const Y& y, double h) const {
    std::array<Y, max_stages> slopes;
    const auto sum = [&](const Row& row) {
      Y total = Y::Zero(y.size());
      for (const Term& term : row) total += term.weight * slopes[term.stage];
      return total;
    };
    for (std::size_t i = 0; i < stages(); ++i) {
      slopes[i] = i == 0 ? derivative(x, y) : derivative(x + nodes_[i] * h, Y(y + h * sum(rows_[i])));
    }
    return y + h * sum(result_);
  }

 private:
  struct Term {
    std::size_t stage;
    double weight;
  };
  using Row = std::vector<Term>;  // coefficients that are not 0

  std::vector<double> nodes_;
  std::vector<Row> rows_;
  Row result_;
};

/// prince_dormand(), shared by all; it has no state.
const RungeKutta& runge_kutta();

}  // namespace hybrid_sphere::integration

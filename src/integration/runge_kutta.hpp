#pragma once

#include <array>
#include <vector>

#include "integration/tableau.hpp"

namespace hybrid_sphere::integration {

/// Steps of an explicit Runge-Kutta method, of a length that the caller chooses.
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
  /// @param difference  out, unless null: of this to what the embedded method gives, the error of the latter
  template <class Y, class Derivative>
  Y step(const Derivative& derivative, double x, const Y& y, double h, Y* difference = nullptr) const {
    std::array<Y, max_stages> slopes;
    const auto sum = [&](const Row& row) {
      Y total = Y::Zero(y.size());
      for (const Term& term : row) total += term.weight * slopes[term.stage];
      return total;
    };
    for (std::size_t i = 0; i < stages(); ++i) {
      slopes[i] = i == 0 ? derivative(x, y) : derivative(x + nodes_[i] * h, Y(y + h * sum(rows_[i])));
    }
    if (difference) *difference = h * sum(difference_);
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
  Row difference_;
};

/// prince_dormand(), shared by all; it has no state.
const RungeKutta& runge_kutta();

}  // namespace hybrid_sphere::integration

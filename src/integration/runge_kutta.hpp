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

  /// Whether the last stage is at the end of the step, so that its slope is the first one of the next step.
  bool ends_with_slope() const { return ends_with_slope_; }

  /// What a step gives besides its end.
  template <class Y>
  struct Estimate {
    Y difference;  ///< to what the embedded method gives: the error of the latter
    Y last_slope;  ///< of the last stage
  };

  /// y(x + h) from y = y(x); the error is that of one step of the method. Evaluates `stages()`
  /// right-hand sides.
  /// @param derivative  Y(double x, const Y& y)
  /// @param y           an Eigen array or vector
  template <class Y, class Derivative>
  Y step(const Derivative& derivative, double x, const Y& y, double h) const {
    return step_from(derivative, x, y, derivative(x, y), h);
  }

  /// The same where the first slope is known.
  /// @param estimate  out, unless null
  template <class Y, class Derivative>
  Y step_from(const Derivative& derivative, double x, const Y& y, const Y& slope, double h,
              Estimate<Y>* estimate = nullptr) const {
    std::array<Y, max_stages> slopes;
    slopes[0] = slope;
    const auto sum = [&](const Row& row) {
      Y total = row.front().weight * slopes[row.front().stage];
      for (auto term = row.begin() + 1; term != row.end(); ++term)
        total += term->weight * slopes[term->stage];
      return total;
    };
    for (std::size_t i = 1; i < stages(); ++i) {
      slopes[i] = derivative(x + nodes_[i] * h, Y(y + h * sum(rows_[i])));
    }
    if (estimate) *estimate = {h * sum(difference_), slopes[stages() - 1]};
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
  bool ends_with_slope_ = false;
};

/// prince_dormand(), shared by all; it has no state.
const RungeKutta& runge_kutta();

}  // namespace hybrid_sphere::integration

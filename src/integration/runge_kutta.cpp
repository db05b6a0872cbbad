#include "integration/runge_kutta.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace hybrid_sphere::integration {

RungeKutta::RungeKutta(const Tableau& tableau) : nodes_(tableau.nodes) {
  const std::size_t stages = tableau.stages();
  if (stages > max_stages) throw std::invalid_argument("a Runge-Kutta method with more than 13 stages");
  const auto compact = [stages](const double* coefficients) {
    Row row;
    for (std::size_t i = 0; i < stages; ++i) {
      if (coefficients[i] != 0) row.push_back({i, coefficients[i]});
    }
    return row;
  };
  for (std::size_t i = 0; i < stages; ++i) rows_.push_back(compact(tableau.slopes.data() + i * stages));
  for (std::size_t i = 0; i < stages; ++i) {
    if (std::abs(nodes_[i] - 0.5) < std::abs(nodes_[inner_] - 0.5)) inner_ = i;
  }
  result_ = compact(tableau.weights.data());
  const auto last = tableau.slopes.end() - static_cast<std::ptrdiff_t>(stages);
  ends_with_slope_ = std::equal(last, tableau.slopes.end(), tableau.weights.begin());
  std::vector<double> difference = tableau.weights;
  for (std::size_t i = 0; i < stages; ++i) difference[i] -= tableau.embedded[i];
  difference_ = compact(difference.data());
}

const RungeKutta& runge_kutta() {
  static const RungeKutta method(prince_dormand());
  return method;
}

}  // namespace hybrid_sphere::integration

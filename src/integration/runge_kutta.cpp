#include "hybrid_sphere/integration/runge_kutta.hpp"

namespace hybrid_sphere::integration {

RungeKutta::RungeKutta() {
  const auto compact = [](const PrinceDormand::Row& coefficients) {
    Row row;
    for (std::size_t i = 0; i < coefficients.size(); ++i) {
      if (coefficients[i] != 0) row.push_back({i, coefficients[i]});
    }
    return row;
  };
  for (const PrinceDormand::Row& row : prince_dormand.slopes) rows_.push_back(compact(row));
  result_ = compact(prince_dormand.weights);
}

const RungeKutta& runge_kutta() {
  static const RungeKutta method;
  return method;
}

}  // namespace hybrid_sphere::integration

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

/// Sets `count` components from `first` on, which fit into registers.
template <int count>
void RungeKutta::set_part(const Row& row, double h, const Room& room, Eigen::Index first,
                          Eigen::VectorXd& sum) {
  using Part = Eigen::Array<double, count, 1>;
  const double* const slopes = room.slopes.data() + first;
  Part total = Part::Zero();
  for (const Term& term : row) {
    total +=
        term.weight * Eigen::Map<const Part>(slopes + static_cast<Eigen::Index>(term.stage) * sum.size());
  }
  Eigen::Map<Part>(sum.data() + first) = h * total;
}

void RungeKutta::set_sum(const Row& row, double h, const Room& room, Eigen::VectorXd& sum) {
  const Eigen::Index size = sum.size();
  Eigen::Index i = 0;
  for (; i + 8 <= size; i += 8) set_part<8>(row, h, room, i, sum);
  switch (size - i) {
    case 7: return set_part<7>(row, h, room, i, sum);
    case 6: return set_part<6>(row, h, room, i, sum);
    case 5: return set_part<5>(row, h, room, i, sum);
    case 4: return set_part<4>(row, h, room, i, sum);
    case 3: return set_part<3>(row, h, room, i, sum);
    case 2: return set_part<2>(row, h, room, i, sum);
    case 1: return set_part<1>(row, h, room, i, sum);
    default: return;
  }
}

const RungeKutta& runge_kutta() {
  static const RungeKutta method(prince_dormand());
  return method;
}

}  // namespace hybrid_sphere::integration

#include "hybrid_sphere/solver/runge_kutta.hpp"

#include <arkode/arkode_butcher_erk.h>

#include <array>
#include <memory>
#include <stdexcept>

namespace hybrid_sphere::solver {

RungeKutta::RungeKutta() {
  struct Free {
    void operator()(ARKodeButcherTableMem* table) const { ARKodeButcherTable_Free(table); }
  };
  const std::unique_ptr<ARKodeButcherTableMem, Free> table(
      ARKodeButcherTable_LoadERK(ARKODE_FEHLBERG_13_7_8));
  if (!table || table->stages != stages || table->q != order) {
    throw std::runtime_error("SUNDIALS has no Runge-Kutta method of order 8");
  }
  const auto compact = [](const realtype* coefficients, int count) {
    Row row;
    for (int i = 0; i < count; ++i) {
      if (coefficients[i] != 0) row.push_back({i, coefficients[i]});
    }
    return row;
  };
  for (int i = 0; i < stages; ++i) rows_.push_back(compact(table->A[i], i));
  result_ = compact(table->b, stages);
}

State RungeKutta::step(const Equations& equations, const State& y, double h) const {
  std::array<State, stages> slopes;
  const auto sum = [&slopes](const Row& row) {
    State total = State::Zero();
    for (const Term& term : row) {
      total += term.weight * slopes[static_cast<std::size_t>(term.stage)];
    }
    return total;
  };
  for (std::size_t i = 0; i < slopes.size(); ++i) {
    slopes[i] = equations.derivative(i == 0 ? y : State(y + h * sum(rows_[i])));
  }
  return y + h * sum(result_);
}

}  // namespace hybrid_sphere::solver

#include "erk_method.hpp"

namespace hybrid_sphere::solver {

ErkMethod::ErkMethod(const integration::Tableau& tableau, double tolerance)
    : tolerance_(tolerance), runge_kutta_(tableau), arkode_(State::RowsAtCompileTime, tableau) {}

void ErkMethod::begin(const Equations& equations, Node& first, const State& scale, double first_step) {
  problem_.equations = &equations;
  problem_.allowed_speed_error = tolerance_ * scale[4];
  arkode_.set_tolerances(tolerance_ * scale.matrix());
  arkode_.begin(problem_, first.y.matrix(), first_step);
}

Node ErkMethod::advance(Node& from, const State& scale) {
  problem_.allowed_speed_error = tolerance_ * scale[4];
  arkode_.set_tolerances(tolerance_ * scale.matrix());
  Eigen::Matrix<double, State::RowsAtCompileTime, 1> reached;
  arkode_.advance(reached);
  from.step = arkode_.last_step();
  Node to;
  to.y = reached.array();
  return to;
}

State ErkMethod::between(const Node& from, const Node& /*to*/, double x) {
  evaluations_ += runge_kutta_.stages();
  const Equations& equations = *problem_.equations;
  return runge_kutta_.step([&equations](double, const State& y) { return equations.derivative(y); }, 0.0,
                           from.y, x);
}

}  // namespace hybrid_sphere::solver

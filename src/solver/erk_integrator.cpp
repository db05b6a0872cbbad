#include "erk_integrator.hpp"

#include "dense_output.hpp"

namespace hybrid_sphere::solver {

ErkIntegrator::ErkIntegrator(const integration::Tableau& tableau, double tolerance)
    : tolerance_(tolerance),
      order_(tableau.order),
      runge_kutta_(tableau),
      arkode_(State::RowsAtCompileTime, tableau) {
  problem_.is_explicit = true;
}

void ErkIntegrator::begin(const Equations& equations, Node& first, const State& scale, double first_step) {
  problem_.equations = &equations;
  problem_.allowed_speed_error = tolerance_ * scale[4];
  arkode_.set_tolerances(tolerance_ * scale.matrix());
  arkode_.begin(problem_, first.y.matrix(), first_step);
}

Node ErkIntegrator::step(Node& from, const State& scale) {
  problem_.allowed_speed_error = tolerance_ * scale[4];
  arkode_.set_tolerances(tolerance_ * scale.matrix());
  Eigen::Matrix<double, State::RowsAtCompileTime, 1> reached;
  arkode_.step(reached);
  from.step = arkode_.last_step();
  Node to;
  to.y = reached.array();
  return to;
}

State ErkIntegrator::interpolate(Node& from, const Node& to, double x) {
  const auto derivative = [this](const State& y) {
    ++evaluations_;
    return problem_.equations->derivative(y);
  };
  const auto reach = [&](double length) {
    return runge_kutta_.step([&](double, const State& y) { return derivative(y); }, 0.0, from.y, length);
  };
  DenseOutput::fit(DenseOutput::places(order_), from, to, derivative, reach);
  return DenseOutput::at(from, x);
}

}  // namespace hybrid_sphere::solver

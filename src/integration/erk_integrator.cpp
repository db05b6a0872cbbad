#include "integration/erk_integrator.hpp"

#include "integration/dense_output.hpp"
#include "integration/integrators.hpp"

namespace hybrid_sphere::integration {

ErkIntegrator::ErkIntegrator(const Tableau& tableau, double tolerance)
    : tolerance_(tolerance),
      order_(tableau.order),
      runge_kutta_(tableau),
      arkode_(FlowState::RowsAtCompileTime, tableau) {
  problem_.is_explicit = true;
}

void ErkIntegrator::begin(const Flow& flow, Node& first, const FlowState& scale, double first_step) {
  problem_.flow = &flow;
  problem_.allowed_speed_error = tolerance_ * scale[4];
  arkode_.set_tolerances(tolerance_ * scale.matrix());
  arkode_.begin(problem_, first.y.matrix(), first_step);
}

Node ErkIntegrator::step(Node& from, const FlowState& scale) {
  problem_.allowed_speed_error = tolerance_ * scale[4];
  arkode_.set_tolerances(tolerance_ * scale.matrix());
  Eigen::Matrix<double, FlowState::RowsAtCompileTime, 1> reached;
  arkode_.step(reached);
  from.step = arkode_.last_step();
  Node to;
  to.y = reached.array();
  return to;
}

FlowState ErkIntegrator::interpolate(Node& from, const Node& to, double x) {
  const auto derivative = [this](const FlowState& y) {
    ++evaluations_;
    return problem_.flow->derivative(y);
  };
  const auto reach = [&](double length) {
    return runge_kutta_.step([&](double, const FlowState& y) { return derivative(y); }, 0.0, from.y, length);
  };
  if (from.shape.empty()) {
    DenseOutput::fit(DenseOutput::places(order_), from, to, derivative(from.y), derivative(to.y), derivative,
                     reach);
  }
  return DenseOutput::at(from, x);
}

std::unique_ptr<Integrator> make_erk(const Tableau& tableau, double tolerance) {
  return std::make_unique<ErkIntegrator>(tableau, tolerance);
}

}  // namespace hybrid_sphere::integration

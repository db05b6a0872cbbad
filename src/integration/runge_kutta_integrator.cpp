#include <algorithm>
#include <cmath>

#include "hybrid_sphere/numerical_error.hpp"
#include "integration/dense_output.hpp"
#include "integration/integrators.hpp"
#include "integration/runge_kutta.hpp"

namespace hybrid_sphere::integration {
namespace {

/// Steps of an embedded pair, as long as its estimate of the error allows.
class RungeKuttaIntegrator final : public Integrator {
 public:
  RungeKuttaIntegrator(const Tableau& tableau, double tolerance)
      : order_(tableau.order),
        embedded_order_(tableau.embedded_order),
        tolerance_(tolerance),
        runge_kutta_(tableau) {}

  void begin(const Flow& flow, Node& first, const FlowState& /*scale*/, double first_step) override {
    flow_ = &flow;
    trial_ = first_step;
    first.slope = derivative(first.y);
  }
  Node step(Node& from, const FlowState& scale) override;
  FlowState interpolate(Node& from, const Node& to, double x) override;
  double last_error() override { return error_of_better(last_error_, order_); }
  double tolerance() const override { return tolerance_; }
  std::size_t largest_shape() const override { return DenseOutput::length(order_); }
  std::uint64_t evaluations() const override { return evaluations_; }

 private:
  FlowState derivative(const FlowState& y) {
    ++evaluations_;
    return flow_->derivative(y);
  }
  /// The state a length h after a node.
  FlowState reach(const Node& from, double h, RungeKutta::Estimate<FlowState>* estimate = nullptr) {
    const auto rate = [this](double, const FlowState& there) { return derivative(there); };
    return runge_kutta_.step_from(rate, 0, from.y, from.slope, h, estimate);
  }
  void choose_next_step(double error);

  int order_;
  int embedded_order_;
  double tolerance_;
  RungeKutta runge_kutta_;
  const Flow* flow_ = nullptr;
  double trial_ = 0;  // length of the next step
  double last_error_ = 0;
  std::uint64_t evaluations_ = 0;
};

/// @param error  of the last trial, in units of the tolerance
void RungeKuttaIntegrator::choose_next_step(double error) {
  constexpr double safety = 0.9;
  constexpr double most = 5;  // the factor of two steps in a row
  if (error > 1) {
    trial_ *= std::max(safety * std::pow(error, -1.0 / (embedded_order_ - 1)), 1 / most);
  } else if (error < 0.5) {
    trial_ *= safety * std::min(std::pow(error, -1.0 / order_), most);
  }
}

Node RungeKuttaIntegrator::step(Node& from, const FlowState& scale) {
  for (;;) {
    trial_ = std::min(trial_, flow_->max_explicit_step(from.y, tolerance_ * scale[4]));
    if (!(trial_ > 0)) throw NumericalError("steps become too short");
    RungeKutta::Estimate<FlowState> estimate;
    Node to;
    to.y = reach(from, trial_, &estimate);
    last_error_ = (estimate.difference.abs() / scale).maxCoeff();
    const double error = last_error_ / tolerance_;
    if (!std::isfinite(error) || !to.y.allFinite()) {
      trial_ *= 0.2;
    } else {
      const bool is_taken = error <= 1;
      if (is_taken) to.slope = runge_kutta_.ends_with_slope() ? estimate.last_slope : derivative(to.y);
      from.step = trial_;
      choose_next_step(error);
      if (is_taken) return to;
    }
  }
}

FlowState RungeKuttaIntegrator::interpolate(Node& from, const Node& to, double x) {
  if (from.shape.empty()) {
    DenseOutput::fit(
        DenseOutput::places(order_), from, to, from.slope, to.slope,
        [this](const FlowState& y) { return derivative(y); },
        [&](double length) { return reach(from, length); });
  }
  return DenseOutput::at(from, x);
}

}  // namespace

std::unique_ptr<Integrator> make_runge_kutta(const Tableau& tableau, double tolerance) {
  return std::make_unique<RungeKuttaIntegrator>(tableau, tolerance);
}

}  // namespace hybrid_sphere::integration

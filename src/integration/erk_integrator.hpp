#pragma once

#include "integration/arkode.hpp"
#include "integration/dense_output.hpp"
#include "integration/flow_problem.hpp"
#include "integration/runge_kutta.hpp"

namespace hybrid_sphere::integration {

/// ARKODE's explicit Runge-Kutta methods: DenseOutput through shorter steps of the same method interpolates
/// between two nodes.
class ErkIntegrator final : public Integrator {
 public:
  /// @param tolerance  of a step, relative to the scale
  ErkIntegrator(const Tableau& tableau, double tolerance);

  void begin(const Flow& flow, Node& first, const FlowState& scale, double first_step) override;
  Node step(Node& from, const FlowState& scale) override;
  FlowState interpolate(Node& from, const Node& to, double x) override;
  double last_error() override { return error_of_better(tolerance_ * arkode_.last_error(), order_); }
  double tolerance() const override { return tolerance_; }
  std::size_t largest_shape() const override { return DenseOutput::length(order_); }
  std::uint64_t evaluations() const override { return arkode_.evaluations() + evaluations_; }

 private:
  FlowProblem problem_;
  double tolerance_;
  int order_;
  RungeKutta runge_kutta_;
  Arkode arkode_;
  std::uint64_t evaluations_ = 0;
};

}  // namespace hybrid_sphere::integration

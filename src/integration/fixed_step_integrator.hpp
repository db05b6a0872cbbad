#pragma once

#include "integration/integrators.hpp"

namespace hybrid_sphere::integration {

/// Fixed-length steps without error control; they end when their errors are as large as the motion. The cubic
/// with the states and slopes of two nodes interpolates between them.
class FixedStepIntegrator final : public Integrator {
 public:
  /// @param step  [s], > 0
  FixedStepIntegrator(FixedStepRule rule, double step) : rule_(rule), step_(step) {}

  double first_step(const Flow& flow, const FlowState& y, double longest) override;
  void begin(const Flow& flow, Node& first, const FlowState& scale, double first_step) override;
  Node step(Node& from, const FlowState& scale) override;
  FlowState interpolate(Node& from, const Node& to, double x) override;
  bool has_step_paths() const override { return true; }
  double last_error() override {
    return rule_ == FixedStepRule::rk4 ? error_of_better(last_error_, 4) : last_error_;
  }
  double tolerance() const override { return 1e-14; }
  double negligible(double /*speed*/) const override { return 0x1p-20 * flow_->decays() * step_; }
  std::size_t largest_shape() const override { return 0; }
  std::uint64_t evaluations() const override { return evaluations_; }

 private:
  FlowState derivative(const FlowState& y);
  FlowState increment(const FlowState& y, const FlowState& slope, double h);

  FixedStepRule rule_;
  double step_;
  const Flow* flow_ = nullptr;
  FlowState estimate_ = FlowState::Zero();
  double last_error_ = 0;
  FlowState sum_of_errors_ = FlowState::Zero();  // of the scale
  FlowState last_scale_ = FlowState::Zero();
  std::uint64_t evaluations_ = 0;
};

}  // namespace hybrid_sphere::integration

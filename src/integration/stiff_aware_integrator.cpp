#include "integration/stiff_aware_integrator.hpp"

#include <cmath>
#include <utility>

#include "hybrid_sphere/numerical_error.hpp"
#include "integration/integrators.hpp"

namespace hybrid_sphere::integration {

StiffAwareIntegrator::StiffAwareIntegrator(std::unique_ptr<Integrator> explicit_method,
                                           std::unique_ptr<Integrator> implicit_method, bool for_drag)
    : explicit_(std::move(explicit_method)), implicit_(std::move(implicit_method)), for_drag_(for_drag) {}

double StiffAwareIntegrator::first_step(const Flow& flow, const FlowState& y, double longest) {
  return explicit_->first_step(flow, y, longest);
}

void StiffAwareIntegrator::begin(const Flow& flow, Node& first, const FlowState& scale, double first_step) {
  flow_ = &flow;
  stiff_ = false;
  allowed_ = true;
  held_ = 0;
  last_step_ = first_step;
  explicit_->begin(flow, first, scale, first_step);
}

Node StiffAwareIntegrator::step(Node& from, const FlowState& scale) {
  if (stiff_) {
    try {
      Node to = implicit_->step(from, scale);
      to.implicit = true;
      last_error_ = implicit_->last_error();
      return to;
    } catch (const NumericalError&) {
      stiff_ = false;
      allowed_ = false;
      explicit_->begin(*flow_, from, scale, last_step_);
    }
  }
  Node to = explicit_->step(from, scale);
  last_error_ = explicit_->last_error();
  last_step_ = from.step;
  const bool is_stiff = (for_drag_ && flow_->is_stiff_by_drag(from.y, from.step)) ||
                        flow_->is_stiff_by_friction(from.y, from.step);
  held_ = is_stiff ? held_ + 1 : 0;
  constexpr int long_enough = 500;
  if (allowed_ && held_ >= long_enough) {
    stiff_ = true;
    implicit_->begin(*flow_, to, scale, implicit_->first_step(*flow_, to.y, from.step));
  }
  return to;
}

FlowState StiffAwareIntegrator::interpolate(Node& from, const Node& to, double x) {
  return (to.implicit ? *implicit_ : *explicit_).interpolate(from, to, x);
}

std::unique_ptr<Integrator> make_stiff_aware(std::unique_ptr<Integrator> explicit_method,
                                             std::unique_ptr<Integrator> implicit_method, bool for_drag) {
  return std::make_unique<StiffAwareIntegrator>(std::move(explicit_method), std::move(implicit_method),
                                                for_drag);
}

}  // namespace hybrid_sphere::integration

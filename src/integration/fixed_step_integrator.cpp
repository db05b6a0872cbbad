#include "integration/fixed_step_integrator.hpp"

#include <algorithm>

#include "hybrid_sphere/numerical_error.hpp"
#include "integration/integrators.hpp"

namespace hybrid_sphere::integration {
namespace {

constexpr double largest = 1e100;  // whose squares are numbers

}  // namespace

FlowState FixedStepIntegrator::derivative(const FlowState& y) {
  ++evaluations_;
  return flow_->derivative(y);
}

double FixedStepIntegrator::first_step(const Flow& flow, const FlowState& y, double /*longest*/) {
  flow_ = &flow;
  return flow.step_of_time(y, step_);
}

void FixedStepIntegrator::begin(const Flow& flow, Node& first, const FlowState& /*scale*/,
                                double /*first_step*/) {
  flow_ = &flow;
  sum_of_errors_.setZero();
  last_scale_.setZero();
  first.slope = derivative(first.y);
}

/// h times the mean slope; sets estimate_ to the part of it that is due to the slope's change.
FlowState FixedStepIntegrator::increment(const FlowState& y, const FlowState& slope, double h) {
  if (rule_ == FixedStepRule::euler) return h * slope;
  const FlowState middle = derivative(y + 0.5 * h * slope);
  if (rule_ == FixedStepRule::midpoint) return h * middle;
  const FlowState second = derivative(y + 0.5 * h * middle);
  estimate_ = derivative(y + h * second);
  return h / 6 * (slope + 2 * (middle + second) + estimate_);
}

// The slope at the end of a step is the first of the next one, and tells the error: for Euler's method by the
// trapezoidal rule, for the others by the method of one order less that it makes possible.
Node FixedStepIntegrator::step(Node& from, const FlowState& scale) {
  const double h = flow_->step_of_time(from.y, step_);
  const FlowState& slope = from.slope;
  Node to;
  const FlowState change = increment(from.y, slope, h);
  to.y = from.y + change;
  to.slope = derivative(to.y);
  const FlowState& end = to.slope;
  if (!(to.y.abs() <= largest).all() || !end.allFinite()) {
    throw NumericalError("the state overflows: the fixed step is too long");
  }
  const FlowState error = rule_ == FixedStepRule::rk4 ? FlowState(h / 6 * (end - estimate_))
                                                      : FlowState(0.5 * h * (slope + end) - change);
  last_error_ = (error.abs() / scale).maxCoeff();
  // A decay at the limit of stability has 2/3 (orders 1 and 2) or 0.53 (order 4); Euler's way from rest 1/2.
  constexpr double most = 0.52;
  if (!(last_error_ <= most)) {
    throw NumericalError("the error of a step is as large as the motion itself: the fixed step is too long");
  }
  // Where the sphere has gone farther, as it does from rest, what was lost before is less of its way.
  sum_of_errors_.segment<2>(2) *= (last_scale_ / scale).min(1).segment<2>(2);
  sum_of_errors_ += error.abs() / scale;
  last_scale_ = scale;
  if (!(sum_of_errors_ <= 1).all()) {
    throw NumericalError(
        "the accumulated error is as large as the motion itself: the fixed step is too long");
  }
  from.step = h;
  return to;
}

FlowState FixedStepIntegrator::interpolate(Node& from, const Node& to, double x) {
  const double h = from.step;
  const double s = x / h;
  const double rest = 1 - s;
  const FlowState& slope = from.slope;
  const FlowState& far_slope = to.slope;
  return from.y + s * s * (3 - 2 * s) * (to.y - from.y) + x * rest * (rest * slope - s * far_slope);
}

std::unique_ptr<Integrator> make_fixed_step(FixedStepRule rule, double step) {
  return std::make_unique<FixedStepIntegrator>(rule, step);
}

}  // namespace hybrid_sphere::integration

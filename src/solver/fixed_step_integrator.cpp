#include "fixed_step_integrator.hpp"

#include <algorithm>
#include <stdexcept>

namespace hybrid_sphere::solver {

State FixedStepIntegrator::derivative(const State& y) {
  ++evaluations_;
  return equations_->derivative(y);
}

double FixedStepIntegrator::first_step(const Equations& equations, const State& y, double /*longest*/) {
  equations_ = &equations;
  return step_in_x(y);
}

void FixedStepIntegrator::begin(const Equations& equations, Node& first, const State& /*scale*/,
                                double /*first_step*/) {
  equations_ = &equations;
  sum_of_errors_.setZero();
  last_scale_.setZero();
  first.slope = derivative(first.y);
}

// Against dry friction x is not the time, and w dies in infinitely many x: a step covers step_ as long as w
// lasts so long, and then a part of what is left.
double FixedStepIntegrator::step_in_x(const State& y) const {
  constexpr double part = 0.5;
  if (!equations_->is_dry()) return step_;
  const double rate = equations_->decays() + equations_->instant(y).forcing.norm();
  return rate > 0 ? std::min(step_ / equations_->pace(y), part / rate) : step_ / equations_->pace(y);
}

/// h times the mean slope; sets estimate_ to the part of it that is due to the slope's change.
State FixedStepIntegrator::increment(const State& y, const State& slope, double h) {
  if (rule_ == Rule::euler) return h * slope;
  const State middle = derivative(y + 0.5 * h * slope);
  if (rule_ == Rule::midpoint) return h * middle;
  const State second = derivative(y + 0.5 * h * middle);
  estimate_ = derivative(y + h * second);
  return h / 6 * (slope + 2 * (middle + second) + estimate_);
}

// The slope at the end of a step is the first of the next one, and tells the error: for Euler's method by the
// trapezoidal rule, for the others by the method of one order less that it makes possible.
Node FixedStepIntegrator::step(Node& from, const State& scale) {
  const double h = step_in_x(from.y);
  const State& slope = from.slope;
  Node to;
  const State change = increment(from.y, slope, h);
  to.y = from.y + change;
  to.slope = derivative(to.y);
  const State& end = to.slope;
  if (!(to.y.abs() <= max_speed).all() || !end.allFinite()) {
    throw std::runtime_error("its numbers leave the range: the fixed step is too long");
  }
  const State error =
      rule_ == Rule::rk4 ? State(h / 6 * (end - estimate_)) : State(0.5 * h * (slope + end) - change);
  last_error_ = (error.abs() / scale).maxCoeff();
  // A decay at the limit of stability has 2/3 (orders 1 and 2) or 0.53 (order 4); Euler's way from rest 1/2.
  constexpr double most = 0.52;
  if (!(last_error_ <= most)) {
    throw std::runtime_error(
        "the error of a step is as large as the motion itself: the fixed step is too long");
  }
  // Where the sphere has gone farther, as it does from rest, what was lost before is less of its way.
  sum_of_errors_.segment<2>(2) *= (last_scale_ / scale).min(1).segment<2>(2);
  sum_of_errors_ += error.abs() / scale;
  last_scale_ = scale;
  if (!(sum_of_errors_ <= 1).all()) {
    throw std::runtime_error("its errors have added up to the motion itself: the fixed step is too long");
  }
  from.step = h;
  return to;
}

State FixedStepIntegrator::interpolate(Node& from, const Node& to, double x) {
  const double h = from.step;
  const double s = x / h;
  const double rest = 1 - s;
  const State& slope = from.slope;
  const State& far_slope = to.slope;
  return from.y + s * s * (3 - 2 * s) * (to.y - from.y) + x * rest * (rest * slope - s * far_slope);
}

}  // namespace hybrid_sphere::solver

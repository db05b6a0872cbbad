#pragma once

#include "hybrid_sphere/solver/integrator.hpp"

namespace hybrid_sphere::solver {

/// Steps of one length, without control of the error; they end where their errors are as large as the motion.
/// Between two nodes lies the cubic with their states and slopes.
class FixedStepIntegrator final : public Integrator {
 public:
  enum class Rule { euler, midpoint, rk4 };

  /// @param step  [s], > 0
  FixedStepIntegrator(Rule rule, double step) : rule_(rule), step_(step) {}

  double first_step(const Equations& equations, const State& y, double longest) override;
  void begin(const Equations& equations, Node& first, const State& scale, double first_step) override;
  Node step(Node& from, const State& scale) override;
  State interpolate(Node& from, const Node& to, double x) override;
  bool has_step_paths() const override { return true; }
  double last_error() override { return rule_ == Rule::rk4 ? error_of_better(last_error_, 4) : last_error_; }
  double tolerance() const override { return 1e-14; }
  double negligible(double /*speed*/) const override { return 0x1p-20 * equations_->decays() * step_; }
  std::size_t largest_shape() const override { return 0; }
  std::uint64_t evaluations() const override { return evaluations_; }

 private:
  State derivative(const State& y);
  State increment(const State& y, const State& slope, double h);
  double step_in_x(const State& y) const;

  Rule rule_;
  double step_;
  const Equations* equations_ = nullptr;
  State estimate_ = State::Zero();
  double last_error_ = 0;
  State sum_of_errors_ = State::Zero();  // of the scale
  State last_scale_ = State::Zero();
  std::uint64_t evaluations_ = 0;
};

}  // namespace hybrid_sphere::solver

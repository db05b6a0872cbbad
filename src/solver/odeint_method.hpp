#pragma once

#include <array>

#include "hybrid_sphere/solver/method.hpp"

namespace hybrid_sphere::solver {

/// Boost.odeint's Dormand-Prince method of order 5(4) with its own control of the step. Between two nodes
/// lies one shorter step.
class OdeintMethod final : public Method {
 public:
  /// @param tolerance  of a step, relative to the scale
  explicit OdeintMethod(double tolerance) : tolerance_(tolerance) {}

  void begin(const Equations& equations, Node& first, const State& scale, double first_step) override;
  Node advance(Node& from, const State& scale) override;
  State between(const Node& from, const Node& to, double x) override;
  double last_error() override { return last_error_; }
  double tolerance() const override { return tolerance_; }
  std::uint64_t evaluations() const override { return evaluations_; }

 private:
  using Values = std::array<double, State::RowsAtCompileTime>;

  double tolerance_;
  const Equations* equations_ = nullptr;
  double trial_ = 0;  // length of the next step
  double last_error_ = 0;
  std::uint64_t evaluations_ = 0;
};

}  // namespace hybrid_sphere::solver

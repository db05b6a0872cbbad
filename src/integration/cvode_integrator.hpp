#pragma once

#include "integration/cvode.hpp"
#include "integration/flow_problem.hpp"

namespace hybrid_sphere::integration {

/// CVODE's multistep methods: between two nodes lies the polynomial of the step that ends at the later one,
/// or a cubic if that is of low order; its derivatives at its beginning, with respect to the fraction of the
/// step, are the later node's shape.
class CvodeIntegrator final : public Integrator {
 public:
  /// @param tolerance  of a step, relative to the scale
  CvodeIntegrator(Cvode::Formula formula, double tolerance)
      : tolerance_(tolerance), cvode_(FlowState::RowsAtCompileTime, formula) {}

  double first_step(const Flow& flow, const FlowState& y, double longest) override;
  void begin(const Flow& flow, Node& first, const FlowState& scale, double first_step) override;
  Node step(Node& from, const FlowState& scale) override;
  FlowState interpolate(Node& from, const Node& to, double x) override;
  double last_error() override { return tolerance_ * cvode_.last_error(); }
  double tolerance() const override { return tolerance_; }
  std::size_t largest_shape() const override { return 12; }  // the highest order, of Adams' formulas
  std::uint64_t evaluations() const override { return cvode_.evaluations() + evaluations_; }

 private:
  static constexpr double largest_step = 0x1p+80;  // in the unit of x

  void restart(const FlowState& y, double first_step);
  std::vector<FlowState> cubic(const Node& from, const Node& to);

  FlowProblem problem_;
  double tolerance_;
  Cvode cvode_;
  std::vector<Eigen::VectorXd> derivatives_;
  std::uint64_t evaluations_ = 0;
};

}  // namespace hybrid_sphere::integration

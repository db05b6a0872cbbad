#pragma once

#include "adaptive_problem.hpp"
#include "hybrid_sphere/integration/cvode.hpp"

namespace hybrid_sphere::solver {

/// CVODE's multistep methods: between two nodes lies the polynomial of the step that ends at the later one,
/// or a cubic where that is of low order; its derivatives at its beginning, by the part of the step, are the
/// later node's shape.
class CvodeIntegrator final : public Integrator {
 public:
  /// @param tolerance  of a step, relative to the scale
  CvodeIntegrator(integration::Cvode::Formula formula, double tolerance)
      : tolerance_(tolerance), cvode_(State::RowsAtCompileTime, formula) {}

  double first_step(const Equations& equations, const State& y, double longest) override;
  void begin(const Equations& equations, Node& first, const State& scale, double first_step) override;
  Node step(Node& from, const State& scale) override;
  State interpolate(Node& from, const Node& to, double x) override;
  double last_error() override { return tolerance_ * cvode_.last_error(); }
  double tolerance() const override { return tolerance_; }
  std::size_t largest_shape() const override { return 12; }  // the highest order, of Adams' formulas
  std::uint64_t evaluations() const override { return cvode_.evaluations() + evaluations_; }

 private:
  static constexpr double largest_step = 0x1p+80;  // in the unit of x

  void restart(const State& y, double first_step);
  std::vector<State> cubic(const Node& from, const Node& to);

  AdaptiveProblem problem_;
  double tolerance_;
  integration::Cvode cvode_;
  std::vector<Eigen::VectorXd> derivatives_;
  std::uint64_t evaluations_ = 0;
};

}  // namespace hybrid_sphere::solver

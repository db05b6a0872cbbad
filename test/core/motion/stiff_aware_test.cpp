#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <vector>

#include "integration/integrators.hpp"

namespace hybrid_sphere::integration::stiff_aware_test {
namespace {

/// y_0'' = -y_0, said to be stiff at every place.
struct Oscillation final : Flow {
  FlowState derivative(const FlowState& y) const override {
    FlowState rate = FlowState::Zero();
    rate[0] = y[1];
    rate[1] = -y[0];
    rate[6] = 1;
    return rate;
  }
  double first_step(const FlowState& /*y*/, double /*tolerance*/, double /*longest*/) const override {
    return 0.01;
  }
  double step_of_time(const FlowState& /*y*/, double duration) const override { return duration; }
  double max_step(const FlowState& /*y*/, double /*allowed*/) const override { return 0.1; }
  double max_explicit_step(const FlowState& /*y*/, double /*allowed*/) const override { return 0.1; }
  bool is_stiff_by_drag(const FlowState& /*y*/, double /*step*/) const override { return true; }
  bool is_stiff_by_friction(const FlowState& /*y*/, double /*step*/) const override { return true; }
  double decays() const override { return 0; }
};

/// CVODE, which finds no step after some.
class FailingAfter final : public Integrator {
 public:
  explicit FailingAfter(int steps) : steps_(steps) {}
  double first_step(const Flow& flow, const FlowState& y, double longest) override {
    return cvode_->first_step(flow, y, longest);
  }
  void begin(const Flow& flow, Node& first, const FlowState& scale, double step) override {
    cvode_->begin(flow, first, scale, step);
  }
  Node step(Node& from, const FlowState& scale) override {
    if (steps_-- == 0) throw NumericalError("no step");
    return cvode_->step(from, scale);
  }
  FlowState interpolate(Node& from, const Node& to, double x) override {
    return cvode_->interpolate(from, to, x);
  }
  double last_error() override { return cvode_->last_error(); }
  double tolerance() const override { return cvode_->tolerance(); }
  std::size_t largest_shape() const override { return cvode_->largest_shape(); }
  std::uint64_t evaluations() const override { return cvode_->evaluations(); }

 private:
  std::unique_ptr<Integrator> cvode_ = make_cvode(Cvode::Formula::bdf, 1e-9);
  int steps_;
};

// There and back: each step has the shape of the method that took it.
TEST(StiffAware, InterpolatesTheFirstStepAfterTheImplicitMethodHasFailed) {
  const Oscillation flow;
  const FlowState scale = FlowState::Ones();
  const Tableau* tableaus[] = {&dormand_prince(), &prince_dormand()};
  for (const Tableau* tableau : tableaus) {
    const std::unique_ptr<Integrator> method =
        make_stiff_aware(make_runge_kutta(*tableau, 1e-11), std::make_unique<FailingAfter>(40), true);
    std::vector<Node> nodes(1);
    nodes[0].y[0] = 1;
    method->begin(flow, nodes[0], scale, 0.05);
    int changes = 0;
    for (std::size_t i = 0; i < 700; ++i) {
      nodes.push_back(method->step(nodes[i], scale));
      changes += nodes[i].implicit != nodes[i + 1].implicit ? 1 : 0;
    }
    for (std::size_t i = 0; i < 700; ++i) {
      const double x = 0.5 * nodes[i].step;
      const FlowState middle = method->interpolate(nodes[i], nodes[i + 1], x);
      EXPECT_NEAR(middle[0], std::cos(nodes[i].y[6] + x), 1e-6) << i;
    }
    EXPECT_EQ(changes, 2);
  }
}

}  // namespace
}  // namespace hybrid_sphere::integration::stiff_aware_test

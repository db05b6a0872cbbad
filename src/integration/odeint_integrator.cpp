#include <algorithm>
#include <array>
#include <boost/numeric/odeint/stepper/controlled_runge_kutta.hpp>
#include <boost/numeric/odeint/stepper/explicit_error_generic_rk.hpp>
#include <boost/numeric/odeint/stepper/runge_kutta_dopri5.hpp>
#include <cmath>
#include <utility>

#include "hybrid_sphere/numerical_error.hpp"
#include "integration/dense_output.hpp"
#include "integration/integrators.hpp"
#include "integration/tableau.hpp"

namespace hybrid_sphere::integration {
namespace {

namespace odeint = boost::numeric::odeint;

using Values = std::array<double, FlowState::RowsAtCompileTime>;
using Dopri5 = odeint::runge_kutta_dopri5<Values>;

constexpr std::size_t stages = 13;

class Dopri87 : public odeint::explicit_error_generic_rk<stages, 8, 8, 7, Values> {
 public:
  Dopri87()
      : explicit_error_generic_rk(slopes(std::make_index_sequence<stages - 1>()), weights(),
                                  weights_of_error(), nodes()) {}

 private:
  static const Tableau& tableau() { return prince_dormand(); }
  /// Row i of the slopes' coefficients, those that are not 0 by being explicit.
  template <std::size_t i>
  static boost::array<double, i> row() {
    boost::array<double, i> coefficients;
    std::copy_n(tableau().slopes.data() + i * stages, i, coefficients.begin());
    return coefficients;
  }
  template <std::size_t... i>
  static coef_a_type slopes(std::index_sequence<i...>) {
    return coef_a_type(row<i + 1>()...);
  }
  static coef_b_type weights() {
    coef_b_type b;
    std::copy(tableau().weights.begin(), tableau().weights.end(), b.begin());
    return b;
  }
  static coef_b_type weights_of_error() {
    coef_b_type b;
    for (std::size_t i = 0; i < stages; ++i) b[i] = tableau().weights[i] - tableau().embedded[i];
    return b;
  }
  static coef_c_type nodes() {
    coef_c_type c;
    std::copy(tableau().nodes.begin(), tableau().nodes.end(), c.begin());
    return c;
  }
};

template <class Stepper>
class OdeintIntegrator final : public Integrator {
 public:
  explicit OdeintIntegrator(double tolerance) : tolerance_(tolerance) {}

  void begin(const Flow& flow, Node& first, const FlowState& scale, double first_step) override;
  Node step(Node& from, const FlowState& scale) override;
  FlowState interpolate(Node& from, const Node& to, double x) override;
  double last_error() override { return error_of_better(last_error_, stepper_.order()); }
  double tolerance() const override { return tolerance_; }
  std::size_t largest_shape() const override { return DenseOutput::length(stepper_.order()); }
  std::uint64_t evaluations() const override { return evaluations_; }

 private:
  FlowState derivative(const FlowState& y) {
    ++evaluations_;
    return flow_->derivative(y);
  }
  /// One step of length h.
  template <class... Error>
  FlowState reach(const FlowState& y, double h, Error&... error);

  double tolerance_;
  Stepper stepper_;
  const Flow* flow_ = nullptr;
  double trial_ = 0;  // length of the next step
  double last_error_ = 0;
  std::uint64_t evaluations_ = 0;
};

template <class Stepper>
void OdeintIntegrator<Stepper>::begin(const Flow& flow, Node& /*first*/, const FlowState& /*scale*/,
                                      double first_step) {
  flow_ = &flow;
  trial_ = first_step;
}

template <class Stepper>
template <class... Error>
FlowState OdeintIntegrator<Stepper>::reach(const FlowState& y, double h, Error&... error) {
  const auto system = [this](const Values& there, Values& rate, double) {
    Eigen::Map<FlowState>(rate.data()) = derivative(Eigen::Map<const FlowState>(there.data()));
  };
  Values from;
  Values to;
  Values rate;
  Eigen::Map<FlowState>(from.data()) = y;
  system(from, rate, 0);
  if constexpr (std::is_same_v<Stepper, Dopri5>) {
    Values rate_there;  // the slope that the next step would begin with
    stepper_.do_step_impl(system, from, rate, 0.0, to, rate_there, h, error...);
  } else {
    stepper_.do_step_impl(system, from, rate, 0.0, to, h, error...);
  }
  return Eigen::Map<const FlowState>(to.data());
}

template <class Stepper>
Node OdeintIntegrator<Stepper>::step(Node& from, const FlowState& scale) {
  odeint::default_step_adjuster<double, double> adjuster;
  for (;;) {
    trial_ = std::min(trial_, flow_->max_explicit_step(from.y, tolerance_ * scale[4]));
    Values error;
    Node to;
    to.y = reach(from.y, trial_, error);
    last_error_ = (Eigen::Map<const FlowState>(error.data()).abs() / scale).maxCoeff();
    const double part = last_error_ / tolerance_;
    const double taken = trial_;
    if (!std::isfinite(part) || !to.y.allFinite()) {
      trial_ *= 0.2;
    } else if (part > 1) {
      trial_ = adjuster.decrease_step(trial_, part, stepper_.error_order());
    } else {
      trial_ = adjuster.increase_step(trial_, part, stepper_.stepper_order());
      from.step = taken;
      return to;
    }
    if (!(trial_ > 0)) throw NumericalError("steps become too short");
  }
}

template <class Stepper>
FlowState OdeintIntegrator<Stepper>::interpolate(Node& from, const Node& to, double x) {
  DenseOutput::fit(
      DenseOutput::places(stepper_.order()), from, to, [this](const FlowState& y) { return derivative(y); },
      [&](double length) { return reach(from.y, length); });
  return DenseOutput::at(from, x);
}

}  // namespace

std::unique_ptr<Integrator> make_dopri5(double tolerance) {
  return std::make_unique<OdeintIntegrator<Dopri5>>(tolerance);
}

std::unique_ptr<Integrator> make_dopri87(double tolerance) {
  return std::make_unique<OdeintIntegrator<Dopri87>>(tolerance);
}

}  // namespace hybrid_sphere::integration

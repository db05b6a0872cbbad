#include "odeint_method.hpp"

#include <algorithm>
#include <boost/numeric/odeint/stepper/controlled_runge_kutta.hpp>
#include <boost/numeric/odeint/stepper/runge_kutta_dopri5.hpp>
#include <cmath>
#include <stdexcept>

namespace hybrid_sphere::solver {
namespace {

namespace odeint = boost::numeric::odeint;

}  // namespace

void OdeintMethod::begin(const Equations& equations, Node& /*first*/, const State& /*scale*/,
                         double first_step) {
  equations_ = &equations;
  trial_ = first_step;
}

Node OdeintMethod::advance(Node& from, const State& scale) {
  using Stepper = odeint::runge_kutta_dopri5<Values>;
  const auto system = [this](const Values& y, Values& rate, double) {
    ++evaluations_;
    Eigen::Map<State>(rate.data()) = equations_->derivative(Eigen::Map<const State>(y.data()));
  };
  odeint::default_step_adjuster<double, double> adjuster;
  Values y{};
  Eigen::Map<State>(y.data()) = from.y;
  for (;;) {
    trial_ = std::min(trial_, longest_step(*equations_, from.y, tolerance_ * scale[4]));
    Values reached{};
    Values error{};
    Stepper stepper;  // a new one: it would take the slope at the end of a refused step for that at y
    stepper.do_step(system, y, 0.0, reached, trial_, error);
    last_error_ = (Eigen::Map<const State>(error.data()).abs() / scale).maxCoeff();
    const double part = last_error_ / tolerance_;
    const double taken = trial_;
    if (!std::isfinite(part)) {
      trial_ *= 0.2;
    } else if (part > 1) {
      trial_ = adjuster.decrease_step(trial_, part, stepper.error_order());
    } else {
      trial_ = adjuster.increase_step(trial_, part, stepper.stepper_order());
      from.step = taken;
      Node to;
      to.y = Eigen::Map<const State>(reached.data());
      return to;
    }
    if (!(trial_ > 0)) throw std::runtime_error("steps become too short");
  }
}

State OdeintMethod::between(const Node& from, const Node& /*to*/, double x) {
  odeint::runge_kutta_dopri5<Values> stepper;
  Values y{};
  Eigen::Map<State>(y.data()) = from.y;
  stepper.do_step(
      [this](const Values& there, Values& rate, double) {
        ++evaluations_;
        Eigen::Map<State>(rate.data()) = equations_->derivative(Eigen::Map<const State>(there.data()));
      },
      y, 0.0, x);
  return Eigen::Map<const State>(y.data());
}

}  // namespace hybrid_sphere::solver

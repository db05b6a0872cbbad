#include "hybrid_sphere/solver/stepper.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

namespace hybrid_sphere::solver {

void Stepper::Problem::derivative(double /*x*/, const integration::ConstState& y, integration::State& rate) {
  rate = equations->derivative(y.array()).matrix();
}

// abs(v) v has a corner at v = 0, which the method's error estimate, a difference of slopes at the two ends
// of a step, does not see from afar. So v may not halve in a step, unless the step is so short that the
// corner, of the size c a^2 h^3, is below the tolerance.
double Stepper::Problem::longest_step(const integration::ConstState& state) {
  const double drag = equations->dynamics().quadratic_drag;
  const State y = state.array();
  const Instant now = equations->instant(y);
  const double acceleration = drag == 0 ? 0 : equations->acceleration(y, now).norm();
  if (acceleration == 0) return std::numeric_limits<double>::max();
  const double blurred = std::cbrt(allowed_speed_error / drag / acceleration / acceleration);
  return std::max(0.5 * now.velocity.norm() / acceleration, blurred) / equations->pace(y);
}

void Stepper::begin(const Equations& equations, const State& y, const State& scale, double first_step,
                    double tolerance) {
  problem_.equations = &equations;
  problem_.allowed_speed_error = tolerance * scale[4];
  tolerance_ = tolerance;
  arkode_.set_tolerances(tolerance * scale.matrix());
  arkode_.begin(problem_, y.matrix(), first_step);
}

double Stepper::advance(const State& scale, State& y) {
  problem_.allowed_speed_error = tolerance_ * scale[4];
  arkode_.set_tolerances(tolerance_ * scale.matrix());
  Eigen::Matrix<double, State::RowsAtCompileTime, 1> reached;
  try {
    arkode_.advance(reached);
  } catch (const std::runtime_error& error) {
    throw std::runtime_error("the motion cannot be integrated beyond " + std::to_string(time_of(y)) +
                             " s of the stretch: " + error.what());
  }
  y = reached.array();
  return arkode_.last_step();
}

}  // namespace hybrid_sphere::solver

#include "cvode_integrator.hpp"

#include <algorithm>
#include <cmath>

#include "hybrid_sphere/geometry/power_of_two.hpp"

namespace hybrid_sphere::solver {

// It is of order 1, a straight line: no longer than the velocity stays the same, within the tolerance, or
// from rest than the way is as small as the tolerance.
double CvodeIntegrator::first_step(const Equations& equations, const State& y, double longest) {
  const Instant now = equations.instant(y);
  const double acceleration = now.forcing.norm() + equations.decays();
  const double speed = std::max(now.velocity.norm(), equations.is_dry() ? equations.pace(y) : 0);
  if (acceleration == 0) return longest;
  if (speed == 0) return std::sqrt(tolerance_) * longest;
  return std::min(longest, tolerance_ * speed / acceleration / equations.pace(y));
}

void CvodeIntegrator::begin(const Equations& equations, Node& first, const State& /*scale*/,
                            double first_step) {
  problem_.equations = &equations;
  restart(first.y, first_step);
}

// The 12th power of a step has to be a number, in x's unit: it may grow by 2^160. Beside a slip of 1e-50 m/s
// steps begin with 1e-60 s.
void CvodeIntegrator::restart(const State& y, double first_step) {
  problem_.unit = geometry::power_of_two(first_step * largest_step);
  cvode_.begin(problem_, y.matrix(), first_step / problem_.unit);
}

Node CvodeIntegrator::step(Node& from, const State& scale) {
  problem_.allowed_speed_error = tolerance_ * scale[4];
  cvode_.set_tolerances(tolerance_ * scale.matrix());
  Eigen::Matrix<double, State::RowsAtCompileTime, 1> reached;
  cvode_.step(reached);
  const double step = cvode_.last_step();
  from.step = step * problem_.unit;
  Node to;
  to.y = reached.array();
  cvode_.derivatives(derivatives_);
  to.shape.reserve(derivatives_.size());
  double power = 1;
  for (const Eigen::VectorXd& derivative : derivatives_) {
    power *= step;
    to.shape.push_back(power * derivative.array());
  }
  if (to.shape.size() < 4) to.shape = cubic(from, to);
  if (step > largest_step) restart(to.y, from.step);
  return to;
}

// A polynomial of low order has not even the slopes of the equations at its ends, so that nothing on a scale
// that is small beside the step would be right: the cubic with both slopes.
std::vector<State> CvodeIntegrator::cubic(const Node& from, const Node& to) {
  const State first = from.step * problem_.equations->derivative(from.y);
  const State last = from.step * problem_.equations->derivative(to.y);
  evaluations_ += 2;
  const State mean = to.y - from.y;
  return {first, State(2 * (3 * mean - 2 * first - last)), State(6 * (first + last - 2 * mean))};
}

namespace {

/// What a polynomial with these derivatives at 0 grows by until s.
State growth(const std::vector<State>& derivatives, double s) {
  State sum = State::Zero();
  for (std::size_t k = derivatives.size(); k-- > 0;) {
    sum = (derivatives[k] + sum) * (s / static_cast<double>(k + 1));
  }
  return sum;
}

}  // namespace

// From the earlier node, so that little is lost near it however long the step. The polynomial is off the
// nodes by part of the step's error, which is made up for smoothly.
State CvodeIntegrator::interpolate(Node& from, const Node& to, double x) {
  const double s = x / from.step;
  const State missing = to.y - from.y - growth(to.shape, 1);
  return from.y + growth(to.shape, s) + s * s * (3 - 2 * s) * missing;
}

}  // namespace hybrid_sphere::solver

#include "cvode_method.hpp"

#include <algorithm>
#include <cmath>

namespace hybrid_sphere::solver {

// It is of order 1, a straight line: no longer than the velocity stays the same, within the tolerance, or
// from rest than the way is as small as the tolerance.
double CvodeMethod::first_step(const Equations& equations, const State& y, double longest) {
  const Instant now = equations.instant(y);
  const double acceleration = now.forcing.norm() + equations.decays();
  const double speed = std::max(now.velocity.norm(), equations.is_dry() ? equations.pace(y) : 0);
  if (acceleration == 0) return longest;
  if (speed == 0) return std::sqrt(tolerance_) * longest;
  return std::min(longest, tolerance_ * speed / acceleration / equations.pace(y));
}

void CvodeMethod::begin(const Equations& equations, Node& first, const State& /*scale*/, double first_step) {
  problem_.equations = &equations;
  cvode_.begin(problem_, first.y.matrix(), first_step);
}

Node CvodeMethod::advance(Node& from, const State& scale) {
  problem_.allowed_speed_error = tolerance_ * scale[4];
  cvode_.set_tolerances(tolerance_ * scale.matrix());
  Eigen::Matrix<double, State::RowsAtCompileTime, 1> reached;
  cvode_.advance(reached);
  from.step = cvode_.last_step();
  Node to;
  to.y = reached.array();
  cvode_.derivatives(derivatives_);
  to.shape.reserve(derivatives_.size());
  for (const Eigen::VectorXd& derivative : derivatives_) to.shape.push_back(derivative.array());
  if (to.shape.size() < 4) to.shape = cubic(from, to);
  return to;
}

// A polynomial of low order has not even the slopes of the equations at its ends, so that nothing on a scale
// that is small beside the step would be right: the cubic with both slopes.
std::vector<State> CvodeMethod::cubic(const Node& from, const Node& to) {
  const double h = from.step;
  const State first = problem_.equations->derivative(from.y);
  const State last = problem_.equations->derivative(to.y);
  evaluations_ += 2;
  const State mean = (to.y - from.y) / h;
  return {first, State(2 / h * (3 * mean - 2 * first - last)),
          State(6 / (h * h) * (first + last - 2 * mean))};
}

namespace {

/// What a polynomial with these derivatives grows by over a length x.
State growth(const std::vector<State>& derivatives, double x) {
  State sum = State::Zero();
  for (std::size_t k = derivatives.size(); k-- > 0;) {
    sum = (derivatives[k] + sum) * (x / static_cast<double>(k + 1));
  }
  return sum;
}

}  // namespace

// From the earlier node, so that little is lost near it however long the step. The polynomial is off the
// nodes by part of the step's error, which is made up for smoothly.
State CvodeMethod::between(Node& from, const Node& to, double x) {
  const double s = x / from.step;
  const State missing = to.y - from.y - growth(to.shape, from.step);
  return from.y + growth(to.shape, x) + s * s * (3 - 2 * s) * missing;
}

}  // namespace hybrid_sphere::solver

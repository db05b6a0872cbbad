#include "cvode_method.hpp"

#include <algorithm>
#include <limits>

namespace hybrid_sphere::solver {

namespace {

// The first step is of order 1: the velocity is a constant in it, whose error has to be allowed at once, and
// not only after the way of a long step.
double turning_step(const Equations& equations, const State& y, double tolerance) {
  constexpr double share = 100;  // of the accuracy, in tolerances
  const Instant now = equations.instant(y);
  const double acceleration = now.forcing.norm() + equations.decay();
  const double speed = std::max(now.velocity.norm(), equations.is_dry() ? equations.pace(y) : 0);
  if (acceleration == 0 || speed == 0) return std::numeric_limits<double>::max();
  return share * tolerance * speed / acceleration / equations.pace(y);
}

}  // namespace

void CvodeMethod::begin(const Equations& equations, Node& first, const State& scale, double first_step) {
  problem_.equations = &equations;
  problem_.allowed_speed_error = tolerance_ * scale[4];
  cvode_.set_tolerances(tolerance_ * scale.matrix());
  cvode_.begin(problem_, first.y.matrix(),
               std::min(first_step, turning_step(equations, first.y, tolerance_)));
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
  for (const Eigen::VectorXd& derivative : derivatives_) to.shape.push_back(derivative.array());
  return to;
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
State CvodeMethod::between(const Node& from, const Node& to, double x) {
  const double s = x / from.step;
  const State missing = to.y - from.y - growth(to.shape, from.step);
  return from.y + growth(to.shape, x) + s * s * (3 - 2 * s) * missing;
}

}  // namespace hybrid_sphere::solver

#include "integration/cvode_integrator.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "integration/integrators.hpp"
#include "integration/power_of_two.hpp"

namespace hybrid_sphere::integration {

namespace {

/// What a polynomial with these derivatives at 0 grows by until s.
FlowState growth(const std::vector<FlowState>& derivatives, double s) {
  FlowState sum = FlowState::Zero();
  for (std::size_t k = derivatives.size(); k-- > 0;) {
    sum = (derivatives[k] + sum) * (s / static_cast<double>(k + 1));
  }
  return sum;
}

/// The slope of a polynomial with these derivatives at 0, at 1.
FlowState last_slope(const std::vector<FlowState>& derivatives) {
  FlowState sum = FlowState::Zero();
  for (std::size_t k = derivatives.size(); k-- > 0;) sum = derivatives[k] + sum / static_cast<double>(k + 1);
  return sum;
}

/// Whether two polynomials have the same slopes at both ends, but for what a step may err by.
bool slopes_agree(const std::vector<FlowState>& a, const std::vector<FlowState>& b,
                  const FlowState& tolerance) {
  constexpr double many = 16;
  return ((a.front() - b.front()).abs() <= many * tolerance).all() &&
         ((last_slope(a) - last_slope(b)).abs() <= many * tolerance).all();
}

}  // namespace

double CvodeIntegrator::first_step(const Flow& flow, const FlowState& y, double longest) {
  return flow.first_step(y, tolerance_, longest);
}

void CvodeIntegrator::begin(const Flow& flow, Node& first, const FlowState& /*scale*/, double first_step) {
  problem_.flow = &flow;
  restart(first.y, first_step);
}

// The 12th power of a step has to be a number, in x's unit: it may grow by 2^160. Beside a slip of 1e-50 m/s
// steps begin with 1e-60 s.
void CvodeIntegrator::restart(const FlowState& y, double first_step) {
  problem_.unit = power_of_two(first_step * largest_step);
  cvode_.begin(problem_, y.matrix(), first_step / problem_.unit);
}

Node CvodeIntegrator::step(Node& from, const FlowState& scale) {
  problem_.allowed_speed_error = tolerance_ * scale[4];
  cvode_.set_tolerances(tolerance_ * scale.matrix());
  Eigen::Matrix<double, FlowState::RowsAtCompileTime, 1> reached;
  cvode_.step(reached);
  const double step = cvode_.last_step();
  from.step = step * problem_.unit;
  Node to;
  to.y = reached.array();
  cvode_.derivatives(derivatives_);
  from.shape.clear();
  from.shape.reserve(derivatives_.size());
  double power = 1;
  for (const Eigen::VectorXd& derivative : derivatives_) {
    power *= step;
    from.shape.push_back(power * derivative.array());
  }
  if (from.shape.size() < 4) {
    std::vector<FlowState> shape = cubic(from, to);
    if (slopes_agree(shape, from.shape, tolerance_ * scale)) from.shape = std::move(shape);
  }
  if (step > largest_step) restart(to.y, from.step);
  return to;
}

// A polynomial of low order has not even the slopes of the equations at its ends, so that nothing on a scale
// that is small beside the step would be right: the cubic with both slopes, unless these show the rounding of
// the state, as where the equations are stiff.
std::vector<FlowState> CvodeIntegrator::cubic(const Node& from, const Node& to) {
  const FlowState first = from.step * problem_.flow->derivative(from.y);
  const FlowState last = from.step * problem_.flow->derivative(to.y);
  evaluations_ += 2;
  const FlowState mean = to.y - from.y;
  return {first, FlowState(2 * (3 * mean - 2 * first - last)), FlowState(6 * (first + last - 2 * mean))};
}

// From the earlier node, so that little is lost near it however long the step. The polynomial is off the
// nodes by part of the step's error, which is made up for smoothly.
FlowState CvodeIntegrator::interpolate(Node& from, const Node& to, double x) {
  const double s = x / from.step;
  const FlowState missing = to.y - from.y - growth(from.shape, 1);
  return from.y + growth(from.shape, s) + s * s * (3 - 2 * s) * missing;
}

std::unique_ptr<Integrator> make_cvode(Cvode::Formula formula, double tolerance) {
  return std::make_unique<CvodeIntegrator>(formula, tolerance);
}

}  // namespace hybrid_sphere::integration

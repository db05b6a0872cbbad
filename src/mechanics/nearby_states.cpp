#include "mechanics/nearby_states.hpp"

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <vector>

#include "mechanics/extrapolated_derivative.hpp"

namespace hybrid_sphere::mechanics {
namespace {

/// The longest step along a direction: each component changes by an eighth of itself, or of 1, at most.
double longest_step(const Vector& x, const Vector& direction) {
  double steepest = 0;
  for (Index i = 0; i < x.size(); ++i) {
    steepest = std::max(steepest, std::abs(direction[i]) / step_size_of(x[i]));
  }
  return steepest > 0 ? 1 / steepest : 1;
}

Matrix directions_at(const EquationsOfMotion& equations, const Vector& q) {
  const Index size = equations.velocities();
  Matrix directions(equations.coordinates(), size);
  Vector unit = Vector::Zero(size);
  Vector rate;
  for (Index i = 0; i < size; ++i) {
    unit[i] = 1;
    equations.rate(q, unit, rate);
    directions.col(i) = rate;
    unit[i] = 0;
  }
  return directions;
}

}  // namespace

NearbyStates::NearbyStates(const Model& model, const State& state)
    : time_(state.time), motion_(model), constraints_(model), q_(state.q), v_(state.v) {
  motion_.set_active(state.active, state.sliding);
  constraints_.set(state.active);
  motion_.evaluate_stage(time_, q_, v_);
}

void NearbyStates::move_to(const Vector& q, const Vector& v) {
  q_ = q;
  v_ = v;
  motion_.project(time_, q_, v_);
  motion_.evaluate_stage(time_, q_, v_);
}

Matrix NearbyStates::directions() const { return directions_at(*motion_.model().equations, q_); }

Matrix NearbyStates::directions_rate() const {
  const Vector rate = motion_.terms().rate;
  const auto along = [&](double h) {
    const Matrix there = directions_at(*motion_.model().equations, q_ + h * rate);
    return Vector(there.reshaped());
  };
  return derivative(along, longest_step(q_, rate)).reshaped(q_.size(), v_.size());
}

Vector NearbyStates::change_of_rate(const Vector& direction) {
  const Vector q = q_;
  const Vector v = v_;
  Vector x(q.size() + v.size());
  x << q, v;
  const auto along = [&](double h) {
    move_to(q + h * direction.head(q.size()), v + h * direction.tail(v.size()));
    Vector rate(x.size());
    rate << motion_.terms().rate, motion_.acceleration();
    return rate;
  };
  const Vector change = derivative(along, longest_step(x, direction), roundoff_of_rate());
  move_to(q, v);
  return change;
}

/// Components that are sums of larger terms have the round-off of these.
Vector NearbyStates::roundoff_of_rate() const {
  constexpr double velocity_roundoff = 64 * DBL_EPSILON;  // of a projection onto some ten constraints
  const Vector& rate = motion_.terms().rate;
  Vector roundoff(rate.size() + v_.size());
  roundoff << Vector::Constant(rate.size(), velocity_roundoff * rate.lpNorm<Eigen::Infinity>()),
      motion_.acceleration_rounding() * weights().cwiseInverse();
  return roundoff;
}

Vector NearbyStates::constraints_at(const Vector& q) {
  Vector value;
  Matrix gradient;
  constraints_.evaluate(time_, q, v_, value, gradient);
  Vector both = Vector::Zero(2 * value.size());
  both.tail(value.size()) = value;
  Vector position;
  Index row = 0;
  for (const std::size_t i : constraints_.active()) {
    const ConstraintFunction& function = *motion_.model().constraints[i].function;
    if (function.has_position()) {
      function.position(time_, q, position);
      both.segment(row, function.size()) = position;
    }
    row += function.size();
  }
  return both;
}

Matrix NearbyStates::changes_of_constraints(const Matrix& directions) {
  Matrix changes(2 * constraints_.size(), directions.cols());
  // Rounding of sums whose terms may cancel.
  const Matrix gradient = 4 * DBL_EPSILON * motion_.gradient().cwiseAbs();
  Vector roundoff(2 * constraints_.size());
  roundoff << gradient.rowwise().sum() * std::max(1.0, q_.lpNorm<Eigen::Infinity>()),
      gradient * v_.cwiseAbs();
  for (Index i = 0; i < directions.cols() && changes.rows() > 0; ++i) {
    const Vector direction = directions.col(i);
    const auto along = [&](double h) { return constraints_at(q_ + h * direction); };
    changes.col(i) = derivative(along, longest_step(q_, direction), roundoff);
  }
  return changes;
}

double NearbyStates::size_of_acceleration() const {
  constexpr double roundings = 8 * DBL_EPSILON;  // of acceleration_rounding(), which counts forces twice
  return motion_.acceleration_rounding() / roundings;
}

Vector NearbyStates::weights() const {
  Vector weights = motion_.terms().mass.diagonal();
  for (Index i = 0; i < weights.size(); ++i) weights[i] = weights[i] > 0 ? std::sqrt(weights[i]) : 1;
  return weights;
}

}  // namespace hybrid_sphere::mechanics

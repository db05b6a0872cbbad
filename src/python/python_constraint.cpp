#include "python/python_constraint.hpp"

#include <cmath>

#include "hybrid_sphere/mechanics/user_function.hpp"

namespace hybrid_sphere::python {
namespace {

namespace py = pybind11;
using mechanics::ConstraintTerms;
using mechanics::is_finite;
using mechanics::Matrix;

void set_one(Index i, double* slopes) { slopes[i] = 1; }

Vector values_of(const Results& results) {
  Vector values(results.size());
  for (Index i = 0; i < values.size(); ++i) values[i] = results[i].value;
  return values;
}

}  // namespace

Index PythonConstraint::count(double t, const Vector& q, const Vector& v) const {
  const py::gil_scoped_acquire lock;
  return function_(PythonFunction::any_size, {}, number(t, {}), numbers(q), numbers(v)).size();
}

/// Directions: the velocities, and the motion.
void PythonConstraint::evaluate(double t, const Vector& q, const Vector& v, const Vector& rate,
                                ConstraintTerms& terms) const {
  const py::gil_scoped_acquire lock;
  const auto n = static_cast<int>(v.size());
  const NumberShape shape{n + 1, 0};
  const py::object coordinates = numbers(q, shape, [&](Index i, double* slopes) { slopes[n] = rate[i]; });
  const Results f = function_(size(), shape, number(t, shape, n), coordinates, numbers(v, shape, set_one));
  terms.value = values_of(f);
  terms.gradient.resize(size(), n);
  terms.gamma.resize(size());
  for (Index i = 0; i < size(); ++i) {
    for (int j = 0; j < n; ++j) terms.gradient(i, j) = f[i].slope(j);
    terms.gamma[i] = -f[i].slope(n);
  }
  function_.check_derivative(is_finite(terms.gradient) && is_finite(terms.gamma));
}

void PythonConstraint::evaluate(double t, const Vector& q, const Vector& v, Vector& value,
                                Matrix& gradient) const {
  const py::gil_scoped_acquire lock;
  const auto n = static_cast<int>(v.size());
  const NumberShape shape{n, 0};
  const Results f = function_(size(), shape, number(t, {}), numbers(q), numbers(v, shape, set_one));
  value = values_of(f);
  gradient.resize(size(), n);
  for (Index i = 0; i < size(); ++i) {
    for (int j = 0; j < n; ++j) gradient(i, j) = f[i].slope(j);
  }
  function_.check_derivative(is_finite(gradient));
}

void PythonConstraint::add_curvature(double t, const Vector& q, const Vector& v, const Vector& multipliers,
                                     Matrix& sum) const {
  const py::gil_scoped_acquire lock;
  const auto n = static_cast<int>(v.size());
  const NumberShape shape{n, n};
  const Results f = function_(size(), shape, number(t, {}), numbers(q), numbers(v, shape, set_one));
  for (Index beta = 0; beta < size(); ++beta) {
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < n; ++j) sum(i, j) += multipliers[beta] * f[beta].second(i, j);
    }
  }
  function_.check_derivative(is_finite(sum));
}

Index PythonHolonomicConstraint::count(double t, const Vector& q, const Vector& /*v*/) const {
  const py::gil_scoped_acquire lock;
  return function_(PythonFunction::any_size, {}, number(t, {}), numbers(q)).size();
}

void PythonHolonomicConstraint::evaluate(double t, const Vector& q, const Vector& v, const Vector& rate,
                                         ConstraintTerms& terms) const {
  Matrix directions;
  Vector drift;
  equations_->directions(q, v, directions, drift);
  const Slopes slopes = differentiate(t, q);
  terms.value = slopes.place * rate + slopes.time;
  terms.gradient = slopes.place.lazyProduct(directions);
  terms.gamma = -slopes.place * drift - second_rate(t, q, rate);
  function_.check_derivative(is_finite(terms.gradient) && is_finite(terms.gamma));
}

void PythonHolonomicConstraint::evaluate(double t, const Vector& q, const Vector& v, Vector& value,
                                         Matrix& gradient) const {
  Matrix directions;
  Vector drift;
  equations_->directions(q, v, directions, drift);
  const Slopes slopes = differentiate(t, q);
  gradient = slopes.place.lazyProduct(directions);
  value = gradient * v + slopes.time;
  function_.check_derivative(is_finite(gradient) && is_finite(value));
}

void PythonHolonomicConstraint::position(double t, const Vector& q, Vector& value) const {
  const py::gil_scoped_acquire lock;
  value = values_of(function_(size(), {}, number(t, {}), numbers(q)));
}

/// Directions: the coordinates, and the time.
PythonHolonomicConstraint::Slopes PythonHolonomicConstraint::differentiate(double t, const Vector& q) const {
  const py::gil_scoped_acquire lock;
  const auto N = static_cast<int>(q.size());
  const NumberShape shape{N + 1, 0};
  const Results g = function_(size(), shape, number(t, shape, N), numbers(q, shape, set_one));
  Slopes slopes{Matrix(size(), N), Vector(size())};
  for (Index i = 0; i < size(); ++i) {
    for (int j = 0; j < N; ++j) slopes.place(i, j) = g[i].slope(j);
    slopes.time[i] = g[i].slope(N);
  }
  return slopes;
}

/// The second derivative along (1, q').
Vector PythonHolonomicConstraint::second_rate(double t, const Vector& q, const Vector& rate) const {
  const py::gil_scoped_acquire lock;
  const NumberShape shape{1, 1};
  const auto along = [&](Index i, double* slopes) { slopes[0] = rate[i]; };
  const Results g = function_(size(), shape, number(t, shape, 0), numbers(q, shape, along));
  Vector result(size());
  for (Index i = 0; i < size(); ++i) result[i] = g[i].second(0, 0);
  return result;
}

double PythonGuard::value(double t, const Vector& q) const {
  const py::gil_scoped_acquire lock;
  return sign_ * function_(PythonFunction::one, {}, number(t, {}), numbers(q))[0].value;
}

double PythonGuard::rate(double t, const Vector& q, const Vector& q_rate) const {
  const py::gil_scoped_acquire lock;
  const NumberShape shape{1, 0};
  const auto along = [&](Index i, double* slopes) { slopes[0] = q_rate[i]; };
  const double rate =
      function_(PythonFunction::one, shape, number(t, shape, 0), numbers(q, shape, along))[0].slope(0);
  function_.check_derivative(std::isfinite(rate));
  return sign_ * rate;
}

double PythonLoad::value(double t, const Vector& q, const Vector& v) const {
  const py::gil_scoped_acquire lock;
  return function_(PythonFunction::one, {}, t, floats(q), floats(v))[0].value;
}

std::function<double(double, const Vector&, const Vector&)> event_function(PythonFunction function) {
  return [function = std::move(function)](double t, const Vector& q, const Vector& v) {
    const py::gil_scoped_acquire lock;
    return function(PythonFunction::one, {}, t, floats(q), floats(v))[0].value;
  };
}

std::function<Vector(double, const Vector&, const Vector&)> reset_function(PythonFunction function) {
  return [function = std::move(function)](double t, const Vector& q, const Vector& v) {
    const py::gil_scoped_acquire lock;
    return values_of(function(v.size(), {}, t, floats(q), floats(v)));
  };
}

std::function<void(Vector&)> normalize_function(PythonFunction function) {
  return [function = std::move(function)](Vector& q) {
    const py::gil_scoped_acquire lock;
    q = values_of(function(q.size(), {}, floats(q)));
  };
}

}  // namespace hybrid_sphere::python

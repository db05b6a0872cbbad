#include "python/python_equations.hpp"

#include <Eigen/Core>
#include <cfloat>
#include <stdexcept>
#include <utility>

#include "hybrid_sphere/mechanics/user_function.hpp"
#include "mechanics/decompositions/cholesky.hpp"

namespace hybrid_sphere::python {
namespace {

namespace py = pybind11;
using mechanics::is_finite;
using mechanics::Matrix;
using mechanics::MotionTerms;

// Far above rounding, and far below what an invalid function produces, as in mechanics::QuasiVelocities.
constexpr double small = 1e-6;

void check_linear(const KinematicTerms& terms, const Vector& v) {
  const Eigen::VectorXd difference = terms.rate - terms.directions * v;
  const Eigen::VectorXd size = terms.rate.cwiseAbs() + terms.directions.cwiseAbs() * v.cwiseAbs();
  if (is_finite(size) && (difference.cwiseAbs().array() > small * size.array() + DBL_MIN).any()) {
    throw std::invalid_argument("the rate of the coordinates is not linear in the velocities");
  }
}

/// B^+ (change - variation), by least squares.
Matrix coefficients(const Matrix& directions, const Matrix& change, const Matrix& variation) {
  const Matrix brackets = change - variation;
  mechanics::Cholesky cholesky;
  const bool regular = cholesky.compute(directions.transpose().lazyProduct(directions));
  Matrix result = directions.transpose().lazyProduct(brackets);
  cholesky.solve(result);
  mechanics::user_function::check_value(regular && is_finite(result), "inverse of rate");
  if (directions.rows() > directions.cols() &&
      (brackets - directions.lazyProduct(result)).norm() > small * (change.norm() + variation.norm())) {
    throw std::invalid_argument(
        "the directions in which the velocities move the coordinates are not closed under brackets");
  }
  return result;
}

}  // namespace

PythonEquations::PythonEquations(Index coordinates, Index velocities, Functions functions)
    : coordinates_(coordinates),
      velocities_(velocities),
      lagrangian_(std::move(functions.lagrangian)),
      forces_(std::move(functions.forces)),
      rate_(std::move(functions.rate)) {}

/// Directions of L's derivatives: the velocities, the motion, and the columns of B.
void PythonEquations::evaluate(double t, const Vector& q, const Vector& v, MotionTerms& terms) const {
  const py::gil_scoped_acquire lock;
  const auto n = static_cast<int>(velocities_);
  const NumberShape shape{2 * n + 1, n + 1};
  std::optional<KinematicTerms> moving;
  if (rate_) moving = kinematics(q, v);
  const Vector& rate = moving ? moving->rate : v;
  const py::object coordinates = numbers(q, shape, [&](Index i, double* slopes) {
    slopes[n] = rate[i];
    if (moving) {
      for (int j = 0; j < n; ++j) slopes[n + 1 + j] = moving->directions(i, j);
    } else {
      slopes[n + 1 + i] = 1;
    }
  });
  const py::object velocities = numbers(v, shape, [](Index i, double* slopes) { slopes[i] = 1; });
  const Results result =
      lagrangian_(PythonFunction::one, shape, number(t, shape, n), coordinates, velocities);
  terms.lagrangian = result[0].value;
  terms.rate = rate;
  set_momentum(result[0], terms.momentum, terms.mass);
  terms.force.resize(n);
  for (int j = 0; j < n; ++j) terms.force[j] = result[0].slope(n + 1 + j) - result[0].second(n, j);
  lagrangian_.check_derivative(is_finite(terms.momentum) && is_finite(terms.mass) && is_finite(terms.force));
  if (moving) terms.force += moving->brackets.transpose() * terms.momentum;
  add_forces(t, q, v, terms.force);
  lagrangian_.check_derivative(is_finite(terms.force));
}

void PythonEquations::add_forces(double t, const Vector& q, const Vector& v, Vector& sum) const {
  if (!forces_) return;
  const Results forces = (*forces_)(velocities_, {}, t, floats(q), floats(v));
  for (Index j = 0; j < velocities_; ++j) sum[j] += forces[j].value;
}

void PythonEquations::momentum(double t, const Vector& q, const Vector& v, Vector& p, Matrix& mass) const {
  const py::gil_scoped_acquire lock;
  const auto n = static_cast<int>(velocities_);
  const NumberShape shape{n, n};
  const py::object velocities = numbers(v, shape, [](Index i, double* slopes) { slopes[i] = 1; });
  const Results result = lagrangian_(PythonFunction::one, shape, number(t, {}), numbers(q), velocities);
  set_momentum(result[0], p, mass);
  lagrangian_.check_derivative(is_finite(p) && is_finite(mass));
}

void PythonEquations::set_momentum(const Operand& lagrangian, Vector& p, Matrix& mass) const {
  const auto n = static_cast<int>(velocities_);
  p.resize(n);
  mass.resize(n, n);
  for (int i = 0; i < n; ++i) {
    p[i] = lagrangian.slope(i);
    for (int j = 0; j <= i; ++j) mass(i, j) = mass(j, i) = lagrangian.second(i, j);
  }
}

void PythonEquations::rate(const Vector& q, const Vector& v, Vector& rate) const {
  if (!rate_) {
    rate = v;
    return;
  }
  const py::gil_scoped_acquire lock;
  const Results result = (*rate_)(coordinates_, {}, numbers(q), numbers(v));
  rate.resize(coordinates_);
  for (Index i = 0; i < coordinates_; ++i) rate[i] = result[i].value;
}

void PythonEquations::directions(const Vector& q, const Vector& v, Matrix& directions, Vector& drift) const {
  if (!rate_) {
    directions.setIdentity(coordinates_, velocities_);
    drift.setZero(coordinates_);
    return;
  }
  const py::gil_scoped_acquire lock;
  const KinematicTerms terms = kinematics(q, v);
  directions = terms.directions;
  drift = terms.drift;
}

KinematicTerms PythonEquations::kinematics(const Vector& q, const Vector& v) const {
  KinematicTerms terms;
  rate(q, v, terms.rate);
  Matrix change;  // (DB_j) W
  set_directions(q, v, terms, change);
  const Matrix variation = along_directions(q, v, terms.directions);  // (DW) B_j
  rate_->check_derivative(is_finite(terms.directions) && is_finite(change) && is_finite(variation));
  terms.drift = change * v;
  check_linear(terms, v);
  terms.brackets = coefficients(terms.directions, change, variation);
  return terms;
}

/// B into terms, and (DB_j) W of all j. @param terms  with W
void PythonEquations::set_directions(const Vector& q, const Vector& v, KinematicTerms& terms,
                                     Matrix& change) const {
  const auto n = static_cast<int>(velocities_);
  const NumberShape shape{n + 1, n + 1};  // the velocities, and the motion
  const py::object coordinates =
      numbers(q, shape, [&](Index i, double* slopes) { slopes[n] = terms.rate[i]; });
  const py::object velocities = numbers(v, shape, [](Index i, double* slopes) { slopes[i] = 1; });
  const Results result = (*rate_)(coordinates_, shape, coordinates, velocities);
  terms.directions.resize(coordinates_, n);
  change.resize(coordinates_, n);
  for (Index i = 0; i < coordinates_; ++i) {
    for (int j = 0; j < n; ++j) {
      terms.directions(i, j) = result[i].slope(j);
      change(i, j) = result[i].second(n, j);
    }
  }
}

Matrix PythonEquations::along_directions(const Vector& q, const Vector& v, const Matrix& directions) const {
  const auto n = static_cast<int>(velocities_);
  const NumberShape shape{n, 0};
  const py::object coordinates = numbers(q, shape, [&](Index i, double* slopes) {
    for (int j = 0; j < n; ++j) slopes[j] = directions(i, j);
  });
  const Results result = (*rate_)(coordinates_, shape, coordinates, numbers(v));
  Matrix variation(coordinates_, n);
  for (Index i = 0; i < coordinates_; ++i) {
    for (int j = 0; j < n; ++j) variation(i, j) = result[i].slope(j);
  }
  return variation;
}

}  // namespace hybrid_sphere::python

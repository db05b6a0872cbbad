#include "mechanics/consistent_velocities.hpp"

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <stdexcept>

#include "hybrid_sphere/mechanics/solve.hpp"
#include "mechanics/constraint_residual.hpp"
#include "mechanics/decompositions/cholesky.hpp"
#include "mechanics/decompositions/least_norm.hpp"
#include "mechanics/guards.hpp"
#include "mechanics/motion_scale.hpp"
#include "text/refusal.hpp"

namespace hybrid_sphere::mechanics {
namespace {

struct Rows {
  Vector value;
  Matrix gradient;
  std::vector<std::size_t> owners;
};

/// The largest value of a constraint.
double largest_of(const Rows& rows, std::size_t owner) {
  double largest = 0;
  for (Index row = 0; row < rows.value.size(); ++row) {
    if (rows.owners[static_cast<std::size_t>(row)] == owner) {
      largest = std::max(largest, std::abs(rows.value[row]));
    }
  }
  return largest;
}

Rows rows_of(const Model& model, double t, const Vector& q, const Vector& v) {
  Rows rows{Vector(0), Matrix(0, v.size()), {}};
  Vector value;
  Matrix gradient;
  for (std::size_t i = 0; i < model.constraints.size(); ++i) {
    const Constraint& constraint = model.constraints[i];
    if (constraint.unilateral || constraint.friction || !has_held(constraint.schedule, t, q)) continue;
    constraint.function->evaluate(t, q, v, value, gradient);
    const Index before = rows.value.size();
    rows.value.conservativeResize(before + value.size());
    rows.value.tail(value.size()) = value;
    rows.gradient.conservativeResize(before + value.size(), v.size());
    rows.gradient.bottomRows(value.size()) = gradient;
    rows.owners.insert(rows.owners.end(), static_cast<std::size_t>(value.size()), i);
  }
  return rows;
}

void refuse_if_off(const Model& model, double t, const Vector& q, const Rows& rows, const Vector& v) {
  const Vector speeds = sizes_at_start(model, t, q, v, 0).v;
  for (Index row = 0; row < rows.value.size(); ++row) {
    const std::size_t owner = rows.owners[static_cast<std::size_t>(row)];
    const bool is_largest = std::abs(rows.value[row]) == largest_of(rows, owner);
    if (!is_largest || relative_velocity(model, {owner}, t, q, v, speeds) <= Options().accuracy) continue;
    throw std::invalid_argument(
        "the velocities given violate constraint " + model.constraints[owner].name + " by " +
        text::shortest(rows.value[row]) +
        ", whatever those of the other bodies are; allowed: velocities that satisfy it");
  }
}

/// Sets components to 0 that are rounding beside what they are with all kinetic energy.
void take_rounding_away(const Matrix& mass, const std::vector<Index>& open, Vector& v) {
  constexpr double roundings = 16 * DBL_EPSILON;
  const double energy = v.dot(mass * v);
  for (const Index i : open) {
    if (mass(i, i) * v[i] * v[i] <= roundings * roundings * energy) v[i] = 0;
  }
}

}  // namespace

Vector consistent_velocities(const Model& model, double t, const Vector& q, const Vector& v,
                             const std::vector<bool>& given) {
  std::vector<Index> open;
  for (Index i = 0; i < v.size(); ++i) {
    if (!given[static_cast<std::size_t>(i)]) open.push_back(i);
  }
  Vector result = v;
  Rows rows = rows_of(model, t, q, result);
  if (!open.empty() && rows.value.size() > 0) {
    Vector momentum;
    Matrix mass;
    model.equations->momentum(t, q, v, momentum, mass);
    // Of the others: v = L^-T y, with the kinetic energy |y|^2 / 2.
    const auto count = static_cast<Index>(open.size());
    Matrix open_mass(count, count);
    Matrix scaled(count, rows.gradient.rows());
    for (Index j = 0; j < count; ++j) {
      const Index s = open[static_cast<std::size_t>(j)];
      for (Index i = 0; i < count; ++i) open_mass(i, j) = mass(open[static_cast<std::size_t>(i)], s);
      for (Index b = 0; b < scaled.cols(); ++b) scaled(j, b) = rows.gradient(b, s);
    }
    const Cholesky cholesky(open_mass);
    cholesky.solve_l(scaled);
    const LeastNorm equations(scaled.transpose());
    constexpr int refinements = 3;
    for (int k = 0; k < refinements; ++k) {
      Vector change = equations.solve(rows.value);
      cholesky.solve_l_transposed(change);
      for (Index j = 0; j < change.size(); ++j) result[open[static_cast<std::size_t>(j)]] -= change[j];
      take_rounding_away(mass, open, result);
      rows = rows_of(model, t, q, result);
    }
  }
  refuse_if_off(model, t, q, rows, result);
  return result;
}

}  // namespace hybrid_sphere::mechanics

#include "mechanics/constraint_residual.hpp"

#include <algorithm>
#include <cfloat>
#include <cmath>

namespace hybrid_sphere::mechanics {
namespace {

constexpr double argument_roundoff = 4 * DBL_EPSILON;  // of t and of a coordinate: four operations

// Below, a double has lost digits.
constexpr double smallest_accurate = DBL_MIN / DBL_EPSILON;

// A residual of this part of its terms is not examined further: it is smaller than any tolerance.
constexpr double negligible_residual = 16 * DBL_EPSILON;

/// Adds the change of the values by a changed argument; none where the functions are not finite there.
template <class Function>
void add_change(const Function& function, const Vector& before, Vector& sum) {
  Vector after;
  try {
    function(after);
  } catch (const NotFinite&) {
    return;
  }
  if (after.allFinite()) sum += (after - before).cwiseAbs();
}

/// The change of f by the round-off of t and of each coordinate, summed.
Vector roundoff_of_velocity(const ConstraintFunction& function, double t, const Vector& q, const Vector& v,
                            const Vector& value) {
  Vector sum = Vector::Zero(value.size());
  Vector at = q;
  Matrix gradient;
  const auto of_time = [&](Vector& f) {
    function.evaluate(t + argument_roundoff * std::abs(t), q, v, f, gradient);
  };
  const auto of_position = [&](Vector& f) { function.evaluate(t, at, v, f, gradient); };
  add_change(of_time, value, sum);
  for (Index i = 0; i < q.size(); ++i) {
    at[i] += argument_roundoff * std::abs(q[i]);
    add_change(of_position, value, sum);
    at[i] = q[i];
  }
  return sum;
}

/// The largest abs(value) beyond its round-off, relative to its size.
double largest_relative(const Vector& values, const Vector& roundoff, const Vector& sizes) {
  double largest = 0;
  for (Index b = 0; b < values.size(); ++b) {
    const double value = std::abs(values[b]);
    if (value <= std::max(roundoff[b], smallest_accurate)) continue;
    largest = std::max(largest, (value - roundoff[b]) / sizes[b]);
  }
  return largest;
}

/// Whether all values are round-off of their sizes.
bool are_negligible(const Vector& values, const Vector& sizes) {
  return (values.array().abs() <= negligible_residual * sizes.array()).all();
}

}  // namespace

double relative_velocity(const Model& model, const ActiveSet& active, double t, const Vector& q,
                         const Vector& v, const Vector& speeds) {
  Vector value;
  Matrix gradient;
  double largest = 0;
  for (const std::size_t i : active) {
    const Constraint& constraint = model.constraints[i];
    constraint.function->evaluate(t, q, v, value, gradient);
    if (!(value.allFinite() && gradient.allFinite())) throw NotFinite("constraint " + constraint.name);
    const Vector sizes = gradient.cwiseAbs() * speeds;
    Vector roundoff = Vector::Zero(value.size());
    if (!are_negligible(value, sizes)) roundoff = roundoff_of_velocity(*constraint.function, t, q, v, value);
    largest = std::max(largest, largest_relative(value, roundoff, sizes));
  }
  return largest;
}

double relative_position(const Constraint& constraint, double t, const Vector& q, const Vector& v,
                         const Vector& sizes) {
  const ConstraintFunction& function = *constraint.function;
  if (!function.has_position()) return 0;
  Vector position;
  function.position(t, q, position);
  if (!position.allFinite()) throw NotFinite("position of constraint " + constraint.name);
  Vector direction = Vector::Zero(q.size());
  ConstraintTerms at_rest;
  ConstraintTerms moving;
  function.evaluate(t, q, v, direction, at_rest);
  Vector size = Vector::Zero(position.size());
  // Coordinates that are 0 up to the round-off of the others satisfy constraints to that round-off alone.
  const double largest_roundoff = residual_roundoff * sizes.maxCoeff();
  Vector roundoff = Vector::Zero(position.size());
  for (Index i = 0; i < q.size(); ++i) {
    direction[i] = 1;
    function.evaluate(t, q, v, direction, moving);
    const Vector slope = (moving.value - at_rest.value).cwiseAbs();
    size += slope * sizes[i];
    roundoff += slope * largest_roundoff;
    direction[i] = 0;
  }
  const auto of_time = [&](Vector& g) { function.position(t + argument_roundoff * std::abs(t), q, g); };
  if (!are_negligible(position, size)) add_change(of_time, position, roundoff);
  return largest_relative(position, roundoff, size);
}

}  // namespace hybrid_sphere::mechanics

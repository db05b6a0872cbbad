#include "mechanics/indeterminate_reactions.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "mechanics/decompositions/right_singular_vectors.hpp"
#include "mechanics/linear_complementarity.hpp"
#include "mechanics/sliding_friction.hpp"

namespace hybrid_sphere::mechanics {
namespace {

/// Conditions rows x + constants >= 0.
struct Limits {
  Matrix rows;
  Vector constants;
};

Index row_of(const Model& model, const ActiveSet& active, std::size_t constraint) {
  Index row = 0;
  for (const std::size_t i : active) {
    if (i == constraint) return row;
    row += model.constraints[i].function->size();
  }
  return -1;
}

Limits limits_of(const Model& model, const ActiveSet& active, double t, const Vector& q, const Vector& v,
                 Index functions) {
  std::vector<Vector> rows;
  std::vector<double> constants;
  const auto unit = [functions](Index row) -> Vector { return Vector::Unit(functions, row); };
  for (const std::size_t i : active) {
    const Constraint& constraint = model.constraints[i];
    const Index row = row_of(model, active, i);
    if (constraint.unilateral) {
      rows.push_back(unit(row));
      constants.push_back(0);
    }
    if (!constraint.friction) continue;
    const Friction& friction = *constraint.friction;
    const Index contact = friction.contact ? row_of(model, active, *friction.contact) : -1;
    const double known =
        friction.contact ? 0 : friction.coefficient * load_of(model, friction, t, q, v, Vector());
    for (const double side : {-1.0, 1.0}) {
      Vector limit = side * unit(row);
      if (contact >= 0) limit[contact] += friction.coefficient;
      rows.push_back(std::move(limit));
      constants.push_back(known);
    }
  }
  Limits limits{Matrix(Index(rows.size()), functions), Vector(Index(rows.size()))};
  for (std::size_t k = 0; k < rows.size(); ++k) {
    limits.rows.row(Index(k)) = rows[k].transpose();
    limits.constants[Index(k)] = constants[k];
  }
  return limits;
}

/// Reactions without effect, each a column, in units in which all directions have the same length.
Matrix reactions_without_effect(const Matrix& directions, Index rank, const Vector& units) {
  Matrix scaled = directions * units.asDiagonal();
  for (Index s = 0; s < scaled.rows(); ++s) {
    const double size = scaled.row(s).cwiseAbs().maxCoeff();
    if (size > 0) scaled.row(s) /= size;
  }
  return right_singular_vectors(scaled).rightCols(directions.cols() - rank);
}

// How far inside of the conditions: on their edge rounding would decide.
constexpr double inside = 0.1;

/// A small y well inside of slopes y + constants >= 0; where there is none, the one that misses least.
double inside_interval(const Limits& limits) {
  const Vector slopes = limits.rows.col(0);
  const Vector& constants = limits.constants;
  constexpr double infinity = std::numeric_limits<double>::infinity();
  double low = -infinity;
  double high = infinity;
  double weight_low = 1;
  double weight_high = 1;
  for (Index k = 0; k < slopes.size(); ++k) {
    const double zero = -constants[k] / slopes[k];
    if (slopes[k] > 0 && zero > low) {
      low = zero;
      weight_low = slopes[k];
    } else if (slopes[k] < 0 && zero < high) {
      high = zero;
      weight_high = -slopes[k];
    }
  }
  if (low > high) return (weight_low * low + weight_high * high) / (weight_low + weight_high);
  if (!std::isfinite(low) && !std::isfinite(high)) return 0;
  const bool is_bounded = std::isfinite(low) && std::isfinite(high);
  const double away = inside * (is_bounded ? high - low : std::abs(std::isfinite(low) ? low : high));
  return std::clamp(0.0, low + away, high - away);
}

/// The y nearest to 0 that is as well inside of rows y + constants >= 0 as one is found; none: there is none.
/// It is the nearest point of a polyhedron, whose sides have multipliers complementary to the conditions.
std::optional<Vector> inside_polyhedron(const Limits& limits) {
  constexpr double least = 1e-9;
  const double size = limits.constants.lpNorm<Eigen::Infinity>();
  if (size == 0) return Vector(Vector::Zero(limits.rows.cols()));
  const Matrix products = limits.rows * limits.rows.transpose();
  for (double away = inside; away > least; away *= inside) {
    const Vector moved = (limits.constants / size).array() - away;
    const std::optional<Vector> sides = solve_complementarity(products, moved);
    if (sides) return Vector(size * (limits.rows.transpose() * *sides));
  }
  return std::nullopt;
}

/// The limits as conditions on y, lambda + units free y; without those that y hardly touches, which rounding
/// alone would let it.
Limits limits_along(const Limits& limits, const Vector& lambda, const Vector& units, const Matrix& free) {
  constexpr double hardly = 1e-9;
  const Matrix scaled = limits.rows * units.asDiagonal();
  const Vector now = limits.rows * lambda + limits.constants;
  Limits along{Matrix(scaled.rows(), free.cols()), Vector(scaled.rows())};
  Index kept = 0;
  for (Index k = 0; k < scaled.rows(); ++k) {
    const double size = scaled.row(k).norm();
    along.rows.row(kept) = scaled.row(k) * free / size;
    along.constants[kept] = now[k] / size;
    if (along.rows.row(kept).norm() > hardly) ++kept;
  }
  along.rows.conservativeResize(kept, free.cols());
  along.constants.conservativeResize(kept);
  return along;
}

}  // namespace

Vector within_limits(const Model& model, const ActiveSet& active, double t, const Vector& q, const Vector& v,
                     const Matrix& directions, Index rank, const Vector& lambda) {
  if (rank >= lambda.size()) return lambda;
  Vector units = directions.colwise().norm().transpose();
  units = (units.array() > 0).select(units.cwiseInverse(), 1.0);
  const Matrix free = reactions_without_effect(directions, rank, units);
  const Limits limits = limits_along(limits_of(model, active, t, q, v, lambda.size()), lambda, units, free);
  if (limits.constants.size() == 0) return lambda;
  const std::optional<Vector> change =
      free.cols() == 1 ? Vector(Vector::Constant(1, inside_interval(limits))) : inside_polyhedron(limits);
  if (!change || !change->allFinite()) return lambda;
  return lambda + units.cwiseProduct(free * *change);
}

}  // namespace hybrid_sphere::mechanics

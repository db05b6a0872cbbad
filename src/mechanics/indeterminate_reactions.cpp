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

/// abs(x) <= radius of the reactions x of a friction, as conditions x e <= radius on one side each.
struct Tangent {
  std::size_t friction;
  Eigen::Vector2d e;
};
using Tangents = std::vector<Tangent>;

/// Both sides of a friction of one function; of two, eight of the circle's.
Tangents first_tangents(const Model& model, const ActiveSet& active) {
  constexpr int sides = 8;
  constexpr double round = 6.283185307179586;
  Tangents tangents;
  for (const std::size_t i : active) {
    if (!model.constraints[i].friction) continue;
    const int count = model.constraints[i].function->size() == 1 ? 2 : sides;
    for (int k = 0; k < count; ++k) {
      const double angle = round * k / count;
      tangents.push_back({i, {std::cos(angle), std::sin(angle)}});
    }
  }
  return tangents;
}

/// The limit of abs(lambda) of a friction.
struct Radius {
  Index contact;       // row whose multiplier counts; -1: none
  double coefficient;  // by which it counts
  double known;
  double at(const Vector& lambda) const { return known + (contact >= 0 ? coefficient * lambda[contact] : 0); }
};

Radius radius_of(const Model& model, const ActiveSet& active, std::size_t i, double t, const Vector& q,
                 const Vector& v) {
  const Friction& friction = *model.constraints[i].friction;
  const double mu = friction.of_sticking();
  if (friction.contact) return {row_of(model, active, *friction.contact), mu, 0};
  return {-1, mu, mu * load_of(model, friction, t, q, v, Vector())};
}

/// Adds tangents where those of a circle say that a reaction is further inside of it, or less far outside,
/// than it is, by half. @return  whether there are any
bool add_tangents(const Model& model, const ActiveSet& active, double t, const Vector& q, const Vector& v,
                  const Vector& lambda, Tangents& tangents) {
  constexpr double rounding = 1e-13;
  const Tangents known = tangents;
  for (const std::size_t i : active) {
    if (!model.constraints[i].friction || model.constraints[i].function->size() == 1) continue;
    const Eigen::Vector2d reaction = lambda.segment<2>(row_of(model, active, i));
    const double most = std::max(0.0, radius_of(model, active, i, t, q, v).at(lambda));
    double left = most;  // up to the nearest tangent
    for (const Tangent& tangent : known) {
      if (tangent.friction == i) left = std::min(left, most - tangent.e.dot(reaction));
    }
    const double off = left - (most - reaction.norm());
    if (off > 0.5 * std::abs(left) + rounding * most) tangents.push_back({i, reaction.normalized()});
  }
  return tangents.size() > known.size();
}

Limits limits_of(const Model& model, const ActiveSet& active, double t, const Vector& q, const Vector& v,
                 Index functions, const Tangents& tangents) {
  std::vector<Vector> rows;
  std::vector<double> constants;
  for (const std::size_t i : active) {
    if (!model.constraints[i].unilateral) continue;
    rows.push_back(Vector::Unit(functions, row_of(model, active, i)));
    constants.push_back(0);
  }
  for (const Tangent& tangent : tangents) {
    const Radius radius = radius_of(model, active, tangent.friction, t, q, v);
    const Index row = row_of(model, active, tangent.friction);
    Vector limit = Vector::Zero(functions);
    const Index size = model.constraints[tangent.friction].function->size();
    limit.segment(row, size) = -tangent.e.head(size);
    if (radius.contact >= 0) limit[radius.contact] += radius.coefficient;
    rows.push_back(std::move(limit));
    constants.push_back(radius.known);
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

/// The y nearest to 0 that is as well inside of rows y + constants >= 0 as one is found, or on their edge, as
/// the reaction of a contact that others relieve is; none: there is none.
/// It is the nearest point of a polyhedron, whose sides have multipliers complementary to the conditions.
std::optional<Vector> inside_polyhedron(const Limits& limits) {
  const double size = limits.constants.lpNorm<Eigen::Infinity>();
  if (size == 0) return Vector(Vector::Zero(limits.rows.cols()));
  const Matrix products = limits.rows * limits.rows.transpose();
  for (const double away : {inside, 1e-2, 1e-4, 1e-6, 1e-8, 1e-10, 1e-12, 0.0}) {
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
  Tangents tangents = first_tangents(model, active);
  constexpr int most = 20;
  Vector moved = lambda;
  for (int i = 0; i < most; ++i) {
    const Limits limits =
        limits_along(limits_of(model, active, t, q, v, lambda.size(), tangents), lambda, units, free);
    if (limits.constants.size() == 0) return lambda;
    const std::optional<Vector> change =
        free.cols() == 1 ? Vector(Vector::Constant(1, inside_interval(limits))) : inside_polyhedron(limits);
    if (!change || !change->allFinite()) return lambda;
    moved = lambda + units.cwiseProduct(free * *change);
    if (!add_tangents(model, active, t, q, v, moved, tangents)) break;
  }
  return moved;
}

}  // namespace hybrid_sphere::mechanics

#include "mechanics/indeterminate_reactions.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "mechanics/active_constraints.hpp"
#include "mechanics/decompositions/pivoted_qr.hpp"
#include "mechanics/inside_cones.hpp"
#include "mechanics/sliding_friction.hpp"

namespace hybrid_sphere::mechanics {
namespace {

Index row_of(const Model& model, const ActiveSet& active, std::size_t constraint) {
  Index row = 0;
  for (const std::size_t i : active) {
    if (i == constraint) return row;
    row += model.constraints[i].function->size();
  }
  return -1;
}

/// The limits of the reactions lambda + F x of one constraint; without a cone for the others.
std::optional<SecondOrderCone> cone_of(const Model& model, const ActiveSet& active, std::size_t i, double t,
                                       const Vector& q, const Vector& v, const Vector& lambda,
                                       const Matrix& F) {
  const Index row = row_of(model, active, i);
  if (model.constraints[i].unilateral)
    return SecondOrderCone{lambda[row], F.row(row).transpose(), Vector(), Matrix(0, F.cols())};
  if (!model.constraints[i].friction) return std::nullopt;
  const Friction& friction = *model.constraints[i].friction;
  const bool is_loaded = !friction.contact || contains(active, *friction.contact);
  if (!is_loaded) return std::nullopt;  // it is made to hold, whatever its load will be
  const double mu = friction.of_sticking();
  const Index size = model.constraints[i].function->size();
  SecondOrderCone cone{0, Vector::Zero(F.cols()), lambda.segment(row, size), F.middleRows(row, size)};
  if (friction.contact) {
    const Index contact = row_of(model, active, *friction.contact);
    cone.u = mu * lambda[contact];
    cone.s = mu * F.row(contact).transpose();
  } else {
    cone.u = mu * load_of(model, friction, t, q, v, Vector());
  }
  return cone;
}

/// Reactions without effect, as orthonormal columns in units in which all directions have the same length.
Matrix reactions_without_effect(const Matrix& directions, Index rank, const Vector& units) {
  Matrix scaled = directions * units.asDiagonal();
  for (Index s = 0; s < scaled.rows(); ++s) {
    const double size = scaled.row(s).cwiseAbs().maxCoeff();
    if (size > 0) scaled.row(s) /= size;
  }
  // The range of its rows comes first in Q, as far as the rank.
  Matrix kernel = Matrix::Zero(directions.cols(), directions.cols() - rank);
  kernel.bottomRows(kernel.cols()).setIdentity();
  PivotedQr(scaled.transpose()).apply_q(kernel);
  return kernel;
}

}  // namespace

Vector within_limits(const Model& model, const ActiveSet& active, double t, const Vector& q, const Vector& v,
                     const Matrix& directions, Index rank, const Vector& lambda) {
  constexpr double hardly = 1e-9;  // of its own unit: rounding alone lets such reactions touch a limit
  if (rank >= lambda.size()) return lambda;
  Vector units = directions.colwise().norm().transpose();
  units = (units.array() > 0).select(units.cwiseInverse(), 1.0);
  const Matrix free = reactions_without_effect(directions, rank, units);
  const Matrix F = units.asDiagonal() * free;
  std::vector<SecondOrderCone> cones;
  double way = 0;  // to the cones
  for (const std::size_t i : active) {
    std::optional<SecondOrderCone> cone = cone_of(model, active, i, t, q, v, lambda, F);
    if (!cone) continue;
    const double effect = std::hypot(cone->s.norm(), cone->B.norm());
    if (!(effect > hardly * units.segment(row_of(model, active, i), 1)[0])) continue;
    *cone = {cone->u / effect, cone->s / effect, cone->w / effect, cone->B / effect};
    way = std::max({way, std::abs(cone->u), cone->w.norm()});
    cones.push_back(*std::move(cone));
  }
  if (way == 0) return lambda;
  for (SecondOrderCone& cone : cones) {
    cone.u /= way;
    cone.w /= way;
  }
  const Vector moved = lambda + way * (F * inside_cones(cones, F.cols()));
  return moved.allFinite() ? moved : lambda;
}

}  // namespace hybrid_sphere::mechanics

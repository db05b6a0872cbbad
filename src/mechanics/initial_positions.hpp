#pragma once

#include <optional>

#include "hybrid_sphere/mechanics/model.hpp"

/// Initial positions that are published or rounded, put onto the constraints: Options::project_positions.
/// Source: docs/theory.md 7.6.
namespace hybrid_sphere::mechanics {

/// The constraints on positions that hold at t: those within their intervals whose guards, if any, are
/// positive, or those that are known to hold. @param known  see Initial::active. Throws NotFinite.
ActiveSet holonomic_at_start(const Model& model, double t, const Vector& q,
                             const std::optional<ActiveSet>& known);

/// Positions with g = 0 for these constraints, at the smallest distance from q in the metric of M, by
/// Newton's method: the displacement w satisfies M w = C^T lambda, as that of an impulse does.
/// @param holding  constraints on positions, not empty
/// @param v        where their gradients are evaluated (n)
/// @param allowed  how far the result may be off them, relative to its size: see relative_position
/// Throws std::invalid_argument, naming the constraints, if the method ends elsewhere, and NotFinite.
Vector positions_on(const Model& model, const ActiveSet& holding, double t, const Vector& q, const Vector& v,
                    double allowed);

}  // namespace hybrid_sphere::mechanics

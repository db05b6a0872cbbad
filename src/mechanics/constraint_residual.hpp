#pragma once

#include "hybrid_sphere/mechanics/model.hpp"

/// How far a state is off its constraints, relative to the scale of the motion. Initial states, the inputs of
/// a plant and the parts of a MultibodySystem are accepted or refused by these numbers alone. Source:
/// docs/theory.md 7.6.
namespace hybrid_sphere::mechanics {

/// A state satisfies its constraints if the numbers below are at most this, or the accuracy if that is
/// larger: the round-off of some hundred operations of a user's function.
constexpr double residual_roundoff = 1e-13;

/// Returns the maximum over the functions of the active constraints of
///   (abs(f) - r) / sum over s of abs(C_s) speeds_s,
/// where r is the change of f by the round-off of t and q; 0 if abs(f) <= r, infinity if only the sum is 0.
/// @param speeds  the scale of the motion's velocities (n): Sizes::v
/// Throws NotFinite, naming the constraint.
double relative_velocity(const Model& model, const ActiveSet& active, double t, const Vector& q,
                         const Vector& v, const Vector& speeds);

/// Returns the maximum over the functions of the constraint of
///   (abs(g) - r) / sum over i of abs(dg/dq_i) sizes_i,
/// where r is the change of g by the round-off of t and of the largest coordinate; 0 for a constraint on
/// velocities alone.
/// @param sizes  the scale of the coordinates (N): Sizes::q
/// Throws NotFinite, naming the constraint.
double relative_position(const Constraint& constraint, double t, const Vector& q, const Vector& v,
                         const Vector& sizes);

}  // namespace hybrid_sphere::mechanics

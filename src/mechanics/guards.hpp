#pragma once

#include "hybrid_sphere/mechanics/model.hpp"

namespace hybrid_sphere::mechanics {

/// -1, 0 or 1: the sign of a guard, 0 if its value can be due to rounding of t and q. Throws NotFinite.
/// @param sizes  of the numbers from which q was computed (N): q carries their rounding
int sign_of(const Guard& guard, double t, const Vector& q, const Vector& sizes);

/// Returns true if a constraint has held since before t: within its interval, and with a positive guard if it
/// has one. Throws NotFinite.
bool has_held(const Schedule& schedule, double t, const Vector& q);

/// Bound on a guard's value that rounding of t and q can cause. @param sizes  as in sign_of
double rounding_of(const Guard& guard, double t, const Vector& q, const Vector& sizes);

/// Its change where all coordinates change by their sizes, to the first order.
double gap_size(const Guard& guard, double t, const Vector& q, const Vector& sizes);

/// The sign of dg/dt along the motion, 0 if it can be due to rounding of the velocities.
/// @param q_rate         q'
/// @param q_rate_before  q' before an impulse, whose rounding q_rate carries
int sign_of_rate(const Guard& guard, double t, const Vector& q, const Vector& q_rate,
                 const Vector& q_rate_before);

/// Whether an impulse changes dg/dt by more than that rounding.
bool changes_rate(const Guard& guard, double t, const Vector& q, const Vector& q_rate,
                  const Vector& q_rate_before);

}  // namespace hybrid_sphere::mechanics

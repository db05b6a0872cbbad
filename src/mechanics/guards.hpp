#pragma once

#include "hybrid_sphere/mechanics/model.hpp"

namespace hybrid_sphere::mechanics {

/// -1, 0 or 1: the sign of a guard, 0 where rounding of t and q can make its value. Throws NotFinite.
/// @param sizes  of the numbers that q was computed from (N): their rounding is in q
int sign_of(const Guard& guard, double t, const Vector& q, const Vector& sizes);

/// What rounding of t and q can make of a guard's value. @param sizes  as in sign_of
double rounding_of(const Guard& guard, double t, const Vector& q, const Vector& sizes);

/// The sign of dg/dt along the motion, 0 where rounding of the velocities can make it.
/// @param q_rate         q'
/// @param q_rate_before  q' before an impulse, whose rounding q_rate has
int sign_of_rate(const Guard& guard, double t, const Vector& q, const Vector& q_rate,
                 const Vector& q_rate_before);

}  // namespace hybrid_sphere::mechanics

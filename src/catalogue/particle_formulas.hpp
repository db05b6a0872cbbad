#pragma once

#include <memory>

#include "catalogue/catalogue.hpp"

/// What the two entries of the nonholonomic particle share: L = m (x'^2 + y'^2 + z'^2)/2 and f = z' - y x'.
namespace hybrid_sphere::mechanics::catalogue::particle {

std::shared_ptr<const EquationsOfMotion> equations_by_hand(double m);
std::shared_ptr<const ConstraintFunction> constraint_by_hand();

/// The velocity after the constraint is applied; y' stays. @param q (3) @param v (3)
Vector after_impulse(const Vector& q, const Vector& v);

/// The motion on f = 0 a while after a state on it. @param start  its multipliers are not read
Known held(double m, const Known& start, double time);

/// m, x, y, z, x_dot, y_dot, z_dot with `between` after m.
std::vector<Parameter> parameters(const Parameter& between, const Initial& as_a_rule);

}  // namespace hybrid_sphere::mechanics::catalogue::particle

#pragma once

#include "hybrid_sphere/mechanics/solution.hpp"
#include "mechanics/contact_rules.hpp"

namespace hybrid_sphere::mechanics {

/// Returns the Switch of a decision at (t, q), without its index and events.
/// @param active  constraints that held before
/// @param v       velocities before
/// Throws NotFinite.
Switch make_switch(const Model& model, const ActiveSet& active, const ContactRules::Decision& decision,
                   double t, const Vector& q, const Vector& v);

}  // namespace hybrid_sphere::mechanics

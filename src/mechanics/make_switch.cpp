#include "mechanics/make_switch.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "hybrid_sphere/numerical_error.hpp"

namespace hybrid_sphere::mechanics {

Switch make_switch(const Model& model, const ActiveSet& active, const ContactRules::Decision& decision,
                   double t, const Vector& q, const Vector& v) {
  const ActiveSet& next = decision.active;
  Switch change;
  change.time = t;
  std::set_difference(next.begin(), next.end(), active.begin(), active.end(),
                      std::back_inserter(change.applied));
  std::set_difference(active.begin(), active.end(), next.begin(), next.end(),
                      std::back_inserter(change.released));
  change.active = next;
  change.sliding = decision.sliding;
  change.q = q;
  change.v_before = v;
  change.v_after = decision.v;
  change.multipliers = decision.multipliers;
  change.impulse = decision.impulse;
  change.rank = decision.rank;
  MotionTerms terms;
  const auto energies = [&](const Vector& velocity, double& energy, double& kinetic) {
    model.equations->evaluate(t, q, velocity, terms);
    energy = velocity.dot(terms.momentum) - terms.lagrangian;
    kinetic = 0.5 * squared_length(terms.mass, velocity);
    if (!(std::isfinite(energy) && std::isfinite(kinetic))) throw NotFinite("the energy");
  };
  energies(change.v_before, change.energy_before, change.kinetic_energy_before);
  energies(change.v_after, change.energy_after, change.kinetic_energy_after);
  return change;
}

}  // namespace hybrid_sphere::mechanics

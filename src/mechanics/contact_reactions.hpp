#pragma once

#include <optional>
#include <vector>

#include "hybrid_sphere/mechanics/equations_of_motion.hpp"

namespace hybrid_sphere::mechanics {

/// The equations of contacts and frictions at one instant: a = W lambda + b along the rows of contacts, then
/// of frictions, in units in which W has diagonals of about 1.
struct ContactEquations {
  Matrix effect;       ///< W
  Vector free;         ///< b
  Index contacts = 0;  ///< rows of contacts
  /// A friction, of one row or two.
  struct Cone {
    Index first = 0;
    Index size = 1;
    Index contact = -1;      ///< the row of the contact that loads it; -1: none
    double coefficient = 0;  ///< mu
    double limit = 0;        ///< of its reaction besides mu N
  };
  std::vector<Cone> cones{};
};

struct ContactReactions {
  Vector reactions;      ///< lambda
  Vector accelerations;  ///< a
  Vector slips;          ///< abs(a) of each friction that slides; 0: it does not
};

/// The reactions with
///   lambda >= 0,  a >= 0,  lambda a = 0                                  along each contact,
///   a = 0 where abs(lambda) < mu N + limit, else lambda = -(mu N + limit) a/abs(a)   of each friction.
/// None where none are found. Source: docs/theory.md 7.8. Throws Interrupted.
std::optional<ContactReactions> solve_contacts(const ContactEquations& equations);

}  // namespace hybrid_sphere::mechanics

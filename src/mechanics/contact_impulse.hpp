#pragma once

#include <vector>

#include "hybrid_sphere/mechanics/model.hpp"
#include "mechanics/contact_rows.hpp"

namespace hybrid_sphere::mechanics {

/// The impulse where bodies meet, with frictions and by Poisson's hypothesis. Source: docs/theory.md 7.8.
class ContactImpulse {
 public:
  /// @param model  must outlive this object
  explicit ContactImpulse(const Model& model);

  struct Outcome {
    Vector v;            ///< after it (n)
    Vector multipliers;  ///< Lambda, as Model::multipliers()
  };
  struct Bounce {
    double restitution = 0;
    double least_speed = 0;  ///< with which bodies part; a slower bounce is none
  };
  /// @param candidates  without sliding ones: the impulse decides of all frictions
  /// @param bounces     of each contact
  /// Throws ConstraintError, NotFinite, Interrupted.
  Outcome solve(double t, const Vector& q, const Vector& v, const ContactCandidates& candidates,
                const std::vector<Bounce>& bounces);

 private:
  struct Phase {
    Vector momentum;   // p before
    Vector least;      // reactions of contacts that are given [N s]
    Vector v;          // in: first guess, out: after
    Vector reactions;  // out: of contacts and frictions
    Vector bilateral;  // out
  };
  /// One step of Newton's method.
  struct Step {
    Vector v;     // after it
    double size;  // of its terms
  };
  void run(double t, const Vector& q, Phase& phase);
  Step step(double t, const Vector& q, const Vector& start, Phase& phase);

  const Model* model_;
  ContactRows rows_;
  ActiveConstraints bilateral_;
};

}  // namespace hybrid_sphere::mechanics

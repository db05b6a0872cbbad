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
    Vector momentum;  // p before
    Vector start;     // v before (n)
    Vector least;     // reactions of contacts that are given [N s]
    // Found:
    Vector v{};          // after it
    Vector reactions{};  // of contacts and frictions
    Vector bilateral{};  // reactions of the bilateral constraints
    Vector rates{};      // f along the rows, as far as it is linear
    double size = 0;     // of the terms of v, in the metric of M
  };
  void run(double t, const Vector& q, Phase& phase);
  void evaluate(double t, const Vector& q, const Phase& phase);
  double error_of(const Phase& phase);
  void step(double t, const Vector& q, Phase& phase);
  Vector weights();

  const Model* model_;
  ContactRows rows_;
  ActiveConstraints bilateral_;
  Vector bilateral_values_;
};

}  // namespace hybrid_sphere::mechanics

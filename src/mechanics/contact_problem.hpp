#pragma once

#include "hybrid_sphere/mechanics/model.hpp"
#include "mechanics/contact_rows.hpp"

namespace hybrid_sphere::mechanics {

/// Which unilateral constraints hold, and which frictions hold or slide, by their accelerations. Source:
/// docs/theory.md 7.8.
class ContactProblem {
 public:
  /// @param model  must outlive this object
  explicit ContactProblem(const Model& model);

  struct Modes {
    ActiveSet active;  ///< bilateral constraints included
    Slides sliding;
  };
  /// At velocities that satisfy all candidates. A contact holds where its reaction is 0, too, as long as
  /// nothing opens it. Where more than one division of the load is possible, a friction slides only if it
  /// does so by the one that the motion has. Throws ConstraintError, NotFinite.
  Modes modes(double t, const Vector& q, const Vector& v, ContactCandidates candidates);

  /// a of a unilateral constraint without its own reaction and its friction, while the others react; without
  /// friction if there is no solution with it.
  double acceleration_without(double t, const Vector& q, const Vector& v, ContactCandidates others,
                              std::size_t contact);

 private:
  std::optional<ContactReactions> solve(double t, const Vector& q, const Vector& v);
  void evaluate_accelerations(double t, const Vector& q, const Vector& v);
  double coefficient(std::size_t friction) const;
  Slides that_slide(const ContactReactions& solution) const;
  bool hold(const Slides& slides, const Modes& modes, double t, const Vector& q, const Vector& v,
            ContactCandidates& candidates);
  bool break_loose(const Slides& slides, ContactCandidates& candidates) const;
  Modes modes_of(const ContactReactions& solution, const Slides& slides) const;

  const Model* model_;
  ContactRows rows_;
  ConstrainedMotion motion_;  // under the constraints that are found to hold
  Vector free_;               // a without reactions
  Vector free_sizes_;         // of its terms
};

}  // namespace hybrid_sphere::mechanics

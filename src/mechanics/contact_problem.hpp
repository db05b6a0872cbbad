#pragma once

#include <optional>
#include <vector>

#include "hybrid_sphere/mechanics/model.hpp"
#include "mechanics/active_constraints.hpp"
#include "mechanics/constrained_motion.hpp"
#include "mechanics/contact_reactions.hpp"

namespace hybrid_sphere::mechanics {

/// What may react at one instant.
struct ContactCandidates {
  ActiveSet bilateral;   ///< constraints that hold in any case
  ActiveSet contacts;    ///< unilateral constraints that touch
  ActiveSet frictions;   ///< constraints with friction that do not slip, or of which an impulse decides
  Slides sliding;        ///< constraints with friction that slip
  ActiveSet loose = {};  ///< of the frictions, those that do not stick any more
};

/// Which unilateral constraints hold, which frictions hold or slide, and the impulse where bodies meet:
/// solve_contacts() with a the accelerations, or, for impulses, the velocities along the rows. Source:
/// docs/theory.md 7.8.
class ContactProblem {
 public:
  /// @param model  must outlive this object
  explicit ContactProblem(const Model& model);

  struct Modes {
    ActiveSet active;  ///< bilateral constraints included
    Slides sliding;
  };
  /// By the accelerations at velocities that satisfy all candidates. A contact holds where its reaction is 0,
  /// too, as long as nothing opens it. Throws ConstraintError, NotFinite.
  Modes modes(double t, const Vector& q, const Vector& v, ContactCandidates candidates);

  struct Impulse {
    Vector v;            ///< after it (n)
    Vector multipliers;  ///< Lambda, as Model::multipliers()
  };
  struct Bounce {
    double restitution = 0;  ///< by Poisson's hypothesis
    double least_speed = 0;  ///< with which bodies part; a slower bounce is none
  };
  /// @param bounces  of each contact
  /// Throws ConstraintError, NotFinite.
  Impulse impulse(double t, const Vector& q, const Vector& v, const ContactCandidates& candidates,
                  const std::vector<Bounce>& bounces);

  /// a of a unilateral constraint without its own reaction and its friction, while the others react; without
  /// friction if there is no solution with it.
  double acceleration_without(double t, const Vector& q, const Vector& v, ContactCandidates others,
                              std::size_t contact);

 private:
  struct Units {
    Vector scale;     // of contacts and frictions
    Vector free;      // a without reactions, in these units
    Matrix effect;    // of the reactions on a
    double size = 0;  // of the largest free term
  };
  struct Rows {
    Index first;
    Index size;
  };
  enum class Sticking {
    rests,  // by the static coefficient
    struck  // in an impact, by that of sliding
  };
  struct Phase {
    Vector momentum;   // p before
    Vector least;      // reactions of contacts that are given [N s]
    Vector v;          // in: first guess, out: after
    Vector reactions;  // out: of contacts and frictions
    Vector bilateral;  // out
  };

  void set(const ContactCandidates& candidates);
  void evaluate_rows(double t, const Vector& q, const Vector& v);
  void respond_to_rows();
  void evaluate_accelerations(double t, const Vector& q, const Vector& v);
  bool is_fixed(Index row) const;
  Units units(const Vector& free, const Vector& sizes) const;
  Vector known_limits(double t, const Vector& q, const Vector& v) const;
  std::optional<ContactReactions> solve(const Vector& free, const Vector& sizes, const Vector& limits,
                                        Sticking sticking);
  Slides that_slide(const ContactReactions& solution) const;
  bool break_loose(const Slides& slides, ContactCandidates& candidates) const;
  double coefficient(std::size_t friction) const;
  Modes modes_of(const ContactReactions& solution, const Slides& slides) const;
  void run(double t, const Vector& q, Phase& phase);
  [[noreturn]] void refuse(double t, const Vector& q) const;
  Index contact_of(std::size_t friction) const;
  Index contacts() const { return static_cast<Index>(candidates_.contacts.size()); }
  Index frictions() const { return static_cast<Index>(candidates_.frictions.size()); }
  std::size_t constraint(Index row) const;

  const Model* model_;
  ConstrainedMotion motion_;
  ActiveConstraints bilateral_;
  ContactCandidates candidates_;
  std::vector<Rows> rows_of_frictions_;
  Index row_count_ = 0;
  // Of contacts, then frictions:
  Vector values_;  // f
  Matrix rows_;    // C
  Vector gamma_;
  Matrix directions_;   // of the reactions (n x rows)
  Matrix responses_;    // of velocities to the reactions (n x rows)
  Matrix multipliers_;  // of the bilateral constraints to them
  Matrix effect_;       // C responses
  Vector free_;         // a without reactions
  Vector free_sizes_;   // of its terms
};

}  // namespace hybrid_sphere::mechanics

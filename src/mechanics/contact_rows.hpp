#pragma once

#include <optional>
#include <vector>

#include "hybrid_sphere/mechanics/model.hpp"
#include "mechanics/active_constraints.hpp"
#include "mechanics/constrained_motion.hpp"
#include "mechanics/contact_reactions.hpp"

namespace hybrid_sphere::mechanics {

/// Constraints that may react at one instant.
struct ContactCandidates {
  ActiveSet bilateral;   ///< constraints that hold in any case
  ActiveSet contacts;    ///< unilateral constraints that touch
  ActiveSet frictions;   ///< constraints with friction that do not slip, or of which an impulse decides
  Slides sliding;        ///< constraints with friction that slip
  ActiveSet loose = {};  ///< of the frictions, those that do not stick any more
};

/// Relative round-off of accelerations and velocities along the rows.
constexpr double contact_roundoff = 1e-12;

/// The rows C of contacts, then of frictions that do not slip, at one instant, the effect of their reactions
/// on one another, and their complementarity problem: solve_contacts() with a the accelerations, or, for
/// impulses, the velocities along the rows. Source: docs/theory.md 7.8.
class ContactRows {
 public:
  /// @param model  must outlive this object
  explicit ContactRows(const Model& model);

  void set(const ContactCandidates& candidates);
  const ContactCandidates& candidates() const { return candidates_; }
  /// The motion under the bilateral candidates.
  ConstrainedMotion& motion() { return motion_; }

  /// f, C and gamma, after an evaluation of the motion. Throws NotFinite.
  void evaluate(double t, const Vector& q, const Vector& v);
  /// The friction of a contact that slides pushes with it. To be called before respond().
  void add_sliding_friction(double t, const Vector& q, const Vector& v);
  /// The effect of reactions. Throws ConstraintError.
  void respond();

  const Vector& values() const { return values_; }            ///< f
  const Matrix& gradient() const { return rows_; }            ///< C
  const Vector& gamma() const { return gamma_; }              ///< of C v' = gamma
  const Matrix& directions() const { return directions_; }    ///< of the reactions (n x rows)
  const Matrix& responses() const { return responses_; }      ///< of velocities to the reactions (n x rows)
  const Matrix& multipliers() const { return multipliers_; }  ///< of the bilateral constraints to them
  const Matrix& effect() const { return effect_; }            ///< C responses

  /// @param free          a without reactions
  /// @param sizes         of its terms
  /// @param coefficients  of the frictions
  /// @param limits        of the frictions, besides mu N
  /// @return  none where no solution is found
  std::optional<ContactReactions> solve(const Vector& free, const Vector& sizes, const Vector& coefficients,
                                        const Vector& limits) const;
  /// Says that there are no reactions. Throws ConstraintError.
  [[noreturn]] void refuse(double t, const Vector& q) const;

  struct Rows {
    Index first;
    Index size;
  };
  const Rows& rows_of(std::size_t friction) const { return rows_of_frictions_[friction]; }
  Index size() const { return row_count_; }
  Index contacts() const { return static_cast<Index>(candidates_.contacts.size()); }
  Index frictions() const { return static_cast<Index>(candidates_.frictions.size()); }
  /// The row of the contact that loads a friction; -1: its load is known, or the contact does not touch.
  Index contact_of(std::size_t friction) const;

 private:
  struct Units {
    Vector scale;     // of contacts and frictions
    Vector free;      // a without reactions, in these units
    Matrix effect;    // of the reactions on a
    double size = 0;  // of the largest free term
  };
  bool is_fixed(Index row) const;
  Units units(const Vector& free, const Vector& sizes) const;
  std::size_t constraint(Index row) const;

  const Model* model_;
  ConstrainedMotion motion_;
  ContactCandidates candidates_;
  std::vector<Rows> rows_of_frictions_;
  Index row_count_ = 0;
  Vector values_;
  Matrix rows_;
  Vector gamma_;
  Matrix directions_;
  Matrix responses_;
  Matrix multipliers_;
  Matrix effect_;
};

}  // namespace hybrid_sphere::mechanics

#pragma once

#include <vector>

#include "hybrid_sphere/mechanics/solution.hpp"
#include "mechanics/contact_impulse.hpp"
#include "mechanics/contact_problem.hpp"
#include "mechanics/segment.hpp"

namespace hybrid_sphere::mechanics {

/// Decides at one instant which unilateral constraints and frictions hold or slide, and applies the impulse
/// where bodies meet. Source: docs/theory.md 7.8.
class ContactRules {
 public:
  /// @param model     must outlive this object
  /// @param accuracy  of the motion, relative to its scale
  ContactRules(const Model& model, double accuracy);

  /// Whether the model has a unilateral constraint or a friction.
  bool are_needed() const { return are_needed_; }

  /// Where and when.
  struct Instant {
    double t;              // [s]
    const Vector& q;       // (N)
    const Vector& speeds;  // sizes of the numbers from which velocities are computed (n)
    double resolution;     // of the clock [s]
    bool may_bounce = true;
    bool is_disturbed = false;  // velocities may be off what holds, by another input
  };
  struct Before {
    const Vector& v;
    const ActiveSet& active;
    const Slides& sliding;
  };
  struct Decision {
    ActiveSet active;
    Slides sliding;
    bool has_impulse = false;
    Vector v;            // after it
    Vector multipliers;  // of the impulse, as Model::multipliers()
    Vector impulse;      // P (n)
    Index rank = 0;      // of the gradient of the constraints that hold
  };
  /// @param bilateral  the other constraints that hold from now on
  /// @param touching   unilateral constraints whose gap is 0
  /// @param passed     guards of reactions, limits and slips that have changed
  /// Throws ConstraintError, NotFinite.
  Decision decide(const Instant& at, const Before& before, const ActiveSet& bilateral,
                  const ActiveSet& touching, const std::vector<MonitoredGuard>& passed);

  /// At the start of a motion. @param known  constraints that hold, if that is known
  Decision begin(const Instant& at, const Vector& v, const ActiveSet& bilateral, const ActiveSet& touching,
                 const std::optional<ActiveSet>& known);

 private:
  Vector rounding_of_rate(const Matrix& gradient, const Instant& at, const Vector& v,
                          const Vector& v_before) const;
  int sign_of_rate(std::size_t constraint, const Instant& at, const Vector& v, const Vector& v_before) const;
  std::vector<std::size_t> loaded(const Instant& at, const ActiveSet& touching) const;
  ActiveSet that_stay(const Instant& at, const Before& before, const ActiveSet& bilateral,
                      const ActiveSet& touching);
  bool meet(const Instant& at, const Before& before, const ActiveSet& touching) const;
  void decide_modes(const Instant& at, const Before& before, const std::vector<MonitoredGuard>& passed,
                    const ContactCandidates& candidates, Decision& decision);
  bool stop(ActiveSet& slipping, const Instant& at, const Before& before, const Decision& decision,
            ContactCandidates& candidates) const;
  void finish(const Instant& at, const Before& before, const std::vector<MonitoredGuard>& passed,
              Decision& decision);
  void apply_impulse(const Instant& at, const Before& before, const ActiveSet& bilateral,
                     const ActiveSet& touching, Decision& decision);
  double least_bounce_speed(const Instant& at, const Vector& v, const ContactCandidates& candidates,
                            std::size_t contact);
  ContactCandidates candidates_at(const Instant& at, const Vector& v, const ActiveSet& bilateral,
                                  const ActiveSet& touching) const;
  bool parts(std::size_t contact, const Instant& at, const Vector& v, const Vector& v_before,
             const ActiveSet& bilateral, const ActiveSet& touching);
  std::vector<ContactImpulse::Bounce> bounces(const Instant& at, const Vector& v,
                                              const ContactCandidates& candidates);
  std::optional<Slide> slip_of(std::size_t friction, const Instant& at, const Vector& v,
                               const Vector& v_before, double error = 0, double slow = 0) const;
  bool is_as_small_as_slip(const Vector& change, std::size_t friction, const Instant& at, double slow) const;
  void complete(Slides& slides, const Instant& at, const Vector& v, const Vector& v_before) const;

  const Model* model_;
  ContactProblem problem_;
  ContactImpulse contact_impulse_;
  ImpulseSolver impulse_;
  double accuracy_;
  double looseness_;  // of velocities, relative to the sizes of their terms
  bool are_needed_ = false;
};

}  // namespace hybrid_sphere::mechanics

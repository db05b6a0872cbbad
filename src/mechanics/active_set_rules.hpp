#pragma once

#include <optional>
#include <vector>

#include "hybrid_sphere/mechanics/impulse.hpp"
#include "hybrid_sphere/mechanics/solution.hpp"
#include "hybrid_sphere/numerical_error.hpp"
#include "mechanics/contact_rules.hpp"
#include "mechanics/event_rules.hpp"
#include "mechanics/segment.hpp"

namespace hybrid_sphere::mechanics {

/// Constraints apply and release one another endlessly at one instant.
class LivelockError : public NumericalError {
 public:
  using NumericalError::NumericalError;
};

/// Decides at one instant which constraints hold, and applies their impulses: the only place where stages
/// switch. Source: docs/theory.md 7.6.
class ActiveSetRules {
 public:
  /// @param model     must outlive this object
  /// @param accuracy  of the motion, relative to its scale
  ActiveSetRules(const Model& model, double accuracy);

  /// At the start of the motion: constraints whose guards are positive hold already, as do those whose
  /// intervals began before t. Nothing is applied yet. Throws NotFinite.
  /// @param known  those that hold, if that is known: a guard may have been left at 0
  /// @param sizes  as in switch_constraints()
  ActiveSet begin(double t, const Vector& q, const Vector& v, const Sizes& sizes, double ahead,
                  const std::optional<ActiveSet>& known);

  /// Why constraints are brought up to date.
  struct Occasion {
    double ahead = 0;  // how far to look ahead if velocities do not determine a guard's sign [s]
    std::vector<MonitoredGuard> passed;  // guards that have changed, at which the last segment has ended
    bool is_disturbed = false;  // by an input or a reset: velocities may be off the constraints that hold
  };
  /// Brings the constraints up to date at (t, q).
  /// @param v        in: the velocities before; out: those after the last impulse
  /// @param sizes    of the numbers from which q and v were computed, whose rounding they carry
  /// @param impulses receives a Switch for each change, without its index
  /// Throws ConstraintError, NotFinite or LivelockError; v, active() and impulses are then those of the last
  /// change that was possible.
  void switch_constraints(double t, const Vector& q, Vector& v, const Sizes& sizes, const Occasion& occasion,
                          std::vector<Switch>& impulses);
  /// The events that occur at (t, q): one Switch for all of them, with their resets and what the constraints
  /// do to the velocities after these. Parameters as in switch_constraints().
  /// @param occasion  a reset takes account of it, and clears it
  /// @return  whether there are any
  /// Throws as switch_constraints(), and what functions of events throw.
  bool pass_events(double t, const Vector& q, Vector& v, const Sizes& sizes, Occasion& occasion,
                   std::vector<Switch>& impulses);

  /// Events of the user's accumulate (Zeno).
  bool events_accumulate() const { return events_.accumulate(); }
  const ActiveSet& active() const { return memory_.active; }
  const Slides& sliding() const { return memory_.sliding; }

  /// What is known of the guards.
  struct Memory {
    std::vector<bool> positive;    // sides; true without a guard
    std::vector<bool> kept;        // at 0 by the motion so far: they are off by its errors
    std::vector<double> released;  // t at which the guard changed to negative last [s]
    ActiveSet active;
    Slides sliding;
    std::vector<EventRules::Side> events{};
  };
  Memory memory() const;
  void restore(const Memory& memory);
  /// The guards, with their present signs, of constraints that are within their intervals, except guards that
  /// the active constraints keep at 0; and those of reactions and slips.
  std::vector<MonitoredGuard> monitored(double t, const Vector& q, const Vector& v, const Sizes& sizes,
                                        double ahead);

  /// The first begin or end of an interval after t; infinity if there is none.
  double next_instant(double t) const;

 private:
  void take_up_motion(double t, const Vector& q, const Vector& v);
  bool in_interval(std::size_t i, double t) const;
  void refuse_overlap(std::size_t i, double t, const Vector& q, const Vector& sizes) const;
  Vector loose_rate(const Vector& q, const Vector& rate, const Sizes& sizes) const;
  bool touches(std::size_t i, double t, const Vector& q, const Vector& v, const Sizes& sizes);
  bool holds_on_edge(std::size_t i, double t, const Vector& q, const Vector& v, const Sizes& sizes,
                     double ahead);
  bool is_kept(std::size_t i, double t, const Vector& q, const Vector& v, const Sizes& sizes);
  int sign_ahead(std::size_t i, double t, const Vector& q, const Vector& v, const Vector& sizes,
                 double ahead);
  void see_sides(double t, const Vector& q, const Vector& v_before, const Vector& v, const Sizes& sizes,
                 const Occasion& occasion);
  ActiveSet members(double t, bool unilateral) const;
  bool is_bilateral(std::size_t i) const;
  void monitor_contacts(std::vector<MonitoredGuard>& guards) const;
  void require_positions(const ActiveSet& next, double t, const Vector& q, const Vector& v,
                         const Vector& sizes) const;
  ContactRules::Decision decide(double t, const Vector& q, const Vector& v, const Sizes& sizes,
                                const Occasion& occasion, bool may_bounce);
  Switch reset_by(const std::vector<std::size_t>& events, const EventRules::Instant& at,
                  const Occasion& occasion);
  void meet_again(double t);
  void keep(const ContactRules::Decision& decision, double t);

  const Model* model_;
  ImpulseSolver impulse_;
  ConstrainedMotion motion_;
  ContactRules contacts_;
  EventRules events_;
  double looseness_;  // the accuracy, in units of the rounding for which sign_of allows
  Memory memory_;
};

}  // namespace hybrid_sphere::mechanics

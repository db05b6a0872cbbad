#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hybrid_sphere/export.hpp"
#include "hybrid_sphere/mechanics/impulse.hpp"
#include "hybrid_sphere/mechanics/model.hpp"

namespace hybrid_sphere::mechanics {

/// Where a motion starts.
struct Initial {
  double time = 0;  ///< t [s]
  Vector q;         ///< (N)
  Vector v;         ///< (n)
  /// Constraints that hold already, ascending, where that is known, as of a State: on the edge of a guard the
  /// state alone may not tell. They need no impulse. By default: constraints whose intervals began before, or
  /// whose guards are positive.
  std::optional<ActiveSet> active{};
};

/// The system at one instant. Stage 1 is motion without constraints, stage 3 motion under constraints.
struct State {
  double time = 0;     ///< t [s]
  Vector q;            ///< (N)
  Vector v;            ///< (n)
  int stage = 1;       ///< 1 or 3
  ActiveSet active;    ///< constraints that hold
  Slides sliding;      ///< constraints whose friction acts while they do not hold
  Vector multipliers;  ///< lambda, as Model::multipliers(); 0 where a constraint neither holds nor slides
  double energy = 0;   ///< v.p - L [J]
  double kinetic_energy = 0;   ///< v.M v / 2 [J]
  double residual = 0;         ///< max abs(f) over the constraints that hold
  double estimated_error = 0;  ///< of q and v, up to this time: see Solution::estimated_error()
  /// Contacts whose gap is negative by more than its error, the accuracy or the estimated error: a step has
  /// missed that they close. Options::max_step shortens the steps.
  ActiveSet penetrating;
};

/// Stage 2: a change of the constraints, with its impulse, or an event of the model. t and q do not change.
struct Switch {
  std::uint64_t index = 0;           ///< 0, 1, 2, ...
  double time = 0;                   ///< t [s]
  ActiveSet applied;                 ///< constraints that are applied
  ActiveSet released;                ///< constraints that are released
  ActiveSet active;                  ///< constraints that hold afterwards
  Slides sliding;                    ///< constraints that slide afterwards
  std::vector<std::size_t> events;   ///< indices of the model's events that happen here
  Vector q;                          ///< (N)
  Vector v_before;                   ///< (n)
  Vector v_after;                    ///< (n)
  Vector multipliers;                ///< Lambda, as Model::multipliers(); 0 where there is none
  Vector impulse;                    ///< P = p(v_after) - p(v_before) (n)
  Index rank = 0;                    ///< of the gradient of the active constraints
  double energy_before = 0;          ///< v.p - L [J]
  double energy_after = 0;           ///< [J]
  double kinetic_energy_before = 0;  ///< v.M v / 2 [J]
  double kinetic_energy_after = 0;   ///< [J]
};

/// Why a motion ended.
enum class Stop {
  reached_end,   ///< at the requested end
  singular,      ///< M is not positive definite on the velocities that the constraints leave free
  no_direction,  ///< a constraint has df/dv = 0
  inconsistent,  ///< constraints that cannot hold together
  no_velocity,   ///< no velocity satisfies the constraints applied
  painleve,      ///< sliding friction leaves no reaction that keeps a contact closed (Painleve's paradox)
  livelock,      ///< constraints apply and release one another endlessly at one instant
  accumulation,  ///< switches follow one another ever faster (Zeno)
  too_many_switches,
  too_many_steps,
  cancelled,   ///< Options::monitor returned false
  not_finite,  ///< a user function is not finite
  undefined,   ///< a part of the model has no meaning: a disk lies flat, the load of a friction is negative
  no_step      ///< the integrator finds no step that is accurate enough
};
HYBRID_SPHERE_EXPORT const char* to_string(Stop stop);

struct Status {
  Stop stop = Stop::reached_end;
  double time = 0;      ///< t of the last state [s]
  std::string message;  ///< one sentence with names and numbers
};

/// How often and how long one constraint held.
struct ConstraintReport {
  std::string name;
  std::uint64_t applied = 0;  ///< how often it was applied
  double held = 0;            ///< total time for which it held [s]
};

/// How far the options project_positions and project_initial have moved the initial state. Without them it is
/// round-off.
struct Projection {
  Vector q;  ///< initial coordinates of the motion less those given, the latter normalized (N)
  Vector v;  ///< initial velocities of the motion less those given (n)
};

/// A motion from its start to the time in its status, stored as a continuous function of time.
/// @code
/// const auto end = [](const mechanics::Solution& solution) { return solution.at(solution.end()).q; };
/// @endcode
class HYBRID_SPHERE_EXPORT Solution {
 public:
  struct Record;
  explicit Solution(std::unique_ptr<Record> record);
  ~Solution();
  Solution(Solution&&) noexcept;
  Solution& operator=(Solution&&) noexcept;

  /// State at a time from begin() to end(); at the time of a switch, the state after it. Throws
  /// std::out_of_range for other times, ConstraintError where the motion passes exactly through a point at
  /// which its equations have no solution, as Euler angles do at their pole, and NotFinite where the
  /// equations are not finite, or overflow, as at the start of a motion that stopped there. If a motion
  /// stopped because its equations have no solution, the multipliers of its last state are 0.
  State at(double time) const;

  double begin() const;
  double end() const;
  const Status& status() const;
  const std::vector<Switch>& switches() const;
  const Projection& projection() const;
  std::vector<ConstraintReport> constraints() const;
  /// Estimated error of q and v at the end, relative to the scale of the motion, as Options::accuracy is: the
  /// local errors and the rounding of all steps, growing linearly with the number of times that the velocity
  /// turns. If it is greater than the accuracy, that is not assured: round-off, or a force that jumps, has
  /// kept the steps from it. Excludes the conditioning: what the motion multiplies errors by beyond that
  /// growth. Source: docs/theory.md 7.5.
  double estimated_error() const;
  std::uint64_t steps() const;
  std::uint64_t evaluations() const;  ///< of the equations of motion, up to the end
  /// The smallest regularity of M that any step encountered, in [0, 1], and its time: near 0 the coordinates
  /// degenerate, as Euler angles do at sin(theta) = 0. See SaddlePoint::regularity.
  double regularity() const;
  double least_regular_time() const;

 private:
  std::unique_ptr<Record> record_;
};

}  // namespace hybrid_sphere::mechanics

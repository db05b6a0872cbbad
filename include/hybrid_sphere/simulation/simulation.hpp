#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "hybrid_sphere/export.hpp"
#include "hybrid_sphere/interrupt/interrupted.hpp"
#include "hybrid_sphere/simulation/records.hpp"
#include "hybrid_sphere/sphere/sphere.hpp"

namespace hybrid_sphere {

class ConstantTwist;
class EventLoop;
class Ground;

/// The computation cannot continue: what() says why and where, time() when.
class HYBRID_SPHERE_EXPORT HaltedError : public std::runtime_error {
 public:
  HaltedError(Stop stop, double time, const std::string& reason)
      : std::runtime_error(reason), stop_(stop), time_(time) {}
  /// With the reason of another error; allocates no memory.
  HaltedError(double time, const HaltedError& other)
      : std::runtime_error(other), stop_(other.stop_), time_(time) {}
  Stop stop() const { return stop_; }
  double time() const { return time_; }

 private:
  Stop stop_;
  double time_;
};

namespace detail {

/// What advance_to() and state() know without asking the event loop, which keeps it up to date.
struct Outlook {
  double now = 0;                         ///< time reached [s]
  double certain_until = 0;               ///< before that time nothing changes and the state is known [s]
  const ConstantTwist* motion = nullptr;  ///< null if the motion is another one, or the state is held
  double epoch = 0;                       ///< beginning of the motion [s]
  double epoch_remainder = 0;             ///< what that leaves out [s]
  State state;                            ///< what a constant twist keeps is always up to date
};

}  // namespace detail

/// Prepares a surface for simulation; this may be done beforehand in another thread: a map of 100,000 regions
/// takes a second. Any number of simulations may share the result.
/// @param surface  valid: from a reader, or passed by scene::validate()
HYBRID_SPHERE_EXPORT std::shared_ptr<const Ground> prepare_ground(const scene::Surface& surface);

/// Event-driven simulation of the three stages of the sphere.
///
/// Between two switches the motion is a function of the time since the last switch, so the trajectory does
/// not depend on when, or how often, it is sampled. Switching rules: docs/theory.md 5.2.
/// @code
/// scene::Scene scene{};
/// scene.sphere = {1, 0.5, 0.3};
/// scene.initial_state.velocity = {1, 0};
/// scene.surface.base = scene::Law::smooth;
/// Simulation simulation(scene);
/// simulation.advance_to(2);
/// const Vector2d there = simulation.state().position;  // (2, 0)
/// @endcode
class HYBRID_SPHERE_EXPORT Simulation {
 public:
  /// The latest time that can be requested [s]: until then, positions and angles stay finite under speeds up
  /// to 1e15 m/s and the forces that a scene allows.
  static constexpr double max_time = 1e15;

  /// Called for every switch, in order, during advance_to.
  using SwitchSink = std::function<void(const Switch&)>;

  /// Called for every ground that the sphere comes to, with the time of that [s] and the region's name.
  using RegionSink = std::function<void(double time, std::string_view region)>;

  /// The sphere is in its initial state at time 0; the ground under it acts in the first advance_to.
  /// @param scene  valid: from a reader, or passed by scene::validate(); an invalid one may move in any way
  /// @throws std::invalid_argument  if the method exact is requested, but some motion on the surface has no
  /// closed form
  explicit Simulation(const scene::Scene& scene);
  ~Simulation();

  Simulation(const Simulation&) = delete;
  Simulation& operator=(const Simulation&) = delete;

  /// Advances to a time, reporting each switch up to and including that time.
  /// @param time  since the initial state [s], from time() to max_time
  /// @throws std::invalid_argument  for any other time; nothing is changed
  /// @throws HaltedError            if the computation cannot continue, whatever was thrown internally: the
  ///                                sphere stays at that instant, in the state after the last reported switch
  ///                                or later. What on_switch throws passes through unchanged; the next call
  ///                                resumes after that switch.
  /// @throws Interrupted            if set_interrupt's function asks for it: the sphere stays at time(), the
  ///                                last time up to which everything is known, after every reported switch.
  ///                                Any member may be called there; the next call resumes from what has been
  ///                                computed, and the trajectory is the same to the bit.
  void advance_to(double time, const SwitchSink& on_switch = {}) {
    if (time >= outlook_.now && time < outlook_.certain_until) {
      outlook_.now = time;
    } else {
      advance_over_instants(time, on_switch);
    }
  }

  /// Computes the states at several times in one call, each as advance_to() and state() would give it.
  /// @param times  ascending, from time() to max_time [s]
  /// @param out    as many; if the call throws, those before the time that it could not reach
  /// @throws       as advance_to()
  void states(const std::vector<double>& times, std::vector<State>& out, const SwitchSink& on_switch = {});

  /// From now on a long computation calls this function, about every millisecond and in the computing thread,
  /// to ask whether it should stop; if so, advance_to throws Interrupted. No other member calls it, nor does
  /// a short computation by a closed form. Only complete steps and pieces of the path are kept: if every call
  /// is interrupted within a piece (half a second for 20,000 edges on one line), there is no progress. An
  /// empty function never interrupts.
  void set_interrupt(std::function<bool()> should_stop);

  /// From now on advance_to calls this function whenever another ground is under the sphere, also where no
  /// switch is reported as its constraint is the same, and before the switch if there is one; the first one
  /// is that of the initial state. What it throws passes through as what on_switch throws, after the switch
  /// of that instant has been reported; if that throws, too, what on_switch has thrown. An empty function is
  /// not called.
  void set_region_sink(RegionSink on_region);

  /// Time reached [s].
  double time() const { return outlook_.now; }

  /// State at time(); at the instant of a switch, the state after it. Valid until the next call. Does not
  /// throw: after a halt it is the state in which the sphere stays, which agrees with the last reported
  /// switch.
  const State& state();

  /// Whether the simulation can continue from here or, after HaltedError or Interrupted, why not.
  /// @throws std::bad_alloc  where there is no memory for the message
  Status status() const;

  /// Force of the ground on the sphere at time(): lambda_1, lambda_2 and the normal force [N]. Does not
  /// throw.
  Vector3d reaction();

  /// Number of switches since the initial state.
  std::uint64_t switches() const;

  /// Number of right-hand sides evaluated since the beginning; 0 if every motion had a closed form.
  std::uint64_t evaluations() const;

  /// Places the sphere: time and switch count restart at 0; the constraint of the ground there is suddenly
  /// applied.
  /// @throws std::invalid_argument  for values beyond what a scene can have (1e15 m, m/s, rad/s in each
  ///                                component), or if the orientation is 0 or not finite; nothing is changed
  void set_initial_state(const scene::InitialState& initial_state);

  /// Places the sphere at time(), which goes on, as does the switch count; reset() still returns to the last
  /// initial state. Otherwise as set_initial_state().
  void set_state(const scene::InitialState& state);

  /// Returns to the last initial state.
  void reset();

  /// Whether the orientation is computed; it is unless this says otherwise. A run that is asked only for
  /// switches, places and velocities does not need it, and everything else is the same to the bit without:
  /// the state keeps the orientation of the initial state, and estimated_error() has no part of it. Returns
  /// to the last initial state, as reset().
  void follow_orientation(bool follow);

  /// Replaces the ground under the moving sphere, from time() on. A constraint that the new ground brings is
  /// suddenly applied. The second form takes a ground that was prepared elsewhere.
  /// @throws std::invalid_argument  as the constructor does; nothing is changed
  /// @throws std::bad_alloc         nothing is changed
  void set_surface(const scene::Surface& surface) { set_ground(prepare_ground(surface)); }
  void set_ground(std::shared_ptr<const Ground> ground);

  /// Applies a wrench to the sphere in addition to that of the scene, from time() until the next command.
  /// @throws std::invalid_argument  as the constructor does, and for components above the limits of a scene's
  ///                                wrench (1e15 m, 1e15 m k^2); nothing is changed
  void set_command(const scene::Wrench& command);

  /// Changes the accuracy: from time() on for an integrated motion, which begins a new segment there;
  /// otherwise from the next segment on, so that a closed form stays the same.
  /// @param accuracy  from 1e-14 to 1
  /// @throws std::invalid_argument  for any other value; nothing is changed
  void set_accuracy(double accuracy);

  /// Applies an external impulse to the centre at time(); several at one time add up. The next advance_to
  /// suddenly applies the constraint of the ground to the velocities after it: a rolling sphere keeps
  /// rolling, its velocity changed by impulse R^2/(m (R^2+k^2)); under coulomb friction, whose impulse in
  /// zero time is 0, it slips. Source: docs/theory.md 5.2, rule 9.
  /// @param impulse  J [N s]; J/m up to 1e15 m/s
  /// @throws std::invalid_argument  for any other impulse; nothing is changed
  /// @throws HaltedError            if the computation has halted; nothing is changed
  void kick(const Vector2d& impulse);

  /// Estimated error of all steps since the initial state: that of the integrated motions, relative to the
  /// scale of motion, and that of the orientation, relative to the angle turned. Excludes rounding.
  double estimated_error() const;

  const scene::Surface& surface() const;
  std::shared_ptr<const Ground> ground() const;
  const Sphere& sphere() const;

 private:
  void advance_over_instants(double time, const SwitchSink& on_switch);

  detail::Outlook outlook_;
  std::unique_ptr<EventLoop> loop_;
};

}  // namespace hybrid_sphere

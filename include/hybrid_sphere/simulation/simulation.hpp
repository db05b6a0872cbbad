#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "hybrid_sphere/export.hpp"
#include "hybrid_sphere/interrupt/interrupted.hpp"
#include "hybrid_sphere/simulation/records.hpp"
#include "hybrid_sphere/sphere/sphere.hpp"

namespace hybrid_sphere {

class EventLoop;
class Ground;

/// The computation cannot go on: what() says why and where, time() when.
class HYBRID_SPHERE_EXPORT HaltedError : public std::runtime_error {
 public:
  HaltedError(Stop stop, double time, const std::string& reason)
      : std::runtime_error(reason), stop_(stop), time_(time) {}
  /// For the reason of another one; takes no memory.
  HaltedError(double time, const HaltedError& other)
      : std::runtime_error(other), stop_(other.stop_), time_(time) {}
  Stop stop() const { return stop_; }
  double time() const { return time_; }

 private:
  Stop stop_;
  double time_;
};

namespace detail {

/// What advance_to() tells without asking the event loop, which keeps it up to date.
struct Outlook {
  double now = 0;            ///< time reached [s]
  double certain_until = 0;  ///< before, nothing changes and the state is known [s]
};

}  // namespace detail

/// A surface made ready for a simulation, which may be done in another thread beforehand: a map of 100,000
/// regions takes a second. Shared by as many simulations as like.
/// @param surface  valid: from a reader, or passed by scene::validate()
HYBRID_SPHERE_EXPORT std::shared_ptr<const Ground> prepare_ground(const scene::Surface& surface);

/// The three stages of the sphere, event-driven.
///
/// Between two switches the motion is a function of the time since the last one, so that the trajectory does
/// not depend on when, or how often, it is looked at. Rules of switching: docs/theory.md 5.2.
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
  /// The latest time that can be asked for [s]: speeds up to 1e15 m/s and the forces that a scene allows give
  /// places and angles that are numbers until then.
  static constexpr double max_time = 1e15;

  /// Called for every switch, in order, during advance_to.
  using SwitchSink = std::function<void(const Switch&)>;

  /// The sphere stands at its initial state at time 0; the ground under it acts in the first advance_to.
  /// @param scene  valid: from a reader, or passed by scene::validate(); one that is not may move in any way
  /// @throws std::invalid_argument  if the method exact is asked for, but some ground leaves a motion no
  /// closed form
  explicit Simulation(const scene::Scene& scene);
  ~Simulation();

  Simulation(const Simulation&) = delete;
  Simulation& operator=(const Simulation&) = delete;

  /// Goes on to a time, reporting each switch up to and including that time.
  /// @param time  since the initial state [s], from time() to max_time
  /// @throws std::invalid_argument  for any other time; nothing has changed then
  /// @throws HaltedError            where the computation cannot go on, whatever was thrown below: the sphere
  ///                                stands at that instant, in the state after the last switch reported or
  ///                                later. What on_switch throws comes out as it is; the next call goes on
  ///                                after that switch.
  /// @throws Interrupted            where set_interrupt's function says so: the sphere stands at time(), the
  ///                                last time up to which all is known, after every switch that was reported.
  ///                                Everything may be asked and done there; the next call goes on with what
  ///                                has been computed, and the trajectory is the same to the bit.
  void advance_to(double time, const SwitchSink& on_switch = {}) {
    if (time >= outlook_.now && time < outlook_.certain_until) {
      outlook_.now = time;
    } else {
      advance_over_instants(time, on_switch);
    }
  }

  /// The states at several times, each as advance_to() and state() give it, in one call.
  /// @param times  ascending, from time() to max_time [s]
  /// @param out    as many; where the call throws, those before the time that it could not reach
  /// @throws       as advance_to()
  void states(const std::vector<double>& times, std::vector<State>& out, const SwitchSink& on_switch = {});

  /// From now on a computation that takes long asks this function, about every millisecond and in the thread
  /// that computes, whether it should stop: advance_to throws Interrupted then. Nothing else asks, and what
  /// has a closed form near by is told without being asked. What is kept are steps and pieces of the path
  /// that are complete: one who is always told to stop within a piece (half a second for 20,000 edges on one
  /// line) gets no further. An empty function: never.
  void set_interrupt(std::function<bool()> should_stop);

  /// Time reached [s].
  double time() const { return outlook_.now; }

  /// State at time(); at the instant of a switch the one after it. Valid until the next call. Throws nothing:
  /// after a halt it is the state in which the sphere stands, which agrees with the last switch reported.
  const State& state();

  /// Whether it goes on from here or, after HaltedError or Interrupted, why not.
  /// @throws std::bad_alloc  where there is no memory for the message
  Status status() const;

  /// Force of the ground on the sphere at time(): lambda_1, lambda_2 and the normal force [N]. Throws
  /// nothing.
  Vector3d reaction();

  /// Number of switches since the initial state.
  std::uint64_t switches() const;

  /// Right-hand sides evaluated since the beginning; 0 where every motion had a closed form.
  std::uint64_t evaluations() const;

  /// Puts the sphere somewhere: time and switches start again at 0; what the ground there imposes, it imposes
  /// suddenly.
  /// @throws std::invalid_argument  beyond what a scene can have (1e15 m, m/s, rad/s in each component), or
  ///                                where the orientation is 0 or not finite; nothing has changed then
  void set_initial_state(const scene::InitialState& initial_state);

  /// Back to the last initial state.
  void reset();

  /// Exchanges the ground under the moving sphere, from time() on. A constraint that comes with it is
  /// suddenly applied. The second form takes one that was prepared elsewhere.
  /// @throws std::invalid_argument  as the constructor does; nothing has changed then
  /// @throws std::bad_alloc         nothing has changed then
  void set_surface(const scene::Surface& surface) { set_ground(prepare_ground(surface)); }
  void set_ground(std::shared_ptr<const Ground> ground);

  /// A wrench on the sphere beside that of the scene, from time() on until the next one.
  /// @throws std::invalid_argument  as the constructor does, and for components above those of a scene's
  ///                                wrench (1e15 m, 1e15 m k^2); nothing has changed then
  void set_command(const scene::Wrench& command);

  /// Another accuracy: from time() on for a motion that is integrated, which begins a new segment there; else
  /// from the next segment on, so that a closed form stays the same.
  /// @param accuracy  from 1e-14 to 1
  /// @throws std::invalid_argument  for any other; nothing has changed then
  void set_accuracy(double accuracy);

  /// An impulse on the centre at time(), from outside; several at one time add up. What the ground imposes on
  /// the velocities after it, it imposes suddenly, in the next advance_to: a sphere that rolls goes on
  /// rolling, its velocity changed by impulse R^2/(m (R^2+k^2)); with coulomb friction, whose impulse in no
  /// time is 0, it slips. Source: docs/theory.md 5.2, rule 9.
  /// @param impulse  J [N s]; J/m up to 1e15 m/s
  /// @throws std::invalid_argument  for any other impulse; nothing has changed then
  /// @throws HaltedError            where the computation has halted; nothing has changed then
  void kick(const Vector2d& impulse);

  /// Estimated error that the steps of a method have made: of the motions that were integrated, relative to
  /// the scale of motion, and of the orientation, relative to the angle turned; since the initial state. Not
  /// that of rounding.
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

#pragma once

#include <algorithm>
#include <functional>
#include <memory>

#include "hybrid_sphere/ground/itinerary.hpp"
#include "hybrid_sphere/simulation/records.hpp"
#include "hybrid_sphere/sphere/sphere.hpp"
#include "hybrid_sphere/sphere/uniform_motion.hpp"

namespace hybrid_sphere {

/// The three stages of the sphere, event-driven: the one place where stages switch.
///
/// Between two switches the motion is a closed form evaluated from the last switch, so that the trajectory
/// does not depend on when, or how often, it is looked at. Rules of switching: docs/theory.md 5.2.
class Simulation {
 public:
  /// Called for every switch, in order, during advance_to.
  using SwitchSink = std::function<void(const Switch&)>;

  /// The sphere stands at its initial state at time 0; the ground under it acts in the first advance_to.
  explicit Simulation(const scene::Scene& scene);

  /// Goes on to a time, reporting each switch up to and including that time.
  /// @param time  since the initial state [s], finite, not before time()
  /// @throws std::invalid_argument  for any other time; nothing has changed then
  void advance_to(double time, const SwitchSink& on_switch) {
    if (time >= now_ && time < next_instant_) {
      now_ = time;
    } else {
      advance_over_switches(time, on_switch);
    }
  }

  /// Time reached [s].
  double time() const { return now_; }

  /// State at time(); at the instant of a switch the one after it. Valid until the next call.
  const State& state() {
    const double tau = std::max(0.0, epoch_.until(now_));
    state_.time = now_;
    state_.position = motion_.position(tau);
    state_.orientation = motion_.orientation(tau);
    return state_;
  }

  /// Number of switches since the initial state.
  std::uint64_t switches() const { return switches_; }

  /// Puts the sphere somewhere: time and switches start again at 0; what the ground there imposes, it imposes
  /// suddenly.
  void set_initial_state(const scene::InitialState& initial_state);

  /// Back to the last initial state.
  void reset() { set_initial_state(initial_state_); }

  /// Exchanges the ground under the moving sphere, from time() on. A constraint that comes with it is
  /// suddenly applied.
  void set_surface(const scene::Surface& surface);

  const scene::Surface& surface() const { return ground_->surface(); }
  const Sphere& sphere() const { return sphere_; }

 private:
  /// A time as an unevaluated sum, so that stretches can be strung together without loss.
  struct Epoch {
    double value = 0;
    double rest = 0;
    Epoch plus(double tau) const;
    double until(double time) const { return (time - value) - rest; }
  };

  void advance_over_switches(double time, const SwitchSink& on_switch);
  void begin_stretch(const Epoch& epoch, const UniformMotion& motion, const Contacts& contacts);
  void update_state();
  void put_on_ground(const SwitchSink& on_switch);
  void pass_instant(const SwitchSink& on_switch);
  /// @param contacts  edges on which the sphere is though its rounded position may be beside them; none where
  /// it was put
  void enter(RegionId region, double tau, const Vector2d& position, const Contacts& contacts,
             const SwitchSink& on_switch);
  void report(double time, std::string_view from, const Vector2d& position, const Twist& before,
              const Vector2d& slip, const SwitchSink& on_switch);
  void schedule();

  Sphere sphere_;
  scene::InitialState initial_state_;
  std::shared_ptr<const Ground> ground_;
  std::shared_ptr<const Ground> left_ground_;  // keeps the name of the region that a new map took away
  Itinerary itinerary_;

  double now_ = 0;
  double next_instant_ = 0;  // when the constraint may change next
  bool on_ground_ = false;   // false: the ground under the sphere has yet to act
  std::uint64_t switches_ = 0;

  Epoch epoch_;           // beginning of the stretch
  UniformMotion motion_;  // since then
  Vector2d sigma_ =
      Vector2d::Zero();  // velocity of the contact point: exactly 0 once a rough ground has stopped it
  scene::Law constraint_ = scene::Law::smooth;
  RegionId region_ = no_region;
  State state_;  // what is constant over the stretch is always up to date
};

}  // namespace hybrid_sphere

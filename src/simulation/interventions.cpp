// Interventions at time(): a state, a ground, a wrench, an accuracy, an impulse (docs/theory.md 5.2, rule 9).
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include "simulation/check_method.hpp"
#include "simulation/event_loop.hpp"
#include "sphere/unit_quaternion.hpp"
#include "text/refusal.hpp"

namespace hybrid_sphere {
namespace {

constexpr double largest_acceleration = 1e15;  // as in a scene [m/s^2, 1/s^2]
constexpr double largest_kick = 1e15;          // [m/s]
constexpr double largest_number = 1e15;        // of an initial state [m, m/s, rad/s]

[[noreturn]] void refuse(const std::string& what, const std::string& allowed) {
  throw std::invalid_argument(text::refusal(what, allowed));
}

/// "(1, 2)"
template <class Vector>
std::string listed(const Vector& vector) {
  std::string text = "(" + text::shortest(vector[0]);
  for (Eigen::Index i = 1; i < vector.size(); ++i) text += ", " + text::shortest(vector[i]);
  return text + ")";
}

/// @param who  asks
/// @return     with a unit quaternion
scene::InitialState checked(scene::InitialState state, const char* who) {
  const auto is_within = [](const auto& vector) {
    return (vector.cwiseAbs().array() <= largest_number).all();
  };
  if (!is_within(state.position) || !is_within(state.velocity) || !is_within(state.angular_velocity) ||
      !state.orientation.coeffs().allFinite()) {
    refuse(std::string(who) + ": a number out of range",
           "up to 1e15 m, m/s and rad/s in each component, and a finite orientation");
  }
  Quaterniond& orientation = state.orientation;
  if (orientation.coeffs().isZero(0))
    refuse(std::string(who) + ": the orientation (0, 0, 0, 0)", "nonzero quaternions");
  orientation = to_unit(orientation);
  return state;
}

}  // namespace

scene::Forces EventLoop::Load::with(const scene::Wrench& wrench) const {
  scene::Forces all = forces;
  all.wrench.force += wrench.force;
  all.wrench.torque += wrench.torque;
  return all;
}

void EventLoop::check_method(const scene::Surface& surface, const scene::Wrench& command) const {
  try {
    hybrid_sphere::check_method(hybrid_.segment.solver(), Dynamics(hybrid_.sphere, load_.with(command)),
                                surface);
  } catch (const scene::SceneError& error) {
    throw std::invalid_argument(error.what());
  }
}

void EventLoop::set_initial_state(const scene::InitialState& initial_state) {
  initial_state_ = checked(initial_state, "set_initial_state");
  outlook_.now = 0;
  switches_ = 0;
  hybrid_.segment.forget_errors();
  place_in(initial_state_);
}

void EventLoop::set_state(const scene::InitialState& state) { place_in(checked(state, "set_state")); }

/// Puts the sphere into a state at time(), whatever it did before.
void EventLoop::place_in(const scene::InitialState& state) {
  InForce& in_force = hybrid_.in_force;
  hybrid_.fastest = 0;
  halt_.reason.reset();
  halt_.interrupted_at = -1;
  pending_.kick.setZero();
  in_force.constraint = {};
  in_force.region = in_force.partner = no_region;
  instant_.ahead = Ahead::known;
  report_.forget_name();
  in_force.mode = ContactMode::free;
  const Twist twist{state.velocity, state.angular_velocity};
  place(Cause::placed);
  report_.stand({state.position, state.orientation, twist, hybrid_.sphere.contact_velocity(twist)});
  schedule(outlook_.now);
}

/// The ground under the sphere has yet to act.
void EventLoop::place(Cause cause) {
  instant_.drawn_in_at = -1;
  instant_.excursion.reset();
  zeno_.begin(outlook_.now);
  repeated_ends_.clear();
  pending_.placed = true;
  pending_.cause = cause;
}

void EventLoop::set_ground(std::shared_ptr<const Ground> ground) {
  InForce& in_force = hybrid_.in_force;
  check_method(ground->surface(), load_.command);
  instant_.contacts.reserve(*ground);
  edge_events_.set_ground(ground);
  // The state names the ground that acted last, even if a second map arrives before the first one has acted;
  // if none has acted, a halt has named the ground under the sphere.
  if (halt_.reason && in_force.region == no_region && report_.is_named_by(hybrid_.ground))
    report_.forget_name();
  hybrid_.ground = std::move(ground);
  instant_.contacts.set_ground(*hybrid_.ground);
  halt_.reason.reset();
  halt_.interrupted_at = -1;
  report_.follow_segment_if_any();
  if (instant_.ahead == Ahead::to_place &&
      instant_.arrival.struck) {  // interrupted before a ground has acted
    report_.stand(instant_.before);
    pending_.kick += instant_.kick;
  }
  in_force.region = in_force.partner = no_region;
  instant_.ahead = Ahead::known;
  place(Cause::placed);
  schedule(outlook_.now);
}

void EventLoop::set_command(const scene::Wrench& command) {
  if (command.force == load_.command.force && command.torque == load_.command.torque) return;
  const double inertia =
      hybrid_.sphere.mass() * hybrid_.sphere.gyration_radius() * hybrid_.sphere.gyration_radius();
  const bool is_allowed =
      (command.force.cwiseAbs().array() <= largest_acceleration * hybrid_.sphere.mass()).all() &&
      (command.torque.cwiseAbs().array() <= largest_acceleration * inertia).all();
  if (!is_allowed) {
    refuse("set_command: force " + listed(command.force) + " N, torque " + listed(command.torque) + " N m",
           "up to 1e15 m [N] and 1e15 m k^2 [N m] in each component");
  }
  check_method(hybrid_.ground->surface(), command);
  load_.command = command;
  restart();
}

void EventLoop::set_accuracy(double accuracy) {
  Segment& segment = hybrid_.segment;
  if (!(accuracy >= 1e-14 && accuracy <= 1)) {
    refuse("set_accuracy: " + text::shortest(accuracy), "a number from 1e-14 to 1");
  }
  if (accuracy == segment.solver().accuracy) return;
  segment.set_accuracy(accuracy);
  if (segment.integrates()) restart();
}

/// Begins a new segment, because something in the motion changes from now on.
void EventLoop::restart() {
  pending_.new_forces = true;
  if (!pending_.placed) {
    if (hybrid_.epoch.until(outlook_.now) > 0) edge_events_.pass_without_crossing();
    place(Cause::grip_lost);
  }
  schedule(outlook_.now);
}

void EventLoop::kick(const Vector2d& impulse) {
  const Vector2d change = impulse / hybrid_.sphere.mass();
  if (!(change.norm() <= largest_kick)) {
    refuse("kick: " + listed(impulse), "finite impulses [N s] that change the velocity by at most " +
                                           text::shortest(largest_kick) + " m/s");
  }
  if (halt_.reason) throw HaltedError(*halt_.reason);
  if (change.isZero(0)) return;
  pending_.kick += change;
  if (!pending_.placed) {
    if (hybrid_.epoch.until(outlook_.now) > 0) edge_events_.pass_without_crossing();
    place(Cause::kicked);
  }
  schedule(outlook_.now);
}

void EventLoop::apply_pending(const SwitchSink& on_switch) {
  InForce& in_force = hybrid_.in_force;
  Arrival arrival = report_.is_detached() ? start() : arrive_at_place();
  if (std::exchange(pending_.new_forces, false)) {
    hybrid_.segment.set_dynamics(Dynamics(hybrid_.sphere, load_.with(load_.command)));
    arrival.restarts = true;
  }
  pending_.placed = false;
  complete(arrival);
  Segment::Start before = arrival.state;
  const bool kicked = !pending_.kick.isZero(0);
  if (kicked) {  // the velocities right after the impulse, before the ground has acted
    arrival.state.twist.velocity += pending_.kick;
    arrival.state.contact_velocity += pending_.kick;
    instant_.kick = pending_.kick;
    arrival.struck = arrival.restarts = true;
    pending_.kick.setZero();
  }
  if (in_force.region == no_region) {
    instant_.contacts.clear();
    edge_events_.forget_path();
    begin_free({next_.value, 0}, arrival, before);
  } else if (kicked) {
    go_on_kicked(arrival, before, on_switch);
  } else if (in_force.partner == no_region || !slide_along_edge(in_force.edge, arrival, on_switch)) {
    enter_ground(in_force.region, arrival, on_switch);
  }
}

/// The state in which the sphere was placed, before there is a motion.
Arrival EventLoop::start() const {
  const State& state = report_.state();
  const Segment::Start at{state.position, to_unit(state.orientation), state.twist,
                          hybrid_.in_force.contact_velocity};
  Arrival arrival{0, at, pending_.cause};
  arrival.complete = true;
  return arrival;
}

Arrival EventLoop::arrive_at_place() {
  const double tau = hybrid_.tau_at(next_.value);
  const MotionState now = hybrid_.segment.output_at(tau);  // what has been told of this instant, to the bit
  return arrive(tau, now, now.center.position, pending_.cause);
}

/// Continues on the ground in force or, if the sphere is on an edge, on the ground into which the impulse
/// sends it.
/// @param before  as it was before the impulse
void EventLoop::go_on_kicked(Arrival& arrival, const Segment::Start& before, const SwitchSink& on_switch) {
  arrival.cause = Cause::kicked;
  if (hybrid_.in_force.partner != no_region && stays_on_edge(arrival.state) &&
      slide_along_edge(hybrid_.in_force.edge, arrival, on_switch)) {
    return;
  }
  const SplitTime instant = arrival.tau > 0 ? SplitTime{next_.value, 0} : hybrid_.epoch;
  begin_free(instant, arrival, before);
}

/// The sphere moves freely until the ground into which its path leads acts.
/// @param before  as it was before an external impulse
void EventLoop::begin_free(const SplitTime& instant, Arrival& arrival, const Segment::Start& before) {
  try {
    begin_segment(instant, ContactMode::free, scene::Material(), arrival.state);
  } catch (...) {
    report_.stand(before);
    throw;
  }
  arrival.tau = 0;
  instant_.arrival = arrival;
  instant_.before = before;
  instant_.ahead = Ahead::to_place;
}

/// Whether the two grounds of an edge slide still throw the sphere at each other: docs/theory.md 5.4.
bool EventLoop::stays_on_edge(const Segment::Start& kicked) const {
  const InForce& in_force = hybrid_.in_force;
  const Vector2d conserved = hybrid_.sphere.conserved_velocity(kicked.twist);
  const auto across = [&](RegionId region) {
    return (conserved + hybrid_.sphere.kappa() * hybrid_.ground->material(region).belt)
        .dot(in_force.edge.normal);
  };
  return across(in_force.region) < 0 && across(in_force.partner) > 0;
}

}  // namespace hybrid_sphere

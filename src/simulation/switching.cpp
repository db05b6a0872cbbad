// Where stages switch: what a ground imposes when the sphere comes to it. Rules: docs/theory.md 5.2, 5.4.
#include <algorithm>
#include <utility>

#include "hybrid_sphere/numerical_error.hpp"

#include "simulation/event_loop.hpp"
#include "sphere/unit_quaternion.hpp"

namespace hybrid_sphere {
namespace {

Stage stage_of(const Constraint& constraint) {
  return constraint.holds() ? Stage::nonholonomic : Stage::holonomic;
}

SwitchKind kind_of(const Constraint& before, const Constraint& after) {
  if (!before.holds()) return SwitchKind::applied;
  return after.holds() ? SwitchKind::exchanged : SwitchKind::released;
}

}  // namespace

/// Leaves out the orientation and the contacts, which are needed only if a new segment begins.
Arrival EventLoop::arrive(double tau, const MotionState& now, const Vector2d& position, Cause cause) const {
  const Twist twist{now.center.velocity, now.angular_velocity};
  const Vector2d sigma = hybrid_.segment.uniform() ? hybrid_.in_force.contact_velocity : now.contact_velocity;
  return {tau, {position, Quaterniond::Identity(), twist, sigma}, cause};
}

/// The sphere reaches a ground; trace_ahead must follow.
void EventLoop::enter_ground(RegionId region, const Arrival& arrival, const SwitchSink& on_switch) {
  const Vector2d& place = arrival.state.position;
  const auto stays = [&] {
    return hybrid_.segment.is_whole() && hybrid_.segment.at(0.5 * arrival.tau).center.position == place;
  };
  if (zeno_.stands_still(place, stays)) halt_in_accumulation();
  instant_.visited.clear();
  zeno_.forget_rebound();
  instant_.arrival = arrival;
  switch_to(region, on_switch);
}

void EventLoop::switch_to(RegionId region, const SwitchSink& on_switch) {
  Segment& segment = hybrid_.segment;
  Arrival& arrival = instant_.arrival;
  instant_.visited.push_back(region);
  const scene::Material& material = hybrid_.ground->material(region);
  Switch event;
  event.before = arrival.state.twist;
  const Vector2d contact_velocity = arrival.state.contact_velocity;
  const Reset reset = hybrid_.rules().apply_reset(
      material,
      {hybrid_.in_force.region != no_region, segment.mode(), segment.material(), hybrid_.in_force.constraint},
      arrival);
  ContactMode mode = reset.mode;
  event.slip_before = reset.slip_before;
  event.impulse = reset.impulse;
  event.angular_impulse = reset.angular_impulse;
  instant_.jumped = reset.jumps();
  if (std::exchange(instant_.stays, false)) instant_.contacts.follow_none();
  const bool goes_on = !instant_.jumped && !arrival.restarts && segment.continues(mode, material);
  const SplitTime instant = hybrid_.epoch.plus(arrival.tau, arrival.tau_remainder);
  event.time = instant.value;
  event.time_remainder = instant.remainder;
  if (goes_on) {
    segment.continue_as(mode, material);
    instant_.ahead = Ahead::to_schedule;
  } else {
    complete(arrival);
    if (arrival.cause == Cause::accumulation) hybrid_.rules().stop_across(zeno_.limit()->normal, arrival);
    if (edge_events_.is_on_line()) mode = keep_on_line(mode, material, arrival.state);
    try {
      begin_segment(instant, mode, material, arrival.state);
    } catch (...) {  // the previous constraint is still in force
      arrival.state.twist = event.before;
      arrival.state.contact_velocity = contact_velocity;
      report_.stand(arrival.state);
      throw;
    }
    arrival.tau = arrival.tau_remainder = 0;
    instant_.ahead = Ahead::to_throw;
  }
  commit_transition(region, constraint_of(mode, material), arrival, event, on_switch);
}

/// What moves along a line keeps to it. @return the contact mode then
ContactMode EventLoop::keep_on_line(ContactMode mode, const scene::Material& material,
                                    Segment::Start& state) const {
  const Vector2d ground = ground_velocity(material, state.position);
  if (!hybrid_.rules().keep_on_line(edge_events_.line(), ground, state) || mode == ContactMode::free)
    return mode;
  const Vector2d& velocity = state.twist.velocity;
  const Vector2d& sigma = state.contact_velocity;
  return contact_mode_on(hybrid_.segment.dynamics(), material, state.position, velocity, sigma - ground,
                         velocity - sigma);
}

void EventLoop::begin_segment(const SplitTime& epoch, ContactMode mode, const scene::Material& material,
                              const Segment::Start& start) {
  const double speed = start.twist.velocity.norm();
  if (!(speed <= max_speed) || !start.twist.angular_velocity.allFinite())
    throw NumericalError("the velocities exceed 1e100 m/s");
  hybrid_.epoch = epoch;
  hybrid_.fastest = std::max({hybrid_.fastest, speed, start.contact_velocity.norm()});
  hybrid_.segment.begin(mode, material, start, first_horizon());
  report_.follow_segment();
}

void EventLoop::complete(Arrival& arrival) {
  if (std::exchange(arrival.complete, true)) return;
  // Renormalized, as the roundings of many segments would add up.
  arrival.state.orientation = to_unit(hybrid_.segment.orientation(arrival.tau));
  instant_.contacts.assign(edge_events_.contacts());
  instant_.contacts.snap_to_corners(hybrid_.segment.motion(), rounded_way(arrival), arrival.state.position);
}

/// The way whose rounding the place carries: at the speeds of centre and contact at its beginning or end, and
/// at those that each force would give alone [m].
double EventLoop::rounded_way(const Arrival& arrival) {
  Segment& segment = hybrid_.segment;
  if (segment.uniform()) return 0;
  const double end = arrival.state.twist.velocity.norm() + arrival.state.contact_velocity.norm();
  const double pull = segment.motion().acceleration_bound(arrival.tau, arrival.tau);
  return (std::max(segment.first_speed(), end) + pull * arrival.tau) * arrival.tau;
}

/// Calls a function of the caller's, whose exceptions pass through the event loop.
template <class Call>
void EventLoop::tell(const Call& call) {
  try {
    call();
  } catch (...) {
    throw CallerException{std::current_exception()};
  }
}

/// Sets the constraint from here on; reports a switch if it changes.
void EventLoop::commit_transition(RegionId region, const Constraint& constraint, const Arrival& arrival,
                                  Switch& event, const SwitchSink& on_switch, RegionId partner) {
  InForce& in_force = hybrid_.in_force;
  Segment& segment = hybrid_.segment;
  event.from_region = report_.state().region;
  const std::shared_ptr<const Ground> named_from = report_.name(region);
  event.to_region = report_.state().region;
  const bool is_another = std::exchange(in_force.region, region) != region;
  in_force.partner = partner;
  in_force.contact_velocity = arrival.state.contact_velocity;
  const Constraint before = std::exchange(in_force.constraint, constraint);
  in_force.mode = segment.mode();
  if (segment.uniform()) report_.note_velocities(segment.at(arrival.tau));
  const auto tell_switch = [&] {
    if (before == constraint) return;
    event.index = switches_++;
    event.kind = kind_of(before, constraint);
    event.cause = arrival.cause;
    event.from_stage = stage_of(before);
    event.to_stage = stage_of(constraint);
    event.position = arrival.state.position;
    event.after = arrival.state.twist;
    event.energy_before = hybrid_.sphere.kinetic_energy(event.before);
    event.energy_after = hybrid_.sphere.kinetic_energy(event.after);
    if (on_switch) tell([&] { on_switch(event); });
  };
  try {
    if (is_another && on_region_) tell([&] { on_region_(event.time, event.to_region); });
  } catch (const CallerException&) {
    tell_switch();
    throw;
  }
  tell_switch();
}

}  // namespace hybrid_sphere

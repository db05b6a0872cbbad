// What the path of a new segment leads into, and what that does at the same instant.
#include <algorithm>
#include <cfloat>
#include <optional>
#include <utility>

#include "simulation/event_loop.hpp"

namespace hybrid_sphere {

/// How far a motion is followed at first: limited if the sphere keeps coming back to an edge, as it is
/// expected back.
double EventLoop::first_horizon() const {
  const double back = 2 * zeno_.expected();
  return back > 0 ? back : never;
}

/// How far its path is traced at first: the next piece is twice as long, and fixed-length steps cost the same
/// in a motion that changes nothing.
double EventLoop::first_piece() const {
  constexpr double few = 1024;
  const scene::Solver& solver = hybrid_.segment.solver();
  return solver.has_fixed_step() ? std::min(first_horizon(), few * solver.step) : first_horizon();
}

/// Traces the first piece of the path of a new segment.
void EventLoop::trace() {
  Segment& segment = hybrid_.segment;
  const InterruptScope scope(should_stop_);
  if (segment.uniform()) {
    const UniformMotion& motion = segment.uniform_motion();
    edge_events_.begin(motion.start(), motion.twist().velocity, instant_.contacts.all());
    return;
  }
  const Curve curve = segment.motion().curve();
  // A sphere that slides along an edge is on its line, whatever rounding does to the velocity.
  const bool is_uniform = curve.form == CurveForm::parabola && curve.acceleration.isZero(0) &&
                          (segment.mode() != ContactMode::edge_sliding || curve.velocity.isZero(0));
  if (is_uniform && segment.motion().end_before(max_time) == never) {
    edge_events_.begin(curve.start, curve.velocity, instant_.contacts.all());
  } else {
    edge_events_.begin(segment.motion(), segment.time_scale(), first_piece(), instant_.contacts.all());
  }
}

/// The ground that the sphere reaches; no region if it continues as before. An edge slide needs both of its
/// grounds.
RegionId EventLoop::region_ahead() const {
  const InForce& in_force = hybrid_.in_force;
  const bool slides = hybrid_.segment.mode() == ContactMode::edge_sliding;
  if (slides && !edge_events_.visible(in_force.partner)) return edge_events_.forward_region(no_region);
  const RegionId region = edge_events_.forward_region(in_force.region);
  return region == in_force.region ? no_region : region;
}

/// The path has met no edge before it comes to rest, but its place may be rounded to the other side of one:
/// the sphere rests on that edge then, on the ground that it was on.
/// To be asked where a slip has ended. @return whether there is such an edge: a contact from now on
bool EventLoop::rests_beside_edge() {
  const Arrival& arrival = instant_.arrival;
  const bool rests = arrival.state.twist.velocity.isZero(0) && arrival.state.contact_velocity.isZero(0) &&
                     hybrid_.segment.at(0).center.acceleration.isZero(0);
  if (!rests) return false;
  const RegionId in_force = hybrid_.in_force.region;
  const RegionId seen = edge_events_.forward_region(in_force);
  if (seen == in_force) return false;
  const Vector2d& place = arrival.state.position;
  const bool has_left =
      in_force != base_region && locate(hybrid_.ground->shape(in_force), place) == Side::outside;
  EdgeContacts& contacts = instant_.contacts;
  const bool left_by_rounding = has_left && contacts.add_nearest(in_force, place);
  const bool met_by_rounding = seen != base_region && contacts.add_nearest(seen, place);
  return left_by_rounding || met_by_rounding;
}

/// The velocity after a reset leads out of the ground, along an edge, by no more than rounding across it. If
/// the ground does not push the sphere out, it stays on it: docs/theory.md 5.2.
/// @return whether it does: with a new segment
bool EventLoop::stay_on_edge(RegionId next) {
  const double rounding = hybrid_.rounding_of_speeds();
  Segment& segment = hybrid_.segment;
  Segment::Start& state = instant_.arrival.state;
  EdgeContacts& contacts = instant_.contacts;
  const RegionId ground = hybrid_.in_force.region;
  if (!contacts.has(ground) && !contacts.has(next)) contacts.add_seen_at(state.position);
  if (contacts.leads_over(ground, next, state.twist.velocity, rounding)) return false;
  const auto normal = contacts.normal_of_rounded_exit(ground, state.twist.velocity, rounding);
  if (!normal) return false;
  const Vector2d acceleration = segment.at(0).center.acceleration;
  const double across = acceleration.dot(*normal);
  const double rounding_of_forces = 32 * DBL_EPSILON * acceleration.norm();
  if (across < -rounding_of_forces) return false;
  const bool is_straight = segment.uniform() || !segment.motion().curve().line.isZero(0);
  if (across <= rounding_of_forces && is_straight) contacts.follow_along(state.twist.velocity, rounding);
  const Segment::Start before = state;
  hybrid_.rules().stop_across(*normal, instant_.arrival);
  try {
    begin_segment(hybrid_.epoch, segment.mode(), hybrid_.ground->material(ground), state);
  } catch (...) {
    state = before;
    report_.stand(state);
    throw;
  }
  if (segment.uniform()) report_.note_velocities(segment.at(0));
  instant_.ahead = Ahead::to_throw;
  instant_.stays = true;
  return true;
}

/// Traces the path of a new segment and applies the grounds into which it leads at the same instant. If this
/// is interrupted, the next call resumes it.
void EventLoop::trace_ahead(const SwitchSink& on_switch) {
  InForce& in_force = hybrid_.in_force;
  while (instant_.ahead != Ahead::known) {
    if (instant_.ahead == Ahead::to_schedule) {
      instant_.ahead = Ahead::known;
      break;
    }
    try {
      trace();
      if (instant_.arrival.cause == Cause::slip_ended && instant_.ahead == Ahead::to_throw &&
          rests_beside_edge())
        trace();
    } catch (const Interrupted&) {
      hold_before_kick();
      throw;
    } catch (const CallerException&) {
      hold_before_kick();
      throw;
    } catch (...) {  // the motion cannot be followed at all: the sphere stays as the last switch left it
      report_.stand(instant_.ahead == Ahead::to_place ? instant_.before : instant_.arrival.state);
      throw;
    }
    const Ahead traced = std::exchange(instant_.ahead, Ahead::known);
    const bool slides = traced == Ahead::to_slide;
    const bool throws = traced == Ahead::to_throw || slides;
    const RegionId next = slides ? region_ahead()
                                 : edge_events_.forward_region(
                                       throws || in_force.partner == no_region ? in_force.region : no_region);
    if (!throws) {
      instant_.visited.clear();
    } else if (next == (slides ? no_region : in_force.region)) {
      break;
    } else if (!slides && may_stay_on_edge() && stay_on_edge(next)) {
      continue;
    } else {
      if (!slides && !hybrid_.segment.uniform() && begin_hidden_excursion(next)) break;
      if (instant_.jumped && !slides) note_rebound();
      if (std::find(instant_.visited.begin(), instant_.visited.end(), next) != instant_.visited.end()) {
        resolve_livelock(next, on_switch);
        continue;
      }
      // Thrown back, the sphere is in another region at once: docs/theory.md 5.2, rule 6. A cause that lies
      // in the ground itself ends with the first switch; an intervention is the cause of all switches at its
      // instant.
      if (instant_.arrival.cause != Cause::placed && instant_.arrival.cause != Cause::kicked)
        instant_.arrival.cause = Cause::edge;
      instant_.arrival.mode.reset();
      instant_.arrival.restarts = instant_.arrival.struck = false;
    }
    switch_to(next, on_switch);
  }
  if (!zeno_.check(instant_.arrival, instant_.contacts.all(), outlook_.now)) halt_in_accumulation();
  if (!pending_.placed) schedule_next();
}

/// The path leads out of the ground at once, though the velocity leads into it: rounding hides the excursion,
/// at whose end the sphere reaches the next ground. docs/theory.md 5.5.
/// @return whether there is one, and the next ground lets the sphere go on from there
bool EventLoop::begin_hidden_excursion(RegionId next) {
  constexpr double little = 0x1p-10;  // of the time in which the acceleration changes
  Segment& segment = hybrid_.segment;
  const Vector2d acceleration = segment.at(0).center.acceleration;
  auto excursion = hidden_excursion(*hybrid_.ground, instant_.contacts.all(), hybrid_.in_force.region, next,
                                    instant_.arrival.state, acceleration);
  if (!excursion || !(excursion->end <= little * segment.time_scale())) return false;
  if (segment.motion().end_before(excursion->end) < never) return false;
  const scene::Material& beyond = hybrid_.ground->material(excursion->next);
  if (sets_velocity(beyond)) return false;
  const Segment::Start last = end_of_excursion(excursion->end);
  const double rounding = 32 * DBL_EPSILON * acceleration.norm();
  if (excursion->over.contains(hybrid_.rules().acceleration_on(beyond, last), rounding)) return false;
  if (!pending_.placed) instant_.excursion = std::move(excursion);
  return true;
}

/// The motion keeps sums whose rounding may exceed the velocities.
Segment::Start EventLoop::end_of_excursion(double tau) {
  Segment& segment = hybrid_.segment;
  Segment::Start state = instant_.arrival.state;
  const MotionState first = segment.at(0);
  const MotionState last = segment.at(tau);
  Twist& twist = state.twist;
  twist.velocity += tau * first.center.acceleration;
  state.contact_velocity += last.contact_velocity - first.contact_velocity;
  const Vector2d nu = twist.velocity - state.contact_velocity;
  twist.angular_velocity = {(0 - nu.y()) / hybrid_.sphere.radius(), nu.x() / hybrid_.sphere.radius(),
                            last.angular_velocity.z()};
  return state;
}

void EventLoop::pass_excursion(const SwitchSink& on_switch) {
  const HiddenExcursion excursion = *std::exchange(instant_.excursion, std::nullopt);
  edge_events_.pass_without_crossing();
  Arrival arrival;
  arrival.tau = excursion.end;
  arrival.cause = Cause::edge;
  arrival.state = end_of_excursion(excursion.end);
  enter_ground(excursion.next, arrival, on_switch);
}

/// After an impulse the ground has yet to act: until then the state is that before it.
void EventLoop::hold_before_kick() {
  if (instant_.ahead == Ahead::to_place && instant_.arrival.struck) report_.hold_at(instant_.before);
}

/// The ground in force has thrown the sphere back at once.
void EventLoop::note_rebound() {
  zeno_.note_rebound({hybrid_.in_force.region, instant_.arrival.state.twist.velocity,
                      hybrid_.segment.at(0).center.acceleration});
  // Grounds that do not set the velocity may now lead elsewhere.
  const auto leaves_it = [this](RegionId region) { return !sets_velocity(hybrid_.ground->material(region)); };
  std::vector<RegionId>& visited = instant_.visited;
  visited.erase(std::remove_if(visited.begin(), visited.end(), leaves_it), visited.end());
}

}  // namespace hybrid_sphere

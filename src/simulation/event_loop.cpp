#include "simulation/event_loop.hpp"

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "text/refusal.hpp"

namespace hybrid_sphere {

EventLoop::EventLoop(const scene::Scene& scene, detail::Outlook& outlook)
    : outlook_(outlook),
      hybrid_(scene),
      load_{scene.forces, {}},
      edge_events_(hybrid_.ground),
      zeno_(hybrid_),
      report_(hybrid_, outlook) {
  constexpr std::size_t usual_cycle = 16;
  check_method(scene.surface, {});
  instant_.visited.reserve(usual_cycle);
  instant_.contacts.reserve(*hybrid_.ground);
  instant_.contacts.set_ground(*hybrid_.ground);
  set_initial_state(scene.initial_state);
}

void EventLoop::advance_to(double time, const SwitchSink& on_switch) {
  halt_.interrupted_at = -1;
  try {
    pass_instants(time, on_switch);
  } catch (const CallerException& caller) {
    schedule(std::max(outlook_.now, next_.value));
    std::rethrow_exception(caller.what);
  } catch (const Interrupted&) {
    halt_.interrupted_at = outlook_.now;
    throw;
  } catch (const std::bad_alloc&) {  // not even room for a message
    halt_without_memory();
  }
}

void EventLoop::pass_instants(double time, const SwitchSink& on_switch) {
  if (!(time >= outlook_.now && time <= max_time)) {
    const std::string range = text::shortest(outlook_.now) + " to " + text::shortest(max_time) + " [s]";
    throw std::invalid_argument(
        text::refusal("advance_to: " + text::shortest(time), "a number from " + range));
  }
  if (halt_.reason) throw HaltedError(*halt_.reason);
  while (next_.value <= time) {
    reach(next_.value);
    // If the computation stops, the sphere stays at that instant.
    outlook_.now = std::max(outlook_.now, next_.value);
    try {
      if (instant_.ahead != Ahead::known) {  // interrupted here
        trace_ahead(on_switch);
      } else {
        pass_instant(on_switch);
      }
    } catch (const HaltedError&) {
      throw;
    } catch (const Interrupted&) {
      throw;
    } catch (const CallerException&) {
      throw;
    } catch (const std::bad_alloc&) {
      halt_without_memory();
    } catch (const std::exception& error) {
      halt(Stop::numerical, error.what());
    }
  }
  reach(time);
  outlook_.now = time;
  schedule(next_.value);
}

/// What happens at the next instant, and what that leads to at once.
void EventLoop::pass_instant(const SwitchSink& on_switch) {
  if (zeno_.limit()) {
    pass_limit(on_switch);
    trace_ahead(on_switch);
    return;
  }
  if (instant_.excursion) {
    if (zeno_.count_instant(outlook_.now)) halt_in_accumulation();
    pass_excursion(on_switch);
    trace_ahead(on_switch);
    return;
  }
  const double crossing = edge_events_.next_instant();
  const bool extends = !pending_.placed && !(edge_events_.end() < crossing) && !edge_events_.crosses_next();
  if (extends) extend(crossing);
  if (zeno_.count_instant(outlook_.now)) halt_in_accumulation();
  if (pending_.placed) {
    apply_pending(on_switch);
  } else if (extends) {
    // A path that was indistinguishable from an edge may have left it.
    const RegionId region = edge_events_.forward_region(hybrid_.in_force.region);
    if (region != hybrid_.in_force.region && hybrid_.segment.mode() != ContactMode::edge_sliding) {
      const MotionState now = hybrid_.segment.told_at(crossing);
      enter_ground(region, arrive(crossing, now, now.center.position, Cause::edge), on_switch);
    }
  } else if (edge_events_.end() < crossing) {
    pass_end(edge_events_.end(), on_switch);
  } else {
    pass_crossing(crossing, on_switch);
  }
  trace_ahead(on_switch);
}

/// Traces the next piece of the path.
void EventLoop::extend(double traced) {
  const InterruptScope scope(should_stop_);
  // The state is evaluated at time(), which is rounded, even if this is interrupted.
  hybrid_.segment.forget_before(std::min(traced, hybrid_.tau_at(outlook_.now)));
  edge_events_.extend();
}

void EventLoop::pass_crossing(double tau, const SwitchSink& on_switch) {
  edge_events_.pass_instant();
  const RegionId region = region_ahead();
  if (region == no_region) return;
  const MotionState now = hybrid_.segment.told_at(tau);
  if (!hybrid_.segment.uniform()) check_doubt(now.center);
  Arrival arrival = arrive(tau, now, edge_events_.snap_to_edge(now.center.position), Cause::edge);
  arrival.tau_remainder = next_.remainder;
  const SplitTime instant = hybrid_.epoch.plus(tau, next_.remainder);
  zeno_.note_arrival(arrival, region, instant, edge_events_.crossed_edge(hybrid_.in_force.region, region));
  enter_ground(region, arrival, on_switch);
}

/// Halts if a curved path approaches an edge so slowly that rounding hides when it arrives, though it moves
/// on along the edge: the switch may be off by much of the remaining motion. A motion that has decayed below
/// the accuracy continues: the difference is invisible.
void EventLoop::check_doubt(const PointState& center) {
  constexpr double much = 0x1p-10;
  constexpr double many = 0x1p+10;  // rounding errors of the place
  const double doubt = edge_events_.doubt();
  const double scale = hybrid_.segment.time_scale();
  const double way = doubt * center.velocity.norm();
  const double small = std::max(many * DBL_EPSILON * center.position.norm(),
                                hybrid_.segment.solver().accuracy * hybrid_.fastest * scale);
  if (!(doubt > much * scale && way > small)) return;
  std::ostringstream reason;
  reason << "rounding hides when the path meets the edge at x = " << center.position.x()
         << " m, y = " << center.position.y() << " m: up to " << doubt
         << " s before or after t = " << outlook_.now << " s";
  halt(Stop::undecided, reason.str());
}

/// The motion has ended by itself.
void EventLoop::pass_end(double tau, const SwitchSink& on_switch) {
  InForce& in_force = hybrid_.in_force;
  Segment& segment = hybrid_.segment;
  edge_events_.pass_without_crossing();
  // In a motion that ends at once the quantity is 0, though the reported velocities may not be.
  const MotionState now = segment.at(tau);
  Arrival arrival = arrive(tau, now, now.center.position, Cause::slip_ended);
  arrival.restarts = true;
  const bool repeats = repeated_ends_.count(segment.mode(), tau, segment.time_scale(), outlook_.now);
  RegionId region = in_force.region;
  if (segment.end_reason() == MotionEnd::edge_left) {
    arrival.cause = Cause::livelock_ended;
    region = segment.edge_slide().leaves_into_first() ? in_force.region : in_force.partner;
    arrival.state.contact_velocity =
        ground_velocity(hybrid_.ground->material(region), arrival.state.position);
  } else {
    hybrid_.rules().end_motion(segment.end_reason(), segment.mode(),
                               hybrid_.ground->material(in_force.region), arrival);
    if (repeats) hold(arrival);
  }
  enter_ground(region, arrival, on_switch);
}

/// Takes the ground to hold the sphere where rounding hides whether it does. If that has already failed at
/// this instant, the remaining velocities, negligible at the requested accuracy, are set to 0.
void EventLoop::hold(Arrival& arrival) {
  constexpr const char* unknown = "rounding hides whether friction holds the sphere";
  const scene::Material& material = hybrid_.ground->material(hybrid_.in_force.region);
  if (!repeated_ends_.was_held()) {
    if (!hybrid_.rules().hold(material, arrival)) halt(Stop::undecided, unknown);
    return;
  }
  const Vector2d u = ground_velocity(material, arrival.state.position);
  const double left = (arrival.state.twist.velocity - u).norm() + (arrival.state.contact_velocity - u).norm();
  const bool again = repeated_ends_.was_stopped();
  if (again || left > hybrid_.segment.solver().accuracy * hybrid_.fastest) halt(Stop::undecided, unknown);
  hybrid_.rules().stop(material, arrival);
}

void EventLoop::follow_to(double time) {
  Segment& segment = hybrid_.segment;
  const auto stand_at_last = [&] {
    const double reached = segment.reached();
    double last = reached < never ? std::min(hybrid_.epoch.plus(reached).value, time) : time;
    while (last > outlook_.now && hybrid_.epoch.until(last) > reached) last = std::nextafter(last, 0);
    outlook_.now = std::max(outlook_.now, last);
  };
  const InterruptScope scope(should_stop_);
  try {
    // Others may ask meanwhile, and begin to count anew.
    interruption_point(is_question_due() ? std::exchange(instants_, 0) : 1);
    segment.reach(hybrid_.epoch.until(time));
  } catch (const Interrupted&) {
    stand_at_last();
    schedule(next_.value);
    throw;
  } catch (const CallerException&) {
    stand_at_last();
    schedule(next_.value);
    throw;
  } catch (const std::bad_alloc&) {
    stand_at_last();
    halt_without_memory();
  } catch (const std::exception& error) {
    stand_at_last();
    halt(Stop::numerical, error.what());
  }
}

void EventLoop::schedule(double instant) {
  next_.value = instant;
  const double reached = report_.is_detached() ? never : hybrid_.segment.reached();
  const double known = reached < never ? hybrid_.epoch.plus(reached).value : never;
  outlook_.certain_until = std::min({instant, known, max_time});
}

void EventLoop::schedule_next() {
  if (zeno_.limit()) {
    next_.remainder = zeno_.limit()->time.remainder;
    schedule(zeno_.limit()->time.value);
    return;
  }
  if (instant_.excursion) {
    next_.remainder = 0;
    schedule(hybrid_.epoch.plus(instant_.excursion->end).value);
    return;
  }
  const double crossing = edge_events_.next_instant();
  const double end = edge_events_.end();
  const double tau = std::min(crossing, end);
  next_.remainder = end < crossing ? 0 : edge_events_.remainder_of_next_instant();
  schedule(std::isinf(tau) ? tau : hybrid_.epoch.plus(tau, next_.remainder).value);
}

}  // namespace hybrid_sphere

#include "hybrid_sphere/simulation/simulation.hpp"

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <iomanip>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "hybrid_sphere/simulation/check_method.hpp"

namespace hybrid_sphere {
namespace {

constexpr std::size_t usual_cycle = 16;
constexpr std::size_t usual_contacts = 4096;

scene::Forces with_command(scene::Forces forces, const scene::Wrench& command) {
  forces.wrench.force += command.force;
  forces.wrench.torque += command.torque;
  return forces;
}

}  // namespace

Simulation::Simulation(const scene::Scene& scene)
    : sphere_(scene.sphere),
      forces_(scene.forces),
      ground_(std::make_shared<const Ground>(scene.surface)),
      edge_events_(ground_),
      segment_(Dynamics(sphere_, scene.forces), scene.solver) {
  check_method(scene.surface, {});
  visited_.reserve(usual_cycle);
  reserve_contacts(*ground_);
  set_initial_state(scene.initial_state);
}

void Simulation::reserve_contacts(const Ground& ground) {
  contacts_.reserve(std::min(ground.surface().regions.size(), usual_contacts));
}

void Simulation::check_method(const scene::Surface& surface, const scene::Wrench& command) const {
  try {
    hybrid_sphere::check_method(segment_.solver(), Dynamics(sphere_, with_command(forces_, command)),
                                surface);
  } catch (const scene::SceneError& error) {
    throw std::invalid_argument(error.what());
  }
}

void Simulation::advance_over_instants(double time, const SwitchSink& on_switch) {
  try {
    pass_instants(time, on_switch);
  } catch (const Foreign& foreign) {
    schedule(std::max(now_, next_instant_));
    std::rethrow_exception(foreign.what);
  } catch (const std::bad_alloc&) {  // not even a message found room
    halt_without_memory();
  }
}

void Simulation::pass_instants(double time, const SwitchSink& on_switch) {
  if (!(time >= now_ && time <= max_time)) {
    std::ostringstream message;
    message << std::setprecision(DBL_DECIMAL_DIG) << "advance_to: " << time
            << " is refused; allowed: a number from " << now_ << " to " << max_time << " [s]";
    throw std::invalid_argument(message.str());
  }
  if (halted_) throw HaltedError(*halted_);
  while (next_instant_ <= time) {
    reach(next_instant_);
    // Where the computation stops, the sphere stands at that instant.
    now_ = std::max(now_, next_instant_);
    try {
      if (ahead_ != Ahead::known) {  // interrupted here
        trace_ahead(on_switch);
      } else {
        pass_instant(on_switch);
      }
    } catch (const HaltedError&) {
      throw;
    } catch (const Interrupted&) {
      throw;
    } catch (const Foreign&) {
      throw;
    } catch (const std::bad_alloc&) {
      halt_without_memory();
    } catch (const std::exception& error) {
      halt(error.what());
    }
  }
  reach(time);
  now_ = time;
  schedule(next_instant_);
}

void Simulation::schedule(double instant) {
  next_instant_ = instant;
  const double reached = detached_ ? never : segment_.reached();
  const double known = reached < never ? epoch_.plus(reached).value : never;
  certain_until_ = std::min({instant, known, max_time});
}

void Simulation::apply_pending(const SwitchSink& on_switch) {
  Arrival arrival = detached_ ? start() : arrive_at_place();
  if (std::exchange(new_forces_, false)) {
    segment_.set_dynamics(Dynamics(sphere_, with_command(forces_, command_)));
    arrival.restarts = true;
  }
  on_ground_ = true;
  complete(arrival);
  Segment::Start before = arrival.state;
  const bool kicked = !kick_.isZero(0);
  if (kicked) strike(arrival);
  if (region_ == no_region) {
    contacts_.clear();
    edge_events_.forget_path();
    begin_free({next_instant_, 0}, arrival, before);
  } else if (kicked) {
    go_on_kicked(arrival, before, on_switch);
  } else if (partner_ == no_region || !slide_along_edge(slid_along_, arrival, on_switch)) {
    enter_ground(region_, arrival, on_switch);
  }
}

/// Where the sphere has been put, before there is a motion.
Arrival Simulation::start() const {
  Arrival arrival{0, {state_.position, state_.orientation.normalized(), state_.twist, sigma_}, placing_};
  arrival.complete = true;
  return arrival;
}

Arrival Simulation::arrive_at_place() {
  const double tau = std::max(0.0, epoch_.until(next_instant_));
  const MotionState now = segment_.told_at(tau);
  return arrive(tau, now, now.center.position, placing_);
}

/// What happens at the next instant, and what that leads to at once.
void Simulation::pass_instant(const SwitchSink& on_switch) {
  if (limit_) {
    pass_limit(on_switch);
    trace_ahead(on_switch);
    return;
  }
  const double crossing = edge_events_.next_instant();
  const bool extends = on_ground_ && !(edge_events_.end() < crossing) && !edge_events_.crosses_next();
  if (extends) extend(crossing);
  if (slow_zeno_.count()) pass_many_instants();
  if (!on_ground_) {
    apply_pending(on_switch);
  } else if (extends) {
    // A path that could not be told from an edge may have left it.
    const RegionId region = edge_events_.forward_region(region_);
    if (region != region_ && segment_.mode() != ContactMode::edge_sliding) {
      const MotionState now = segment_.told_at(crossing);
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
void Simulation::extend(double traced) {
  const InterruptScope scope(should_stop_);
  // The sphere is looked at at time(), which is rounded, and also if this is interrupted.
  segment_.forget_before(std::min(traced, std::max(0.0, epoch_.until(now_))));
  edge_events_.extend();
}

void Simulation::pass_crossing(double tau, const SwitchSink& on_switch) {
  edge_events_.pass_instant();
  const RegionId region = region_ahead();
  if (region == no_region) return;
  const MotionState now = segment_.told_at(tau);
  if (!segment_.uniform()) check_doubt(now.center);
  Arrival arrival = arrive(tau, now, edge_events_.snap_to_edge(now.center.position), Cause::edge);
  arrival.tau_remainder = next_remainder_;
  const SplitTime instant = epoch_.plus(tau, next_remainder_);
  ZenoDetector::Arrival& next = zeno_.next();
  next.left = region_;
  next.entered = region;
  next.time = instant.value;
  next.remainder = instant.remainder;
  next.position = arrival.state.position;
  next.twist = arrival.state.twist;
  next.contact = edge_events_.crossed_edge(region_, region);
  next.unseen = 0;
  comes_ = true;
  enter_ground(region, arrival, on_switch);
}

/// The motion has ended of itself.
void Simulation::pass_end(double tau, const SwitchSink& on_switch) {
  edge_events_.pass_without_crossing();
  // What has ended at once is 0 by the motion, though the velocities that were told may not be.
  const MotionState now = segment_.at(tau);
  Arrival arrival = arrive(tau, now, now.center.position, Cause::slip_ended);
  arrival.restarts = true;
  const bool repeats = has_ended_here(tau);
  RegionId region = region_;
  if (segment_.end_reason() == MotionEnd::edge_left) {
    arrival.cause = Cause::livelock_ended;
    region = segment_.edge_slide().leaves_into_first() ? region_ : partner_;
    arrival.state.contact_velocity = ground_velocity(ground_->material(region), arrival.state.position);
  } else {
    rules().end_motion(segment_.end_reason(), segment_.mode(), ground_->material(region_), arrival);
    if (repeats) hold(arrival);
  }
  enter_ground(region, arrival, on_switch);
}

/// Whether a mode of this kind has ended at this instant before, as soon as it began: it would go on so for
/// ever. So it would where each lasts for a time in which the forces change nothing.
bool Simulation::has_ended_here(double tau) {
  constexpr double no_time = 0x1p-60;
  const double scale = segment_.time_scale();
  const double brief = scale < never ? no_time * scale : 0;
  const bool at_once = tau <= brief;
  const auto mode = static_cast<unsigned>(1) << static_cast<unsigned>(segment_.mode());
  const double last_end = std::exchange(ended_at_, now_);
  if (!at_once || now_ > std::nextafter(last_end + brief, never)) ended_at_once_ = 0;
  const bool repeats = at_once && (ended_at_once_ & mode) != 0;
  ended_at_once_ |= at_once ? mode : 0U;
  return repeats;
}

/// The ground holds the sphere where rounding does not tell whether it does. Where that has come to nothing
/// at this instant, what is left of the velocities, too little for the accuracy asked for, is none.
void Simulation::hold(Arrival& arrival) {
  constexpr unsigned held = 1U << 31U;
  constexpr unsigned at_rest = 1U << 30U;
  constexpr const char* unknown = "rounding does not tell whether friction holds the sphere";
  const scene::Material& material = ground_->material(region_);
  if ((std::exchange(ended_at_once_, ended_at_once_ | held) & held) == 0) {
    if (!rules().hold(material, arrival)) halt(unknown);
    return;
  }
  const Vector2d u = ground_velocity(material, arrival.state.position);
  const double left = (arrival.state.twist.velocity - u).norm() + (arrival.state.contact_velocity - u).norm();
  const bool again = (std::exchange(ended_at_once_, ended_at_once_ | at_rest) & at_rest) != 0;
  if (again || left > segment_.solver().accuracy * fastest_) halt(unknown);
  rules().stop(material, arrival);
}

void Simulation::schedule_next() {
  if (limit_) {
    next_remainder_ = limit_->time.remainder;
    schedule(limit_->time.value);
    return;
  }
  const double tau = std::min(edge_events_.next_instant(), edge_events_.end());
  next_remainder_ =
      edge_events_.end() < edge_events_.next_instant() ? 0 : edge_events_.remainder_of_next_instant();
  schedule(std::isinf(tau) ? tau : epoch_.plus(tau, next_remainder_).value);
}

}  // namespace hybrid_sphere

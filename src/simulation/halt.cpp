// Where the computation stops, and what the sphere's state is there.
#include <algorithm>
#include <cmath>
#include <new>

#include "hybrid_sphere/simulation/simulation.hpp"
#include "hybrid_sphere/sphere/contact_mode.hpp"

namespace hybrid_sphere {
namespace {

/// Slip relative to a ground; smooth ground has no velocity that matters.
Vector2d slip_on(const scene::Material& material, const Vector2d& contact_velocity,
                 const Vector2d& position) {
  if (material.law == scene::Law::smooth) return contact_velocity;
  return contact_velocity - ground_velocity(material, position);
}

bool is_finite(const Segment::Start& state) {
  return state.position.allFinite() && state.orientation.coeffs().allFinite() &&
         state.twist.velocity.allFinite() && state.twist.angular_velocity.allFinite() &&
         state.contact_velocity.allFinite();
}

Mode mode_of(ContactMode mode, bool at_rest) {
  switch (mode) {
    case ContactMode::free: return Mode::free;
    case ContactMode::sliding:
    case ContactMode::skidding: return Mode::sliding;
    case ContactMode::rolling:
    case ContactMode::sticking: return at_rest ? Mode::resting : Mode::rolling;
    case ContactMode::edge_sliding: break;
  }
  return Mode::edge_sliding;
}

}  // namespace

void Simulation::set_interrupt(std::function<bool()> should_stop) {
  if (!should_stop) {
    should_stop_ = nullptr;
    return;
  }
  should_stop_ = [ask = std::move(should_stop)] {
    try {
      return ask();
    } catch (...) {
      throw Foreign{std::current_exception()};
    }
  };
}

/// Makes sure that the state at a time can be told, or halts at the last time at which it can.
void Simulation::reach(double time) {
  const bool is_known = segment_.uniform() && !should_stop_;
  if (detached_ || is_known) return;
  const auto stand_at_last = [&] {
    const double reached = segment_.reached();
    double last = reached < never ? std::min(epoch_.plus(reached).value, time) : time;
    while (last > now_ && epoch_.until(last) > reached) last = std::nextafter(last, 0);
    now_ = std::max(now_, last);
  };
  const InterruptScope scope(should_stop_);
  try {
    interruption_point();
    segment_.reach(epoch_.until(time));
  } catch (const Interrupted&) {
    stand_at_last();
    schedule(next_instant_);
    throw;
  } catch (const Foreign&) {
    stand_at_last();
    schedule(next_instant_);
    throw;
  } catch (const std::bad_alloc&) {
    stand_at_last();
    halt_without_memory();
  } catch (const std::exception& error) {
    stand_at_last();
    halt(error.what());
  }
}

void Simulation::halt(const std::string& reason) { stop(HaltedError(now_, reason)); }

void Simulation::halt_without_memory() { stop(HaltedError(now_, out_of_memory_)); }

/// The sphere stands from here on; nothing is thrown but what was asked for.
void Simulation::stop(const HaltedError& reason) {
  halted_ = reason;
  hold_state();
  name_ground();
  schedule(now_);
  throw HaltedError(*halted_);
}

/// Where no ground has acted yet, the state tells the one under the sphere, if there is memory to look it up.
void Simulation::name_ground() {
  if (!state_.region.empty()) return;
  try {
    state_.region = ground_->name(ground_->top_region(state_.position));
    named_by_ = ground_;
  } catch (const std::bad_alloc&) {
    return;
  }
}

/// Keeps the state and the reaction at time(), so that they can be told whatever becomes of the motion.
void Simulation::hold_state() {
  if (state_is_held_) return;
  const double tau = std::max(0.0, epoch_.until(now_));
  const Segment::Start told{state_.position, state_.orientation, state_.twist, sigma_};
  try {
    update_state(tau);
    reaction_ = reaction_of(segment_.at(tau).center);
    state_is_held_ =
        is_finite({state_.position, state_.orientation, state_.twist, sigma_}) && reaction_.allFinite();
  } catch (...) {
    state_is_held_ = false;
  }
  if (!state_is_held_) detach(is_finite(arrival_.state) ? arrival_.state : told);
  state_.time = now_;
}

/// There is no motion: the sphere stands in a state of its own, with the constraint in force.
void Simulation::detach(const Segment::Start& start) {
  detached_ = state_is_held_ = true;
  state_.time = now_;
  if (!is_finite(start)) return;  // the last one that was told
  state_.position = start.position;
  state_.orientation = start.orientation;
  sigma_ = start.contact_velocity;
  describe(mode_, start.twist, start.contact_velocity, false, start.position);
  const Vector2d& v = start.twist.velocity;
  const Dynamics& dynamics = segment_.dynamics();
  const bool touches =
      mode_ != ContactMode::free && mode_ != ContactMode::edge_sliding && region_ != no_region;
  Vector2d acceleration = dynamics.acceleration(start.position, v);
  if (touches) {
    const scene::Material& material = ground_->material(region_);
    const Vector2d nu =
        dynamics.radius * Vector2d(start.twist.angular_velocity.y(), -start.twist.angular_velocity.x());
    const ContactForces forces(dynamics, material, start.position, v, nu);
    acceleration += contact_response(forces, state_.slip, nu).reaction;
  }
  reaction_ = reaction_of({start.position, v, acceleration});
}

const State& Simulation::state_of_motion() {
  try {
    update_state(std::max(0.0, epoch_.until(now_)));
    state_.time = now_;
  } catch (const std::exception& error) {
    give_up(error.what());
  }
  return state_;
}

/// What is thrown while the state is looked at is told by the next advance_to; the state is the last one that
/// was told.
void Simulation::give_up(const char* reason) {
  try {
    halted_ = HaltedError(now_, reason);
  } catch (const std::bad_alloc&) {
    halted_ = HaltedError(now_, out_of_memory_);
  }
  state_is_held_ = true;
  schedule(now_);
}

/// What the state says at a time of the segment: all of it, or nothing where that throws.
void Simulation::update_state(double tau) {
  const MotionState now = segment_.told_at(tau);
  state_.orientation = segment_.orientation(tau);
  state_.position = now.center.position;
  note_velocities(now);
}

void Simulation::note_velocities(const MotionState& now) {
  const Twist twist{now.center.velocity, now.angular_velocity};
  const bool at_rest = segment_.uniform() && twist.velocity.isZero(0) && twist.angular_velocity.isZero(0);
  const Vector2d sigma = segment_.uniform() ? sigma_ : now.contact_velocity;
  describe(segment_.mode(), twist, sigma, at_rest, now.center.position);
}

void Simulation::describe(ContactMode mode, const Twist& twist, const Vector2d& contact_velocity,
                          bool at_rest, const Vector2d& position) {
  state_.twist = twist;
  if (mode == ContactMode::rolling || mode == ContactMode::sticking) {
    state_.slip = Vector2d::Zero();
  } else {
    state_.slip = region_ == no_region ? contact_velocity
                                       : slip_on(ground_->material(region_), contact_velocity, position);
  }
  state_.stage = constraint_.holds() ? Stage::nonholonomic : Stage::holonomic;
  state_.mode = mode_of(mode, at_rest);
}

/// lambda = m (v' - f).
Vector3d Simulation::reaction_of(const PointState& center) const {
  const Dynamics& dynamics = segment_.dynamics();
  const Vector2d lambda =
      sphere_.mass() * (center.acceleration - dynamics.acceleration(center.position, center.velocity));
  return {lambda.x(), lambda.y(), dynamics.normal_force};
}

Vector3d Simulation::reaction() {
  if (state_is_held_) return reaction_;
  if (segment_.mode() == ContactMode::free) return {0, 0, segment_.dynamics().normal_force};
  try {
    reaction_ = reaction_of(segment_.at(std::max(0.0, epoch_.until(now_))).center);
  } catch (const std::exception& error) {
    give_up(error.what());
  }
  return reaction_;
}

}  // namespace hybrid_sphere

// Where stages switch: what a ground imposes when the sphere comes to it. Rules: docs/theory.md 5.2, 5.4.
#include <algorithm>
#include <cfloat>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "hybrid_sphere/simulation/simulation.hpp"

namespace hybrid_sphere {
namespace {

using scene::Law;

Stage stage_of(const Constraint& constraint) {
  return constraint.holds() ? Stage::nonholonomic : Stage::holonomic;
}

SwitchKind kind_of(const Constraint& before, const Constraint& after) {
  if (!before.holds()) return SwitchKind::applied;
  return after.holds() ? SwitchKind::exchanged : SwitchKind::released;
}

}  // namespace

/// The orientation and the contacts are left open: they are needed only where a new segment begins.
Arrival Simulation::arrive(double tau, const MotionState& now, const Vector2d& position, Cause cause) const {
  const Twist twist{now.center.velocity, now.angular_velocity};
  const Vector2d sigma = segment_.uniform() ? sigma_ : now.contact_velocity;
  return {tau, {position, Quaterniond::Identity(), twist, sigma}, cause};
}

/// How far a motion is followed at first: where the sphere has come back to an edge again and again, it is
/// expected back.
double Simulation::first_horizon() const {
  const double back = 2 * zeno_.expected();
  return back > 0 ? back : never;
}

/// How far its path is traced at first: the next piece is twice as long, and steps of a fixed length cost as
/// much in a motion that changes nothing.
double Simulation::first_piece() const {
  constexpr double few = 1024;
  const scene::Solver& solver = segment_.solver();
  return solver.has_fixed_step() ? std::min(first_horizon(), few * solver.step) : first_horizon();
}

void Simulation::begin_segment(const SplitTime& epoch, ContactMode mode, const scene::Material& material,
                               const Segment::Start& start) {
  const double speed = start.twist.velocity.norm();
  if (!(speed <= max_speed) || !start.twist.angular_velocity.allFinite())
    throw std::runtime_error("the velocities leave the range up to 1e100 m/s");
  epoch_ = epoch;
  fastest_ = std::max({fastest_, speed, start.contact_velocity.norm()});
  segment_.begin(mode, material, start, first_horizon());
  detached_ = state_is_held_ = false;
}

/// The sphere goes on freely, until the ground into which its path leads acts.
/// @param before  as it was before an impulse from outside
void Simulation::begin_free(const SplitTime& instant, Arrival& arrival, const Segment::Start& before) {
  try {
    begin_segment(instant, ContactMode::free, scene::Material(), arrival.state);
  } catch (...) {
    detach(before);
    throw;
  }
  arrival.tau = 0;
  arrival_ = arrival;
  before_ = before;
  ahead_ = Ahead::to_place;
}

void Simulation::complete(Arrival& arrival) {
  if (std::exchange(arrival.complete, true)) return;
  // Unit anew: the roundings of many segments would add up.
  arrival.state.orientation = segment_.orientation(arrival.tau).normalized();
  const Contacts& contacts = edge_events_.contacts();
  contacts_.assign(contacts.begin(), contacts.end());
  meet_corners(arrival);
}

/// The way whose rounding the place has: at the speeds of centre and contact at its beginning or its end, and
/// at those that the forces would give without each other [m].
double Simulation::rounded_way(const Arrival& arrival) {
  if (segment_.uniform()) return 0;
  const double end = arrival.state.twist.velocity.norm() + arrival.state.contact_velocity.norm();
  const double pull = segment_.motion().acceleration_bound(arrival.tau, arrival.tau);
  return (std::max(segment_.first_speed(), end) + pull * arrival.tau) * arrival.tau;
}

/// The end of a side from which rounding does not tell the place is the place: from a corner a straight path
/// and a curved one lead into the same ground, within rounding of it they need not.
void Simulation::meet_corners(Arrival& arrival) {
  Vector2d& position = arrival.state.position;
  const Vector2d way = Vector2d::Constant(rounded_way(arrival));
  for (Contact& contact : contacts_) {
    const auto* polygon = std::get_if<scene::Polygon>(&ground_->shape(contact.region));
    if (!polygon || contact.followed || contact.piece.kind != EdgePiece::Kind::line) continue;
    const Vector2d start = segment_.motion().curve().start;
    const auto size = static_cast<std::int32_t>(polygon->vertices.size());
    for (const std::int32_t i : {contact.piece.index, contact.piece.index + 1}) {
      const std::int32_t corner = i < size ? i : 0;
      const Vector2d& vertex = polygon->vertices[static_cast<std::size_t>(corner)];
      const Vector2d off = (position - vertex).cwiseAbs();
      const Vector2d rounding = 4 * DBL_EPSILON * (vertex.cwiseAbs() + start.cwiseAbs() + way);
      if ((off.array() > rounding.array()).any()) continue;
      contact.piece = {EdgePiece::Kind::vertex, corner};
      position = vertex;
    }
  }
}

/// Traces the first piece of the path of a new segment.
void Simulation::trace() {
  const InterruptScope scope(should_stop_);
  if (segment_.uniform()) {
    const UniformMotion& motion = segment_.uniform_motion();
    edge_events_.begin(motion.start(), motion.twist().velocity, contacts_);
    return;
  }
  const Curve curve = segment_.motion().curve();
  // What slides along an edge is on its line, whatever rounding makes of the velocity.
  const bool is_uniform = curve.form == CurveForm::parabola && curve.acceleration.isZero(0) &&
                          (segment_.mode() != ContactMode::edge_sliding || curve.velocity.isZero(0));
  if (is_uniform && segment_.motion().end_before(max_time) == never) {
    edge_events_.begin(curve.start, curve.velocity, contacts_);
  } else {
    edge_events_.begin(segment_.motion(), segment_.time_scale(), first_piece(), contacts_);
  }
}

/// A curved path comes to an edge so slowly across it that rounding does not tell when, though it runs on
/// along the edge: the switch may be off by a good part of what is to come. A motion that has died out to
/// less than the accuracy goes on: nobody sees the difference.
void Simulation::check_doubt(const PointState& center) {
  constexpr double much = 0x1p-10;
  constexpr double many = 0x1p+10;  // rounding errors of the place
  const double doubt = edge_events_.doubt();
  const double scale = segment_.time_scale();
  const double way = doubt * center.velocity.norm();
  const double small =
      std::max(many * DBL_EPSILON * center.position.norm(), segment_.solver().accuracy * fastest_ * scale);
  if (!(doubt > much * scale && way > small)) return;
  std::ostringstream reason;
  reason << "rounding does not tell when the path meets the edge at x = " << center.position.x()
         << " m, y = " << center.position.y() << " m: " << doubt << " s before or after t = " << now_ << " s";
  halt(reason.str());
}

/// The sphere comes to a ground; trace_ahead must follow.
void Simulation::enter_ground(RegionId region, const Arrival& arrival, const SwitchSink& on_switch) {
  const Vector2d& place = arrival.state.position;
  const auto stays = [&] {
    return segment_.is_whole() && segment_.at(0.5 * arrival.tau).center.position == place;
  };
  if (standstill_.count(place, stays)) halt_in_accumulation();
  visited_.clear();
  thrown_.reset();
  arrival_ = arrival;
  switch_to(region, on_switch);
}

void Simulation::switch_to(RegionId region, const SwitchSink& on_switch) {
  Arrival& arrival = arrival_;
  visited_.push_back(region);
  const scene::Material& material = ground_->material(region);
  Switch event;
  event.before = arrival.state.twist;
  const Vector2d contact_velocity = arrival.state.contact_velocity;
  const Reset reset = rules().enter(
      material, {region_ != no_region, segment_.mode(), segment_.material(), constraint_}, arrival);
  ContactMode mode = reset.mode;
  event.slip_before = reset.slip_before;
  event.impulse = reset.impulse;
  event.angular_impulse = reset.angular_impulse;
  jumped_ = reset.jumps();
  const bool goes_on = !jumped_ && !arrival.restarts && segment_.continues(mode, material);
  const SplitTime instant = epoch_.plus(arrival.tau, arrival.tau_remainder);
  event.time = instant.value;
  event.time_remainder = instant.remainder;
  if (goes_on) {
    segment_.continue_as(mode, material);
    ahead_ = Ahead::to_schedule;
  } else {
    complete(arrival);
    if (arrival.cause == Cause::accumulation) rules().stop_across(limit_->normal, arrival);
    const Vector2d ground = ground_velocity(material, arrival.state.position);
    if (rules().keep_on_line(edge_events_.line(), ground, arrival.state) && mode != ContactMode::free) {
      const Vector2d& velocity = arrival.state.twist.velocity;
      const Vector2d& sigma = arrival.state.contact_velocity;
      mode = contact_mode_on(segment_.dynamics(), material, arrival.state.position, velocity, sigma - ground,
                             velocity - sigma);
    }
    try {
      begin_segment(instant, mode, material, arrival.state);
    } catch (...) {  // the constraint in force is still that of before
      arrival.state.twist = event.before;
      arrival.state.contact_velocity = contact_velocity;
      detach(arrival.state);
      throw;
    }
    arrival.tau = arrival.tau_remainder = 0;
    ahead_ = Ahead::to_throw;
  }
  commit_transition(region, constraint_of(mode, material), arrival, event, on_switch);
}

/// The ground that the sphere comes to; no region where it goes on as it does. An edge slide needs both of
/// its grounds.
RegionId Simulation::region_ahead() const {
  const bool slides = segment_.mode() == ContactMode::edge_sliding;
  if (slides && !edge_events_.visible(partner_)) return edge_events_.forward_region(no_region);
  const RegionId region = edge_events_.forward_region(region_);
  return region == region_ ? no_region : region;
}

/// Traces the path of a new segment, and does what the grounds into which it leads do at the same instant.
/// Where that is interrupted, the next call goes on.
void Simulation::trace_ahead(const SwitchSink& on_switch) {
  while (ahead_ != Ahead::known) {
    if (ahead_ == Ahead::to_schedule) {
      ahead_ = Ahead::known;
      break;
    }
    try {
      trace();
    } catch (const Interrupted&) {
      throw;
    } catch (const Foreign&) {
      throw;
    } catch (...) {  // the motion cannot be followed at all: the sphere stands as the last switch left it
      detach(ahead_ == Ahead::to_place ? before_ : arrival_.state);
      throw;
    }
    const Ahead traced = std::exchange(ahead_, Ahead::known);
    const bool slides = traced == Ahead::to_slide;
    const bool throws = traced == Ahead::to_throw || slides;
    const RegionId next =
        slides ? region_ahead()
               : edge_events_.forward_region(throws || partner_ == no_region ? region_ : no_region);
    if (!throws) {
      visited_.clear();
    } else if (next == (slides ? no_region : region_)) {
      break;
    } else {
      if (jumped_ && !slides) {
        thrown_ = {region_, arrival_.state.twist.velocity, segment_.at(0).center.acceleration};
        // Grounds that do not set the velocity may lead elsewhere now.
        const auto leaves_it = [this](RegionId region) { return !strikes(region); };
        visited_.erase(std::remove_if(visited_.begin(), visited_.end(), leaves_it), visited_.end());
      }
      if (std::find(visited_.begin(), visited_.end(), next) != visited_.end()) {
        resolve_livelock(next, on_switch);
        continue;
      }
      // Thrown back, the sphere is in another region at once: docs/theory.md 5.2, rule 6. What the ground
      // itself brought about ends with the first switch; an intervention is the cause of all switches of its
      // instant.
      if (arrival_.cause != Cause::placed && arrival_.cause != Cause::kicked) arrival_.cause = Cause::edge;
      arrival_.mode.reset();
      arrival_.restarts = arrival_.struck = false;
    }
    switch_to(next, on_switch);
  }
  monitor_zeno();
  if (on_ground_) schedule_next();
}

/// The constraint changes from here on; reported if it does.
void Simulation::commit_transition(RegionId region, const Constraint& constraint, const Arrival& arrival,
                                   Switch& event, const SwitchSink& on_switch, RegionId partner) {
  std::shared_ptr<const Ground> named_from;
  if (named_by_ != ground_) named_from = std::exchange(named_by_, ground_);
  event.from_region = std::exchange(state_.region, ground_->name(region));
  event.to_region = state_.region;
  region_ = region;
  partner_ = partner;
  sigma_ = arrival.state.contact_velocity;
  const Constraint before = std::exchange(constraint_, constraint);
  mode_ = segment_.mode();
  if (segment_.uniform()) note_velocities(segment_.at(arrival.tau));
  if (before == constraint) return;
  event.index = switches_++;
  event.kind = kind_of(before, constraint);
  event.cause = arrival.cause;
  event.from_stage = stage_of(before);
  event.to_stage = stage_of(constraint);
  event.position = arrival.state.position;
  event.after = arrival.state.twist;
  event.energy_before = sphere_.kinetic_energy(event.before);
  event.energy_after = sphere_.kinetic_energy(event.after);
  if (!on_switch) return;
  try {
    on_switch(event);
  } catch (...) {
    throw Foreign{std::current_exception()};
  }
}

}  // namespace hybrid_sphere

#include "simulation/state_report.hpp"

#include <new>
#include <utility>

#include "sphere/contact_mode.hpp"

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

void StateReport::set_held(bool held) {
  held_ = held;
  const bool is_constant = !held && hybrid_.segment.uniform();
  outlook_.epoch = hybrid_.epoch.value;
  outlook_.epoch_remainder = hybrid_.epoch.remainder;
  outlook_.motion = is_constant ? &hybrid_.segment.uniform_motion().constant_twist() : nullptr;
}

void StateReport::follow_segment() {
  detached_ = false;
  set_held(false);
}

void StateReport::follow_segment_if_any() { set_held(detached_); }

void StateReport::hold() { set_held(true); }

void StateReport::hold_at_present(const Segment::Start& fallback) {
  if (held_) return;
  const double tau = hybrid_.tau_at(outlook_.now);
  const Segment::Start told{outlook_.state.position, outlook_.state.orientation, outlook_.state.twist,
                            hybrid_.in_force.contact_velocity};
  bool is_known = false;
  try {
    update(tau);
    reaction_ = reaction_of(hybrid_.segment.at(tau).center);
    is_known = is_finite({outlook_.state.position, outlook_.state.orientation, outlook_.state.twist,
                          hybrid_.in_force.contact_velocity}) &&
               reaction_.allFinite();
  } catch (...) {
    is_known = false;
  }
  set_held(is_known);
  if (!is_known) stand(is_finite(fallback) ? fallback : told);
  outlook_.state.time = outlook_.now;
}

void StateReport::stand(const Segment::Start& start) {
  detached_ = true;
  if (is_finite(start)) hybrid_.in_force.contact_velocity = start.contact_velocity;
  hold_at(start);
}

void StateReport::hold_at(const Segment::Start& start) {
  set_held(true);
  outlook_.state.time = outlook_.now;
  if (!is_finite(start)) return;
  InForce& in_force = hybrid_.in_force;
  outlook_.state.position = start.position;
  outlook_.state.orientation = start.orientation;
  const bool rests = outlook_.state.mode == Mode::resting && start.twist.velocity.isZero(0) &&
                     start.twist.angular_velocity.isZero(0);
  describe(in_force.mode, start.twist, start.contact_velocity, rests, start.position);
  const Vector2d& v = start.twist.velocity;
  const Dynamics& dynamics = hybrid_.segment.dynamics();
  const bool touches = in_force.mode != ContactMode::free && in_force.mode != ContactMode::edge_sliding &&
                       in_force.region != no_region;
  Vector2d acceleration = dynamics.acceleration(start.position, v);
  if (touches) {
    const scene::Material& material = hybrid_.ground->material(in_force.region);
    const Vector2d nu =
        dynamics.radius * Vector2d(start.twist.angular_velocity.y(), -start.twist.angular_velocity.x());
    const ContactForces forces(dynamics, material, start.position, v, nu);
    acceleration += contact_response(forces, outlook_.state.slip, nu).reaction;
  }
  reaction_ = reaction_of({start.position, v, acceleration});
}

void StateReport::update(double tau) {
  const MotionState now = hybrid_.segment.output_at(tau);
  outlook_.state.orientation = hybrid_.segment.orientation(tau);
  outlook_.state.position = now.center.position;
  note_velocities(now);
}

void StateReport::note_velocities(const MotionState& now) {
  const Twist twist{now.center.velocity, now.angular_velocity};
  const Segment& segment = hybrid_.segment;
  const bool stands = twist.velocity.isZero(0) && twist.angular_velocity.isZero(0);
  const bool at_rest = stands && (segment.uniform() ||
                                  (now.center.acceleration.isZero(0) && segment.dynamics().normal_spin == 0));
  const Vector2d sigma = segment.uniform() ? hybrid_.in_force.contact_velocity : now.contact_velocity;
  describe(segment.mode(), twist, sigma, at_rest, now.center.position);
}

void StateReport::describe(ContactMode mode, const Twist& twist, const Vector2d& contact_velocity,
                           bool at_rest, const Vector2d& position) {
  const InForce& in_force = hybrid_.in_force;
  outlook_.state.twist = twist;
  if (mode == ContactMode::rolling || mode == ContactMode::sticking) {
    outlook_.state.slip = Vector2d::Zero();
  } else {
    outlook_.state.slip = in_force.region == no_region ? contact_velocity
                                                       : slip_on(hybrid_.ground->material(in_force.region),
                                                                 contact_velocity, position);
  }
  outlook_.state.stage = in_force.constraint.holds() ? Stage::nonholonomic : Stage::holonomic;
  outlook_.state.mode = mode_of(mode, at_rest);
}

/// lambda = m (v' - f).
Vector3d StateReport::reaction_of(const PointState& center) const {
  const Dynamics& dynamics = hybrid_.segment.dynamics();
  const Vector2d lambda =
      hybrid_.sphere.mass() * (center.acceleration - dynamics.acceleration(center.position, center.velocity));
  return {lambda.x(), lambda.y(), dynamics.normal_force};
}

const Vector3d& StateReport::update_reaction() {
  reaction_ = reaction_of(hybrid_.segment.at(hybrid_.tau_at(outlook_.now)).center);
  return reaction_;
}

std::shared_ptr<const Ground> StateReport::name(RegionId region) {
  std::shared_ptr<const Ground> before;
  if (named_by_ != hybrid_.ground) before = std::exchange(named_by_, hybrid_.ground);
  outlook_.state.region = hybrid_.ground->name(region);
  return before;
}

void StateReport::name_if_nameless() {
  if (!outlook_.state.region.empty()) return;
  try {
    outlook_.state.region = hybrid_.ground->name(hybrid_.ground->top_region(outlook_.state.position));
    named_by_ = hybrid_.ground;
  } catch (const std::bad_alloc&) {
    return;
  }
}

}  // namespace hybrid_sphere

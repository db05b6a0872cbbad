#include "simulation/switching_rules.hpp"

#include <algorithm>
#include <cfloat>
#include <cmath>

#include "sphere/contact_mode.hpp"

namespace hybrid_sphere {

bool SwitchingRules::keep_on_line(const Vector2d& line, const Vector2d& ground, Segment::Start& state) const {
  if (line.x() == 0 || line.y() == 0) return false;  // along an axis nothing is rounded across it
  const Vector2d along = line.normalized();
  const auto kept = [&](const Vector2d& v) { return v == ground ? v : Vector2d(along.dot(v) * along); };
  const Vector2d velocity = kept(state.twist.velocity);
  const Vector2d contact_velocity = kept(state.contact_velocity);
  const double across =
      (velocity - state.twist.velocity).norm() + (contact_velocity - state.contact_velocity).norm();
  // A spring makes velocities of the rounding of places, which tell the direction of no slow motion.
  constexpr double greatest_angle = 0x1p-20;
  const double place = state.position.norm() + dynamics_->spring_center.norm();
  const double of_places = DBL_EPSILON * std::sqrt(dynamics_->spring_rate) * place;
  if (across == 0 || across > std::max(rounding_, std::min(of_places, greatest_angle * velocity.norm())))
    return false;
  const bool slips = state.contact_velocity != ground;
  const bool turns = state.twist.velocity != state.contact_velocity;
  state.twist.velocity = velocity;
  state.contact_velocity = contact_velocity;
  const Vector2d nu = velocity - contact_velocity;
  state.twist.angular_velocity.x() = (0 - nu.y()) / sphere_->radius();
  state.twist.angular_velocity.y() = nu.x() / sphere_->radius();
  return (slips && contact_velocity == ground) || (turns && nu.isZero(0));
}

/// The velocities after an impulse that takes away the slip on ground that moves with u.
Twist SwitchingRules::stopped(const Segment::Start& state, const Vector2d& slip, const Vector2d& u) const {
  const Twist& before = state.twist;
  Twist after = sphere_->rolling_twist(sphere_->conserved_velocity(before), u, before.angular_velocity.z());
  // Along an axis without slip nothing changes, whatever rounding does to p_c + kappa u.
  for (int i = 0; i < 2; ++i) {
    if (slip[i] != 0) continue;
    after.velocity[i] = before.velocity[i];
    after.angular_velocity[1 - i] = before.angular_velocity[1 - i];
  }
  // When a sphere is brought to rest, on the ground or in space, rounding may leave a small velocity. No
  // squares: they underflow.
  constexpr double roundings = 32;
  const auto size = [](const Vector2d& v) { return v.lpNorm<Eigen::Infinity>(); };
  const double small =
      roundings * DBL_EPSILON * (size(before.velocity) + size(state.contact_velocity) + size(u));
  if (size(after.velocity - u) <= small) {
    after.velocity = u;
    after.angular_velocity.head<2>().setZero();
  } else if (size(after.velocity) <= small) {
    after.velocity.setZero();
    after.angular_velocity.head<2>() = Vector2d(u.y(), 0 - u.x()) / sphere_->radius();
  }
  return after;
}

/// Friction mu N gives no impulse: the sphere slips on.
Reset SwitchingRules::reset_on_coulomb(const scene::Material& ground, const Vector2d& slip,
                                       Arrival& arrival) const {
  Segment::Start& state = arrival.state;
  const Vector3d& omega = state.twist.angular_velocity;
  Reset reset;
  reset.slip_before = slip;
  if (arrival.mode) {
    reset.mode = *arrival.mode;
    return reset;
  }
  const Vector2d nu = dynamics_->radius * Vector2d(omega.y(), -omega.x());
  // A remainder of faster motions that rounding cannot distinguish from rest is rest.
  if (slip.lpNorm<Eigen::Infinity>() + nu.lpNorm<Eigen::Infinity>() <= rounding_) {
    const Vector2d u = ground_velocity(ground, state.position);
    state.twist.velocity = state.contact_velocity = u;
    state.twist.angular_velocity.head<2>().setZero();
    arrival.restarts = true;
    reset.mode = contact_mode_on(*dynamics_, ground, state.position, u, Vector2d::Zero(), Vector2d::Zero());
    return reset;
  }
  reset.mode = contact_mode_on(*dynamics_, ground, state.position, state.twist.velocity, slip, nu);
  return reset;
}

Reset SwitchingRules::apply_reset(const scene::Material& ground, const Before& before,
                                  Arrival& arrival) const {
  Reset reset;
  if (is_frictionless(*dynamics_, ground)) return reset;
  Segment::Start& state = arrival.state;
  // The same ground keeps acting as before.
  if (goes_on_over(ground, before, arrival)) {
    reset.mode = before.mode;
    return reset;
  }
  const Vector2d u = ground_velocity(ground, state.position);
  // What the constraint in force keeps at 0 is 0, despite rounding.
  const bool held = !arrival.struck && before.constraint.keeps_from_slipping_on(ground);
  const Vector2d slip = held ? Vector2d::Zero() : Vector2d(state.contact_velocity - u);
  if (ground.law == scene::Law::coulomb && !slip.isZero(0)) return reset_on_coulomb(ground, slip, arrival);
  reset.slip_before = slip;
  double& spin = state.twist.angular_velocity.z();
  if (!slip.isZero(0)) {
    reset.impulse = sphere_->stopping_impulse(slip);
    reset.angular_impulse = sphere_->angular_impulse(reset.impulse);
    state.twist = stopped(state, slip, u);
  }
  if (ground.law == scene::Law::rubber) {
    if (spin != ground.turntable_rate)
      reset.angular_impulse.z() = sphere_->spin_impulse(ground.turntable_rate - spin);
    spin = ground.turntable_rate;
  }
  state.contact_velocity = u;
  reset.mode = arrival.mode ? *arrival.mode
                            : contact_mode_on(*dynamics_, ground, state.position, state.twist.velocity,
                                              Vector2d::Zero(), state.twist.velocity - u);
  return reset;
}

/// Whether the sphere reaches ground that differs from the one in force only in its place, and nothing else
/// has happened to it.
bool SwitchingRules::goes_on_over(const scene::Material& ground, const Before& before,
                                  const Arrival& arrival) const {
  const bool disturbed = arrival.restarts || arrival.struck || arrival.mode;
  return !disturbed && before.has_acted && before.mode != ContactMode::edge_sliding &&
         same_ground(ground, before.material);
}

void SwitchingRules::end_motion(MotionEnd end, ContactMode mode, const scene::Material& material,
                                Arrival& arrival) const {
  const bool skids = mode == ContactMode::skidding;
  Segment::Start& state = arrival.state;
  const Vector2d u = ground_velocity(material, state.position);
  // Slip and turning that are used up together leave only the rounding of the velocities.
  const bool told = (state.twist.velocity - u).norm() > rounding_;
  const bool rests = end == MotionEnd::slip_used_up && !told && resists_rolling(*dynamics_, material);
  const bool stops_turning = rests || end == MotionEnd::roll_used_up || end == MotionEnd::breaks_loose ||
                             mode == ContactMode::sticking || skids;
  const bool slips = (mode == ContactMode::sliding && end == MotionEnd::roll_used_up && told) ||
                     (skids && end == MotionEnd::breaks_loose);
  if (stops_turning) state.twist.angular_velocity.head<2>().setZero();
  state.contact_velocity = slips ? state.twist.velocity : u;
  const bool turns = !state.twist.angular_velocity.head<2>().isZero(0);
  if (!slips && !turns) state.twist.velocity = u;  // exactly at rest relative to the ground
  if (end == MotionEnd::breaks_loose) arrival.mode = skids ? ContactMode::sliding : ContactMode::rolling;
  if (end == MotionEnd::grip_lost) arrival.mode = ContactMode::sliding;
  if (mode == ContactMode::sticking) {
    const bool loses_grip =
        end == MotionEnd::grip_lost || needs_all_friction(*dynamics_, material, state.position);
    arrival.mode = loses_grip ? ContactMode::skidding : ContactMode::rolling;
  }
  if (mode == ContactMode::rolling && end == MotionEnd::roll_used_up) {
    const Vector2d still = Vector2d::Zero();
    arrival.mode = contact_mode_on(*dynamics_, material, state.position, u, still, still);
  }
  const bool released = arrival.mode == ContactMode::sliding || arrival.mode == ContactMode::skidding;
  if (released) arrival.cause = Cause::grip_lost;
}

bool SwitchingRules::hold(const scene::Material& ground, Arrival& arrival) const {
  const Segment::Start& state = arrival.state;
  const Vector2d slip = state.contact_velocity - ground_velocity(ground, state.position);
  const bool turns = !state.twist.angular_velocity.head<2>().isZero(0);
  const bool slips = !slip.isZero(0);
  const bool resists = resists_rolling(*dynamics_, ground);
  arrival.mode = slips               ? ContactMode::skidding
                 : turns || !resists ? ContactMode::rolling
                                     : contact_mode_from_rest(*dynamics_, ground, state.position);
  arrival.state.loose = true;
  if (!slips) return true;
  scene::Material raised = ground;
  raised.rolling_resistance *= 1 + 0x1p-20;
  return contact_mode_on(*dynamics_, raised, state.position, state.twist.velocity, slip, Vector2d::Zero()) ==
         ContactMode::skidding;
}

void SwitchingRules::stop(const scene::Material& ground, Arrival& arrival) const {
  Segment::Start& state = arrival.state;
  const Vector2d u = ground_velocity(ground, state.position);
  state.twist.angular_velocity.head<2>().setZero();
  state.twist.velocity = state.contact_velocity = u;
  arrival.mode = contact_mode_on(*dynamics_, ground, state.position, u, Vector2d::Zero(), Vector2d::Zero());
}

Vector2d SwitchingRules::acceleration_on(const scene::Material& ground, const Segment::Start& state) const {
  const Vector2d& velocity = state.twist.velocity;
  const Vector2d force = dynamics_->acceleration(state.position, velocity);
  if (is_frictionless(*dynamics_, ground)) return force;
  const Vector2d nu = velocity - state.contact_velocity;
  const Vector2d slip = state.contact_velocity - ground_velocity(ground, state.position);
  const ContactForces forces(*dynamics_, ground, state.position, velocity, nu);
  return force + contact_response(forces, slip, nu).reaction;
}

std::optional<Segment::Start> SwitchingRules::drawn_in(const scene::Material& ground, const LocalEdge& edge,
                                                       const Segment::Start& state, double small) const {
  Arrival arrival;
  arrival.state = state;
  Segment::Start& drawn = arrival.state;
  const Vector2d u = ground_velocity(ground, drawn.position);
  const bool is_smooth = is_frictionless(*dynamics_, ground);
  if (!is_smooth && (drawn.contact_velocity - u).norm() <= small) {
    drawn.twist =
        sphere_->rolling_twist(sphere_->conserved_velocity(drawn.twist), u, drawn.twist.angular_velocity.z());
    drawn.contact_velocity = u;
  } else if (sets_velocity(ground)) {
    return std::nullopt;
  }
  if (std::abs(drawn.twist.velocity.dot(edge.normal)) > small) return std::nullopt;
  const Vector3d omega = drawn.twist.angular_velocity;
  const Vector2d before = drawn.twist.velocity;
  stop_across(edge.normal, arrival);
  if (is_smooth) {
    drawn.twist.angular_velocity = omega;
    drawn.contact_velocity += drawn.twist.velocity - before;
  }
  const Vector2d acceleration = acceleration_on(ground, drawn);
  const double away = acceleration.dot(edge.normal) + edge.bend * drawn.twist.velocity.squaredNorm();
  const bool is_drawn = away > 32 * DBL_EPSILON * acceleration.norm();
  return is_drawn ? std::optional(drawn) : std::nullopt;
}

void SwitchingRules::stop_across(const Vector2d& normal, Arrival& arrival) const {
  constexpr double roundings = 2;  // of the normal, the products and the sum, half of one each
  Twist& twist = arrival.state.twist;
  const double speed = twist.velocity.norm();
  twist.velocity -= twist.velocity.dot(normal) * normal;
  twist.velocity += roundings * DBL_EPSILON * speed * normal;
  for (int i = 0; i < 2; ++i) {
    if (std::abs(normal[i]) == 1) twist.velocity[i] = 0;
  }
  const Vector2d nu = twist.velocity - arrival.state.contact_velocity;
  twist.angular_velocity.x() = (0 - nu.y()) / sphere_->radius();
  twist.angular_velocity.y() = nu.x() / sphere_->radius();
}

}  // namespace hybrid_sphere

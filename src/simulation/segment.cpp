#include "simulation/segment.hpp"

#include <algorithm>
#include <cmath>

namespace hybrid_sphere {

Segment::Segment(const Dynamics& dynamics, const scene::Solver& solver)
    : dynamics_(dynamics), solver_(solver) {}

void Segment::set_dynamics(const Dynamics& dynamics) {
  dynamics_ = dynamics;
  if (numeric_) numeric_->set_dynamics(dynamics);
}

void Segment::set_accuracy(double accuracy) {
  scene::Solver solver = solver_;
  solver.accuracy = accuracy;
  if (numeric_) numeric_->set_solver(solver);  // first, as this may run out of memory
  solver_ = solver;
}

bool Segment::continues(ContactMode mode, const scene::Material& material) const {
  const bool same_mode = mode == mode_ && same_ground(material, material_);
  if (same_mode || !is_uniform_) return same_mode;
  return hybrid_sphere::is_uniform(dynamics_, mode, material, uniform_.twist().angular_velocity.z());
}

NormalSpin Segment::normal_spin(ContactMode mode, const scene::Material& material, double omega_3) const {
  if (mode == ContactMode::free) return {omega_3, dynamics_.normal_spin, dynamics_.rotational_drag, 0, 0};
  if (material.law == scene::Law::rubber) return NormalSpin(omega_3);
  return {omega_3, dynamics_.normal_spin, dynamics_.rotational_drag,
          dynamics_.spin_decay(material.spin_friction), material.turntable_rate};
}

Segment::Turned Segment::turned() const {
  if (is_uniform_) return turned_before_;
  return {turned_before_.error + attitude_.error(), turned_before_.angle + attitude_.angle()};
}

double Segment::estimated_error() const {
  const Turned all = turned();
  const double turning = all.error > 0 ? all.error / all.angle : 0;
  return (numeric_ ? numeric_->estimated_error() : 0) + turning;
}

void Segment::forget_errors() {
  set_motion(uniform_, true);
  turned_before_ = {};
  if (numeric_) numeric_->forget_errors();
}

void Segment::begin(ContactMode mode, const scene::Material& material, const Start& start, double first) {
  turned_before_ = turned();
  is_whole_ = true;
  mode_ = mode;
  material_ = material;
  first_twist_ = start.twist;
  first_contact_velocity_ = start.contact_velocity;
  set_motion(uniform_, true);
  const double omega_3 = start.twist.angular_velocity.z();
  const auto at_rest = [&start] {
    return start.twist.velocity.isZero(0) && start.twist.angular_velocity.isZero(0);
  };
  MotionKind kind = solver_.uses_closed_forms()
                        ? motion_kind(dynamics_, mode, material, omega_3)
                        : integrated_kind(dynamics_, mode, material, omega_3, at_rest());
  if (kind == MotionKind::uniform) {
    uniform_ = UniformMotion(start.position, start.orientation, start.twist, dynamics_.radius);
    if (!follows_orientation_) uniform_.hold_orientation();
    return;
  }
  time_scale_ = find_time_scale(start);
  const NormalSpin spin = normal_spin(mode, material, omega_3);
  if (kind == MotionKind::integrated && begin_straight(start, spin)) kind = MotionKind::straight;
  switch (kind) {
    case MotionKind::uniform:
    case MotionKind::straight: break;
    case MotionKind::linear: begin_linear(start, spin); break;
    case MotionKind::dry_friction: begin_dry_friction(start, spin); break;
    case MotionKind::sticking:
    case MotionKind::integrated: begin_numeric(start, spin); break;
  }
  SpinProfile profile = spin_profile(start);
  profile.scale = std::min(profile.scale, first);
  begin_attitude(start, profile);
}

/// Accelerations that constant forces and friction can give [m/s^2].
double Segment::pulls() const {
  const Dynamics& d = dynamics_;
  const double of_slide = mode_ == ContactMode::sliding ? d.spinning_decay(material_.rolling_resistance) : 0;
  return d.free.norm() + d.spin.norm() + d.slip_decay(material_.friction) +
         d.roll_decay(material_.rolling_resistance) + of_slide;
}

/// Time in which forces change the velocities, estimated from their rates.
double Segment::find_time_scale(const Start& start) const {
  const Dynamics& d = dynamics_;
  const double rates = d.translational_drag + d.rotational_drag +
                       d.quadratic_drag * start.twist.velocity.norm() + std::sqrt(d.spring_rate) +
                       std::abs(material_.turntable_rate);
  const double rate = rates + std::sqrt(pulls() / d.radius) + std::sqrt(std::abs(d.normal_spin));
  return rate > 0 ? 1 / rate : never;
}

void Segment::begin_linear(const Start& start, const NormalSpin& spin) {
  set_linear_motion(start, spin);
  set_motion(linear_);
  if (linear_.fastest_rate() == 0) return;
  linear_series_.begin(linear_);
  outputs_ = &linear_series_;
}

void Segment::set_linear_motion(const Start& start, const NormalSpin& spin) {
  if (mode_ == ContactMode::free) {
    linear_ = LinearMotion::free(dynamics_, start.position, start.twist, start.contact_velocity, spin);
    return;
  }
  Dynamics dynamics = dynamics_;
  if (mode_ == ContactMode::skidding) {  // no friction, and the resistance takes up all torques
    dynamics.spin = Vector2d::Zero();
    linear_ = LinearMotion::free(dynamics, start.position, start.twist, start.contact_velocity, spin);
    return;
  }
  if (mode_ == ContactMode::sticking) {  // the resistance takes up all forces
    dynamics.free = dynamics.spin = Vector2d::Zero();
    dynamics.translational_drag = dynamics.rotational_drag = dynamics.quadratic_drag = dynamics.spring_rate =
        0;
  }
  linear_ = LinearMotion::rolling(dynamics, material_, start.position, start.twist.velocity, spin);
  if (start.loose) linear_.loosen();
}

void Segment::begin_dry_friction(const Start& start, const NormalSpin& spin) {
  set_motion(dry_);
  if (mode_ == ContactMode::sliding) {
    dry_ = DryFrictionMotion::sliding(dynamics_, material_, start.position, conserved_velocity(start),
                                      slip(start), spin);
  } else if (mode_ == ContactMode::skidding) {
    dry_ = DryFrictionMotion::skidding(dynamics_, material_, start.position, slip(start), spin);
  } else {
    const Vector2d nu = start.twist.velocity - material_.belt;
    dry_ = DryFrictionMotion::rolling(dynamics_, material_, start.position, nu, spin);
  }
  dry_.set_first_velocity(start.twist.velocity);
  if (dry_.straight()) return;
  dry_series_.begin(dry_, time_scale_);
  outputs_ = &dry_series_;
}

void Segment::begin_numeric(const Start& start, const NormalSpin& spin) {
  if (!numeric_) numeric_ = std::make_unique<NumericMotion>(dynamics_, solver_);
  set_motion(*numeric_);
  const Vector2d& velocity = start.twist.velocity;
  switch (mode_) {
    case ContactMode::free: numeric_->begin_free(start.position, start.twist, spin); break;
    case ContactMode::sliding:
    case ContactMode::skidding: begin_numeric_slide(start, spin); break;
    case ContactMode::rolling:
      if (resists_rolling(dynamics_, material_)) {
        numeric_->begin_resisted_rolling(material_, start.position, velocity, spin);
      } else {
        numeric_->begin_rolling(material_, start.position, velocity, spin);
      }
      break;
    case ContactMode::sticking: numeric_->begin_sticking(material_, start.position, spin); break;
    case ContactMode::edge_sliding: break;
  }
  if (start.loose) numeric_->loosen();
  if (!numeric_->estimates_errors()) return;
  numeric_series_.begin(*numeric_);
  outputs_ = &numeric_series_;
}

/// nu = R (omega_2, -omega_1): exactly 0 where the sphere does not turn.
Vector2d Segment::rolling_velocity(const Start& start) const {
  const Vector3d& omega = start.twist.angular_velocity;
  return dynamics_.radius * Vector2d(omega.y(), -omega.x());
}

Vector2d Segment::slip(const Start& start) const {
  return start.contact_velocity - ground_velocity(material_, start.position);
}

/// The path is a parabola where neither slip nor rolling turns.
bool Segment::begin_straight(const Start& start, const NormalSpin& spin) {
  const bool resisted = mode_ == ContactMode::sliding && resists_rolling(dynamics_, material_);
  if (!resisted || !solver_.uses_closed_forms()) return false;
  const std::optional<StraightSlide> straight =
      StraightSlide::from(dynamics_, material_, start.position, slip(start), rolling_velocity(start), spin);
  if (!straight) return false;
  straight_ = *straight;
  straight_.set_first_velocity(start.twist.velocity);
  set_motion(straight_);
  return true;
}

void Segment::begin_numeric_slide(const Start& start, const NormalSpin& spin) {
  const bool rubs = material_.friction != 0;
  // Without friction the motion of the ground has no effect.
  scene::Material ground = material_;
  if (!rubs) {
    ground.belt.setZero();
    ground.turntable_rate = 0;
  }
  const Vector2d slip = start.contact_velocity - ground_velocity(ground, start.position);
  const Vector2d& velocity = start.twist.velocity;
  if (!resists_rolling(dynamics_, material_)) {
    numeric_->begin_sliding(ground, start.position, conserved_velocity(start), slip, spin);
  } else if (mode_ == ContactMode::sliding) {
    numeric_->begin_resisted_sliding(ground, start.position, velocity, slip, rolling_velocity(start), spin);
  } else if (rubs) {
    numeric_->begin_skidding(ground, start.position, velocity, slip, spin);
  } else {
    numeric_->begin_frictionless_skidding(start.position, velocity, spin);
  }
}

/// p_c = v - kappa sigma.
Vector2d Segment::conserved_velocity(const Start& start) const {
  return start.twist.velocity - dynamics_.kappa * start.contact_velocity;
}

void Segment::begin_edge_slide(const EdgeSlide& slide, const Start& start) {
  turned_before_ = turned();
  is_whole_ = true;
  mode_ = ContactMode::edge_sliding;
  first_twist_ = start.twist;
  first_contact_velocity_ = start.contact_velocity;
  time_scale_ = find_time_scale(start);
  edge_slide_ = slide;
  set_motion(edge_slide_);
  SpinProfile profile = spin_profile(start);
  profile.rule = SpinRule::series;  // a closed form by every method
  begin_attitude(start, profile);
}

MotionState Segment::told_at(double tau) {
  MotionState now = at(tau);
  if (tau != 0) return now;
  now.center.velocity = first_twist_.velocity;
  now.angular_velocity = first_twist_.angular_velocity;
  now.contact_velocity = first_contact_velocity_;
  return now;
}

}  // namespace hybrid_sphere

#include "hybrid_sphere/simulation/stretch.hpp"

#include <algorithm>
#include <cmath>

namespace hybrid_sphere {

Stretch::Stretch(const Dynamics& dynamics, const scene::Solver& solver)
    : dynamics_(dynamics), solver_(solver) {}

void Stretch::set_dynamics(const Dynamics& dynamics) {
  dynamics_ = dynamics;
  if (numeric_) numeric_->set_dynamics(dynamics);
}

void Stretch::set_accuracy(double accuracy) {
  scene::Solver solver = solver_;
  solver.accuracy = accuracy;
  if (numeric_) numeric_->set_solver(solver);  // first what may find no memory
  solver_ = solver;
}

bool Stretch::continues(Regime regime, const scene::Material& material) const {
  const bool same_regime = regime == regime_ && same_ground(material, material_);
  if (same_regime || motion_ != nullptr) return same_regime;
  return is_uniform(dynamics_, regime, material, uniform_.twist().angular_velocity.z());
}

NormalSpin Stretch::normal_spin(Regime regime, const scene::Material& material, double omega_3) const {
  if (regime == Regime::free) return {omega_3, dynamics_.normal_spin, dynamics_.rotational_drag, 0, 0};
  if (material.law == scene::Law::rubber) return NormalSpin(omega_3);
  return {omega_3, dynamics_.normal_spin, dynamics_.rotational_drag,
          dynamics_.spin_decay(material.spin_friction), material.turntable_rate};
}

Stretch::Turned Stretch::turned() const {
  if (motion_ == nullptr) return turned_before_;
  return {turned_before_.error + attitude_.error(), turned_before_.angle + attitude_.angle()};
}

double Stretch::estimated_error() const {
  const Turned all = turned();
  const double turning = all.error > 0 ? all.error / all.angle : 0;
  return (numeric_ ? numeric_->estimated_error() : 0) + turning;
}

void Stretch::forget_errors() {
  motion_ = nullptr;
  turned_before_ = {};
  if (numeric_) numeric_->forget_errors();
}

void Stretch::begin(Regime regime, const scene::Material& material, const Start& start, double first) {
  turned_before_ = turned();
  is_whole_ = true;
  regime_ = regime;
  material_ = material;
  first_twist_ = start.twist;
  first_contact_velocity_ = start.contact_velocity;
  motion_ = nullptr;
  const double omega_3 = start.twist.angular_velocity.z();
  const bool at_rest = start.twist.velocity.isZero(0) && start.twist.angular_velocity.isZero(0);
  MotionKind kind = solver_.uses_closed_forms()
                        ? motion_kind(dynamics_, regime, material, omega_3)
                        : integrated_kind(dynamics_, regime, material, omega_3, at_rest);
  if (kind == MotionKind::uniform) {
    uniform_ = UniformMotion(start.position, start.orientation, start.twist);
    return;
  }
  time_scale_ = find_time_scale(start);
  const NormalSpin spin = normal_spin(regime, material, omega_3);
  if (kind == MotionKind::integrated && begin_straight(start, spin)) kind = MotionKind::straight;
  switch (kind) {
    case MotionKind::uniform:
    case MotionKind::straight: break;
    case MotionKind::linear: begin_linear(start, spin); break;
    case MotionKind::dry_friction: begin_dry_friction(start, spin); break;
    case MotionKind::carriage:
    case MotionKind::integrated: begin_numeric(start, spin); break;
  }
  SpinCourse course = spin_course(spin.kink());
  course.scale = std::min(course.scale, first);
  begin_attitude(start, course);
}

/// Accelerations that constant forces and friction can give [m/s^2].
double Stretch::pulls() const {
  const Dynamics& d = dynamics_;
  const double of_slide = regime_ == Regime::sliding ? d.spinning_decay(material_.rolling_resistance) : 0;
  return d.free.norm() + d.spin.norm() + d.slip_decay(material_.friction) +
         d.roll_decay(material_.rolling_resistance) + of_slide;
}

/// Time in which forces change the velocities, as far as their rates tell.
double Stretch::find_time_scale(const Start& start) const {
  const Dynamics& d = dynamics_;
  const double rates = d.translational_drag + d.rotational_drag +
                       d.quadratic_drag * start.twist.velocity.norm() + std::sqrt(d.spring_rate) +
                       std::abs(material_.turntable_rate);
  const double rate = rates + std::sqrt(pulls() / d.radius) + std::sqrt(std::abs(d.normal_spin));
  return rate > 0 ? 1 / rate : never;
}

void Stretch::begin_linear(const Start& start, const NormalSpin& spin) {
  motion_ = &linear_;
  if (regime_ == Regime::free) {
    linear_ = LinearMotion::free(dynamics_, start.position, start.twist, start.contact_velocity, spin);
    return;
  }
  Dynamics dynamics = dynamics_;
  if (regime_ == Regime::skidding) {  // no friction, and the resistance takes up all torques
    dynamics.spin = Vector2d::Zero();
    linear_ = LinearMotion::free(dynamics, start.position, start.twist, start.contact_velocity, spin);
    return;
  }
  if (regime_ == Regime::carried) {  // the resistance takes up all forces
    dynamics.free = dynamics.spin = Vector2d::Zero();
    dynamics.translational_drag = dynamics.rotational_drag = dynamics.quadratic_drag = dynamics.spring_rate =
        0;
  }
  linear_ = LinearMotion::rolling(dynamics, material_, start.position, start.twist.velocity, spin);
  if (start.loose) linear_.loosen();
}

void Stretch::begin_dry_friction(const Start& start, const NormalSpin& spin) {
  motion_ = &dry_;
  if (regime_ == Regime::sliding) {
    dry_ = DryFrictionMotion::sliding(dynamics_, material_, start.position, conserved_velocity(start),
                                      slip(start), spin);
  } else if (regime_ == Regime::skidding) {
    dry_ = DryFrictionMotion::skidding(dynamics_, material_, start.position, slip(start), spin);
  } else {
    const Vector2d nu = start.twist.velocity - material_.belt;
    dry_ = DryFrictionMotion::rolling(dynamics_, material_, start.position, nu, spin);
  }
}

void Stretch::begin_numeric(const Start& start, const NormalSpin& spin) {
  if (!numeric_) numeric_ = std::make_unique<NumericMotion>(dynamics_, solver_);
  motion_ = numeric_.get();
  const Vector2d& velocity = start.twist.velocity;
  switch (regime_) {
    case Regime::free: numeric_->begin_free(start.position, start.twist, spin); break;
    case Regime::sliding:
    case Regime::skidding: begin_numeric_slide(start, spin); break;
    case Regime::rolling:
      if (resists_rolling(dynamics_, material_)) {
        numeric_->begin_resisted(material_, start.position, velocity, spin);
      } else {
        numeric_->begin_rolling(material_, start.position, velocity, spin);
      }
      break;
    case Regime::carried: numeric_->begin_carried(material_, start.position, spin); break;
    case Regime::edge_slide: break;
  }
  if (start.loose) numeric_->loosen();
}

/// nu = R (omega_2, -omega_1): exactly 0 where the sphere does not turn.
Vector2d Stretch::rolling_velocity(const Start& start) const {
  const Vector3d& omega = start.twist.angular_velocity;
  return dynamics_.radius * Vector2d(omega.y(), -omega.x());
}

Vector2d Stretch::slip(const Start& start) const {
  return start.contact_velocity - ground_velocity(material_, start.position);
}

/// The path is a parabola where neither slip nor rolling turns.
bool Stretch::begin_straight(const Start& start, const NormalSpin& spin) {
  const bool resisted = regime_ == Regime::sliding && resists_rolling(dynamics_, material_);
  if (!resisted || !solver_.uses_closed_forms()) return false;
  const std::optional<StraightSlide> straight =
      StraightSlide::from(dynamics_, material_, start.position, slip(start), rolling_velocity(start), spin);
  if (!straight) return false;
  straight_ = *straight;
  motion_ = &straight_;
  return true;
}

void Stretch::begin_numeric_slide(const Start& start, const NormalSpin& spin) {
  const bool rubs = material_.friction != 0;
  // What has no friction does not know how the ground moves.
  scene::Material ground = material_;
  if (!rubs) {
    ground.belt.setZero();
    ground.turntable_rate = 0;
  }
  const Vector2d slip = start.contact_velocity - ground_velocity(ground, start.position);
  const Vector2d& velocity = start.twist.velocity;
  if (!resists_rolling(dynamics_, material_)) {
    numeric_->begin_sliding(ground, start.position, conserved_velocity(start), slip, spin);
  } else if (regime_ == Regime::sliding) {
    numeric_->begin_scrubbing(ground, start.position, velocity, slip, rolling_velocity(start), spin);
  } else if (rubs) {
    numeric_->begin_skidding(ground, start.position, velocity, slip, spin);
  } else {
    numeric_->begin_gliding(start.position, velocity, spin);
  }
}

/// p_c = v - kappa sigma.
Vector2d Stretch::conserved_velocity(const Start& start) const {
  return start.twist.velocity - dynamics_.kappa * start.contact_velocity;
}

void Stretch::begin_edge_slide(const EdgeSlide& slide, const Start& start) {
  turned_before_ = turned();
  is_whole_ = true;
  regime_ = Regime::edge_slide;
  first_twist_ = start.twist;
  first_contact_velocity_ = start.contact_velocity;
  time_scale_ = find_time_scale(start);
  edge_slide_ = slide;
  motion_ = &edge_slide_;
  SpinCourse course = spin_course(never);
  course.rule = SpinRule::magnus;  // a closed form by every method
  begin_attitude(start, course);
}

Kinematics Stretch::at(double tau) {
  if (motion_) return motion_->at(tau);
  const Twist& twist = uniform_.twist();
  const Vector2d nu = dynamics_.radius * Vector2d(twist.angular_velocity.y(), -twist.angular_velocity.x());
  return {{uniform_.position(tau), twist.velocity, Vector2d::Zero()},
          twist.velocity - nu,
          twist.angular_velocity};
}

Kinematics Stretch::told_at(double tau) {
  Kinematics now = at(tau);
  if (tau != 0) return now;
  now.center.velocity = first_twist_.velocity;
  now.angular_velocity = first_twist_.angular_velocity;
  now.contact_velocity = first_contact_velocity_;
  return now;
}

Stretch::End Stretch::end() const {
  if (regime_ == Regime::edge_slide) return End::edge_left;
  if (numeric_ && motion_ == numeric_.get()) {
    switch (numeric_->end_kind()) {
      case NumericMotion::End::slip_used_up: return End::slip_used_up;
      case NumericMotion::End::roll_used_up: return End::roll_used_up;
      case NumericMotion::End::breaks_loose: return End::breaks_loose;
      case NumericMotion::End::grip_lost:
      case NumericMotion::End::none: break;
    }
    return End::grip_lost;
  }
  if (motion_ == &straight_) return straight_.stops_turning() ? End::roll_used_up : End::slip_used_up;
  if (motion_ == &dry_) return regime_ == Regime::rolling ? End::roll_used_up : End::slip_used_up;
  return End::grip_lost;
}

}  // namespace hybrid_sphere

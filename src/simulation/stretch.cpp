#include "hybrid_sphere/simulation/stretch.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "hybrid_sphere/interrupt/interrupt.hpp"

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

void Stretch::begin_attitude(const Start& start, const SpinCourse& course) {
  attitude_.begin(start.orientation, *motion_, course);
  lazy_until_ = find_lazy_time(start, course);
}

/// Until when a motion certainly turns the sphere so little, and changes its spin so seldom, that its
/// orientation can be told at any time within milliseconds: by 1e4 rad, from the speeds at the start and the
/// accelerations that the forces can give, in 1e3 of the times in which they change it.
double Stretch::find_lazy_time(const Start& start, const SpinCourse& course) {
  constexpr double angle = 1e4;
  constexpr double changes = 1e3;
  if (course.constant) return never;
  if (course.rule != SpinRule::magnus) return 0;  // steps of fixed length may fail
  if (motion_->last_time() < never) return 0;
  if (course.period < longest_time) {
    const double round = turned_in_a_round(course.period);
    return round <= angle ? never : course.period * (angle / round);
  }
  const double speed = start.twist.velocity.norm() + dynamics_.radius * start.twist.angular_velocity.norm() +
                       ground_velocity(material_, start.position).norm() +
                       std::sqrt(dynamics_.spring_rate) * (start.position - dynamics_.spring_center).norm();
  const double pull = pulls() + dynamics_.radius * std::abs(dynamics_.normal_spin);
  const double way = angle * dynamics_.radius;  // = speed tau + pull tau^2
  const double lazy =
      std::min(2 * way / (speed + std::sqrt(speed * speed + 4 * pull * way)), changes * time_scale_);
  // The farther out on a turntable, the faster: in this time by a factor of e at most.
  const double turntable = std::abs(material_.turntable_rate);
  return turntable > 0 ? std::min(lazy / 3, 1 / turntable) : lazy;
}

/// Bound on the angle that a motion turns in a period [rad]: omega^2 is a constant and a sine of this period,
/// so that two values half a period apart tell its mean.
double Stretch::turned_in_a_round(double period) {
  const double mean_square = 0.5 * (motion_->angular_velocity(0).squaredNorm() +
                                    motion_->angular_velocity(0.5 * period).squaredNorm());
  return period * std::sqrt(mean_square);
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

namespace {

SpinRule spin_rule(scene::Solver::Method method) {
  using Method = scene::Solver::Method;
  switch (method) {
    case Method::euler: return SpinRule::euler;
    case Method::rk4: return SpinRule::rk4;
    case Method::lie_midpoint: return SpinRule::midpoint;
    case Method::rkmk4: return SpinRule::rkmk4;
    default: return SpinRule::magnus;
  }
}

/// Then the orientation may fail, also where the path is known for ever.
bool takes_fixed_steps(scene::Solver::Method method) { return spin_rule(method) != SpinRule::magnus; }

}  // namespace

double spin_accuracy(double accuracy, bool closed_form) {
  constexpr double to_rounding = scene::Solver().accuracy;
  const double finest = SpinCourse().accuracy;
  return closed_form && accuracy <= to_rounding ? finest : std::max(finest, 0.02 * accuracy);
}

SpinCourse Stretch::spin_course(double kink) const {
  SpinCourse course;
  course.kink = kink;
  course.scale = time_scale_;
  course.rule = spin_rule(solver_.method);
  course.step = solver_.step;
  course.accuracy = spin_accuracy(solver_.accuracy, motion_ != numeric_.get());
  if (motion_ == &linear_) {
    course.period = linear_.period();
    course.constant = linear_.steady();
    course.end = linear_.last_time();
  } else if (motion_ == &dry_) {
    course.end = dry_.end();
    course.constant = dry_.steady();
    const DryFriction::Corner corner = dry_.corner();
    course.corner = corner.time;
    course.corner_width = corner.width;
  } else if (motion_ == &straight_) {
    course.end = straight_.end();
    course.constant = straight_.steady();
  } else if (motion_ == &edge_slide_) {
    course.end = edge_slide_.end();
    course.constant = edge_slide_.steady();
  } else {
    course.end = longest_time;
  }
  return course;
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

void Stretch::forget_before(double tau) {
  if (numeric_) numeric_->release_memory();
  if (!numeric_ || motion_ != numeric_.get()) return;
  is_whole_ = false;
  attitude_.at(tau, *motion_);
  attitude_.forget_before_now();
  // A node of the orientation may be a rounding later.
  numeric_->forget_before(std::min(tau, attitude_.needs_from()));
}

void Stretch::reach(double tau) {
  if (motion_ == nullptr) return;
  if (tau > motion_->last_time()) {
    throw std::runtime_error(
        "the motion grows beyond all bounds: its speed leaves the range up to 1e100 m/s, or its orientation "
        "1e7 rad");
  }
  if (!numeric_ || motion_ != numeric_.get()) {
    if (tau > lazy_until_) attitude_.reach(tau, *motion_);
    return;
  }
  try {
    numeric_->reach(tau);
  } catch (const std::runtime_error&) {
    follow_to_failure();
    throw;
  }
  const bool is_lazy = numeric_->reached() == never && tau <= lazy_until_;  // it has come to rest
  if (!is_lazy || takes_fixed_steps(solver_.method)) attitude_.reach(tau, *motion_);
}

/// The last time at which the state is known must not depend on the times that have been asked for before.
void Stretch::follow_to_failure() {
  try {
    attitude_.reach(numeric_->reached(), *motion_);
  } catch (const std::runtime_error&) {
    // Its next step would need the motion beyond its failure: reached() tells how far it came.
  }
}

double Stretch::reached() const {
  if (motion_ == nullptr) return never;
  if (!numeric_ || motion_ != numeric_.get()) {
    return std::min(motion_->last_time(), std::max(lazy_until_, attitude_.reached()));
  }
  const double reached = numeric_->reached();
  if (reached < never || takes_fixed_steps(solver_.method)) return std::min(reached, attitude_.reached());
  return std::max(lazy_until_, attitude_.reached());
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

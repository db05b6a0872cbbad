#include "motion/numeric_motion.hpp"

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <utility>

#include "integration/bracketed_root.hpp"
#include "integration/power_of_two.hpp"
#include "interrupt/interrupt.hpp"
#include "motion/phi.hpp"

namespace hybrid_sphere {

using numeric::EquationForm;
using numeric::Equations;
using numeric::Instant;
using numeric::State;

NumericMotion::NumericMotion(const Dynamics& dynamics, const scene::Solver& solver)
    : dynamics_(dynamics), trajectory_(solver) {}

// The greatest of the speeds at the beginning and of those that the forces there can give in the time in
// which they change, or in the longest time there is.
void NumericMotion::choose_unit(double speed, const scene::Material& ground, const Vector2d& position) {
  const Dynamics& d = dynamics_;
  const double rate =
      d.translational_drag + d.rotational_drag + std::sqrt(d.spring_rate) + std::abs(ground.turntable_rate);
  const double force = d.acceleration(position, Vector2d::Zero()).norm() + d.spin.norm();
  const double most =
      std::max({speed, ground_velocity(ground, position).norm(), force / std::max(rate, 1 / max_time)});
  unit_ = most > 0 ? integration::power_of_two(most) : 1;
  // What begins from rest has no other length than the sphere's.
  const double of_radius = std::sqrt(force / (2 * d.radius));
  scale_ = speed * of_radius < force ? 1 / of_radius : never;
}

Equations NumericMotion::equations(EquationForm form, const scene::Material& ground,
                                   const Vector2d& position) const {
  Dynamics dynamics = dynamics_;
  dynamics.free /= unit_;
  dynamics.spin /= unit_;
  dynamics.normal_force /= unit_;
  dynamics.quadratic_drag *= unit_;
  dynamics.spring_center = (dynamics.spring_center - position) / unit_;
  scene::Material here = ground;
  here.belt = ground_velocity(ground, position) / unit_;
  here.turntable_center = Vector2d::Zero();
  return {form, dynamics, here, Vector2d::Zero()};
}

void NumericMotion::begin(const Equations& equations, const scene::Material& ground, const Vector2d& position,
                          const NormalSpin& spin) {
  equations_ = equations;
  onset_.reset();
  friction_limit_.reset();
  sticking_.reset();
  start_ = position;
  friction_ = ground.law == scene::Law::coulomb ? ground.friction : never;
  spin_ = spin;
  rests_ = is_stopping_ = false;
  stop_time_ = never;
  stopping_vector_ = 0;
  fastest_ = 0;
  end_ = never;
  end_reason_ = MotionEnd::grip_lost;
  checked_nodes_ = 0;
  onset_is_checked_ = false;
  searched_until_ = 0;
  const bool rolls =
      equations.form() == EquationForm::rolling || equations.form() == EquationForm::resisted_rolling;
  if (rolls && friction_ < never) friction_limit_.emplace(*equations_, friction_);
  const bool may_turn = equations.form() == EquationForm::skidding && !equations.dynamics().spin.isZero(0);
  if (may_turn) friction_limit_.emplace(*equations_, ground.rolling_resistance);
}

Curve NumericMotion::curve() const {
  Curve curve;
  curve.start = start_;
  curve.velocity = velocity_;
  curve.acceleration = acceleration_;
  curve.line = line_;
  curve.line_size = line_size_;
  return curve;
}

// All that accelerates the centre, and the way that dry friction acts along, has to lie on the line.
/// @param y  at the beginning
/// @param w  the vector that dry friction acts against, or nothing
void NumericMotion::find_line(const Vector2d& start_velocity, const State& y, const Vector2d& w) {
  const Dynamics& d = equations_->dynamics();
  const Instant now = equations_->instant(y);
  velocity_ = unit_ * without_rounding(start_velocity, w.norm());
  acceleration_ = unit_ * equations_->acceleration(y, now);
  const Vector2d velocity = velocity_ / unit_;
  const Vector2d ground = equations_->ground(Vector2d::Zero());
  const bool rolls = equations_->form() != EquationForm::free;
  // The spring's force as far away as it lets the sphere come, and as the place that was rounded.
  const double far = d.spring_center.norm() + start_.norm() / unit_;
  const double spring = d.spring_rate * far + std::sqrt(d.spring_rate) * velocity.norm();
  const Vector2d force = d.acceleration(Vector2d::Zero(), Vector2d::Zero());
  const Vector2d spin = rolls ? Vector2d(d.spin + d.rotational_drag * ground) : Vector2d(Vector2d::Zero());
  const Vector2d carried = equations_->is_dry() ? ground : Vector2d(Vector2d::Zero());
  const double pull = d.free.norm() + spring;
  const double torque = d.spin.norm() + d.rotational_drag * ground.norm();
  const double speeds = velocity.norm() + w.norm() + ground.norm();
  line_.setZero();
  line_size_ = velocity.isZero(0) ? pull : 0;
  if (equations_->turntable_rate() != 0) return;
  Vector2d line = line_of(velocity, force, pull);
  if (line.isZero(0)) {
    line = spin;
    line_size_ = torque;
  }
  if (line.isZero(0)) {
    line = w;
    line_size_ = speeds;
  }
  const bool straight = parallel(line, spin, torque) && parallel(line, w, speeds) &&
                        parallel(line, carried) && parallel(line, velocity) && parallel(line, force, pull);
  if (straight) line_ = line;
}

void NumericMotion::begin_free(const Vector2d& position, const Twist& twist, const NormalSpin& spin) {
  choose_unit(twist.velocity.norm(), scene::Law::smooth, position);
  begin(equations(EquationForm::free, scene::Law::smooth, position), scene::Law::smooth, position, spin);
  planar_spin_ = twist.angular_velocity.head<2>();
  find_line(twist.velocity / unit_, equations_->start(twist.velocity / unit_), Vector2d::Zero());
  trajectory_.begin(*equations_, equations_->start(twist.velocity / unit_), scale_);
  detect_rest();
}

void NumericMotion::begin_rolling(const scene::Material& ground, const Vector2d& position,
                                  const Vector2d& velocity, const NormalSpin& spin) {
  choose_unit(velocity.norm(), ground, position);
  begin(equations(EquationForm::rolling, ground, position), ground, position, spin);
  find_line(velocity / unit_, equations_->start(velocity / unit_), Vector2d::Zero());
  trajectory_.begin(*equations_, equations_->start(velocity / unit_), scale_);
  detect_rest();
}

void NumericMotion::begin_sliding(const scene::Material& ground, const Vector2d& position,
                                  const Vector2d& p_c, const Vector2d& slip, const NormalSpin& spin) {
  choose_unit(std::max(p_c.norm(), slip.norm()), ground, position);
  Equations equations = this->equations(EquationForm::sliding, ground, position);
  equations.set_momentum(p_c / unit_);
  begin(equations, ground, position, spin);
  const Vector2d w = slip / unit_;
  const Vector2d carried = w + equations_->ground(Vector2d::Zero());
  find_line(p_c / unit_ + dynamics_.kappa * carried, equations_->start(w), w);
  begin_dry(w);
}

void NumericMotion::begin_resisted_rolling(const scene::Material& ground, const Vector2d& position,
                                           const Vector2d& velocity, const NormalSpin& spin) {
  choose_unit(velocity.norm(), ground, position);
  begin(equations(EquationForm::resisted_rolling, ground, position), ground, position, spin);
  const Vector2d w = (velocity - ground_velocity(ground, position)) / unit_;
  find_line(velocity / unit_, equations_->start(w), w);
  begin_dry(w);
}

void NumericMotion::begin_sticking(const scene::Material& ground, const Vector2d& position,
                                   const NormalSpin& spin) {
  choose_unit(0, ground, position);
  begin(equations(EquationForm::resisted_rolling, ground, position), ground, position, spin);
  sticking_.emplace(*equations_);
  velocity_ = ground.belt;
  acceleration_.setZero();
  line_ = ground.turntable_rate == 0 ? ground.belt : Vector2d(Vector2d::Zero());
}

void NumericMotion::begin_skidding(const scene::Material& ground, const Vector2d& position,
                                   const Vector2d& velocity, const Vector2d& slip, const NormalSpin& spin) {
  choose_unit(std::max(velocity.norm(), slip.norm()), ground, position);
  begin(equations(EquationForm::skidding, ground, position), ground, position, spin);
  find_line(velocity / unit_, equations_->start(slip / unit_), slip / unit_);
  begin_dry(slip / unit_);
}

void NumericMotion::begin_frictionless_skidding(const Vector2d& position, const Vector2d& velocity,
                                                const NormalSpin& spin) {
  const Vector2d spin_of_torques = std::exchange(dynamics_.spin, Vector2d(Vector2d::Zero()));
  try {
    begin_free(position, {velocity, Vector3d::Zero()}, spin);
  } catch (...) {
    dynamics_.spin = spin_of_torques;
    throw;
  }
  dynamics_.spin = spin_of_torques;
}

void NumericMotion::begin_resisted_sliding(const scene::Material& ground, const Vector2d& position,
                                           const Vector2d& velocity, const Vector2d& slip, const Vector2d& nu,
                                           const NormalSpin& spin) {
  choose_unit(std::max({velocity.norm(), slip.norm(), nu.norm()}), ground, position);
  begin(equations(EquationForm::resisted_sliding, ground, position), ground, position, spin);
  const auto told = [this](const Vector2d& w) {
    const Vector2d scaled = w / unit_;
    return scaled.norm() <= numeric::least_speed ? Vector2d(Vector2d::Zero()) : scaled;
  };
  State y = equations_->start(told(slip), told(nu));
  find_line(velocity / unit_, y, slip / unit_);
  if (!parallel(line_, nu, velocity.norm() + nu.norm())) line_.setZero();
  const bool slips = !numeric::pair(y, 0).isZero(0) || equations_->decay() == 0;
  const bool turns = !numeric::pair(y, 4).isZero(0);
  if (!slips || !turns) {
    onset_.emplace(*equations_, numeric::pair(y, 0), numeric::pair(y, 4));
    if (onset_->end() == 0) stop_at(slips ? 1 : turns ? 0 : 2, 0);
    if (!is_stopping_) y = onset_->at(onset_->end());
  }
  trajectory_.begin(*equations_, y);
  if (!is_stopping_) detect_stop();
}

// A w that is not told from 0 but grows is the one that grows from 0.
void NumericMotion::begin_dry(const Vector2d& w) {
  constexpr double told = 1 + 16 * DBL_EPSILON;
  State y = equations_->start(w);
  const bool grows = equations_->instant(y).forcing.norm() > told * equations_->decay();
  if (w.isZero(0) || (grows && w.norm() <= numeric::least_speed)) {
    onset_.emplace(*equations_);
    if (onset_->end() == 0) stop_at(0, 0);  // w does not grow
    y = onset_->at(onset_->end());
  }
  trajectory_.begin(*equations_, y);
  if (!is_stopping_) detect_stop();
}

void NumericMotion::cover(double tau) {
  const bool dry = equations_->is_dry();
  constexpr std::uint32_t turns_of_a_step = 4;
  while (!is_stopping_ && !rests_ && numeric::time_of(trajectory_.last()) < tau) {
    interruption_point(turns_of_a_step);
    trajectory_.extend();
    if (dry) {
      detect_stop();
    } else {
      detect_rest();
    }
  }
}

void NumericMotion::reach(double tau) {
  if (!sticking_ && tau > series_end()) cover(tau);
}

double NumericMotion::reached() const {
  return sticking_ || is_stopping_ || rests_ ? never
                                             : std::max(series_end(), numeric::time_of(trajectory_.last()));
}

// Of a motion along a line nothing is across it but what the method has rounded.
void NumericMotion::keep_on_line(State& y) const {
  if (line_.x() == 0 || line_.y() == 0) return;  // along an axis nothing is rounded across it
  const Vector2d along = stable_normalized(line_);
  for (const int i : {0, 2, 4}) numeric::set_pair(y, i, along * along.dot(numeric::pair(y, i)));
}

State NumericMotion::state(double tau, Vector2d* path_velocity) {
  State y = computed(tau, path_velocity);
  if (!sticking_) keep_on_line(y);
  return y;
}

State NumericMotion::computed(double tau, Vector2d* path_velocity) {
  if (sticking_) return sticking_->at(tau);
  if (onset_ && onset_->end() > 0 && tau <= onset_->end()) return onset_->at(tau);
  cover(tau);
  if (is_stopping_ && tau >= numeric::time_of(trajectory_.last())) return stopping(tau);
  if (rests_ && tau > numeric::time_of(trajectory_.last())) {
    State y = trajectory_.last();
    numeric::set_pair(y, 0, Vector2d::Zero());
    y[6] = tau;
    return y;
  }
  return trajectory_.at(tau, path_velocity);
}

PointState NumericMotion::point_state(const State& y, const Instant& now) const {
  const Vector2d d = numeric::displacement(y);
  const Vector2d acceleration = sticking_ ? Vector2d(equations_->turntable_rate() * turned(now.velocity))
                                          : equations_->acceleration(y, now);
  return {start_ + unit_ * d, unit_ * now.velocity, unit_ * acceleration};
}

PointState NumericMotion::center(double tau) {
  const State y = state(tau);
  return point_state(y, equations_->instant(y));
}

MotionState NumericMotion::at(double tau) {
  const State y = state(tau);
  const Instant now = equations_->instant(y);
  const Vector2d d = numeric::displacement(y);
  MotionState all;
  all.center = point_state(y, now);
  const double radius = dynamics_.radius;
  if (equations_->form() == EquationForm::free) {
    const Dynamics& dynamics = equations_->dynamics();
    const Vector2d rate = unit_ * Vector2d(-dynamics.spin.y(), dynamics.spin.x()) / radius -
                          dynamics.rotational_drag * planar_spin_;
    const Vector2d omega = planar_spin_ + tau * phi1(-dynamics.rotational_drag * tau) * rate;
    all.contact_velocity = all.center.velocity + radius * Vector2d(-omega.y(), omega.x());
    all.angular_velocity << omega, spin_.at(tau);
    return all;
  }
  all.contact_velocity = unit_ * equations_->ground(d);
  if (equations_->slides()) all.contact_velocity += unit_ * numeric::pair(y, 0);
  all.angular_velocity << unit_ * Vector2d(-now.nu.y(), now.nu.x()) / radius, spin_.at(tau);
  return all;
}

// Dry friction turns round where w is across B, and quadratic drag where v is across its rate: the faster,
// the shorter w or v is. In x that is smooth, so that it lies between two nodes and is found there by
// halving.
RapidChange NumericMotion::rapid_change(double from, double until) {
  const bool turns = equations_->is_dry() || equations_->dynamics().quadratic_drag != 0;
  if (sticking_ || !turns) return {};
  cover(until);
  for (std::size_t i = trajectory_.index_at(from); i + 1 < trajectory_.size(); ++i) {
    interruption_point();
    if (numeric::time_of(trajectory_.node(i).y) > until) break;
    const RapidChange turn = rapid_change_in_step(i, from);
    if (turn.time < never) return turn;
  }
  if (is_stopping_ && stop_time_ > from && stop_time_ <= until) return {stop_time_, 0};
  return {};
}

/// The first one in the step from a node.
RapidChange NumericMotion::rapid_change_in_step(std::size_t i, double from) {
  RapidChange first;
  const auto look = [&](const auto& turning) {
    const RapidChange turn = rapid_change_of(turning, i, from);
    if (turn.time < first.time) first = turn;
  };
  for (int k = 0; k < equations_->dry_vectors(); ++k) {
    look([this, k](const State& y) {
      const numeric::DryVector dry = equations_->dry_vector(k, y, equations_->instant(y));
      return Turning{dry.w, dry.drive, dry.w.norm() / (dry.drive.norm() + dry.decay)};
    });
  }
  const double drag = equations_->dynamics().quadratic_drag;
  if (drag != 0) {
    // Of the angle within that part of the time in which the drag acts, the kink is 2^-51.
    constexpr double part = 0x1p-17;
    look([this, drag](const State& y) {
      const Instant now = equations_->instant(y);
      const Vector2d rate = equations_->acceleration(y, now);
      const double size = rate.norm();
      return Turning{now.velocity, rate, std::max(part / std::sqrt(drag * size), now.velocity.norm() / size)};
    });
  }
  return first;
}

/// @param turning  of a state, a vector whose direction acts
template <class Function>
RapidChange NumericMotion::rapid_change_of(const Function& turning, std::size_t i, double from) {
  constexpr int halvings = 40;
  const auto shrinks = [&](const State& y) {
    const Turning now = turning(y);
    return now.w.dot(now.rate) < 0;
  };
  const numeric::Node& node = trajectory_.node(i);
  if (!shrinks(node.y) || shrinks(trajectory_.node(i + 1).y)) return {};
  const auto is_before = [&](double x) { return shrinks(trajectory_.after(i, x)); };
  const State turn = trajectory_.after(i, integration::halved({0, node.step}, halvings, is_before).high);
  if (!(numeric::time_of(turn) > from)) return {};
  return {numeric::time_of(turn), turning(turn).width};
}

std::uint64_t NumericMotion::steps(double from, double until) const {
  return sticking_ ? 0 : trajectory_.index_at(until) - trajectory_.index_at(from);
}

void NumericMotion::loosen() {
  if (friction_limit_) friction_limit_->loosen();
  if (sticking_) sticking_->loosen();
}

void NumericMotion::forget_before(double tau) {
  if (!sticking_) trajectory_.forget_before(tau);
}

SpinProfile NumericMotion::spin_profile() const {
  SpinProfile profile;
  profile.kink = spin_.kink();
  profile.end = max_time;
  return profile;
}

}  // namespace hybrid_sphere

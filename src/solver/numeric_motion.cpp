#include "hybrid_sphere/solver/numeric_motion.hpp"

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <utility>

#include "hybrid_sphere/interrupt/interrupt.hpp"
#include "hybrid_sphere/sphere/phi.hpp"

namespace hybrid_sphere {

using solver::Equations;
using solver::Instant;
using solver::Regime;
using solver::State;

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
      std::max({speed, ground_velocity(ground, position).norm(), force / std::max(rate, 1 / longest_time)});
  unit_ = most > 0 ? std::ldexp(1.0, std::clamp(std::ilogb(most), -1000, 1000)) : 1;
}

Equations NumericMotion::equations(Regime regime, const scene::Material& ground,
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
  return {regime, dynamics, here, Vector2d::Zero()};
}

void NumericMotion::begin(const Equations& equations, const scene::Material& ground, const Vector2d& position,
                          const NormalSpin& spin) {
  equations_ = equations;
  departure_.reset();
  grip_.reset();
  carriage_.reset();
  start_ = position;
  friction_ = ground.law == scene::Law::coulomb ? ground.friction : never;
  spin_ = spin;
  rests_ = dead_ = false;
  death_ = never;
  dying_ = 0;
  end_ = never;
  end_kind_ = End::none;
  gripped_nodes_ = 0;
  departure_grips_ = false;
  carried_until_ = 0;
  const bool rolls = equations.regime() == Regime::rolling || equations.regime() == Regime::resisted;
  if (rolls && friction_ < never) grip_.emplace(*equations_, friction_);
  const bool may_turn = equations.regime() == Regime::skidding && !equations.dynamics().spin.isZero(0);
  if (may_turn) grip_.emplace(*equations_, ground.rolling_resistance);
}

Curve NumericMotion::curve() const {
  Curve curve;
  curve.start = start_;
  curve.velocity = velocity_;
  curve.acceleration = acceleration_;
  curve.line = line_;
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
  const bool rolls = equations_->regime() != Regime::free;
  const double spring = d.spring_rate * d.spring_center.norm();
  const Vector2d force = d.acceleration(Vector2d::Zero(), Vector2d::Zero());
  const Vector2d spin = rolls ? Vector2d(d.spin + d.rotational_drag * ground) : Vector2d(Vector2d::Zero());
  const Vector2d carried = equations_->is_dry() ? ground : Vector2d(Vector2d::Zero());
  line_.setZero();
  if (equations_->turntable_rate() != 0) return;
  Vector2d line = line_of(velocity, force, d.free.norm() + spring);
  if (line.isZero(0)) line = spin;
  const double speeds = velocity.norm() + w.norm() + ground.norm();
  const bool straight = parallel(line, spin, d.spin.norm() + d.rotational_drag * ground.norm()) &&
                        parallel(line, w, speeds) && parallel(line, carried) && parallel(line, velocity) &&
                        parallel(line, force, d.free.norm() + spring);
  if (straight) line_ = line;
}

void NumericMotion::begin_free(const Vector2d& position, const Twist& twist, const NormalSpin& spin) {
  choose_unit(twist.velocity.norm(), scene::Law::smooth, position);
  begin(equations(Regime::free, scene::Law::smooth, position), scene::Law::smooth, position, spin);
  planar_spin_ = twist.angular_velocity.head<2>();
  find_line(twist.velocity / unit_, equations_->start(twist.velocity / unit_), Vector2d::Zero());
  trajectory_.begin(*equations_, equations_->start(twist.velocity / unit_));
  look_for_rest();
}

void NumericMotion::begin_rolling(const scene::Material& ground, const Vector2d& position,
                                  const Vector2d& velocity, const NormalSpin& spin) {
  choose_unit(velocity.norm(), ground, position);
  begin(equations(Regime::rolling, ground, position), ground, position, spin);
  find_line(velocity / unit_, equations_->start(velocity / unit_), Vector2d::Zero());
  trajectory_.begin(*equations_, equations_->start(velocity / unit_));
  look_for_rest();
}

void NumericMotion::begin_sliding(const scene::Material& ground, const Vector2d& position,
                                  const Vector2d& p_c, const Vector2d& slip, const NormalSpin& spin) {
  choose_unit(std::max(p_c.norm(), slip.norm()), ground, position);
  Equations equations = this->equations(Regime::sliding, ground, position);
  equations.set_momentum(p_c / unit_);
  begin(equations, ground, position, spin);
  const Vector2d w = slip / unit_;
  const Vector2d carried = w + equations_->ground(Vector2d::Zero());
  find_line(p_c / unit_ + dynamics_.kappa * carried, equations_->start(w), w);
  begin_dry(w);
}

void NumericMotion::begin_resisted(const scene::Material& ground, const Vector2d& position,
                                   const Vector2d& velocity, const NormalSpin& spin) {
  choose_unit(velocity.norm(), ground, position);
  begin(equations(Regime::resisted, ground, position), ground, position, spin);
  const Vector2d w = (velocity - ground_velocity(ground, position)) / unit_;
  find_line(velocity / unit_, equations_->start(w), w);
  begin_dry(w);
}

void NumericMotion::begin_carried(const scene::Material& ground, const Vector2d& position,
                                  const NormalSpin& spin) {
  choose_unit(0, ground, position);
  begin(equations(Regime::resisted, ground, position), ground, position, spin);
  carriage_.emplace(*equations_);
  velocity_ = ground.belt;
  acceleration_.setZero();
  line_ = ground.turntable_rate == 0 ? ground.belt : Vector2d(Vector2d::Zero());
}

void NumericMotion::begin_skidding(const scene::Material& ground, const Vector2d& position,
                                   const Vector2d& velocity, const Vector2d& slip, const NormalSpin& spin) {
  choose_unit(std::max(velocity.norm(), slip.norm()), ground, position);
  begin(equations(Regime::skidding, ground, position), ground, position, spin);
  find_line(velocity / unit_, equations_->start(slip / unit_), slip / unit_);
  begin_dry(slip / unit_);
}

void NumericMotion::begin_gliding(const Vector2d& position, const Vector2d& velocity,
                                  const NormalSpin& spin) {
  const Vector2d held = std::exchange(dynamics_.spin, Vector2d(Vector2d::Zero()));
  begin_free(position, {velocity, Vector3d::Zero()}, spin);
  dynamics_.spin = held;
}

void NumericMotion::begin_scrubbing(const scene::Material& ground, const Vector2d& position,
                                    const Vector2d& velocity, const Vector2d& slip, const Vector2d& nu,
                                    const NormalSpin& spin) {
  choose_unit(std::max({velocity.norm(), slip.norm(), nu.norm()}), ground, position);
  begin(equations(Regime::scrubbing, ground, position), ground, position, spin);
  const auto told = [this](const Vector2d& w) {
    const Vector2d scaled = w / unit_;
    return scaled.norm() <= solver::least_speed ? Vector2d(Vector2d::Zero()) : scaled;
  };
  State y = equations_->start(told(slip), told(nu));
  find_line(velocity / unit_, y, slip / unit_);
  if (!parallel(line_, nu, velocity.norm() + nu.norm())) line_.setZero();
  const bool slips = !y.head<2>().isZero(0) || equations_->decay() == 0;
  const bool turns = !y.segment<2>(4).isZero(0);
  if (!slips || !turns) {
    departure_.emplace(*equations_, y.head<2>().matrix(), y.segment<2>(4).matrix());
    if (departure_->end() == 0) die(slips ? 1 : turns ? 0 : 2, 0);
    if (!dead_) y = departure_->at(departure_->end());
  }
  trajectory_.begin(*equations_, y);
  if (!dead_) look_for_death();
}

// A w that is not told from 0 but grows is the one that grows from 0.
void NumericMotion::begin_dry(const Vector2d& w) {
  constexpr double told = 1 + 16 * DBL_EPSILON;
  State y = equations_->start(w);
  const bool grows = equations_->instant(y).forcing.norm() > told * equations_->decay();
  if (w.isZero(0) || (grows && w.norm() <= solver::least_speed)) {
    departure_.emplace(*equations_);
    if (departure_->end() == 0) die(0, 0);  // w does not grow
    y = departure_->at(departure_->end());
  }
  trajectory_.begin(*equations_, y);
  if (!dead_) look_for_death();
}

void NumericMotion::die(int i, double time) {
  dead_ = true;
  dying_ = i;
  death_ = time;
}

// Of vector i, over the rest of its time: how far the drive may change, relative to what uses it up. e turns
// towards B, by at most the whole angle between them, B changes with the motion, and with the direction of
// the other vector.
double NumericMotion::deviation_of(int i, const State& y, const Instant& now, double rest, double rate,
                                   const solver::SpeedBound& bound) const {
  constexpr double all = 0x1p+60;
  const solver::DryVector dry = equations_->dry_vector(i, y, now);
  const double b = dry.drive.norm();
  const double along = dry.drive.dot(dry.e);
  // The angle matters by b (1 - cos): or, where abs(B) > A and w turns round, altogether.
  const double turn = b < dry.decay ? (b - along) / (dry.decay - b) : all;
  const solver::ForcingBound forcing(*equations_, bound);
  const double drift =
      (forcing.force_rate + forcing.spin_rate + std::abs(equations_->turntable_rate()) * bound.acceleration) *
      rest / rate;
  if (dry.coupled == 0) return std::min(turn, 1.0) + drift;
  const solver::DryVector other = equations_->dry_vector(1 - i, y, now);
  const double pull = other.drive.norm();
  const double left = other.w.norm() - (pull + other.decay) * rest;
  if (!(left > 0)) return all;
  return std::min(turn, 1.0) + drift + dry.coupled * pull / left * rest / rate;
}

// Near w = 0 the remaining time is abs(w)/(A - B.e), but for the change of B.e meanwhile. Once that is below
// rounding, the motion is taken to its end on a straight line.
void NumericMotion::look_for_death() {
  const double small = std::max(0x1p-54, 0.01 * trajectory_.tolerance());
  const State& y = trajectory_.last();
  const Instant now = equations_->instant(y);
  double rest = never;
  double rate = 0;
  int dying = 0;
  const bool alone = equations_->dry_vectors() == 1;
  for (int i = 0; i < equations_->dry_vectors(); ++i) {
    const solver::DryVector dry = equations_->dry_vector(i, y, now);
    const double slows = dry.decay - dry.drive.dot(dry.e);
    // One whose rest is without end, because what drives it is just as much as friction can hold.
    const bool held = !alone && dry.drive.norm() <= (1 + 16 * DBL_EPSILON) * dry.decay;
    const double speed = now.velocity.norm();
    const double least =
        slows <= 0x1p-20 * dry.decay ? trajectory_.negligible(speed) : 0x1p-54 * small * speed;
    if (held && dry.w.norm() <= least) {
      die(i, solver::time_of(y));
      return;
    }
    if (dry.decay == 0 || !(slows > 0) || !(dry.w.norm() / slows < rest)) continue;
    rest = dry.w.norm() / slows;
    rate = slows;
    dying = i;
  }
  if (rest == never) return;
  const double size = equations_->dry_vector(dying, y, now).w.norm();
  const double duration = std::max(solver::time_of(y), rest);
  const double speed = now.velocity.norm() + size + rate * duration;
  const solver::SpeedBound bound(*equations_, y, rest);
  const double change = deviation_of(dying, y, now, rest, rate, bound);
  const double least = 0x1p-54 * small * speed;
  const bool both = !alone && equations_->dry_vector(1 - dying, y, now).w.norm() <= least;
  if (rest * change > small * duration || bound.acceleration * rest * rest > small * speed * duration) {
    if (!(size <= least) || !(alone || both)) return;
  }
  die(both ? 2 : dying, solver::time_of(y) + rest);
}

// Where all forces but drag have a potential, sqrt(v^2 + abs(drive)^2/gamma) does not grow. Once it is less
// than the rounding of the way that has been made, the sphere is at rest as well as can be told; so it is
// where no force is left and the speed is too small for any time to tell.
void NumericMotion::look_for_rest() {
  constexpr double small = 0x1p-40;  // of the way
  constexpr double nothing = solver::least_speed;
  const State& y = trajectory_.last();
  const Vector2d d = solver::displacement(y);
  const solver::Drive drive = solver::drive_of(*equations_, d);
  if (!drive.conserves) return;
  const double speed = equations_->instant(y).velocity.norm();
  if (drive.stiffness > 0) {
    const double frequency = std::sqrt(drive.stiffness);
    const double amplitude = std::hypot(speed, drive.drive.norm() / frequency) / frequency;
    rests_ = amplitude <= std::max(nothing / frequency, small * d.norm());
  } else {
    rests_ = drive.drive.isZero(0) && speed <= nothing;
  }
}

void NumericMotion::cover(double tau) {
  const bool dry = equations_->is_dry();
  constexpr std::uint32_t turns_of_a_step = 4;
  while (!dead_ && !rests_ && solver::time_of(trajectory_.last()) < tau) {
    interruption_point(turns_of_a_step);
    trajectory_.extend();
    if (dry) {
      look_for_death();
    } else {
      look_for_rest();
    }
  }
}

void NumericMotion::reach(double tau) {
  if (!carriage_ && tau > series_end()) cover(tau);
}

double NumericMotion::reached() const {
  return carriage_ || dead_ || rests_ ? never : std::max(series_end(), solver::time_of(trajectory_.last()));
}

// The last bit of a motion against dry friction: w dies linearly.
State NumericMotion::dying(double tau) const {
  State y = trajectory_.last();
  const double rest = death_ - solver::time_of(y);
  const double passed = std::min(tau - solver::time_of(y), rest);
  const State rate = equations_->derivative(y);
  const double pace = equations_->pace(y);
  const double left = tau >= death_ ? 0 : rest > 0 ? std::max(0.0, (rest - passed) / rest) : 0;
  if (pace > 0) y.segment<4>(2) += rate.segment<4>(2) / pace * passed;
  if (dying_ == 1 && pace > 0) y.head<2>() += rate.head<2>() / pace * passed;
  if (dying_ != 1) y.head<2>() *= left;
  if (dying_ != 0) y.segment<2>(4) = left * trajectory_.last().segment<2>(4);
  y[6] = std::min(tau, death_);
  return y;
}

State NumericMotion::state(double tau) {
  if (carriage_) return carriage_->at(tau);
  if (departure_ && tau <= departure_->end()) return departure_->at(tau);
  cover(tau);
  if (dead_ && tau >= solver::time_of(trajectory_.last())) return dying(tau);
  if (rests_ && tau > solver::time_of(trajectory_.last())) {
    State y = trajectory_.last();
    y.head<2>() = 0;
    y[6] = tau;
    return y;
  }
  return trajectory_.at(tau);
}

Placement NumericMotion::placed(const State& y, const Instant& now) const {
  const Vector2d d = solver::displacement(y);
  const Vector2d acceleration = carriage_ ? Vector2d(equations_->turntable_rate() * turned(now.velocity))
                                          : equations_->acceleration(y, now);
  return {start_ + unit_ * d, unit_ * now.velocity, unit_ * acceleration};
}

Placement NumericMotion::center(double tau) {
  const State y = state(tau);
  return placed(y, equations_->instant(y));
}

Kinematics NumericMotion::at(double tau) {
  const State y = state(tau);
  const Instant now = equations_->instant(y);
  const Vector2d d = solver::displacement(y);
  Kinematics all;
  all.center = placed(y, now);
  const double radius = dynamics_.radius;
  if (equations_->regime() == Regime::free) {
    const Dynamics& dynamics = equations_->dynamics();
    const Vector2d rate = unit_ * Vector2d(-dynamics.spin.y(), dynamics.spin.x()) / radius -
                          dynamics.rotational_drag * planar_spin_;
    const Vector2d omega = planar_spin_ + tau * phi1(-dynamics.rotational_drag * tau) * rate;
    all.contact_velocity = all.center.velocity + radius * Vector2d(-omega.y(), omega.x());
    all.angular_velocity << omega, spin_.at(tau);
    return all;
  }
  all.contact_velocity = unit_ * equations_->ground(d);
  if (equations_->slides()) all.contact_velocity += unit_ * y.head<2>().matrix();
  all.angular_velocity << unit_ * Vector2d(-now.nu.y(), now.nu.x()) / radius, spin_.at(tau);
  return all;
}

double NumericMotion::acceleration_bound(double from, double until) {
  if (carriage_) return unit_ * std::abs(equations_->turntable_rate()) * carriage_->speed();
  const State y = state(from);
  return unit_ * solver::SpeedBound(*equations_, y, std::max(0.0, until - solver::time_of(y))).acceleration;
}

// Dry friction turns round where w is across B, the faster the shorter w is. In x that is smooth, so that it
// lies between two nodes and is found there by halving.
SharpTurn NumericMotion::sharp_turn(double from, double until) {
  if (carriage_ || !equations_->is_dry()) return {};
  cover(until);
  for (std::size_t i = trajectory_.index_at(from); i + 1 < trajectory_.size(); ++i) {
    if (solver::time_of(trajectory_.node(i).y) > until) break;
    SharpTurn first;
    for (int k = 0; k < equations_->dry_vectors(); ++k) {
      const SharpTurn turn = sharp_turn_of(k, i, from);
      if (turn.time < first.time) first = turn;
    }
    if (first.time < never) return first;
  }
  if (dead_ && death_ > from && death_ <= until) return {death_, 0};
  return {};
}

/// Of one dry vector in the step from a node.
SharpTurn NumericMotion::sharp_turn_of(int k, std::size_t i, double from) {
  constexpr int halvings = 40;
  const auto along = [this, k](const State& y) {
    const solver::DryVector dry = equations_->dry_vector(k, y, equations_->instant(y));
    return dry.w.dot(dry.drive);
  };
  const solver::Node& node = trajectory_.node(i);
  if (!(along(node.y) < 0 && along(trajectory_.node(i + 1).y) >= 0)) return {};
  double low = 0;
  double high = node.step;
  for (int n = 0; n < halvings; ++n) {
    const double middle = 0.5 * (low + high);
    (along(trajectory_.after(i, middle)) < 0 ? low : high) = middle;
  }
  const State turn = trajectory_.after(i, high);
  if (!(solver::time_of(turn) > from)) return {};
  const solver::DryVector dry = equations_->dry_vector(k, turn, equations_->instant(turn));
  return {solver::time_of(turn), dry.w.norm() / (dry.drive.norm() + dry.decay)};
}

void NumericMotion::end_at(double time, End kind) {
  if (!(time < end_)) return;
  end_ = time;
  end_kind_ = kind;
}

// Looks at whole steps, so that the answer does not depend on the horizons that are asked for.
void NumericMotion::look_for_grip() {
  const End loss = equations_->regime() == Regime::skidding ? End::breaks_loose : End::grip_lost;
  if (departure_ && !departure_grips_ && departure_->end() > 0) {
    const auto margin = [this](double tau) { return grip_->along_departure(*departure_, tau); };
    const double curvature = grip_->curvature(*departure_);
    const auto bound = [curvature](double, double) { return curvature; };
    end_at(solver::first_loss(margin, bound, departure_->end()), loss);
    departure_grips_ = true;
  }
  for (; end_ == never; ++gripped_nodes_) {
    const std::size_t i = std::max(gripped_nodes_, trajectory_.forgotten()) - trajectory_.forgotten();
    if (i + 1 >= trajectory_.size()) return;
    const solver::Node& node = trajectory_.node(i);
    const double begin = solver::time_of(node.y);
    const State& far = trajectory_.node(i + 1).y;
    const double curvature = grip_->curvature(node.y, node.step, solver::time_of(far) - begin);
    const geometry::Jet near_jet = grip_->along_trajectory(node.y);
    const geometry::Jet far_jet = grip_->along_trajectory(far);
    const double least = std::min(near_jet.value - near_jet.noise, far_jet.value - far_jet.noise);
    if (least > 0.125 * curvature * node.step * node.step) continue;
    const auto margin = [&](double x) { return grip_->along_trajectory(trajectory_.after(i, x)); };
    // The bound for a whole step may be larger by many powers of ten than that for a part of it.
    const auto bound = [&](double low, double high) {
      if (high - low == node.step) return curvature;
      const State from = trajectory_.after(i, low);
      const double duration = solver::time_of(trajectory_.after(i, high)) - solver::time_of(from);
      return std::min(curvature, grip_->curvature(from, high - low, std::max(0.0, duration)));
    };
    const double x = solver::first_loss(margin, bound, node.step);
    if (x < never) end_at(solver::time_of(trajectory_.after(i, x)), loss);
  }
}

// In pieces that do not depend on the horizons that are asked for.
void NumericMotion::look_ahead_carried(double horizon) {
  while (end_ == never && carried_until_ <= horizon && carried_until_ < carriage_->repeats()) {
    const double until = carriage_->next_piece(carried_until_);
    const double breaking = carriage_->first_breaking(carried_until_, until);
    const double slipping = grip_ ? carriage_->first_slipping(friction_, carried_until_, until) : never;
    end_at(breaking, End::breaks_loose);
    end_at(slipping, End::grip_lost);
    carried_until_ = until;
  }
}

double NumericMotion::end_before(double horizon) {
  if (carriage_) {
    look_ahead_carried(horizon);
  } else if (end_ == never && (equations_->is_dry() || grip_)) {
    cover(horizon);
    if (grip_) look_for_grip();
    const bool slips = equations_->slides() && dying_ != 1;
    if (dead_ && equations_->is_dry()) end_at(death_, slips ? End::slip_used_up : End::roll_used_up);
  }
  return end_ <= horizon ? end_ : never;
}

std::uint64_t NumericMotion::steps(double from, double until) const {
  return carriage_ ? 0 : trajectory_.index_at(until) - trajectory_.index_at(from);
}

void NumericMotion::loosen() {
  if (grip_) grip_->loosen();
  if (carriage_) carriage_->loosen();
}

void NumericMotion::forget_before(double tau) {
  if (!carriage_) trajectory_.forget_before(tau);
}

}  // namespace hybrid_sphere

#include "mechanics/motion_scale.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace hybrid_sphere::mechanics {

namespace {

/// Constraints may balance the forces, so that the motion never has the speed that the forces alone would
/// give to it. This part of that speed is the scale of round-off for a system at rest. A body under gravity
/// for 1 s then has a scale of 1e-6 m, and 6e-17 m, what cos(pi/2) gives, is round-off at the default
/// accuracy.
constexpr double balanced_force_share = 1e-3;

/// The speed, in the metric of M, that the forces alone give to a motion within a time; 0 if they are not
/// finite, which the motion itself reports. Velocities without mass are left out: their forces give them no
/// speed of their own.
double speed_by_forces(const Model& model, double t, const Vector& q, const Vector& v, double time) {
  if (time == 0) return 0;
  MotionTerms terms;
  try {
    model.equations->evaluate(t, q, v, terms);
  } catch (const NotFinite&) {
    return 0;
  }
  double sum = 0;
  for (Index i = 0; i < terms.force.size(); ++i) {
    if (terms.mass(i, i) > 0) sum += terms.force[i] * terms.force[i] / terms.mass(i, i);
  }
  return std::isfinite(sum) ? time * std::sqrt(sum) : 0;
}

}  // namespace

Sizes sizes_at_start(const Model& model, double t, const Vector& q, const Vector& v, double time) {
  Sizes sizes{q.cwiseAbs(), v.cwiseAbs()};
  Vector momentum;
  Matrix mass;
  model.equations->momentum(t, q, v, momentum, mass);
  const double by_forces = balanced_force_share * speed_by_forces(model, t, q, v, time);
  const double speed = std::max(length(mass, v), by_forces);
  Vector rate;
  for (Index i = 0; i < v.size(); ++i) {
    if (!(mass(i, i) > 0)) continue;
    const double of_velocity = speed / std::sqrt(mass(i, i));
    sizes.v[i] = std::max(sizes.v[i], of_velocity);
    model.equations->rate(q, Vector::Unit(v.size(), i), rate);
    sizes.q = sizes.q.cwiseMax(time * of_velocity * rate.cwiseAbs());
  }
  return sizes;
}

Vector sizes_of_rate(const Model& model, const Vector& q, const Vector& speeds) {
  Vector sizes = Vector::Zero(q.size());
  Vector rate;
  for (Index i = 0; i < speeds.size(); ++i) {
    model.equations->rate(q, speeds[i] * Vector::Unit(speeds.size(), i), rate);
    sizes = sizes.cwiseMax(rate.cwiseAbs());
  }
  return sizes;
}

MotionScale::MotionScale(const Model& model, const Vector& q)
    : model_(&model),
      start_(q),
      displacement_(Vector::Zero(q.size())),
      velocity_(Vector::Zero(model.equations->velocities())),
      direction_(velocity_),
      values_(Vector::Ones(q.size() + velocity_.size())) {}

void MotionScale::see(const ConstrainedMotion& motion, const Vector& q, const Vector& v, double step) {
  const Matrix& mass = motion.terms().mass;
  const double now_speed = length(mass, v);
  const double acceleration = length(mass, motion.acceleration());
  acceleration_ = std::max(acceleration_, acceleration);
  speed_ = std::max(speed_, now_speed);
  present_turning_time_ = acceleration > 0 ? speed_ / acceleration : std::numeric_limits<double>::infinity();
  // What the next step adds is a guess: it counts for that step alone. A jolt that is over does not make it
  // more than the speed.
  const double more = std::min(acceleration_ * step, std::max(acceleration * step, speed_));
  const double speed = std::max(speed_, now_speed + more);
  turning_time_ = acceleration_ > 0 ? speed / acceleration_ : std::numeric_limits<double>::infinity();
  displacement_ = displacement_.cwiseMax((q - start_).cwiseAbs());
  velocity_ = velocity_.cwiseMax(v.cwiseAbs());
  expected_ = speed;
  set_velocities(motion, speed);
  const double now = is_slow_ ? std::min(speed, now_speed + more) : speed;
  set_coordinates(q, now < speed ? step * now / speed : step);
}

void MotionScale::expect(const ConstrainedMotion& motion, const Vector& q, double speed, double step) {
  constexpr double much = 2;
  if (!(speed > much * expected_)) return;
  turning_time_ = step;
  set_velocities(motion, speed);
  set_coordinates(q, step);
}

// The metric of M, in which errors are measured, knows nothing of a velocity without mass: the constraints
// say how much of the energy's speed it has.
void MotionScale::set_velocities(const ConstrainedMotion& motion, double speed) {
  const Matrix& mass = motion.terms().mass;
  for (Index i = 0; i < velocity_.size(); ++i) {
    const double scale =
        mass(i, i) > 0 ? speed / std::sqrt(mass(i, i)) : std::max(speed * motion.mobility(i), velocity_[i]);
    values_[start_.size() + i] = scale > 0 ? scale : 1;
  }
}

void MotionScale::set_coordinates(const Vector& q, double step) {
  const Index coordinates = q.size();
  auto scale = values_.head(coordinates);
  const auto velocities = values_.tail(velocity_.size());
  if (coordinates == velocity_.size()) {
    scale = velocities;
  } else {
    scale.setZero();
    for (Index j = 0; j < velocity_.size(); ++j) {
      direction_.setZero();
      direction_[j] = velocities[j];
      model_->equations->rate(q, direction_, rate_);
      scale = scale.cwiseMax(rate_.cwiseAbs());
    }
  }
  for (Index i = 0; i < coordinates; ++i) {
    const double farthest = scale[i] > 0 ? scale[i] * turning_time_ : 0;
    const double length = std::min(displacement_[i], farthest) + scale[i] * step;
    scale[i] = length > 0 ? length : 1;
  }
}

}  // namespace hybrid_sphere::mechanics

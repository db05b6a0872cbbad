#include "mechanics/motion_scale.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace hybrid_sphere::mechanics {

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

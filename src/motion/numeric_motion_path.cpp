// What others ask of the steps of a motion: its path, how much that bends, and its steps.
#include <algorithm>

#include "hybrid_sphere/numerical_error.hpp"
#include "motion/numeric_motion.hpp"
#include "motion/speed_bound.hpp"

namespace hybrid_sphere {

using numeric::EquationForm;
using numeric::State;

PointState NumericMotion::path(double tau) {
  Vector2d velocity = Vector2d::Constant(never);
  const State y = state(tau, &velocity);
  PointState there = point_state(y, equations_->instant(y));
  if (!velocity.allFinite()) return there;
  State rate = State::Zero();
  numeric::set_pair(rate, 0, velocity);
  keep_on_line(rate);
  there.velocity = unit_ * numeric::pair(rate, 0);
  return there;
}

Vector2d NumericMotion::reference_velocity() {
  const EquationForm form = equations_->form();
  if (form == EquationForm::free || form == EquationForm::rolling) return Vector2d::Zero();
  return unit_ * equations_->ground(Vector2d::Zero());
}

// A cubic of a long step bends as no force does.
double NumericMotion::acceleration_bound(double from, double until) {
  if (sticking_) return unit_ * std::abs(equations_->turntable_rate()) * sticking_->speed();
  const State y = state(from);
  const double by_forces =
      numeric::SpeedBound(*equations_, y, std::max(0.0, until - numeric::time_of(y))).acceleration;
  if (!trajectory_.has_step_paths()) return unit_ * by_forces;
  try {
    cover(until);
  } catch (const NumericalError&) {
    // Nobody can look where no step leads, either.
  }
  return unit_ * std::max(by_forces, trajectory_.path_bend(from, until));
}

void NumericMotion::keep_rolling(MotionState& state) const {
  const EquationForm form = equations_->form();
  if (form != EquationForm::rolling && form != EquationForm::resisted_rolling) return;
  const Vector2d nu = state.center.velocity - state.contact_velocity;
  state.angular_velocity.head<2>() = Vector2d(-nu.y(), nu.x()) / dynamics_.radius;
}

std::optional<NumericMotion::Step> NumericMotion::step_at(double tau) {
  if (sticking_ || tau < numeric::time_of(trajectory_.node(0).y)) return std::nullopt;
  cover(tau);
  const std::size_t i = trajectory_.index_at(tau);
  if (i + 1 == trajectory_.size()) return std::nullopt;
  return Step{numeric::time_of(trajectory_.node(i).y), numeric::time_of(trajectory_.node(i + 1).y)};
}

}  // namespace hybrid_sphere

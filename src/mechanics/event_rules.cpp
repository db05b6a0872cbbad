#include "mechanics/event_rules.hpp"

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <stdexcept>

namespace hybrid_sphere::mechanics {
namespace {

int sign_of(double x) { return (x > 0) - (x < 0); }

Vector after_reset(const Event& event, double t, const Vector& q, const Vector& v) {
  Vector after = event.reset(t, q, v);
  if (after.size() != v.size()) {
    throw std::invalid_argument("the reset of event " + event.name + " returns " +
                                std::to_string(after.size()) + " velocities; the model has " +
                                std::to_string(v.size()));
  }
  if (!after.allFinite()) throw NotFinite("reset of event " + event.name);
  return after;
}

}  // namespace

double value_of(const Event& event, double t, const Vector& q, const Vector& v) {
  const double value = event.function(t, q, v);
  if (!std::isfinite(value)) throw NotFinite("event " + event.name);
  return value;
}

double change_of(const Event& event, double t, const Vector& q, const Vector& v,
                 const ConstrainedMotion& motion, double step) {
  const Vector q_change = step * motion.terms().rate;
  const Vector v_change = step * motion.acceleration();
  return value_of(event, t + step, q + q_change, v + v_change) -
         value_of(event, t - step, q - q_change, v - v_change);
}

EventRules::EventRules(const Model& model) : model_(&model), sides_(model.events.size()) {}

double EventRules::value(std::size_t i, double t, const Vector& q, const Vector& v) const {
  return value_of(model_->events[i], t, q, v);
}

std::vector<std::size_t> EventRules::pass(double t, const Vector& q, Vector& v,
                                          const std::vector<MonitoredGuard>& passed) {
  std::vector<std::size_t> happened;
  for (std::size_t i = 0; i < sides_.size(); ++i) {
    Side& side = sides_[i];
    const bool is_passed = std::any_of(passed.begin(), passed.end(), [&](const MonitoredGuard& guard) {
      return guard.kind == MonitoredGuard::Kind::event && guard.constraint == i;
    });
    const bool jumps =
        !is_passed && !side.is_left && side.sign != 0 && sign_of(value(i, t, q, v)) == -side.sign;
    if (!is_passed && !jumps) continue;
    const Crossing crossing = side.sign > 0 ? Crossing::falling : Crossing::rising;
    side = {jumps ? -side.sign : 0, is_passed};
    const Event& event = model_->events[i];
    if (event.crossing != Crossing::either && event.crossing != crossing) continue;
    happened.push_back(i);
  }
  for (const std::size_t i : happened) {
    if (model_->events[i].reset) v = after_reset(model_->events[i], t, q, v);
  }
  return happened;
}

/// Where the motion goes from a place at which the function is 0, or its rounding: by its rate, or further
/// on.
int EventRules::sign_from(std::size_t i, double t, const Vector& q, const Vector& v, double ahead,
                          ConstrainedMotion& motion) const {
  constexpr double part = 1e-4;
  constexpr double rounding = 64 * DBL_EPSILON;
  try {
    motion.evaluate_stage(t, q, v);
    const double step = part * ahead;
    const double change = change_of(model_->events[i], t, q, v, motion, step);
    if (std::abs(change) > rounding * std::abs(value(i, t, q, v))) return sign_of(change);
    MotionStep to(motion);
    Node start{0, Vector(q.size() + v.size())};
    start.y << q, v;
    const Node there = to.reach(t, start, step);
    return sign_of(value(i, t + step, there.y.head(q.size()), there.y.tail(v.size())));
  } catch (const NumericalError&) {
    return 0;  // the motion need not come so far
  }
}

void EventRules::monitor(double t, const Vector& q, const Vector& v, double ahead, ConstrainedMotion& motion,
                         std::vector<MonitoredGuard>& guards) {
  for (std::size_t i = 0; i < sides_.size(); ++i) {
    Side& side = sides_[i];
    const double now = value(i, t, q, v);
    const int sign = sign_of(now);
    if (side.is_left || sign == 0) {
      side.sign = sign_from(i, t, q, v, ahead, motion);
    } else if (side.sign == 0) {
      side.sign = sign;
    }
    side.is_left = false;
    if (side.sign == 0) continue;
    const double rounding = sign == side.sign ? 0 : 2 * std::abs(now);
    guards.push_back({i, side.sign > 0, MonitoredGuard::Kind::event, 1, rounding});
  }
}

}  // namespace hybrid_sphere::mechanics

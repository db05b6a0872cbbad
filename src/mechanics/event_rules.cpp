#include "mechanics/event_rules.hpp"

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <stdexcept>

namespace hybrid_sphere::mechanics {
namespace {

constexpr double state_roundoff = 16 * DBL_EPSILON;  // as many roundings as the clock's resolution has
constexpr double part_of_look_ahead = 1e-4;          // step of the difference that gives a rate

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

void EventRules::restore(const std::vector<Side>& sides) {
  sides_ = sides;
  for (Side& side : sides_) side.sign = 0;
}

double EventRules::value(std::size_t i, const Instant& at) const {
  return value_of(model_->events[i], at.t, at.q, at.v);
}

bool EventRules::has_crossed(const Side& side, const Instant& at) const {
  return at.t - side.crossed <= at.resolution;
}

/// Whether a function is still as near to 0 as the crossing has been located.
bool EventRules::is_at_crossing(const Side& side, const Instant& at, double value) const {
  constexpr double times = 2;
  return has_crossed(side, at) && std::abs(value) <= times * side.overshoot;
}

/// Bounds what round-off of t, q and v does to a function's value: the sum of its changes when each of them
/// changes by its round-off.
double EventRules::roundoff(std::size_t i, const Instant& at, double value) const {
  const Event& event = model_->events[i];
  double sum = 0;
  const auto add = [&](double t, const Vector& q, const Vector& v) {
    const double change = std::abs(event.function(t, q, v) - value);
    if (std::isfinite(change)) sum += change;  // the function need not be defined beyond this state
  };
  add(at.t + at.resolution, at.q, at.v);
  Vector shifted = at.q;
  for (Index k = 0; k < shifted.size(); ++k) {
    shifted[k] += state_roundoff * at.sizes.q[k];
    add(at.t, shifted, at.v);
    shifted[k] = at.q[k];
  }
  shifted = at.v;
  for (Index k = 0; k < shifted.size(); ++k) {
    shifted[k] += state_roundoff * at.sizes.v[k];
    add(at.t, at.q, shifted);
    shifted[k] = at.v[k];
  }
  return sum;
}

/// The sign of a function's rate along the motion; 0 if it can be due to the function's round-off, or if the
/// motion has no rate here.
int EventRules::sign_of_rate(std::size_t i, const Instant& at, double roundoff,
                             ConstrainedMotion& motion) const {
  try {
    motion.evaluate_stage(at.t, at.q, at.v);
    const double change =
        change_of(model_->events[i], at.t, at.q, at.v, motion, part_of_look_ahead * at.ahead);
    return std::abs(change) > roundoff ? sign_of(change) : 0;
  } catch (const NumericalError&) {
    return 0;
  }
}

/// Bounds what round-off of the velocities and of the present coordinates does to the change that gives the
/// rate.
double EventRules::roundoff_of_rate(std::size_t i, const Instant& at, double value,
                                    const ConstrainedMotion& motion) const {
  const double step = part_of_look_ahead * at.ahead;
  double sum = 0;
  Vector shifted = at.q;
  const double fastest = at.sizes.v.maxCoeff();
  for (Index k = 0; k < shifted.size(); ++k) {
    const double speed = fastest + (motion.terms().rate.size() > k ? std::abs(motion.terms().rate[k]) : 0);
    shifted[k] += state_roundoff * (step * speed + std::abs(at.q[k]));
    const double change = std::abs(model_->events[i].function(at.t, shifted, at.v) - value);
    if (std::isfinite(change)) sum += change;
    shifted[k] = at.q[k];
  }
  return sum;
}

/// The sign of a function a short piece of motion later; 0 if it can be due to round-off, or if the motion
/// does not come so far.
int EventRules::sign_ahead(std::size_t i, const Instant& at, double roundoff,
                           ConstrainedMotion& motion) const {
  try {
    motion.evaluate_stage(at.t, at.q, at.v);
    MotionStep to(motion);
    Node start{0, Vector(at.q.size() + at.v.size())};
    start.y << at.q, at.v;
    const double step = part_of_look_ahead * at.ahead;
    const Node there = to.reach(at.t, start, step);
    const double later =
        value_of(model_->events[i], at.t + step, there.y.head(at.q.size()), there.y.tail(at.v.size()));
    return std::abs(later) > roundoff ? sign_of(later) : 0;
  } catch (const NumericalError&) {
    return 0;
  }
}

/// Returns whether a function that the motion has not been seen to take over 0 changes its sign here: by an
/// impulse, or because it is 0 up to round-off and the motion takes it to the other side.
bool EventRules::changes(std::size_t i, const Instant& at, ConstrainedMotion& motion) {
  Side& side = sides_[i];
  if (has_crossed(side, at)) return false;
  const double now = value(i, at);
  const double least = roundoff(i, at, now);
  if (std::abs(now) > least) return side.sign != 0 && sign_of(now) == -side.sign;
  const int rate = sign_of_rate(i, at, least, motion);
  if (side.sign == 0) {  // nothing is known from before: the motion comes from where its rate says
    side.sign = -rate;
    return rate != 0;
  }
  const int next = rate != 0 ? rate : sign_ahead(i, at, least, motion);
  return next == -side.sign;
}

std::vector<std::size_t> EventRules::occurring(const Instant& at, const std::vector<MonitoredGuard>& passed,
                                               ConstrainedMotion& motion) {
  std::vector<std::size_t> events;
  for (std::size_t i = 0; i < sides_.size(); ++i) {
    const bool is_passed = std::any_of(passed.begin(), passed.end(), [&](const MonitoredGuard& guard) {
      return guard.kind == MonitoredGuard::Kind::event && guard.constraint == i;
    });
    if (!is_passed && !changes(i, at, motion)) continue;
    const Crossing crossing = sides_[i].sign > 0 ? Crossing::falling : Crossing::rising;
    constexpr double soon = 1e4;  // resolutions
    const bool again =
        is_passed && model_->events[i].reset && at.t - sides_[i].crossed <= soon * at.resolution;
    const int repeats = again ? sides_[i].repeats + 1 : 0;
    sides_[i] = {-sides_[i].sign, at.t, is_passed ? std::abs(value(i, at)) : 0, repeats};
    const Crossing wanted = model_->events[i].crossing;
    if (wanted == Crossing::either || wanted == crossing) events.push_back(i);
  }
  return events;
}

bool EventRules::accumulate() const {
  constexpr int few = 2;
  return std::any_of(sides_.begin(), sides_.end(), [](const Side& side) { return side.repeats > few; });
}

Vector EventRules::after_resets(const std::vector<std::size_t>& events, const Instant& at) const {
  Vector v = at.v;
  for (const std::size_t i : events) {
    if (model_->events[i].reset) v = after_reset(model_->events[i], at.t, at.q, v);
  }
  return v;
}

void EventRules::rearm(const Instant& after) {
  for (std::size_t i = 0; i < sides_.size(); ++i) {
    const double now = value(i, after);
    if (!is_at_crossing(sides_[i], after, now) && std::abs(now) > roundoff(i, after, now)) {
      sides_[i] = {sign_of(now)};
    } else {
      sides_[i] = {0, after.t, sides_[i].overshoot, sides_[i].repeats};
    }
  }
}

void EventRules::monitor(const Instant& at, ConstrainedMotion& motion, std::vector<MonitoredGuard>& guards) {
  for (std::size_t i = 0; i < sides_.size(); ++i) {
    Side& side = sides_[i];
    const double now = value(i, at);
    const double least = roundoff(i, at, now);
    int next = sign_of(now);
    const bool is_zero = is_at_crossing(side, at, now) || std::abs(now) <= least;
    if (is_zero) {
      const int rate = sign_of_rate(i, at, least, motion);
      next = rate != 0 ? rate : sign_ahead(i, at, 0, motion);
      // A bounce too low to be seen comes back to 0 at once: its side is the one to which it starts.
      const int first = rate != 0 ? rate : sign_of_rate(i, at, roundoff_of_rate(i, at, now, motion), motion);
      if (first != 0) next = first;
    }
    if (next != 0) side.sign = next;
    if (side.sign == 0) continue;
    const double rounding = is_zero ? std::max(2 * std::abs(now), least) : 0;
    guards.push_back({i, side.sign > 0, MonitoredGuard::Kind::event, rounding});
  }
}

}  // namespace hybrid_sphere::mechanics

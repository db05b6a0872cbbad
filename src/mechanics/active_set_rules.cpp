#include "mechanics/active_set_rules.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cfloat>
#include <cmath>
#include <iterator>
#include <limits>

#include "hybrid_sphere/numerical_error.hpp"
#include "mechanics/guards.hpp"

namespace hybrid_sphere::mechanics {

namespace {

/// Of the clock [s].
double resolution(double t) { return 16 * DBL_EPSILON * std::abs(t); }

}  // namespace

ActiveSetRules::ActiveSetRules(const Model& model, double accuracy)
    : model_(&model),
      impulse_(model),
      motion_(model),
      looseness_(std::max(1.0, accuracy / DBL_EPSILON)),
      positive_(model.constraints.size(), true),
      kept_(model.constraints.size(), false),
      released_(model.constraints.size(), -std::numeric_limits<double>::infinity()) {}

ActiveSet ActiveSetRules::begin(double t, const Vector& q) {
  active_.clear();
  for (std::size_t i = 0; i < model_->constraints.size(); ++i) {
    const Schedule& schedule = model_->constraints[i].schedule;
    positive_[i] = !schedule.guard || sign_of(*schedule.guard, t, q, q.cwiseAbs()) > 0;
    if (positive_[i] && schedule.begin < t && t < schedule.end) active_.push_back(i);
  }
  return active_;
}

bool ActiveSetRules::in_interval(std::size_t i, double t) const {
  const Schedule& schedule = model_->constraints[i].schedule;
  return schedule.begin <= t && t < schedule.end;
}

double ActiveSetRules::next_instant(double t) const {
  double next = std::numeric_limits<double>::infinity();
  for (const Constraint& constraint : model_->constraints) {
    for (const double instant : {constraint.schedule.begin, constraint.schedule.end}) {
      if (instant > t) next = std::min(next, instant);
    }
  }
  return next;
}

std::vector<MonitoredGuard> ActiveSetRules::monitored(double t, const Vector& q, const Vector& v,
                                                      const Vector& sizes) {
  std::vector<MonitoredGuard> guards;
  for (std::size_t i = 0; i < positive_.size(); ++i) {
    const bool watch = model_->constraints[i].schedule.guard && in_interval(i, t);
    kept_[i] = watch && is_kept(i, t, q, v, sizes);
    if (watch && !kept_[i]) guards.push_back({i, positive_[i]});
  }
  return guards;
}

// Where a body has landed, or a rope is taut, the constraint itself keeps the motion on its guard's edge:
// dg/dt is 0 and, as a function of the velocities, a sum of the constraints' functions.
bool ActiveSetRules::is_kept(std::size_t i, double t, const Vector& q, const Vector& v, const Vector& sizes) {
  constexpr double small = 1e-9;
  if (active_.empty()) return false;
  const Guard& guard = *model_->constraints[i].schedule.guard;
  if (sign_of(guard, t, q, kept_[i] ? Vector(looseness_ * sizes) : sizes) != 0) return false;
  Vector rate;
  model_->equations->rate(q, v, rate);
  if (sign_of_rate(guard, t, q, rate, looseness_ * rate) != 0) return false;
  motion_.set_active(active_);
  motion_.evaluate_stage(t, q, v);
  const Matrix& gradient = motion_.gradient();
  const double at_rest = guard.rate(t, q, Vector::Zero(q.size()));
  Vector direction(v.size());
  for (Index j = 0; j < v.size(); ++j) {
    model_->equations->rate(q, Vector::Unit(v.size(), j), rate);
    direction[j] = guard.rate(t, q, rate) - at_rest;
  }
  // In the metric of M, which has no units.
  const Vector scale = motion_.terms().mass.diagonal().cwiseMax(DBL_MIN).cwiseSqrt().cwiseInverse();
  const Matrix rows = scale.asDiagonal() * gradient.transpose();
  const Vector wanted = scale.cwiseProduct(direction);
  const Vector rest = wanted - rows * rows.colPivHouseholderQr().solve(wanted);
  return rest.norm() <= small * wanted.norm();
}

ActiveSet ActiveSetRules::holding(double t) const {
  ActiveSet set;
  for (std::size_t i = 0; i < positive_.size(); ++i) {
    if (positive_[i] && in_interval(i, t)) set.push_back(i);
  }
  return set;
}

// On the edge the velocity says where the motion goes; where it says nothing, a short piece of the motion
// does. What stays on the edge stays as it was, and so does what comes back to it before the clock can tell.
void ActiveSetRules::see_sides(double t, const Vector& q, const Vector& v_before, const Vector& v,
                               const Vector& sizes, double ahead) {
  Vector rate;
  Vector rate_before;
  for (std::size_t i = 0; i < positive_.size(); ++i) {
    const Guard* const guard = model_->constraints[i].schedule.guard.get();
    if (guard == nullptr || !in_interval(i, t)) continue;
    if (is_kept(i, t, q, v, sizes)) continue;
    int sign = sign_of(*guard, t, q, kept_[i] ? Vector(looseness_ * sizes) : sizes);
    if (sign == 0) {
      model_->equations->rate(q, v, rate);
      model_->equations->rate(q, v_before, rate_before);
      sign = sign_of_rate(*guard, t, q, rate, rate_before);
    }
    if (sign == 0) sign = sign_ahead(i, t, q, v, sizes, ahead);
    const bool is_released = positive_[i] && sign < 0;
    if (is_released && released_[i] < t && t - released_[i] <= resolution(t)) continue;
    if (is_released) released_[i] = t;
    if (sign != 0) positive_[i] = sign > 0;
  }
}

int ActiveSetRules::sign_ahead(std::size_t i, double t, const Vector& q, const Vector& v, const Vector& sizes,
                               double ahead) {
  Node start{0, Vector(q.size() + v.size())};
  start.y << q, v;
  motion_.set_active(active_);
  MotionStep step(motion_);
  const Guard& guard = *model_->constraints[i].schedule.guard;
  for (const double part : {1e-3, 1e-2, 1e-1}) {
    try {
      const Node there = step.reach(t, start, part * ahead);
      const int sign = sign_of(guard, t + part * ahead, there.y.head(q.size()), sizes);
      if (sign != 0) return sign;
    } catch (const NumericalError&) {
      return 0;  // The motion need not come so far; if it does, it will say what is wrong there.
    }
  }
  return 0;
}

Switch ActiveSetRules::apply(const ActiveSet& next, double t, const Vector& q, const Vector& v) {
  Switch change;
  change.time = t;
  std::set_difference(next.begin(), next.end(), active_.begin(), active_.end(),
                      std::back_inserter(change.applied));
  std::set_difference(active_.begin(), active_.end(), next.begin(), next.end(),
                      std::back_inserter(change.released));
  change.active = next;
  change.q = q;
  change.v_before = v;
  Impulse impulse;
  impulse_.solve(next, t, q, v, impulse);
  change.v_after = impulse.velocity;
  change.impulse = impulse.impulse;
  change.multipliers = spread(*model_, next, impulse.multipliers);
  change.rank = impulse.rank;
  MotionTerms terms;
  const auto energies = [&](const Vector& velocity, double& energy, double& kinetic) {
    model_->equations->evaluate(t, q, velocity, terms);
    energy = velocity.dot(terms.momentum) - terms.lagrangian;
    kinetic = 0.5 * velocity.dot(terms.mass * velocity);
    if (!(std::isfinite(energy) && std::isfinite(kinetic))) throw NotFinite("the energy");
  };
  energies(change.v_before, change.energy_before, change.kinetic_energy_before);
  energies(change.v_after, change.energy_after, change.kinetic_energy_after);
  return change;
}

const ActiveSet& ActiveSetRules::switch_constraints(double t, const Vector& q, Vector& v, const Vector& sizes,
                                                    double ahead, std::vector<Switch>& impulses) {
  std::vector<ActiveSet> seen;
  Vector v_before = v;
  for (;;) {
    see_sides(t, q, v_before, v, sizes, ahead);
    const ActiveSet next = holding(t);
    if (next == active_) return active_;
    if (std::find(seen.begin(), seen.end(), next) != seen.end()) {
      const auto list = [this](const ActiveSet& set) { return set.empty() ? "none" : names(*model_, set); };
      throw LivelockError("the constraints that hold alternate endlessly between " + list(active_) + " and " +
                          list(next) + ", at " + describe(*model_, t, q));
    }
    seen.push_back(next);
    impulses.push_back(apply(next, t, q, v));
    active_ = next;
    v_before = v;
    v = impulses.back().v_after;
  }
}

}  // namespace hybrid_sphere::mechanics

#include "stiff_aware_integrator.hpp"

#include <cmath>
#include <stdexcept>
#include <utility>

namespace hybrid_sphere::solver {

StiffAwareIntegrator::StiffAwareIntegrator(std::unique_ptr<Integrator> explicit_method,
                                           std::unique_ptr<Integrator> implicit_method, bool for_drag)
    : explicit_(std::move(explicit_method)), implicit_(std::move(implicit_method)), for_drag_(for_drag) {}

double StiffAwareIntegrator::first_step(const Equations& equations, const State& y, double longest) {
  return explicit_->first_step(equations, y, longest);
}

void StiffAwareIntegrator::begin(const Equations& equations, Node& first, const State& scale,
                                 double first_step) {
  equations_ = &equations;
  stiff_ = false;
  allowed_ = true;
  held_ = 0;
  last_step_ = first_step;
  explicit_->begin(equations, first, scale, first_step);
}

// Within a few of its time constants drag has had its effect: a motion that still takes steps of that length
// hundreds of them later takes them for stability alone.
bool StiffAwareIntegrator::held_by_drag(const Node& from) const {
  constexpr double much = 100;
  constexpr double good_part = 0.5;
  const Dynamics& dynamics = equations_->dynamics();
  const double speed = equations_->instant(from.y).velocity.norm();
  const double drag =
      dynamics.translational_drag + dynamics.rotational_drag + dynamics.quadratic_drag * speed;
  const double others = std::sqrt(dynamics.spring_rate) + std::abs(equations_->turntable_rate());
  return drag > much * others && drag * from.step * equations_->pace(from.y) > good_part;
}

// A slip or a rolling velocity that neither dies nor grows turns to where its forces push it, in far less
// than the time in which anything else changes. Before it dies it takes fewer steps so.
bool StiffAwareIntegrator::held_by_friction(const Node& from) const {
  constexpr double good_part = 0.5;
  constexpr double nothing = 0x1p-8;
  if (!equations_->is_dry() || !(equations_->decays() * from.step > good_part)) return false;
  const Instant now = equations_->instant(from.y);
  if (equations_->dry_vectors() == 1) {
    const DryVector dry = equations_->dry_vector(0, from.y, now);
    return std::abs(dry.e.dot(dry.drive) - dry.decay) * from.step < nothing;
  }
  const double speed = now.velocity.norm();
  return equations_->pace(from.y) * from.step * (equations_->decays() + now.forcing.norm()) < nothing * speed;
}

Node StiffAwareIntegrator::step(Node& from, const State& scale) {
  if (stiff_) {
    try {
      Node to = implicit_->step(from, scale);
      to.implicit = true;
      last_error_ = implicit_->last_error();
      return to;
    } catch (const std::runtime_error&) {
      stiff_ = false;
      allowed_ = false;
      explicit_->begin(*equations_, from, scale, last_step_);
    }
  }
  Node to = explicit_->step(from, scale);
  last_error_ = explicit_->last_error();
  last_step_ = from.step;
  held_ = (for_drag_ && held_by_drag(from)) || held_by_friction(from) ? held_ + 1 : 0;
  constexpr int long_enough = 500;
  if (allowed_ && held_ >= long_enough) {
    stiff_ = true;
    implicit_->begin(*equations_, to, scale, implicit_->first_step(*equations_, to.y, from.step));
  }
  return to;
}

State StiffAwareIntegrator::interpolate(Node& from, const Node& to, double x) {
  return (to.implicit ? *implicit_ : *explicit_).interpolate(from, to, x);
}

}  // namespace hybrid_sphere::solver

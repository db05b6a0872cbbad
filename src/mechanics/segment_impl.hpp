#pragma once

#include <algorithm>
#include <cfloat>
#include <optional>
#include <vector>

#include "integration/arkode.hpp"
#include "mechanics/guard_search.hpp"
#include "mechanics/motion_scale.hpp"
#include "mechanics/segment.hpp"

namespace hybrid_sphere::mechanics {

inline Index guards_of(const Model& model) {
  return std::count_if(model.constraints.begin(), model.constraints.end(),
                       [](const Constraint& constraint) { return constraint.schedule.guard != nullptr; });
}

/// The implementation of SegmentIntegrator: segment_integrator.cpp takes the steps, segment_events.cpp checks
/// guards and constraints within a step.
struct SegmentIntegrator::Impl final : integration::Problem {
  Impl(const Model& model_, const StepDemand& demand_, const Vector& q_)
      : model(model_),
        demand(demand_),
        motion(model_),
        scale(model_, q_),
        state_size(model_.equations->coordinates() + model_.equations->velocities()),
        y(Vector::Zero(state_size + guards_of(model_))),
        allowed(Vector::Ones(y.size())),
        node_rate(Vector::Zero(state_size)),
        noise(node_rate),
        guard_sizes(Vector::Zero(y.size() - state_size)),
        arkode(y.size()),
        q(q_),
        v(model_.equations->velocities()) {}

  template <class Y>
  double take(double x, const Y& y) {
    q = y.head(q.size());
    v = y.segment(q.size(), v.size());
    return segment->start + offset + x;
  }

  void derivative(double x, const integration::ConstState& y, integration::State& rate) override {
    const double t = take(x, y);
    last_stage = y.head(state_size);
    motion.evaluate_stage(t, q, v);
    see_regularity(t);
    rate.head(q.size()) = motion.terms().rate;
    rate.segment(q.size(), v.size()) = motion.acceleration();
    if (!rate.head(state_size).allFinite()) throw NotFinite("the acceleration");
    for (Index i = 0; i < guard_sizes.size(); ++i) {
      rate[state_size + i] = i < monitored() ? guard(i).rate(t, q, motion.terms().rate) : 0;
    }
  }

  void see_regularity(double t) {
    if (motion.regularity() >= effort.regularity) return;
    effort.regularity = motion.regularity();
    effort.least_regular_time = t;
  }

  void finish_step(double x, integration::State& y) override {
    require_agreement(y.head(state_size));
    motion.project(take(x, y), q, v);
    y.head(q.size()) = q;
    y.segment(q.size(), v.size()) = v;
  }

  double max_step(const integration::ConstState& /*y*/) override { return demand.max_step; }

  // Each guard and its rate: where the rate changes sign, the guard has an extremum and may have changed sign
  // twice in a step. A function is never 0, which ARKODE does not tolerate at two points of one step: on the
  // boundary of a guard, a motion counts as still on its previous side. The roots only show where to look:
  // after many in one step, which are noise of a function, no more are reported to ARKODE.
  static constexpr std::size_t max_roots = 64;
  int roots() const override { return 2 * static_cast<int>(guards.size()); }
  void root_functions(double x, const integration::ConstState& y, double* values) override {
    if (roots_found.size() >= max_roots) {
      std::fill_n(values, roots(), 1.0);
      return;
    }
    const double t = take(x, y);
    model.equations->rate(q, v, q_rate);
    for (Index i = 0; i < monitored(); ++i) {
      const double rate = guard(i).rate(t, q, q_rate);
      *values++ = value_of(i, t);
      *values++ = rate != 0 ? rate : DBL_MIN;
    }
  }

  /// g at (t, q); never 0.
  double value_of(Index i, double t) const {
    const double value = guard(i).value(t, q);
    if (value != 0) return value;
    return guards[static_cast<std::size_t>(i)].positive ? DBL_MIN : -DBL_MIN;
  }

  Index monitored() const { return static_cast<Index>(guards.size()); }
  const Guard& guard(Index i) const { return guard_of(guards[static_cast<std::size_t>(i)]); }
  const Guard& guard_of(const MonitoredGuard& monitored) const {
    return *model.constraints[monitored.constraint].schedule.guard;
  }

  bool advance();
  void restart(double trial_step);
  void evaluate_at(const Node& node);
  void set_tolerances(const Node& node);
  void allow_rounding_of_coordinates(const Node& node);
  double first_step() const;
  Node attempt();
  void require_agreement(const Vector& reached) const;
  void require_progress(const Node& reached);
  void require_directions(const Node& from);
  Vector sizes_at(const Node& node);
  bool changed(const MonitoredGuard& monitored, const Node& node);
  double instant_of_change(const MonitoredGuard& monitored, const Node& from, double low, double high);
  std::vector<double> places_to_check(const Node& from, const Node& reached);
  void interpolate(const Node& from, double x);
  GuardSample sample_guard(Index guard, double x, const Vector& state);
  std::optional<Node> first_change(const Node& from, const Node& reached);

  const Model& model;
  StepDemand demand;
  ConstrainedMotion motion;
  MotionScale scale;
  Index state_size;    // N + n
  Vector y;            // q, v and the guards
  Vector allowed;      // errors of y in a step
  Vector node_rate;    // of q and v at the last node
  Vector noise;        // of them, in a step
  Vector guard_sizes;  // largest value, or change in a step, of each monitored guard
  integration::Arkode arkode;
  Segment* segment = nullptr;
  Node latest;  // reached
  std::vector<MonitoredGuard> guards;
  double end = 0;
  double offset = 0;  // x of ARKODE's origin
  double step = 0;    // length of the last step; 0: none yet in this motion
  int steps_without_progress = 0;
  bool beyond_arkode = false;  // the last step was not ARKODE's
  std::vector<double> roots_found;
  Vector q;
  Vector v;
  Vector q_rate;
  Vector interpolated;
  Vector last_stage;
  Matrix gradient;         // C at the last node
  Matrix gradient_before;  // and at the one before
  Effort effort;
};

}  // namespace hybrid_sphere::mechanics

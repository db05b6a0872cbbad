#include <algorithm>
#include <cfloat>
#include <cmath>
#include <optional>

#include "hybrid_sphere/numerical_error.hpp"
#include "interrupt/interrupt.hpp"
#include "mechanics/guards.hpp"
#include "mechanics/segment.hpp"
#include "mechanics/segment_impl.hpp"

namespace hybrid_sphere::mechanics {
namespace {

// A tolerance below the last figures, which rounding spoils, no step can hold.
constexpr double least_tolerance = 4e-15;
constexpr double roundings = 4 * DBL_EPSILON;

// Guards are integrated beside the motion, so that no step is too long for a polynomial to follow them: a
// sine is sampled about once in a radian.
constexpr double guard_tolerance = 1e-7;

constexpr double caution = 0.01;  // first step, in turning times

}  // namespace

SegmentIntegrator::SegmentIntegrator(const Model& model, const StepDemand& demand, const Vector& q)
    : impl_(std::make_unique<Impl>(model, demand, q)) {}

SegmentIntegrator::~SegmentIntegrator() = default;

double SegmentIntegrator::last_step() const { return impl_->step; }

Vector SegmentIntegrator::sizes(const Vector& q) const {
  return impl_->step == 0 ? q.cwiseAbs() : impl_->sizes_at(impl_->latest);
}

// The rounding of the instant counts by the way that the motion goes meanwhile.
Vector SegmentIntegrator::Impl::sizes_at(const Node& node) {
  q = node.y.head(q.size());
  v = node.y.tail(v.size());
  model.equations->rate(q, v, q_rate);
  return q.cwiseAbs().cwiseMax(scale.values().head(q.size())).cwiseMax(node.x * q_rate.cwiseAbs());
}

Effort SegmentIntegrator::effort() const {
  Effort effort = impl_->effort;
  effort.evaluations = impl_->motion.evaluations();
  return effort;
}

void SegmentIntegrator::begin(Segment& segment, std::vector<MonitoredGuard> guards, double end) {
  Impl& impl = *impl_;
  impl.segment = &segment;
  impl.guards = std::move(guards);
  impl.guard_sizes.setZero();
  impl.end = end;
  impl.latest = segment.nodes.back();
  impl.motion.set_active(segment.active);
  impl.evaluate_at(segment.nodes.back());
  impl.restart(impl.step);
}

void SegmentIntegrator::Impl::restart(double trial_step) {
  const Node& node = segment->nodes.back();
  offset = node.x;
  y.setZero();
  y.head(state_size) = node.y;
  arkode.begin(*this, y, std::min(trial_step, end - offset), end - offset);
}

// Cautious; what follows adapts itself.
double SegmentIntegrator::Impl::first_step() const {
  const Vector& a = motion.acceleration();
  const Matrix& mass = motion.terms().mass;
  const double acceleration = std::sqrt(std::max(0.0, a.dot(mass * a)));
  const double turning_time =
      acceleration > 0 ? std::sqrt(std::max(0.0, v.dot(mass * v))) / acceleration : demand.duration;
  const double shorter = std::min(turning_time > 0 ? turning_time : demand.duration, demand.duration);
  return std::min(caution * shorter, demand.max_step);
}

// Velocities that are off by a part of themselves put coordinates off by that part of the way: over many
// turning times by more than the size of the motion.
void SegmentIntegrator::Impl::evaluate_at(const Node& node) {
  const double now = segment->start + node.x;
  q = node.y.head(q.size());
  v = node.y.tail(v.size());
  motion.evaluate(now, q, v, step > 0 ? step : std::min(caution * demand.duration, demand.max_step));
  see_regularity(now);
  gradient_before = std::move(gradient);
  gradient = motion.gradient();
  if (step == 0) step = first_step();
  scale.see(motion, q, v, step);
  set_tolerances(node);
  allow_rounding_of_coordinates(node);
  arkode.set_tolerances(allowed);
}

void SegmentIntegrator::Impl::set_tolerances(const Node& node) {
  const double turns = scale.turning_time() > 0 ? demand.duration / scale.turning_time() : 0;
  const double part = std::min(1.0, step / demand.duration);
  const double least = least_tolerance / std::max(motion.regularity(), DBL_EPSILON);
  const double tolerance = std::max(demand.accuracy * part / (1 + turns), least);
  allowed.head(state_size) = (tolerance * scale.values()).cwiseMax(roundings * node.y.cwiseAbs());
  for (Index i = 0; i < monitored(); ++i) {
    const double now = segment->start + node.x;
    const double change = guard(i).rate(now, q, motion.terms().rate) * step;
    guard_sizes[i] = std::max({guard_sizes[i], std::abs(guard(i).value(now, q)), std::abs(change)});
    // What the integration gives for a guard is not used: its rounding does not matter.
    const double size =
        std::max(guard_sizes[i], rounding_of(guard(i), now, q, scale.values().head(q.size())));
    allowed[state_size + i] = size > 0 ? guard_tolerance * size : 1;
  }
}

// Coordinates that are larger than their changes bring their rounding into the forces: no step is short
// enough to be rid of it.
void SegmentIntegrator::Impl::allow_rounding_of_coordinates(const Node& node) {
  constexpr double large = 16;  // below, least_tolerance covers it
  const double now = segment->start + node.x;
  node_rate << motion.terms().rate, motion.acceleration();
  for (Index i = 0; i < q.size(); ++i) {
    if (!(std::abs(node.y[i]) > large * scale.values()[i])) continue;
    q[i] += roundings * std::abs(q[i]);
    try {
      motion.evaluate_stage(now, q, v);
      noise << motion.terms().rate, motion.acceleration();
      noise = step * (noise - node_rate).cwiseAbs();
      if (noise.allFinite()) allowed.head(state_size) = allowed.head(state_size).cwiseMax(noise);
    } catch (const NumericalError&) {
      // Beyond a limit that the motion itself need not cross.
    }
    q[i] = node.y[i];
  }
}

// One whole step. A function of the user may not be finite, or the equations not solvable, at a trial state
// that a shorter step does not reach.
Node SegmentIntegrator::Impl::attempt() {
  constexpr double negligible = 1e-6;  // of a step: too short for ARKODE, which needs some figures of it
  // At rest nothing but the step itself tells how long it should be: a guess that was far too long has made
  // the scale of motion too large, and with it the tolerances.
  constexpr double far = 0.25;
  const Node& from = segment->nodes.back();
  beyond_arkode = end - from.x <= negligible * step;
  if (beyond_arkode) return step_from(*segment, from, end, motion);
  for (double trial = step;;) {
    try {
      roots_found.clear();
      Node reached;
      for (;;) {
        const integration::Step taken = arkode.step(y);
        reached.x = offset + taken.x;
        if (taken.at_root) roots_found.push_back(reached.x);
        if (taken.complete) break;
        interruption_point();
      }
      reached.y = y.head(state_size);
      const double guess = step;
      step = arkode.last_step();
      if (!scale.has_moved() && step < far * guess) {
        evaluate_at(from);
        restart(step);
        continue;
      }
      if (end - reached.x <= 4 * DBL_EPSILON * end) reached.x = end;
      return reached;
    } catch (const integration::NoStep& error) {
      throw StepError(error.what());
    } catch (const NumericalError&) {
      trial *= 0.25;
      if (trial <= segment->resolution(from.x)) throw;
      restart(trial);
    }
  }
}

bool SegmentIntegrator::advance() {
  try {
    const bool changed = impl_->advance();
    impl_->latest = impl_->segment->nodes.back();
    return changed;
  } catch (const integration::NoStep& error) {
    throw StepError(error.what());
  }
}

bool SegmentIntegrator::Impl::advance() {
  std::vector<Node>& nodes = segment->nodes;
  const Node reached = attempt();
  ++effort.steps;
  require_progress(reached);
  std::optional<Node> change = first_change(nodes.back(), reached);
  const bool changes = change.has_value();
  nodes.push_back(changes ? *std::move(change) : reached);
  if (changes) return true;
  try {
    evaluate_at(reached);
  } catch (const NotFinite&) {
    nodes.pop_back();
    throw;
  }
  require_directions(*(nodes.end() - 2));
  return false;
}

// The last stage of a step is at its end, as the result is, and near it wherever the force is smooth. Where
// it is far off, stages have met another force, across a kink say, and the estimate of the error need not
// know of it.
void SegmentIntegrator::Impl::require_agreement(const Vector& reached) const {
  constexpr double far = 0.1;  // of the scale of motion
  if (((reached - last_stage).array().abs() > far * scale.values().array()).any()) {
    throw StepError("the stages of a step contradict each other");
  }
}

// Where forces or their derivatives have no bound, steps become shorter than the clock can tell.
void SegmentIntegrator::Impl::require_progress(const Node& reached) {
  constexpr int max_without = 100;
  const double before = segment->nodes.back().x;
  steps_without_progress = reached.x - before <= segment->resolution(before) ? steps_without_progress + 1 : 0;
  if (steps_without_progress == max_without)
    throw StepError("steps become shorter than the clock can resolve");
}

}  // namespace hybrid_sphere::mechanics

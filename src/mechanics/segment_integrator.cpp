#include <algorithm>
#include <cfloat>
#include <cmath>
#include <optional>
#include <utility>

#include "hybrid_sphere/numerical_error.hpp"
#include "interrupt/interrupt.hpp"
#include "mechanics/segment.hpp"
#include "mechanics/segment_impl.hpp"

namespace hybrid_sphere::mechanics {
namespace {

constexpr double caution = 0.01;  // first step, in turning times

const char* const singular_position =
    "the constraints move the state by more than the error of a step, however short it is: is this a "
    "singular "
    "position, at which they lose rank?";

// Order of the local error in the step length.
constexpr int explicit_order = 8;
constexpr int implicit_order = 7;

}  // namespace

SegmentIntegrator::SegmentIntegrator(const Model& model, const StepDemand& demand, const Vector& q)
    : impl_(std::make_unique<Impl>(model, demand, q)) {}

SegmentIntegrator::~SegmentIntegrator() = default;

double SegmentIntegrator::next_step() const { return impl_->step; }

SegmentIntegrator::Memory SegmentIntegrator::memory() const {
  return {impl_->scale, impl_->method.start ? impl_->method.explicit_step : impl_->step, impl_->errors.sum};
}

void SegmentIntegrator::restore(const Memory& memory, const Node& node) {
  impl_->scale = memory.scale;
  impl_->step = memory.step;
  impl_->method = {};
  impl_->latest = node;
  impl_->reached.reset();
  impl_->errors.sum = memory.errors;
  // The node may be within a step.
  const Vector& sizes = impl_->scale.values();
  const double more = std::max(0.0, node.error - memory.errors.value(sizes));
  for (Index i = 0; i < impl_->state_size; ++i) impl_->errors.sum.add(i, more * sizes[i]);
}

double SegmentIntegrator::estimated_error() const { return impl_->errors.sum.value(impl_->scale.values()); }

Vector SegmentIntegrator::position_scale() const {
  const Index coordinates = impl_->q.size();
  if (impl_->step == 0) return Vector::Zero(coordinates);
  return impl_->scale.values().head(coordinates);
}

Sizes SegmentIntegrator::sizes(double t, const Vector& q, const Vector& v) const {
  if (impl_->step == 0) {
    const double time = std::min(caution * impl_->demand.duration, impl_->demand.max_step);
    return sizes_at_start(impl_->model, t, q, v, time);
  }
  return {impl_->sizes_at(impl_->latest), Vector(impl_->scale.values().tail(v.size()))};
}

// The rounding of the instant counts by the way that the motion goes meanwhile.
Vector SegmentIntegrator::Impl::sizes_at(const Node& node) {
  q = node.y.head(q.size());
  v = node.y.tail(v.size());
  model.equations->rate(q, v, q_rate);
  return q.cwiseAbs().cwiseMax(scale.values().head(q.size())).cwiseMax(node.x * q_rate.cwiseAbs());
}

Effort SegmentIntegrator::effort() const { return {impl_->motion.effort(), impl_->steps}; }

void SegmentIntegrator::begin(Segment& segment, std::vector<MonitoredGuard> guards, double end) {
  Impl& impl = *impl_;
  impl.segment = &segment;
  impl.guards = std::move(guards);
  impl.guard_sizes.setZero(impl.monitored());
  impl.end = end;
  impl.passage_end = 0;
  const Node before = std::exchange(impl.latest, segment.nodes.back());
  impl.reached.reset();
  impl.motion.set_active(segment.active, segment.sliding);
  impl.redundancy.begin();
  impl.begin_explicitly();
  impl.evaluate_at(segment.nodes.back());
  impl.add_errors_of_switch(before);
}

// Cautious; what follows adapts itself.
double SegmentIntegrator::Impl::first_step() const {
  const Vector& a = motion.acceleration();
  const Matrix& mass = motion.terms().mass;
  const double acceleration = length(mass, a);
  const double turning_time = acceleration > 0 ? length(mass, v) / acceleration : demand.duration;
  const double shorter = std::min(turning_time > 0 ? turning_time : demand.duration, demand.duration);
  return std::min(caution * shorter, demand.max_step);
}

// Velocities that are off by a part of themselves put coordinates off by that part of the way: over many
// turning times by more than the size of the motion.
void SegmentIntegrator::Impl::evaluate_at(const Node& node) {
  const double now = segment->start + node.x;
  q = node.y.head(q.size());
  v = node.y.tail(v.size());
  motion.aim(now, q, v);
  motion.evaluate(now, q, v, step > 0 ? step : std::min(caution * demand.duration, demand.max_step));
  motion.require_finite_energy(v);
  const std::vector<Index> rows = motion.independent_rows();
  segment->nodes.back().rows =
      redundancy.see(now, static_cast<Index>(rows.size()), motion.gradient().rows(), rows);
  std::vector<const Guard*> functions;
  for (Index i = 0; i < positions(); ++i) functions.push_back(&guard(i));
  std::vector<MotionStep::Function> values;
  for (Index i = positions(); i < positions() + reactions(); ++i) {
    values.push_back([this, i] { return smooth_value(guards[static_cast<std::size_t>(i)]); });
  }
  motion_step.begin(segment->start, node, {std::move(functions), std::move(values)});
  gradient_before = std::move(gradient);
  gradient = motion.gradient();
  if (step == 0) step = first_step();
  scale.see(motion, q, v, std::min(step, demand.duration));
  motion.keep_rows(segment->nodes.back().rows);
  if (positions() > 0) set_rate_sizes();
  set_tolerances(node);
  allow_rounding_of_coordinates(node);
}

void SegmentIntegrator::Impl::set_rate_sizes() {
  rate_sizes = sizes_of_rate(model, q, scale.values().tail(v.size()));
}

/// A step to this x was too long, as across a kink of a force. The steps up to there may have a part of the
/// error that was allowed to it, or they would become the shorter the nearer they come to the kink. It is a
/// small part, as across a kink both methods may err alike.
void SegmentIntegrator::Impl::begin_passage(double to) {
  constexpr double part = 0.001;
  if (!scale.has_moved() || segment->nodes.back().x < passage_end) return;
  passage_end = to;
  passage_allowed = part * allowed;
}

void SegmentIntegrator::Impl::choose_next_step(double h, double error) {
  constexpr double safety = 0.9;
  constexpr double most = 5;  // the factor of two steps in a row
  const int order = method.start ? implicit_order : explicit_order;
  const double factor = error > 0 ? safety * std::pow(error, -1.0 / order) : most;
  const double next = h * std::clamp(factor, 1 / most, most);
  step = error <= 1 ? std::max(next, h < step ? step : 0) : next;
  if (error <= 1) step = std::min(step, longest_by_slips(h, &SlidingFriction::Speed::now));
}

/// At rest the speed to which a step leads is the scale of its errors, where the method converges.
void SegmentIntegrator::Impl::expect_speed(const Node& from, const Node& to, double h) {
  constexpr double poor = 0.01;
  const auto speed_of = [this](const Vector& state) {
    return length(motion.terms().mass, state.segment(q.size(), v.size()));
  };
  const double speed = speed_of(to.y);
  motion_step.difference(difference);
  Vector of_last_stage(state_size);
  for (Index i = 0; i < state_size; ++i) of_last_stage[i] = motion_step.difference_of_last_stage(i);
  const double apart = std::max(speed_of(difference), speed_of(of_last_stage));
  if (!(std::isfinite(speed) && apart <= poor * speed)) return;
  scale.expect(motion, q, speed, h);
  set_tolerances_of_state(from);
  set_tolerances_of_positions(from);
  set_tolerances_of_reactions();
}

// One whole step. A function of the user may not be finite, or the equations not solvable, at a trial state
// that a shorter step does not reach.
Node SegmentIntegrator::Impl::attempt() {
  // At rest nothing but the step itself tells how long it should be: a guess that was far too long has made
  // the scale of motion too large, and with it the tolerances.
  constexpr double far = 0.25;
  constexpr double nearly = 1e-3;
  // A regular motion is hardly ever refused by its projection. Near a singular position one in ten steps is,
  // while they get shorter.
  constexpr double refusals_forgotten = 0.02;  // with each step that is not
  constexpr double max_refusals = 100;
  const Node& from = segment->nodes.back();
  double guess = step;
  for (;;) {
    interruption_point();
    const double left = end - from.x;
    const double longest = std::min(step, demand.max_step);
    const double h = longest < (1 - nearly) * left ? longest : left;
    leave_implicit(h);
    try {
      Node reached = motion_step.take(h);
      if (is_too_long_for_slips(h)) continue;
      if (!scale.has_moved()) expect_speed(from, reached, h);
      require_agreement();
      const double projection = projection_of_step();
      const double error = std::max(error_of_step(), projection);
      if (!(error <= std::numeric_limits<double>::max())) throw StepError("the state is not finite");
      if (error > 1) begin_passage(from.x + h);
      choose_next_step(h, error);
      refusals = std::max(0.0, refusals + (projection > 1 ? 1 : -refusals_forgotten));
      const bool is_shortest = h <= segment->resolution(from.x) || refusals >= max_refusals;
      if (error > 1 && !is_shortest) continue;
      if (projection > 1) throw StepError(singular_position);
      if (error > 1 && !is_jump_at_resolution(h)) {
        throw StepError("the error is too large however short the step");
      }
      if (!scale.has_moved() && step < far * guess) {
        guess = step;
        evaluate_at(from);
        continue;
      }
      if (h == left) reached.x = end;
      return reached;
    } catch (const NumericalError&) {
      if (h <= segment->resolution(from.x) || refusals >= max_refusals) throw;
      if (method.start && renew_implicit()) continue;
      begin_passage(from.x + h);
      step = 0.25 * h;
    }
  }
}

const std::vector<MonitoredGuard>& SegmentIntegrator::passed() const { return impl_->passed; }

bool SegmentIntegrator::advance() {
  const bool changed = impl_->advance();
  impl_->latest = impl_->segment->nodes.back();
  return changed;
}

bool SegmentIntegrator::Impl::advance() {
  std::vector<Node>& nodes = segment->nodes;
  // An interruption while guards are looked for leaves the step as it is.
  if (!reached) {
    reached = attempt();
    see_stability(reached->x - nodes.back().x);
    ++steps;
    add_errors_of_step(*reached);
  }
  const double attempted = reached->x - nodes.back().x;
  std::optional<Node> change = first_change(nodes.back(), *reached);
  Node end_of_step = *std::exchange(reached, std::nullopt);
  const bool changes = change.has_value();
  nodes.push_back(changes ? *std::move(change) : std::move(end_of_step));
  const double h = nodes.back().x - (nodes.end() - 2)->x;
  require_progress(attempted, h);
  if (changes) {
    pass_time(h);
    return true;
  }
  const bool slip_began = motion.friction().begins();
  try {
    evaluate_at(nodes.back());
  } catch (const NotFinite&) {
    nodes.pop_back();
    throw;
  }
  pass_time(h);
  const bool has_direction = slip_began && !motion.friction().begins();
  require_directions(*(nodes.end() - 2));
  // A slow slip turns fast into the direction in which it is pushed.
  if (has_direction && !method.start) {
    take_up_implicit();
  } else {
    choose_method();
  }
  return false;
}

// The last stage of a step is at its end, as the result is, and near it wherever the force is smooth. Where
// it is far off, stages have met another force, across a kink say, and the estimate of the error need not
// know of it.
void SegmentIntegrator::Impl::require_agreement() const {
  constexpr double far = 0.1;  // of the scale of motion
  for (Index i = 0; i < state_size; ++i) {
    const double most = std::max(far * scale.values()[i], allowed[i]);
    if (std::abs(motion_step.difference_of_last_stage(i)) > most) {
      throw StepError("the stages of a step contradict each other");
    }
  }
}

// Steps become shorter than the resolution of the clock if forces or their derivatives have no bound, or if
// something changes at one instant again and again. If a force jumps as often as it is crossed, as dry
// friction does at rest, steps are not much longer than that.
void SegmentIntegrator::Impl::require_progress(double attempted, double passed) {
  constexpr int max_without = 100;
  constexpr int max_short = 3000;
  constexpr double hardly_longer = 1000;
  const double least = segment->resolution(segment->nodes.back().x);
  steps_without_progress = passed <= least ? steps_without_progress + 1 : 0;
  short_steps = attempted <= hardly_longer * least ? short_steps + 1 : 0;
  if (steps_without_progress == max_without)
    throw StepError("steps become shorter than the clock can resolve");
  if (short_steps < max_short) return;
  throw StepError(is_at_rest() ? "at rest a force jumps with the velocity, as dry friction -mu sign(v) does"
                               : "steps of the clock's resolution get no further: a force jumps to and fro");
}

/// Whether hardly anything is left of the greatest speed of the motion.
bool SegmentIntegrator::Impl::is_at_rest() const {
  constexpr double hardly = 1e-6;
  return length(motion.terms().mass, v) <= hardly * scale.speed();
}

}  // namespace hybrid_sphere::mechanics

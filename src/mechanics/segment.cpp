#include "mechanics/segment.hpp"

#include <algorithm>
#include <cfloat>
#include <cmath>

#include "hybrid_sphere/numerical_error.hpp"
#include "mechanics/guards.hpp"

namespace hybrid_sphere::mechanics {
namespace {

/// The contacts whose gaps are negative beyond the error of the motion.
ActiveSet penetrating(const Model& model, double t, const Vector& q, double error, const Vector& sizes) {
  ActiveSet set;
  for (std::size_t i = 0; i < model.constraints.size(); ++i) {
    const Schedule& schedule = model.constraints[i].schedule;
    if (!model.constraints[i].unilateral || !(schedule.begin <= t && t < schedule.end)) continue;
    const double overlap = schedule.guard->value(t, q);
    if (!(overlap > 0)) continue;
    const double allowed =
        error * gap_size(*schedule.guard, t, q, sizes) + rounding_of(*schedule.guard, t, q, sizes);
    if (overlap > allowed) set.push_back(i);
  }
  return set;
}

}  // namespace

double Segment::resolution(double x) const { return 16 * DBL_EPSILON * std::max(std::abs(start + x), x); }

Node state_at(const Segment& segment, double x, MotionStep& motion) {
  const auto later = [](double at, const Node& node) { return at < node.x; };
  const auto next = std::upper_bound(segment.nodes.begin(), segment.nodes.end(), x, later);
  const Node& before = next == segment.nodes.begin() ? *next : *(next - 1);
  try {
    Node node = motion.reach(segment.start, before, x);
    node.error = (x > before.x && next != segment.nodes.end() ? *next : before).error;
    return node;
  } catch (const NumericalError&) {
    if (next != segment.nodes.end() && next->x - x <= segment.resolution(x)) return *next;
    throw;
  }
}

State state_of(const Model& model, const Segment& segment, double time, const Status& status,
               const Precision& precision) {
  const double x = std::min(time - segment.start, segment.duration());
  ConstrainedMotion motion(model);
  motion.set_active(segment.active, segment.sliding);
  MotionStep step(motion);
  const Node node = state_at(segment, x, step);
  State state;
  state.time = time;
  state.q = node.y.head(model.equations->coordinates());
  state.v = node.y.tail(model.equations->velocities());
  state.stage = segment.active.empty() ? 1 : 3;
  state.active = segment.active;
  state.multipliers = Vector::Zero(model.multipliers());
  const bool is_end = time >= status.time;
  try {
    motion.keep_rows(nullptr);  // the multipliers are of all of them
    motion.aim(time, state.q, state.v);
    motion.evaluate_stage(time, state.q, state.v);
    const bool refused = status.stop == Stop::inconsistent && is_end;
    if (!refused) state.multipliers = motion.multipliers();
  } catch (const ConstraintError&) {
    if (!is_end) throw;
    // The end of a motion that cannot go on: everything else is known.
  }
  state.sliding = motion.friction().sliding();
  motion.require_finite_energy(state.v);
  state.energy = motion.energy(state.v);
  state.kinetic_energy = motion.kinetic_energy(state.v);
  state.residual = motion.residual();
  state.estimated_error = node.error;
  state.penetrating = penetrating(model, time, state.q, std::max(precision.accuracy, node.error),
                                  state.q.cwiseAbs().cwiseMax(precision.scale));
  return state;
}

}  // namespace hybrid_sphere::mechanics

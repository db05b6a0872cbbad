// The errors of steps and switches that add up to the estimated error of a motion.
#include <algorithm>
#include <cfloat>
#include <cmath>

#include "mechanics/segment_impl.hpp"

namespace hybrid_sphere::mechanics {

/// To be called once for each step that is taken. Its local error is that of the embedded method, or the
/// distance by which the projection moves its end, if that is larger. Its round-off, which no accuracy can
/// undercut, is that of the state, of the accelerations, by the regularity, and of forces that cancel.
/// @param end  of the step
void SegmentIntegrator::Impl::add_errors_of_step(const Node& end) {
  const bool is_projected = motion_step.slips_across().empty();  // otherwise friction takes slips away
  const double roundoff =
      DBL_EPSILON / std::max(motion.regularity(), DBL_EPSILON) + (method.start ? 0 : errors.force_roundoff);
  const Vector& sizes = scale.values();
  for (Index i = 0; i < state_size; ++i) {
    const double by_projection = is_projected ? std::abs(motion_step.projection(i)) : 0;
    const double local = std::max(errors.gain * std::abs(difference[i]), by_projection);
    errors.sum.add(i, local + DBL_EPSILON * std::abs(end.y[i]) + roundoff * sizes[i]);
  }
}

/// Earlier errors grow while the velocity turns.
void SegmentIntegrator::Impl::pass_time(double h) {
  const double turning_time = scale.present_turning_time();
  if (turning_time > 0) errors.sum.pass(h / turning_time, scale.values());
  segment->nodes.back().error = errors.sum.value(scale.values());
}

/// The instant of a switch is rounded: positions are off by the jump of their rates in that time. To be
/// called after the motion has been evaluated at the first node of the segment.
/// @param before  the last node of the segment before; of no size: there is none
void SegmentIntegrator::Impl::add_errors_of_switch(const Node& before) {
  if (before.y.size() == 0) return;
  const Vector jump = v - before.y.segment(q.size(), v.size());
  const Vector& sizes = scale.values();
  if (scale.has_moved()) errors.sum.pass(length(motion.terms().mass, jump) / scale.speed(), sizes);
  model.equations->rate(q, jump, q_rate);
  const double clock = 2 * DBL_EPSILON * std::abs(segment->start);
  for (Index i = 0; i < q.size(); ++i) errors.sum.add(i, clock * std::abs(q_rate[i]));
  const double roundoff = DBL_EPSILON / std::max(motion.regularity(), DBL_EPSILON);
  for (Index i = q.size(); i < state_size; ++i) errors.sum.add(i, roundoff * sizes[i]);
  segment->nodes.back().error = errors.sum.value(sizes);
}

}  // namespace hybrid_sphere::mechanics

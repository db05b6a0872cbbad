// Tolerances of the state and the guards in a step, and the error and projection of a step relative to them.
#include <algorithm>
#include <cfloat>
#include <cmath>
#include <random>

#include "hybrid_sphere/numerical_error.hpp"
#include "mechanics/guards.hpp"
#include "mechanics/segment_impl.hpp"

namespace hybrid_sphere::mechanics {
namespace {

// Tolerances are never below the round-off of the state. An accuracy that leads below it in long motions gets
// this part of itself, within the limits, so that the default accuracy does not pay for it. A fast damper
// multiplies round-off, so that the lower limit would shorten steps in vain.
constexpr double least_tolerance = 1e-15;
constexpr double greatest_least_tolerance = 4e-15;
constexpr double least_part = 4e-6;
constexpr double node_roundoff = 4 * DBL_EPSILON;

// Guards are integrated beside the motion, so that no step is too long for a polynomial to follow them: a
// sine is sampled about once in a radian.
constexpr double guard_tolerance = 1e-7;

// Fraction of the requested error: motions multiply their errors, and those of several velocities add up.
constexpr double margin = 0.25;

// The error of a step is less than what the embedded method differs by this power of the difference.
constexpr double explicit_gain = 1.0 / 8;
constexpr double implicit_gain = 1.0 / 3;

}  // namespace

void SegmentIntegrator::Impl::set_tolerances_of_state(const Node& node) {
  const double turns = scale.turning_time() > 0 ? demand.duration / scale.turning_time() : 0;
  const double part = std::min(1.0, step / demand.duration);
  const double part_of_accuracy =
      method.start || method.is_damped ? greatest_least_tolerance : least_part * demand.accuracy;
  const double least = std::clamp(part_of_accuracy, least_tolerance, greatest_least_tolerance) /
                       std::max(motion.regularity(), DBL_EPSILON);
  allowed.head(state_size) = (std::max(margin * demand.accuracy * part / (1 + turns), least) * scale.values())
                                 .cwiseMax(node_roundoff * node.y.cwiseAbs());
  if (method.start && motion.friction().turns()) allow_errors_that_are_forgotten();
  allow_rounding_of_forces();
}

/// Friction turns a slow slip back into its direction at once, so that errors of it do not last; the implicit
/// steps that follow this get longer from one to the next, so that there are some tens of them.
void SegmentIntegrator::Impl::allow_errors_that_are_forgotten() {
  constexpr double part = 1e-4;       // of the error of the motion
  constexpr double rounding = 1e-13;  // of the scale, in such a step
  auto of_velocities = allowed.segment(q.size(), v.size());
  of_velocities =
      of_velocities.cwiseMax(std::max(part * demand.accuracy, rounding) * scale.values().tail(v.size()));
}

/// Of a motion that has hardly begun, the rounding of forces that cancel may be all that there is.
/// Constraints spread it over all velocities.
void SegmentIntegrator::Impl::allow_rounding_of_forces() {
  constexpr double little = 0.01;
  const double rounding = step * motion.acceleration_rounding();
  errors.force_roundoff = scale.speed() > 0 ? rounding / scale.speed() : 0;
  const Vector& scales = scale.values();
  const auto relative = allowed.segment(q.size(), v.size()).array() / scales.tail(v.size()).array();
  if (rounding <= little * relative.minCoeff() * scale.speed()) return;
  Vector speeds(v.size());
  for (Index i = 0; i < v.size(); ++i) {
    const double mass = motion.terms().mass(i, i);
    speeds[i] = rounding * std::max(motion.mobility(i), mass > 0 ? 1 / std::sqrt(mass) : 0);
  }
  Vector rates;
  model.equations->rate(q, speeds, rates);
  allowed.head(q.size()) = allowed.head(q.size()).cwiseMax(step * rates.cwiseAbs());
  allowed.segment(q.size(), v.size()) = allowed.segment(q.size(), v.size()).cwiseMax(speeds);
}

void SegmentIntegrator::Impl::set_tolerances(const Node& node) {
  allowed.resize(state_size + monitored());
  set_tolerances_of_state(node);
  for (Index i = 0; i < positions(); ++i) {
    const double now = segment->start + node.x;
    const double change = guard(i).rate(now, q, motion.terms().rate) * step;
    guard_sizes[i] = std::max({guard_sizes[i], std::abs(guard(i).value(now, q)), std::abs(change)});
  }
  set_tolerances_of_positions(node);
  for (Index i = positions(); i < monitored(); ++i) {
    guard_sizes[i] = std::max(guard_sizes[i], std::abs(smooth_value(guards[static_cast<std::size_t>(i)])));
  }
  set_tolerances_of_reactions();
  if (node.x < passage_end) allowed = allowed.cwiseMax(passage_allowed);
}

/// The integrated value of a guard is not used, so that its round-off does not matter.
void SegmentIntegrator::Impl::set_tolerances_of_positions(const Node& node) {
  const double now = segment->start + node.x;
  const Vector place = node.y.head(q.size());
  const Vector sizes = scale.values().head(q.size());
  for (Index i = 0; i < positions(); ++i) {
    double size = std::max(guard_sizes[i], rounding_of(guard(i), now, place, sizes));
    // A gap that opens has no size of its own yet.
    if (is_gap(i)) size = std::max(size, gap_size(guard(i), now, place, sizes));
    allowed[state_size + i] = size > 0 ? guard_tolerance * size : 1;
  }
}

// Coordinates that are larger than their changes bring their rounding into the forces: no step is short
// enough to be rid of it. Most motions are far from this limit: one state with all coordinates rounded shows
// it.
void SegmentIntegrator::Impl::allow_rounding_of_coordinates(const Node& node) {
  constexpr double large = 16;  // below, least_tolerance covers it
  node_rate << motion.terms().rate, motion.acceleration();
  projection_roundoff.setZero(state_size);
  large_coordinates.clear();
  for (Index i = 0; i < q.size(); ++i) {
    if (std::abs(node.y[i]) > large * scale.values()[i]) large_coordinates.push_back(i);
  }
  if (large_coordinates.empty() || is_roundoff_of_coordinates_negligible(node)) return;
  for (const Index i : large_coordinates) {
    q[i] += node_roundoff * std::abs(q[i]);
    if (see_roundoff_of_coordinates(node)) {
      allowed.head(state_size) = allowed.head(state_size).cwiseMax(noise);
      if (projection_noise.allFinite()) projection_roundoff = projection_roundoff.cwiseMax(projection_noise);
    }
    q[i] = node.y[i];
  }
}

/// Returns true if the round-off of all large coordinates together, with signs without a pattern, changes a
/// step by a small part of its tolerances, and its projection by a small part of projection_of_step()'s
/// bound. The parts of single coordinates might cancel in one number of the state, but not in all of them.
bool SegmentIntegrator::Impl::is_roundoff_of_coordinates_negligible(const Node& node) {
  constexpr double part = 1e-3;
  constexpr double part_of_projection = 4;  // of max_projection = 100
  std::minstd_rand signs;                   // the same ones at every node
  for (const Index i : large_coordinates) {
    q[i] += (signs() % 2 == 0 ? node_roundoff : -node_roundoff) * std::abs(q[i]);
  }
  const auto of_state = allowed.head(state_size).array();
  const bool is_negligible = see_roundoff_of_coordinates(node) && (noise.array() <= part * of_state).all() &&
                             (projection_noise.array() <= part_of_projection * of_state).all();
  for (const Index i : large_coordinates) q[i] = node.y[i];
  return is_negligible;
}

/// Sets the noise of a step from a node, and that of its projection, by the coordinates' round-off, which q
/// has.
/// @return  false beyond a limit that the motion itself need not cross
bool SegmentIntegrator::Impl::see_roundoff_of_coordinates(const Node& node) {
  const double now = segment->start + node.x;
  try {
    motion.evaluate_stage(now, q, v);
    noise << motion.terms().rate, motion.acceleration();
    noise = step * (noise - node_rate).cwiseAbs();
    Vector place = q;
    Vector velocity = node.y.segment(q.size(), v.size());
    motion.project(now, place, velocity);
    projection_noise << (place - q).cwiseAbs(), (velocity - node.y.segment(q.size(), v.size())).cwiseAbs();
    return noise.allFinite();
  } catch (const NumericalError&) {
    return false;
  }
}

/// The error of the last step in units of that allowed. The difference is the error of the embedded method;
/// that of the method is the less the better both converge.
double SegmentIntegrator::Impl::error_of_step() {
  constexpr double poor = 1e-4;  // a difference at which neither converges
  motion_step.difference(difference);
  const auto of_state = difference.head(state_size).array().abs();
  const double relative = (of_state / scale.values().array()).maxCoeff();
  const bool converges = segment->nodes.back().x >= passage_end;
  const double gain = method.start ? implicit_gain : explicit_gain;
  const double better = converges ? std::min(1.0, std::pow(relative / poor, gain)) : 1;
  errors.gain = better;
  double error = better * (of_state / allowed.head(state_size).array()).maxCoeff();
  error = std::max(error, error_of_directions());
  if (monitored() == 0) return error;
  return std::max(error, (difference.array().abs() / allowed.array()).tail(monitored()).maxCoeff());
}

/// Whether a step as short as the clock's resolution has a small error all the same, as where a force jumps:
/// the instant of the jump is not known any better.
bool SegmentIntegrator::Impl::is_jump_at_resolution(double h) const {
  constexpr double least = 1e-12;  // of the scale of motion; the accuracy may be smaller
  if (h > segment->resolution(segment->nodes.back().x)) return false;
  const auto of_state = difference.head(state_size).array().abs();
  return (of_state / scale.values().array()).maxCoeff() <= std::max(demand.accuracy, least);
}

/// The error of a step in which slips begin, by their parts across the direction that the step gives to them.
/// Such a slip is of no size as yet: what counts as small is the speed that the forces give to the motion.
double SegmentIntegrator::Impl::error_of_directions() {
  constexpr double share = 0.01;  // of the duration: the time that forces have
  if (motion_step.slips_across().empty()) return 0;
  const Node& from = segment->nodes.back();
  const Vector place = from.y.head(q.size());
  const Vector velocity = from.y.segment(q.size(), v.size());
  const double time = std::min(share * demand.duration, demand.max_step);
  const Vector speeds = sizes_at_start(model, segment->start + from.x, place, velocity, time).v;
  constexpr double part = 0.1;  // of the error of the motion
  Vector most = (demand.accuracy * speeds).cwiseMax(allowed.segment(q.size(), v.size()));
  if (scale.has_moved()) most = most.cwiseMax(part * demand.accuracy * scale.values().tail(v.size()));
  double error = 0;
  for (const SlidingFriction::Across& across : motion_step.slips_across()) {
    error = std::max(error, std::abs(across.slip) / across.gradient.cwiseAbs().dot(most));
  }
  return error;
}

/// What the projection onto the constraints has moved the end of the last step by, in units of what it may. A
/// projection removes the part of a step's error that leaves the constraints. Where these lose rank it would
/// move the state by more, and take energy from the motion.
double SegmentIntegrator::Impl::projection_of_step() const {
  constexpr double max_projection = 100;  // errors of a step, which constraints spread over all velocities
  if (!motion_step.slips_across().empty()) return 0;  // error_of_directions() bounds what has been removed
  const double least = greatest_least_tolerance / std::max(motion.regularity(), DBL_EPSILON);
  double largest = 0;
  for (Index i = 0; i < state_size; ++i) {
    const double roundoff = std::max(least * scale.values()[i], projection_roundoff[i]);
    const double most = max_projection * std::max(allowed[i], roundoff);
    largest = std::max(largest, std::abs(motion_step.projection(i)) / most);
  }
  return largest;
}

/// Integrals of reactions, limits and slips shorten steps that are too long for a polynomial to follow them:
/// by a part of the whole duration, so that a force that jumps is passed, and not for round-off.
void SegmentIntegrator::Impl::set_tolerances_of_reactions() {
  for (Index i = positions(); i < monitored(); ++i) {
    const MonitoredGuard& monitored = guards[static_cast<std::size_t>(i)];
    const double size = std::max(guard_sizes[i], size_of_terms(monitored));
    const double error = std::max(guard_tolerance * size, size_of(monitored));
    allowed[state_size + i] = error > 0 ? error * demand.duration : 1;
  }
}

}  // namespace hybrid_sphere::mechanics

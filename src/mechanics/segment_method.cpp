// The method of the steps: explicit, or implicit where a fast damper keeps explicit ones short.
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

#include "hybrid_sphere/numerical_error.hpp"
#include "mechanics/segment_impl.hpp"

namespace hybrid_sphere::mechanics {
namespace {

// An explicit step of length h follows a decay of some rate stably while h rate < 5.17; its estimate of the
// error holds it at 3.3, or a little below, where rounding is all that is left of the decay. Well below, its
// stages, which are of lower orders, may cost it its accuracy, where the steps show for a longer time that
// they get no longer.
constexpr double unstable = 2.5;
constexpr double inaccurate = 0.5;
constexpr double surely_explicit = 0.25;
constexpr int long_enough = 100;  // steps in a row, of which
constexpr int count_of_unstable = 7;

}  // namespace

/// A segment begins with explicit steps: they follow what a fast damper does after a switch.
void SegmentIntegrator::Impl::begin_explicitly() {
  if (method.start) step = method.explicit_step;
  method = {};
  scale.expect_short_steps();
  segment->nodes.back().implicit = nullptr;
}

/// To be called after each step, of length h. Steps that show no rate neither count nor end a row.
void SegmentIntegrator::Impl::see_stability(double h) {
  constexpr double faster = 100;  // than the motion
  if (method.start) return;
  const double rate = motion_step.fast_rate(scale.values());
  if (rate == 0) return;
  method.is_damped = rate * scale.present_turning_time() > faster;
  if (h * rate <= inaccurate || !method.is_damped) {
    method.held = 0;
  } else {
    method.held += h * rate > unstable ? count_of_unstable : 1;
  }
}

/// Chooses the method of the steps from the last node, at which the motion has been evaluated.
void SegmentIntegrator::Impl::choose_method() {
  constexpr double fast = 1e-3;
  if (method.start) {
    const bool may_stay = motion_step.contraction() <= fast && !motion.friction().turns();
    if (may_stay) {
      set_implicit(method.start);
    } else if (!renew_implicit()) {
      set_implicit(nullptr);
    }
  } else if (method.held >= long_enough) {
    method.held = 0;
    take_up_implicit();
  }
}

void SegmentIntegrator::Impl::take_up_implicit() {
  const double explicit_step = step;
  if (!renew_implicit()) return;
  if (!method.start->decays) return set_implicit(nullptr);
  method.explicit_step = explicit_step;
  // What the damper did at first is over.
  scale.forget_accelerations();
  evaluate_at(segment->nodes.back());
}

void SegmentIntegrator::Impl::set_implicit(std::shared_ptr<const ImplicitStart> start) {
  if (!start) {
    method = {};
    scale.expect_short_steps();
  }
  method.start = start;
  segment->nodes.back().implicit = start;
  motion_step.use(std::move(start));
}

/// Linearizes the motion at the last node. @return  whether that is possible and has not been done before
bool SegmentIntegrator::Impl::renew_implicit() {
  const double x = segment->nodes.back().x;
  if (method.start && method.linearized == x) return false;
  try {
    set_implicit(
        std::make_shared<const ImplicitStart>(motion_step.linearize(scale.values()), scale.values()));
  } catch (const NumericalError&) {
    return false;  // beyond a limit that the motion itself need not cross
  }
  method.linearized = x;
  return true;
}

/// The rate at which friction turns a slip goes with the inverse of its speed. Of an implicit step Newton's
/// iterations, with the rate where it starts, converge while the speed changes by a factor of some. An
/// explicit one, at the end of which the slip is much slower, makes a part across it of rounding.
/// @param h      length of the last step [s]
/// @param where  of it the next step starts
/// @return  the length of that step, by the change of the speeds in the last one [s]
double SegmentIntegrator::Impl::longest_by_slips(double h, double SlidingFriction::Speed::*where) const {
  constexpr double gained = 2;
  constexpr double nearly_ended = 1000;
  const bool is_implicit = method.start != nullptr;
  const double lost = is_implicit ? 0.5 : 1 - 1 / nearly_ended;
  double longest = std::numeric_limits<double>::infinity();
  for (const SlidingFriction::Speed& speed : motion_step.slip_speeds()) {
    const double rate = (speed.forward - speed.at_start) / h;
    const bool may_end = speed.*where <= nearly_ended * slowest_slip(speed.constraint);
    if (rate == 0 || (!is_implicit && (rate > 0 || may_end))) continue;
    longest = std::min(longest, (rate < 0 ? lost : gained) * speed.*where / std::abs(rate));
  }
  return std::max(longest, segment->resolution(segment->nodes.back().x));
}

/// The friction of a step is that of a slip which keeps to its direction at the start, or turns it about: one
/// that turns across it may be faster than 0 all the time.
void SegmentIntegrator::Impl::require_small_turns() const {
  constexpr double cosine = 0.5;
  for (const SlidingFriction::Speed& speed : motion_step.slip_speeds()) {
    if (std::abs(speed.forward) >= cosine * speed.now) continue;
    if (speed.now > slowest_slip(speed.constraint) / cosine)
      throw StepError("a slip turns too far in a step");
  }
}

/// Shortens the step where the last one, of length h, was too long for a slip.
bool SegmentIntegrator::Impl::is_too_long_for_slips(double h) {
  if (h <= segment->resolution(segment->nodes.back().x)) return false;
  require_small_turns();
  const double much = method.start ? 1.5 : 1.0009;  // a slip keeps a quarter, or 1e-4, of its speed
  const double longest = longest_by_slips(h, &SlidingFriction::Speed::at_start);
  if (h <= much * longest) return false;
  step = longest;
  return true;
}

/// Where a step of this length is stable with the explicit method, too, or too short for the clock.
void SegmentIntegrator::Impl::leave_implicit(double h) {
  if (!method.start) return;
  if (h * method.start->fastest_rate <= surely_explicit) return set_implicit(nullptr);
  if (h > segment->resolution(segment->nodes.back().x)) return;
  step = method.explicit_step;
  set_implicit(nullptr);
}

}  // namespace hybrid_sphere::mechanics

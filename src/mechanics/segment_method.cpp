// The method of the steps: explicit, or implicit where a fast damper keeps explicit ones short.
#include <memory>
#include <utility>

#include "hybrid_sphere/numerical_error.hpp"
#include "mechanics/segment_impl.hpp"

namespace hybrid_sphere::mechanics {
namespace {

// An explicit step of length h follows a decay of some rate stably while h rate < 5.17; its estimate of the
// error holds it at 3.3, or a little below, where rounding is all that is left of the decay.
constexpr double held_short = 2.5;
constexpr double surely_stable = 1;

}  // namespace

/// A segment begins with explicit steps: they follow what a fast damper does after a switch.
void SegmentIntegrator::Impl::begin_explicitly() {
  if (method.start) step = method.explicit_step;
  method = {};
  segment->nodes.back().implicit = nullptr;
}

/// To be called after each step. Steps that show no rate neither count nor end a row.
void SegmentIntegrator::Impl::see_stability() {
  if (method.start) return;
  const double turns = motion_step.fast_turns(scale.values());
  if (turns > held_short) {
    ++method.held;
  } else if (turns > 0) {
    method.held = 0;
  }
}

/// Chooses the method of the steps from the last node, at which the motion has been evaluated.
void SegmentIntegrator::Impl::choose_method() {
  constexpr int long_enough = 15;
  constexpr double fast = 1e-3;
  if (method.start) {
    if (motion_step.contraction() <= fast) {
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
  if (!method.start->is_damped()) return set_implicit(nullptr);
  method.explicit_step = explicit_step;
  // What the damper did at first is over.
  scale.forget_accelerations();
  evaluate_at(segment->nodes.back());
}

void SegmentIntegrator::Impl::set_implicit(std::shared_ptr<const ImplicitStart> start) {
  if (!start) method = {};
  method.start = start;
  segment->nodes.back().implicit = start;
  motion_step.use(std::move(start));
}

/// Linearizes the motion at the last node. @return  whether that is possible and has not been done before
bool SegmentIntegrator::Impl::renew_implicit() {
  const double x = segment->nodes.back().x;
  if (method.start && method.linearized == x) return false;
  try {
    set_implicit(std::make_shared<const ImplicitStart>(motion_step.linearize(scale.values())));
  } catch (const NumericalError&) {
    return false;  // beyond a limit that the motion itself need not cross
  }
  method.linearized = x;
  method.fastest_rate = method.start->fastest_rate();
  return true;
}

/// Where a step of this length is stable with the explicit method, too, or too short for the clock.
void SegmentIntegrator::Impl::leave_implicit(double h) {
  if (!method.start) return;
  if (h * method.fastest_rate <= surely_stable) return set_implicit(nullptr);
  if (h > segment->resolution(segment->nodes.back().x)) return;
  step = method.explicit_step;
  set_implicit(nullptr);
}

}  // namespace hybrid_sphere::mechanics

#include <algorithm>
#include <cmath>

#include "motion/equations.hpp"

/// What methods have to know of the equations besides their right-hand sides.
namespace hybrid_sphere::numeric {

// It is of order 1, a straight line: no longer than the velocity stays the same, within the tolerance, or
// from rest than the way is as small as the tolerance.
double Equations::first_step(const State& y, double tolerance, double longest) const {
  const Instant now = instant(y);
  const double acceleration = now.forcing.norm() + decays();
  const double speed = std::max(now.velocity.norm(), is_dry() ? pace(y) : 0);
  if (acceleration == 0) return longest;
  if (speed == 0) return std::sqrt(tolerance) * longest;
  return std::min(longest, tolerance * speed / acceleration / pace(y));
}

// Against dry friction x is not the time, and w dies in infinitely many x: a step covers the time as long as
// w lasts so long, and then a part of what is left.
double Equations::step_of_time(const State& y, double duration) const {
  constexpr double part = 0.5;
  if (!is_dry()) return duration;
  const double rate = decays() + instant(y).forcing.norm();
  return rate > 0 ? std::min(duration / pace(y), part / rate) : duration / pace(y);
}

// abs(v) v has a corner at v = 0, which a method's error estimate, a difference of slopes within a step, does
// not see from afar. So v may not halve in a step, unless the step is so short that the corner, of the size
// c a^2 h^3, is below the tolerance.
double Equations::max_step(const State& y, double allowed_speed_error) const {
  const double drag = dynamics_.quadratic_drag;
  const double pace = this->pace(y);
  const double longest = max_time / pace;
  if (drag == 0) return longest;
  const Instant now = instant(y);
  const double acceleration = this->acceleration(y, now).norm();
  if (acceleration == 0) return longest;
  const double blurred = std::cbrt(allowed_speed_error / drag / acceleration / acceleration);
  return std::min(std::max(0.5 * now.velocity.norm() / acceleration, blurred) / pace, longest);
}

// In x what lies across w decays with the rate A. A path along a line has nothing there that an error
// estimate would see, until a rounding is multiplied by about (A h)^p/p! in each step.
double Equations::max_explicit_step(const State& y, double allowed_speed_error) const {
  constexpr double stable = 8;
  const double longest = max_step(y, allowed_speed_error);
  const double decay = decays();
  return decay * longest > stable ? stable / decay : longest;
}

// Within a few of its time constants drag has had its effect: a motion that still takes steps of that length
// hundreds of them later takes them for stability alone.
bool Equations::is_stiff_by_drag(const State& y, double step) const {
  constexpr double much = 100;
  constexpr double good_part = 0.5;
  const double speed = instant(y).velocity.norm();
  const double drag =
      dynamics_.translational_drag + dynamics_.rotational_drag + dynamics_.quadratic_drag * speed;
  const double others = std::sqrt(dynamics_.spring_rate) + std::abs(rate_);
  return drag > much * others && drag * step * pace(y) > good_part;
}

// A slip or a rolling velocity that neither dies nor grows turns to where its forces push it, in far less
// than the time in which anything else changes. Before it dies it takes fewer steps so.
bool Equations::is_stiff_by_friction(const State& y, double step) const {
  constexpr double good_part = 0.5;
  constexpr double nothing = 0x1p-8;
  if (!is_dry() || !(decays() * step > good_part)) return false;
  const Instant now = instant(y);
  if (dry_vectors() == 1) {
    const DryVector dry = dry_vector(0, y, now);
    return std::abs(dry.e.dot(dry.drive) - dry.decay) * step < nothing;
  }
  const double speed = now.velocity.norm();
  return pace(y) * step * (decays() + now.forcing.norm()) < nothing * speed;
}

}  // namespace hybrid_sphere::numeric

#include "motion/step_path.hpp"

#include <algorithm>
#include <cmath>

#include "motion/motion.hpp"

namespace hybrid_sphere::numeric {

StepPath::StepPath(const Node& from, const Node& to, bool dry) : step_(from.step) {
  constexpr double told = 0x1p-26;  // its square is the rounding of the time, squared
  const Vector2d way = displacement(to.y) - displacement(from.y);
  way_[0] = step_ * displacement(from.slope);
  way_[2] = step_ * displacement(to.slope);
  way_[1] = 3 * way - (way_[0] + way_[2]);
  const double duration = dry ? time_of(to.y) - time_of(from.y) : step_;
  time_[0] = step_ * time_of(from.slope);
  time_[2] = step_ * time_of(to.slope);
  time_[1] = dry ? 3 * duration - (time_[0] + time_[2]) : step_;
  is_told_ = duration > told * time_of(to.y);
}

Vector2d StepPath::velocity(double x) const {
  const double s = x / step_;
  const double rest = 1 - s;
  const double b[3] = {rest * rest, 2 * rest * s, s * s};
  return (b[0] * way_[0] + b[1] * way_[1] + b[2] * way_[2]) /
         (b[0] * time_[0] + b[1] * time_[1] + b[2] * time_[2]);
}

// With e = d - c tau, whatever c is, d^2d/dtau^2 = (e'' tau' - e' tau'')/tau'^3. Where c is the velocity at
// the beginning, e' is what the step changes: both terms are of the size of the acceleration.
double StepPath::bend() const {
  if (!is_told_) return 0;
  const double slowest = std::min({time_[0], time_[1], time_[2]});
  if (!(slowest > 0)) return never;  // the time does not run forwards
  const Vector2d velocity = way_[0] / time_[0];
  const Vector2d first = way_[1] - time_[1] * velocity;  // of e'; before it lies 0
  const Vector2d last = way_[2] - time_[2] * velocity;
  const double way = std::sqrt(std::max(first.squaredNorm(), last.squaredNorm()));
  const double turn = 2 * std::sqrt(std::max(first.squaredNorm(), (last - first).squaredNorm()));
  const double delay = 2 * std::max(std::abs(time_[1] - time_[0]), std::abs(time_[2] - time_[1]));
  const double bend = (turn / slowest + way / slowest * (delay / slowest)) / slowest;
  return bend >= 0 ? bend : never;  // numbers at the ends of their range
}

}  // namespace hybrid_sphere::numeric

#include "motion/state_series.hpp"

#include <algorithm>
#include <cfloat>
#include <cmath>

#include "interrupt/interrupt.hpp"

namespace hybrid_sphere {
namespace {

/// A vector in the columns of the values.
struct Part {
  Eigen::Index first;
  Eigen::Index count;
};
// The acceleration is smooth where the velocity is, and no output.
constexpr Part judged_parts[] = {{0, 2}, {2, 2}, {6, 2}, {8, 2}, {10, 1}};

/// The interval of this width, a power of two, in which a time lies.
double start_of(double tau, double width) { return width * std::floor(tau / width); }

constexpr double much_rounding = 16;  // of the motion itself

/// Whether half the length gains so little that what the series leave out is the rounding of the motion.
bool shows_noise(double excess, double before) {
  constexpr double told = 1e11;  // from where on the series are anything like the motion
  constexpr double gain = 16;
  return excess < told && excess > before / gain;
}

}  // namespace

void StateSeries::begin(Motion& motion, double scale) {
  constexpr double longest = 16;  // of the scale: rarely covered
  motion_ = &motion;
  profile_ = motion.spin_profile();
  longest_ = std::exp2(std::floor(std::log2(std::clamp(longest * scale, 0x1p-900, 0x1p+60))));
  for (Panel& panel : panels_) panel.forget();
}

double StateSeries::width(int level) const { return std::ldexp(longest_, -level); }

MotionState StateSeries::at(double tau) {
  if (!panels_[now_].has(tau)) find_panel(tau);
  const Panel& panel = panels_[now_];
  return panel.is_fitted ? panel.at(tau) : motion_->at(tau);
}

void StateSeries::find_panel(double tau) {
  const auto found =
      std::find_if(panels_.begin(), panels_.end(), [tau](const Panel& p) { return p.has(tau); });
  if (found != panels_.end()) {
    now_ = static_cast<std::size_t>(found - panels_.begin());
    return;
  }
  const std::size_t next = (now_ + 1) % kept;
  panels_[next].forget();  // should the fit be interrupted
  fit_around(tau, panels_[now_], panels_[next]);
  now_ = next;
}

/// Goes up to the first interval with tau that contains the last panel, for that is not covered, and down
/// from there.
void StateSeries::fit_around(double tau, const Panel& last, Panel& panel) {
  int level = 0;
  if (last.level != none && start_of(tau, longest_) == start_of(last.from, longest_)) {
    level = last.level;
    while (level > 0 && start_of(tau, width(level - 1)) != start_of(last.from, width(level - 1))) --level;
    panel.excesses = last.excesses;
  }
  for (;; ++level) {
    const double from = start_of(tau, width(level));
    const double excess = is_allowed(from, width(level)) ? fit(from, width(level), panel) : never;
    const auto i = static_cast<std::size_t>(level);
    panel.excesses[i] = excess;
    const bool is_noisy = level > 0 && shows_noise(excess, panel.excesses[i - 1]);
    panel.is_fitted = excess <= (is_noisy ? much_rounding : 1);
    if (panel.is_fitted || is_noisy || level == last_level || from + 0.5 * width(level) == from) {
      panel.from = from;
      panel.until = from + width(level);
      panel.level = level;
      return;
    }
  }
}

bool StateSeries::is_allowed(double from, double width) const {
  constexpr double widths = 4;
  const double until = from + width;
  for (const double border : {profile_.kink, profile_.end}) {
    if (from < border && until > border) return false;
  }
  const double distance = std::max({profile_.corner - until, from - profile_.corner, 0.0});
  return width <= std::max(distance, widths * profile_.corner_width);
}

/// @return what the series leave out of any vector, over the rounding of its greatest size in the panel
double StateSeries::fit(double from, double width, Panel& panel) {
  constexpr double rounding = 4 * DBL_EPSILON;
  constexpr std::uint32_t turns_of_a_fit = 4;
  interruption_point(turns_of_a_fit);
  const chebyshev::Column& nodes = chebyshev::maps().nodes;
  panel.base = motion_->center(from + 0.5 * width).position;
  Values values = Values::Zero();
  double far = panel.base.norm();
  for (Eigen::Index i = 0; i < chebyshev::size; ++i) {
    const MotionState state = motion_->at(from + 0.5 * (1 + nodes[i]) * width);
    const Vector2d way = state.center.position - panel.base;
    values.row(i).head<11>() << way.transpose(), state.center.velocity.transpose(),
        state.center.acceleration.transpose(), state.contact_velocity.transpose(),
        state.angular_velocity.transpose();
    far = std::max(far, way.norm());
  }
  const chebyshev::Parts<columns> coefficients = chebyshev::coefficients_of(values);
  double excess = 0;
  for (const Part& part : judged_parts) {
    double size = values.middleCols(part.first, part.count).rowwise().norm().maxCoeff();
    if (part.first == 0) size = far;
    const double error = chebyshev::left_out(coefficients, part.first, part.count);
    if (!(error <= 0)) excess = std::isfinite(error) ? std::max(excess, error / (rounding * size)) : never;
  }
  panel.series = chebyshev::powers_of(coefficients).transpose();
  return excess;
}

MotionState StateSeries::Panel::at(double tau) const {
  const double x = 2 * ((tau - from) / (until - from)) - 1;
  const auto now = polynomials::values<columns>(series, x);
  MotionState state;
  state.center = {base + now.head<2>(), now.segment<2>(2), now.segment<2>(4)};
  state.contact_velocity = now.segment<2>(6);
  state.angular_velocity = now.segment<3>(8);
  return state;
}

}  // namespace hybrid_sphere

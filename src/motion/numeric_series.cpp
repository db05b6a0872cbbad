#include "motion/numeric_series.hpp"

#include <algorithm>
#include <array>
#include <cfloat>
#include <cmath>
#include <iterator>

#include "motion/chebyshev.hpp"

namespace hybrid_sphere {
namespace {

constexpr int rows = 12;  // of the polynomials

/// The state in the order of the polynomials.
std::array<double, rows> numbers_of(const MotionState& state, const Vector2d& origin) {
  const Vector2d way = state.center.position - origin;
  const Vector2d& v = state.center.velocity;
  const Vector2d& a = state.center.acceleration;
  const Vector2d& sigma = state.contact_velocity;
  const Vector3d& omega = state.angular_velocity;
  return {way.x(),   way.y(),   v.x(),     v.y(),     a.x(),     a.y(),
          sigma.x(), sigma.y(), omega.x(), omega.y(), omega.z(), 0};
}

}  // namespace

void NumericSeries::begin(NumericMotion& motion) {
  motion_ = &motion;
  kink_ = motion.spin_profile().kink;
  step_ = {0, 0};
  interval_.clear();
}

MotionState NumericSeries::at(double tau) {
  constexpr int last_level = 4;  // where that is not covered, the motion itself is evaluated
  if (!interval_.contains(tau)) {
    if (!(tau >= step_.from && tau < step_.until)) {
      interval_.clear();
      const std::optional<NumericMotion::Step> step = motion_->step_at(tau);
      if (!step) return motion_->at(tau);
      step_ = *step;
    }
    interval_.find(tau, {step_.from, step_.until - step_.from}, last_level,
                   [this](double from, double width) { return cover(from, width); });
  }
  if (!interval_.is_covered()) return motion_->at(tau);
  MotionState now = polynomial_.at(tau);
  motion_->keep_rolling(now);
  return now;
}

/// Much nearer to the beginning of the motion than a part is long, its rounding would be seen.
bool NumericSeries::cover(double from, double width) {
  constexpr double near = 0.125;
  const bool has_kink = from < kink_ && from + width > kink_;
  return from >= near * width && !has_kink && fit(from, width);
}

/// @return whether the polynomials leave out of no vector more than rounding of its size, and round no more
bool NumericSeries::fit(double from, double width) {
  constexpr double rounding = 4 * DBL_EPSILON;
  constexpr double most_rounded = 4;  // sum of the sizes of coefficients
  polynomial_.origin = from + 0.5 * width;
  polynomial_.width = 0.5 * width;
  // Less the state on the first node, so that what is constant stays so to the bit.
  std::array<double, rows> first{};
  chebyshev::Table<rows> values;
  for (int i = 0; i < chebyshev::size; ++i) {
    const MotionState now = motion_->at(polynomial_.origin + polynomial_.width * chebyshev::maps().nodes[i]);
    if (i == 0) {
      polynomial_.position = now.center.position;
      first = numbers_of(now, polynomial_.position);
    }
    const std::array<double, rows> numbers = numbers_of(now, polynomial_.position);
    for (int k = 0; k < rows; ++k) values(i, k) = numbers[std::size_t(k)] - first[std::size_t(k)];
  }
  const chebyshev::Parts<rows> series = chebyshev::coefficients_of(values);
  polynomial_.powers = chebyshev::powers_of(series);
  for (int k = 0; k < rows; ++k) polynomial_.powers(k, 0) += first[std::size_t(k)];
  constexpr auto& judged = StatePolynomial::judged;
  return std::all_of(std::begin(judged), std::end(judged), [&](const StatePolynomial::Part& part) {
    double size = std::abs(values(0, part.first) + first[std::size_t(part.first)]);
    for (Eigen::Index k = part.first; k < part.first + part.count; ++k) {
      for (int i = 0; i < chebyshev::size; ++i) {
        size = std::max(size, std::abs(values(i, k) + first[std::size_t(k)]));
      }
    }
    if (part.first == 0) {
      size = std::max({size, std::abs(polynomial_.position.x()), std::abs(polynomial_.position.y())});
    }
    return chebyshev::left_out(series, part.first, part.count) <= rounding * size &&
           polynomial_.sum_of_sizes(part) <= most_rounded * size;
  });
}

}  // namespace hybrid_sphere

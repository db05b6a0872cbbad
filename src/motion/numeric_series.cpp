#include "motion/numeric_series.hpp"

#include <algorithm>
#include <cfloat>
#include <iterator>

#include "motion/chebyshev.hpp"

namespace hybrid_sphere {
namespace {

using Row = Eigen::Matrix<double, 1, 12>;

/// The state as a row of the polynomials.
Row row_of(const MotionState& state, const Vector2d& origin) {
  Row row = Row::Zero();
  row.segment<2>(0) = state.center.position - origin;
  row.segment<2>(2) = state.center.velocity;
  row.segment<2>(4) = state.center.acceleration;
  row.segment<2>(6) = state.contact_velocity;
  row.segment<3>(8) = state.angular_velocity;
  return row;
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
  Row first = Row::Zero();
  chebyshev::Table<12> values = chebyshev::Table<12>::Zero();
  for (int i = 0; i < chebyshev::size; ++i) {
    const MotionState now = motion_->at(polynomial_.origin + polynomial_.width * chebyshev::maps().nodes[i]);
    if (i == 0) {
      polynomial_.position = now.center.position;
      first = row_of(now, polynomial_.position);
    }
    values.row(i) = row_of(now, polynomial_.position) - first;
  }
  const chebyshev::Parts<12> series = chebyshev::coefficients_of(values);
  polynomial_.powers = chebyshev::powers_of(series).transpose();
  polynomial_.powers.col(0) += first.transpose();
  values.rowwise() += first;
  constexpr auto& judged = StatePolynomial::judged;
  return std::all_of(std::begin(judged), std::end(judged), [&](const StatePolynomial::Part& part) {
    double size = values.middleCols(part.first, part.count).cwiseAbs().maxCoeff();
    if (part.first == 0) size = std::max(size, polynomial_.position.cwiseAbs().maxCoeff());
    return chebyshev::left_out(series, part.first, part.count) <= rounding * size &&
           polynomial_.sum_of_sizes(part) <= most_rounded * size;
  });
}

}  // namespace hybrid_sphere

#pragma once

#include <array>

#include "motion/chebyshev.hpp"
#include "motion/motion.hpp"

namespace hybrid_sphere {

/// Dense output of a motion in closed form whose evaluation is expensive: its state as polynomials in time,
/// to rounding. A panel is one of the intervals [i, i + 1) 2^k s, the longest that the polynomials cover and
/// none of whose parents they do; the states are therefore the same to the last bit however often they are
/// requested. Source: docs/theory.md 4.4.
class StateSeries final : public Motion {
 public:
  /// No panel goes over a kink or the end of the motion, and over a corner only as its width allows.
  /// @param motion  must outlive this object, or its next begin()
  /// @param scale   time in which it changes, > 0 [s]
  void begin(Motion& motion, double scale);

  MotionState at(double tau) override;
  double acceleration_bound(double from, double until) override {
    return motion_->acceleration_bound(from, until);
  }
  double end_before(double horizon) override { return motion_->end_before(horizon); }
  MotionEnd end_reason() const override { return motion_->end_reason(); }
  SpinProfile spin_profile() const override { return motion_->spin_profile(); }

 private:
  static constexpr int columns = 12;
  using Values = chebyshev::Table<columns>;

  double width(int level) const;
  void find_panel(double tau);
  bool is_allowed(double from, double width) const;
  double fit(double from, double width);
  MotionState evaluate(double tau) const;

  static constexpr int none = -1;
  static constexpr int last_level = 12;  // within such a panel the motion itself is evaluated

  Motion* motion_ = nullptr;
  SpinProfile profile_;
  double longest_ = 0;  // width of the first panels to try, a power of two; each level halves it [s]
  // The present panel, and how well it and those around it are covered: 1 is rounding.
  int level_ = none;
  double from_ = 0;
  std::array<double, last_level + 1> excesses_{};
  bool is_fitted_ = false;
  Vector2d base_ = Vector2d::Zero();  // position at the middle of the panel
  // Powers of x, one a column: position - base_, velocity, acceleration, contact velocity, omega, nothing.
  Eigen::Matrix<double, columns, chebyshev::size> series_ =
      Eigen::Matrix<double, columns, chebyshev::size>::Zero();
};

}  // namespace hybrid_sphere

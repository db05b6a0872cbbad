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

  static constexpr int none = -1;
  static constexpr int last_level = 12;  // within such a panel the motion itself is evaluated

  /// An interval, and how well it and those around it are covered: 1 is rounding.
  struct Panel {
    int level = none;
    double from = 0;
    double until = 0;
    std::array<double, last_level + 1> excesses{};
    bool is_fitted = false;
    Vector2d base = Vector2d::Zero();  // position at the middle
    // Powers of x, one a column: position - base, velocity, acceleration, contact velocity, omega, nothing.
    polynomials::Powers<columns> series = polynomials::Powers<columns>::Zero();
    void forget() {
      level = none;
      from = until = 0;
    }
    bool has(double tau) const { return tau >= from && tau < until; }
    MotionState at(double tau) const;
  };

  double width(int level) const;
  void find_panel(double tau);
  void fit_around(double tau, const Panel& last, Panel& panel);
  bool is_allowed(double from, double width) const;
  double fit(double from, double width, Panel& panel);

  Motion* motion_ = nullptr;
  SpinProfile profile_;
  double longest_ = 0;  // width of the first panels to try, a power of two; each level halves it [s]
  // The orientation looks a panel of its own ahead, so that times go to and fro.
  static constexpr std::size_t kept = 4;
  std::array<Panel, kept> panels_;
  std::size_t now_ = 0;
};

}  // namespace hybrid_sphere

#pragma once

#include <array>

#include "motion/equations.hpp"

namespace hybrid_sphere::numeric {

/// How w grows from 0 under dry friction: a power series in the time,
///   w = rho e,  abs(e) = 1,  rho = rho_1 tau + rho_2 tau^2 + ...,  e = e_0 + e_1 tau + ...
/// with e_0 = B_0/abs(B_0) and rho_1 = abs(B_0) - A. It also holds if rho_1 = 0 and B grows, that is, if
/// rolling has just lost its grip; there x of Equations is useless, because the direction of w follows B
/// infinitely fast. Order by order w' = B - A e gives, with the components along and across e_0,
///   (A + (n+1) rho_1) e_n = B_n - (n+1) sum_{k=2..n} rho_k e_{n+1-k}                 across
///   (n+1) rho_{n+1} = B_n - A e_n - (n+1) sum_{k=1..n} rho_k e_{n+1-k}               along
/// where e_n along e_0 follows from abs(e) = 1. A slip that starts beside a rolling velocity, or vice versa,
/// has the other vector's direction in its B, as an accompanying power series. If both start at once, they
/// grow along straight lines, for so short a time that B does not change. Source: docs/theory.md 4.8.
class SlipOnset {
 public:
  /// The series that begins at w = 0 with abs(B) >= A. A deficit of up to a relative 2^-20 counts as
  /// rounding; a vector that would grow by less than a relative 2^-40 of its drive is held.
  explicit SlipOnset(const Equations& equations) : SlipOnset(equations, Vector2d::Zero(), Vector2d::Zero()) {}
  /// @param slip  for the form resisted_sliding: slip, nu or both are 0
  SlipOnset(const Equations& equations, const Vector2d& slip, const Vector2d& nu);

  /// Time up to which the series is exact to rounding [s]; 0 if w does not grow.
  double end() const { return end_; }
  State at(double tau) const;

  /// de/dtau, and bounds on abs(de/dtau) and abs(d^2e/dtau^2) up to the end.
  Vector2d turning(double tau) const;
  double turning_bound(int derivative) const;

 private:
  static constexpr int order = 14;
  using Coefficients = std::array<Vector2d, order + 1>;

  /// What begins at 0, and what accompanies it.
  enum class Kind { slip, slip_of_skid, rolling, slip_beside_roll, roll_beside_slip, both };

  static Kind kind_of(const Equations& equations, const Vector2d& slip, const Vector2d& nu);
  void begin_both(const Equations& equations);
  void drag_from_rest(const Equations& equations);
  void add_orders(const Equations& equations);
  void add_order(const Equations& equations, int n);
  void choose_unit();
  Vector2d forcing(const Equations& equations, int n);
  Vector2d force(const Equations& equations, int n);
  Vector2d forcing_of_slip(const Equations& equations, int n, const Vector2d& ground);
  Vector2d forcing_of_roll(const Equations& equations, int n, const Vector2d& ground);
  Vector2d direction_of_other(int n);
  Vector2d drag(double coefficient, int n);
  bool keeps_speed(double t) const;
  double reach() const;
  Vector2d growth(double tau) const;
  State sum(double tau) const;

  Kind kind_;
  Coefficients d_, velocity_, momentum_, w_, e_;
  Coefficients other_, n_;                      // the accompanying vector, and its direction
  std::array<double, order + 1> other_size_{};  // its length
  std::array<double, order + 2> rho_{};
  std::array<double, order + 1> speed_{};
  int first_order_ = 0;  // of the velocity that the quadratic drag sees
  int leading_ = -1;     // order of the first coefficient of that which is not 0
  bool affine_;
  double decay_;
  double unit_ = 1;  // of the time in the series [s]
  double end_ = 0;
};

}  // namespace hybrid_sphere::numeric

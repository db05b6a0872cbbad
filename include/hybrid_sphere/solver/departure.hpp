#pragma once

#include <array>

#include "hybrid_sphere/solver/equations.hpp"

namespace hybrid_sphere::solver {

/// How w grows from 0 under dry friction: a power series in the time,
///   w = rho e,  abs(e) = 1,  rho = rho_1 tau + rho_2 tau^2 + ...,  e = e_0 + e_1 tau + ...
/// with e_0 = B_0/abs(B_0) and rho_1 = abs(B_0) - A. It holds also where rho_1 = 0 and B grows, that is,
/// where rolling has just lost its grip; there x of Equations is useless, because the direction of w follows
/// B infinitely fast. Order by order w' = B - A e gives, with the components along and across e_0,
///   (A + (n+1) rho_1) e_n = B_n - (n+1) sum_{k=2..n} rho_k e_{n+1-k}                 across
///   (n+1) rho_{n+1} = B_n - A e_n - (n+1) sum_{k=1..n} rho_k e_{n+1-k}               along
/// where e_n along e_0 follows from abs(e) = 1. Source: docs/theory.md 4.8.
class Departure {
 public:
  /// The series that begins at w = 0 with abs(B) >= A (up to rounding).
  explicit Departure(const Equations& equations);

  /// Up to here the series is exact to rounding [s]; 0 if w does not grow at all.
  double end() const { return end_; }
  State at(double tau) const;

  /// de/dtau, and bounds on abs(de/dtau) and abs(d^2e/dtau^2) up to the end.
  Vector2d turning(double tau) const;
  double turning_bound(int derivative) const;

 private:
  static constexpr int order = 14;
  using Coefficients = std::array<Vector2d, order + 1>;

  void add_order(const Equations& equations, int n);
  Vector2d forcing(const Equations& equations, int n);
  Vector2d drag(double coefficient, int n);
  double reach() const;
  State sum(double tau) const;

  Coefficients d_, velocity_, momentum_, w_, e_;
  std::array<double, order + 2> rho_{};
  std::array<double, order + 1> speed_{};
  int leading_ = -1;  // order of the first coefficient of the velocity that is not 0
  bool slides_;
  bool affine_;
  double decay_;
  double end_ = 0;
};

}  // namespace hybrid_sphere::solver

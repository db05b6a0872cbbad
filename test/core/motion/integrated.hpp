#pragma once

#include <array>
#include <cstddef>

#include "motion/motion.hpp"
#include "sphere/dynamics.hpp"

/// The equations of motion of docs/theory.md 3 and 4 as they stand, integrated step by step: another way to
/// every closed form.
namespace hybrid_sphere::testing {

/// More than the rounding errors of a whole integration, relative to the largest value on the way.
inline constexpr double integration_error = 1e-13;

/// Integrates y' = f(y, t) from 0 by Gragg's method: the midpoint rule with 2, 4 ... 16 steps, extrapolated.
/// Works on the increments over an interval, so that extrapolation does not magnify the rounding of y.
template <std::size_t size, class Derivative>
std::array<double, size> integrated(std::array<double, size> y, double time, const Derivative& derivative,
                                    int intervals = 100) {
  using State = std::array<double, size>;
  constexpr std::size_t rows = 8;
  const auto plus = [](State a, double factor, const State& b) {
    for (std::size_t i = 0; i < size; ++i) a[i] += factor * b[i];
    return a;
  };
  const double length = time / intervals;
  for (int interval = 0; interval < intervals; ++interval) {
    const double start = interval * length;
    std::array<State, rows> table;
    for (std::size_t row = 0; row < rows; ++row) {
      const int steps = 2 * static_cast<int>(row + 1);
      const double h = length / steps;
      State before{};
      State now = plus({}, h, derivative(y, start));
      for (int i = 1; i < steps; ++i) {
        const State next = plus(before, 2 * h, derivative(plus(y, 1, now), start + i * h));
        before = now;
        now = next;
      }
      table[row] = plus({}, 0.5, plus(plus(now, 1, before), h, derivative(plus(y, 1, now), start + length)));
      for (std::size_t k = row; k-- > 0;) {
        const double ratio = static_cast<double>(row + 1) / static_cast<double>(k + 1);
        table[k] = plus(table[k + 1], 1 / (ratio * ratio - 1), plus(table[k + 1], -1, table[k]));
      }
    }
    y = plus(y, 1, table[0]);
  }
  return y;
}

/// r, v and nu = R (omega_2, -omega_1).
using PlaneState = std::array<double, 6>;

inline PlaneState plane_state(const Vector2d& r, const Vector2d& v, const Vector2d& nu) {
  return {r.x(), r.y(), v.x(), v.y(), nu.x(), nu.y()};
}
inline Vector2d position_of(const PlaneState& y) { return {y[0], y[1]}; }
inline Vector2d velocity_of(const PlaneState& y) { return {y[2], y[3]}; }
inline Vector2d nu_of(const PlaneState& y) { return {y[4], y[5]}; }

/// v' = f + lambda/m, nu' = g - R^2/(m k^2) lambda with a reaction (r, v, nu) -> lambda/m.
template <class Reaction>
PlaneState equations_of_motion(const Dynamics& dynamics, const PlaneState& y, const Reaction& reaction) {
  const Vector2d pull = reaction(position_of(y), velocity_of(y), nu_of(y));
  const double lever = (1 - dynamics.kappa) / dynamics.kappa;  // R^2/k^2
  return plane_state(velocity_of(y), dynamics.acceleration(position_of(y), velocity_of(y)) + pull,
                     dynamics.spin_acceleration(nu_of(y)) - lever * pull);
}

/// The reaction that keeps sigma = u(r): from d/dt (v - nu - u) = 0.
inline auto rolling_reaction(const Dynamics& dynamics, const scene::Material& material) {
  return [dynamics, material](const Vector2d& r, const Vector2d& v, const Vector2d& nu) -> Vector2d {
    return dynamics.kappa * (material.turntable_rate * turned(v) + dynamics.spin_acceleration(nu) -
                             dynamics.acceleration(r, v));
  };
}

inline Vector2d nu_of(const MotionState& now, double radius) {
  return radius * Vector2d(now.angular_velocity.y(), -now.angular_velocity.x());
}

}  // namespace hybrid_sphere::testing

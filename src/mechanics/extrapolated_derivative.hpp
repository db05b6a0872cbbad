#pragma once

#include <algorithm>
#include <array>
#include <cfloat>
#include <cmath>
#include <limits>
#include <utility>

#include "hybrid_sphere/mechanics/vector.hpp"
#include "hybrid_sphere/numerical_error.hpp"

namespace hybrid_sphere::mechanics {

/// The longest step of a derivative by a component of this size.
inline double step_size_of(double x) { return 0.125 * std::max(1.0, std::abs(x)); }

/// Returns df/dx at 0 by Ridders' method: differences over steps that are halved, extrapolated to none, of
/// which each component takes the one that agrees best with those before it.
/// @param f     x -> Vector; steps at which it is not defined are left out
/// @param size   the longest step
/// @param noise  round-off of f besides that of its value, if any
template <class Function>
Vector derivative(const Function& f, double size, const Vector& noise = Vector()) {
  constexpr int halvings = 40;
  constexpr std::size_t orders = 5;
  std::array<Vector, orders> before;  // by the power of the step that is extrapolated away
  std::array<Vector, orders> now;
  std::size_t known = 0;  // in `before`
  Vector best;
  Vector error;
  Vector sizes;  // of the terms of f: at a zero of f its values do not show them
  for (int i = 0; i < halvings; ++i) {
    const double h = std::ldexp(size, -i);
    Vector rounding;
    try {
      const Vector up = f(h);
      const Vector down = f(-h);
      now[0] = (up - down) / (2 * h);
      const Vector now_sizes = up.cwiseAbs() + down.cwiseAbs();
      sizes = sizes.size() > 0 ? Vector(sizes.cwiseMax(now_sizes)) : now_sizes;
      rounding = DBL_EPSILON / h * sizes;
      if (noise.size() > 0) rounding += noise / h;
    } catch (const NumericalError&) {
      if (i + 1 == halvings) throw;
      known = 0;
      continue;
    }
    if (best.size() == 0) {
      best = now[0];
      error = Vector::Constant(best.size(), std::numeric_limits<double>::infinity());
    }
    double power = 1;
    const std::size_t count = std::min(known + 1, orders);
    for (std::size_t k = 1; k < count; ++k) {
      power *= 4;
      now[k] = (power * now[k - 1] - before[k - 1]) / (power - 1);
      const Vector apart =
          rounding + (now[k] - now[k - 1]).cwiseAbs().cwiseMax((now[k] - before[k - 1]).cwiseAbs());
      for (Index j = 0; j < best.size(); ++j) {
        // Where the two sides are equal, rounding has swallowed the step.
        const bool is_swallowed = now[0][j] == 0 && best[j] != 0;
        if (is_swallowed || !(apart[j] < error[j])) continue;
        error[j] = apart[j];
        best[j] = now[k][j];
      }
    }
    std::swap(before, now);
    known = count;
  }
  return best;
}

}  // namespace hybrid_sphere::mechanics

#pragma once

#include <algorithm>
#include <cmath>
#include <initializer_list>

#include "hybrid_sphere/mechanics/solve.hpp"
#include "hybrid_sphere/mechanics/system.hpp"

namespace hybrid_sphere::mechanics::testing {

inline Vector vector(std::initializer_list<double> values) {
  Vector result(static_cast<Index>(values.size()));
  std::copy(values.begin(), values.end(), result.data());
  return result;
}

/// A unit mass in the plane; gravity along -y.
inline System<2> particle(double gravity = 0) {
  return {{"x", "y"}, [=](auto, const auto& q, const auto& v) { return v.dot(v) / 2 - gravity * q[1]; }};
}

/// Keeps y' = 0.
const auto level = [](auto, const auto&, const auto& v) { return v[1]; };

/// Falls on the hill y = 0.3 sin x and slides on it, held by a guard that is 0 all the way.
inline System<2> on_a_hill() {
  System<2> system = particle(9.81);
  system.constrain(
      "ground",
      [](auto, const auto& q, const auto& v) {
        using std::cos;
        return v[1] - 0.3 * cos(q[0]) * v[0];
      },
      while_positive([](auto, const auto& q) {
        using std::sin;
        return 0.3 * sin(q[0]) - q[1];
      }));
  return system;
}

inline Options accurate(double accuracy) {
  Options options;
  options.accuracy = accuracy;
  return options;
}

}  // namespace hybrid_sphere::mechanics::testing

#pragma once

#include <algorithm>
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

inline Options accurate(double accuracy) {
  Options options;
  options.accuracy = accuracy;
  return options;
}

}  // namespace hybrid_sphere::mechanics::testing

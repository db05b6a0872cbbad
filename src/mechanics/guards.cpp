#include "mechanics/guards.hpp"

#include <algorithm>
#include <cfloat>
#include <cmath>

namespace hybrid_sphere::mechanics {
namespace {

/// sum over t and q of abs(dg/dq_i) weight_i
double weighted(const Guard& guard, double t, const Vector& q, double time_weight, const Vector& weights) {
  Vector direction = Vector::Zero(q.size());
  const double time_rate = guard.rate(t, q, direction);
  double sum = std::abs(time_rate) * time_weight;
  for (Index i = 0; i < q.size(); ++i) {
    direction[i] = 1;
    sum += std::abs(guard.rate(t, q, direction) - time_rate) * weights[i];
    direction[i] = 0;
  }
  return sum;
}

int sign_beyond(double value, double tolerance) {
  if (value == 0 || std::abs(value) <= tolerance) return 0;
  return value > 0 ? 1 : -1;
}

constexpr double guard_roundoff = 4 * DBL_EPSILON;  // of the instant, the integration and g itself

}  // namespace

double rounding_of(const Guard& guard, double t, const Vector& q, const Vector& sizes) {
  return guard_roundoff * weighted(guard, t, q, std::abs(t), sizes);
}

double gap_size(const Guard& guard, double t, const Vector& q, const Vector& sizes) {
  return weighted(guard, t, q, 0, sizes);
}

int sign_of(const Guard& guard, double t, const Vector& q, const Vector& sizes) {
  return sign_beyond(guard.value(t, q), rounding_of(guard, t, q, sizes));
}

int sign_of_rate(const Guard& guard, double t, const Vector& q, const Vector& q_rate,
                 const Vector& q_rate_before) {
  const Vector speeds = q_rate.cwiseAbs().cwiseMax(q_rate_before.cwiseAbs());
  return sign_beyond(guard.rate(t, q, q_rate), guard_roundoff * weighted(guard, t, q, 1, speeds));
}

double relative_position(const ConstraintFunction& function, double t, const Vector& q, const Vector& v,
                         const Vector& sizes) {
  if (!function.has_position()) return 0;
  Vector position;
  function.position(t, q, position);
  Vector direction = Vector::Zero(q.size());
  ConstraintTerms at_rest;
  ConstraintTerms moving;
  function.evaluate(t, q, v, direction, at_rest);
  Vector size = Vector::Zero(position.size());
  for (Index i = 0; i < q.size(); ++i) {
    direction[i] = 1;
    function.evaluate(t, q, v, direction, moving);
    size += (moving.value - at_rest.value).cwiseAbs() * sizes[i];
    direction[i] = 0;
  }
  double largest = 0;
  for (Index b = 0; b < position.size(); ++b) {
    if (position[b] != 0) largest = std::max(largest, std::abs(position[b]) / size[b]);
  }
  return largest;
}

}  // namespace hybrid_sphere::mechanics

#include "mechanics/guards.hpp"

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

double rounding_of_rate(const Guard& guard, double t, const Vector& q, const Vector& q_rate,
                        const Vector& q_rate_before) {
  const Vector speeds = q_rate.cwiseAbs().cwiseMax(q_rate_before.cwiseAbs());
  return guard_roundoff * weighted(guard, t, q, 1, speeds);
}

}  // namespace

bool has_held(const Schedule& schedule, double t, const Vector& q) {
  if (!(schedule.begin < t && t < schedule.end)) return false;
  return !schedule.guard || schedule.guard->value(t, q) > 0;
}

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
  return sign_beyond(guard.rate(t, q, q_rate), rounding_of_rate(guard, t, q, q_rate, q_rate_before));
}

bool changes_rate(const Guard& guard, double t, const Vector& q, const Vector& q_rate,
                  const Vector& q_rate_before) {
  const double change = guard.rate(t, q, q_rate) - guard.rate(t, q, q_rate_before);
  return sign_beyond(change, rounding_of_rate(guard, t, q, q_rate, q_rate_before)) != 0;
}

}  // namespace hybrid_sphere::mechanics

// Bounds on the second derivatives of the edges' equations, with which no root is missed, are never below
// the true ones.

#include "hybrid_sphere/ground/edge_functions.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "hybrid_sphere/sphere/linear_motion.hpp"

namespace hybrid_sphere::testing {
namespace {

constexpr double error = 1e-9;  // of the samples, relative

class Numbers {
 public:
  double part() { return std::uniform_real_distribution<double>(0, 1)(engine_); }
  double size() { return std::pow(10.0, 4 * part() - 2); }
  Vector2d vector(double length) {
    const double angle = 2 * M_PI * part();
    return length * Vector2d(std::cos(angle), std::sin(angle));
  }

 private:
  std::mt19937 engine_{11};
};

LinearMotion random_motion(Numbers& numbers, int i) {
  scene::Forces forces;
  forces.wrench.force = numbers.vector(i % 2 == 0 ? 0 : numbers.size());
  if (i % 3 == 0) forces.drag = {numbers.size(), numbers.size(), 0};
  if (i % 5 == 0) forces.spring = {numbers.vector(numbers.size()), numbers.size()};
  const Dynamics dynamics(Sphere({1, 0.5, 0.25}), forces);
  scene::Material ground(scene::Law::rough);
  if (i % 7 < 3) ground.turntable_rate = numbers.size();
  return LinearMotion::rolling(dynamics, ground, numbers.vector(numbers.size()),
                               numbers.vector(numbers.size()), NormalSpin(0));
}

/// g' changes between two places within an interval by no more than its bound allows.
template <class Edge>
void expect_bound(const Edge& edge, LinearMotion& motion, double from, double until) {
  constexpr int samples = 50;
  const double middle = from + 0.5 * (until - from);
  const double bound = edge.curvature(motion, motion.center(middle), from, until);
  double before = 0;
  for (int k = 0; k <= samples; ++k) {
    const double slope = edge.jet(motion.center(from + (until - from) * k / samples)).slope;
    if (k > 0) {
      const double noise = error * (std::abs(slope) + std::abs(before));
      ASSERT_LE(std::abs(slope - before), bound * (until - from) / samples * (1 + error) + noise);
    }
    before = slope;
  }
}

TEST(TheCurvatureOfAnEdgesEquation, IsNeverBelowTheTrueOne) {
  Numbers numbers;
  for (int i = 0; i < 600; ++i) {
    SCOPED_TRACE(i);
    LinearMotion motion = random_motion(numbers, i);
    const double horizon = std::min(2 * numbers.size(), motion.last_time());
    const double from = horizon * numbers.part();
    const double until = from + (horizon - from) * numbers.part() * numbers.part();
    if (!(until > from)) continue;
    const scene::Circle circle{numbers.vector(numbers.size()), numbers.size()};
    expect_bound(CircleFunction(circle), motion, from, until);
    expect_bound(LineFunction(numbers.vector(numbers.size()), numbers.vector(numbers.size())), motion, from,
                 until);
    if (HasFatalFailure()) return;
  }
}

}  // namespace
}  // namespace hybrid_sphere::testing

// Constraints of positions given as such.
#include "hybrid_sphere/mechanics/holonomic_constraint.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "hybrid_sphere/mechanics/solve.hpp"
#include "hybrid_sphere/mechanics/system.hpp"

namespace hybrid_sphere::mechanics::holonomic_test {
namespace {

System<2> particle() {
  return {{"x", "y"},
          [](auto, const auto& q, const auto& v) { return (v[0] * v[0] + v[1] * v[1]) / 2 - 9.81 * q[1]; }};
}

// A rod whose length changes with the time: f = x x' + y y' - l l', twice that of g = x^2 + y^2 - l^2.
TEST(Holonomic, IsTheRateOfItsFunction) {
  System<2> system = particle();
  system.holonomic(
      "rod",
      [](const auto& t, const auto& q) {
        const auto length = 2.0 + 0.1 * t * t;
        return q[0] * q[0] + q[1] * q[1] - length * length;
      },
      always());
  const ConstraintFunction& function = *system.constraints[0].function;
  const double t = 0.7, length = 2 + 0.1 * t * t, rate = 0.2 * t;
  const Vector q{0.3, -1.2};
  const Vector v{1.5, 0.4};
  ConstraintTerms terms;
  function.evaluate(t, q, v, v, terms);
  EXPECT_NEAR(terms.value[0], 2 * q.dot(v) - 2 * length * rate, 1e-14);
  EXPECT_NEAR(terms.gradient(0, 0), 2 * q[0], 1e-14);
  EXPECT_NEAR(terms.gradient(0, 1), 2 * q[1], 1e-14);
  EXPECT_NEAR(terms.gamma[0], -(2 * v.squaredNorm() - 2 * (rate * rate + length * 0.2)), 1e-13);
  Vector value;
  Matrix gradient;
  function.evaluate(t, q, v, value, gradient);
  EXPECT_NEAR(value[0], terms.value[0], 1e-14);
  EXPECT_EQ(gradient, terms.gradient);
  function.position(t, q, value);
  EXPECT_NEAR(value[0], q.squaredNorm() - length * length, 1e-14);
}

// Differentiating loses the length of the rod; the projection keeps it.
TEST(Holonomic, KeepsThePositionsOfALongMotion) {
  System<2> pendulum = particle();
  pendulum.holonomic(
      "rod", [](const auto&, const auto& q) { return q[0] * q[0] + q[1] * q[1] - 1.0; }, always());
  Options options;
  options.accuracy = 1e-6;
  const Solution motion = solve(pendulum, {0, {1, 0}, {0, 0}}, 50, options);
  ASSERT_EQ(motion.status().stop, Stop::reached_end) << motion.status().message;
  for (int i = 0; i <= 100; ++i) {
    const State state = motion.at(0.5 * i);
    EXPECT_NEAR(state.q.squaredNorm(), 1, 1e-14) << state.time;
    EXPECT_NEAR(state.energy, 0, 1e-5) << state.time;
  }
}

// In quasi-velocities: a body turns by a quaternion, and a point of it stays at a height.
TEST(Holonomic, KnowsQuasiVelocities) {
  const auto turning = [](const auto& q, const auto& w) {
    using T = std::decay_t<decltype(q[0] * w[0])>;
    return Eigen::Matrix<T, 4, 1>(
        0.5 * (-q[1] * w[0] - q[2] * w[1] - q[3] * w[2]), 0.5 * (q[0] * w[0] + q[2] * w[2] - q[3] * w[1]),
        0.5 * (q[0] * w[1] + q[3] * w[0] - q[1] * w[2]), 0.5 * (q[0] * w[2] + q[1] * w[1] - q[2] * w[0]));
  };
  System<3, 4> body({"q0", "q1", "q2", "q3"}, {"w1", "w2", "w3"}, turning,
                    [](auto, const auto&, const auto& w) {
                      return (2.0 * w[0] * w[0] + 3.0 * w[1] * w[1] + 4.0 * w[2] * w[2]) / 2;
                    });
  const auto height = [](const auto&, const auto& q) {
    return 2.0 * (q[1] * q[3] - q[0] * q[2]);
  };  // of axis 1
  body.holonomic("height", height, always());
  body.normalize = [](Vector& q) { q /= q.norm(); };
  Options options;
  options.project_initial = true;
  const Solution motion = solve(body, {0, {1, 0, 0, 0}, {1, 0.5, 2}}, 10, options);
  ASSERT_EQ(motion.status().stop, Stop::reached_end) << motion.status().message;
  const double energy = motion.at(0).energy;
  for (int i = 0; i <= 20; ++i) {
    const State state = motion.at(0.5 * i);
    EXPECT_NEAR(height(0.0, state.q), 0, 1e-14) << state.time;
    EXPECT_NEAR(state.energy, energy, 1e-8) << state.time;
    EXPECT_NEAR(state.residual, 0, 1e-13) << state.time;
  }
}

TEST(Holonomic, WantsTheDirectionsOfQuasiVelocitiesByHand) {
  class Doubled final : public EquationsOfMotion {
   public:
    Index coordinates() const override { return 1; }
    Index velocities() const override { return 1; }
    void evaluate(double, const Vector&, const Vector&, MotionTerms&) const override {}
    void momentum(double, const Vector&, const Vector&, Vector&, Matrix&) const override {}
    void rate(const Vector&, const Vector& v, Vector& rate) const override { rate = 2 * v; }
  };
  Matrix directions;
  Vector drift;
  EXPECT_THROW(Doubled().directions({0.0}, {1.0}, directions, drift), std::logic_error);
}

TEST(Holonomic, IsRefusedWhereThePositionsAreOffIt) {
  System<2> pendulum = particle();
  pendulum.holonomic(
      "rod", [](const auto&, const auto& q) { return q[0] * q[0] + q[1] * q[1] - 1.0; }, always());
  try {
    solve(pendulum, {0, {1.5, 0}, {0, 0}}, 1);
    ADD_FAILURE() << "not refused";
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("rod"), std::string::npos) << error.what();
  }
  System<2> caught = particle();
  caught.holonomic(
      "rod", [](const auto&, const auto& q) { return q[0] * q[0] + q[1] * q[1] - 1.0; }, from(0.5));
  const Solution motion = solve(caught, {0, {1.5, 0}, {0, 0}}, 1);
  EXPECT_EQ(motion.status().stop, Stop::inconsistent);
  EXPECT_NEAR(motion.end(), 0.5, 1e-12);
}

}  // namespace
}  // namespace hybrid_sphere::mechanics::holonomic_test

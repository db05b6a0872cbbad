// Whipple's bicycle from parts. Parameters and eigenvalues: J. P. Meijaard, J. M. Papadopoulos, A. Ruina, A.
// L. Schwab, Linearized dynamics equations for the balance and steer of a bicycle, Proc. R. Soc. A 463 (2007)
// 1955-1982, tables 1 and 2; x forward, y to the left, z up.
#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <vector>

#include "core/mechanics/particle.hpp"
#include "hybrid_sphere/mechanics/modes.hpp"
#include "hybrid_sphere/mechanics/multibody_system.hpp"

namespace hybrid_sphere::mechanics::multibody_bicycle_test {
namespace {

using Eigen::Vector3d;

MultibodySystem bicycle() {
  const Vector3d left(0, 1, 0), rear(0, 0, 0.3), front(1.02, 0, 0.35);
  const Vector3d steering_axis(-std::sin(M_PI / 10), 0, std::cos(M_PI / 10));
  MultibodySystem system;
  system.body("rear wheel", 2, {0.0603, 0.12, 0.0603}, rear)
      .body("frame", 85, {9.2, 11, 2.8, 0, -2.4}, Vector3d(0.3, 0, 0.9))
      .body("fork", 4, {0.05892, 0.06, 0.00708, 0, 0.00756}, Vector3d(0.9, 0, 0.7))
      .body("front wheel", 3, {0.1405, 0.28, 0.1405}, front)
      .hinge("rear hub", "frame", "rear wheel", rear, left)
      .hinge("steering", "frame", "fork", {1.1, 0, 0}, steering_axis)
      .hinge("front hub", "fork", "front wheel", front, left)
      .rolling("rear tyre", "rear wheel", ContactShape::disk(0.3, left))
      .rolling("front tyre", "front wheel", ContactShape::disk(0.35, left));
  return system;
}

Initial straight(const MultibodySystem& system, double speed) {
  return system.initial({{"frame", {{speed, 0, 0}, {0, 0, 0}}}});
}

TEST(MultibodyBicycle, HasThePublishedEigenvalues) {
  using Eigenvalues = std::vector<std::complex<double>>;
  const std::pair<double, Eigenvalues> cases[] = {
      {0, {3.131643247906560, -3.131643247906560, 5.530943717653927, -5.530943717653927}},
      {5,
       {{-0.775341882195845, 4.464867713788229},
        {-0.775341882195845, -4.464867713788229},
        -0.322866429004087,
        -14.078389692798220}}};
  const MultibodySystem system = bicycle();
  for (const auto& [speed, expected] : cases) {
    const double time = speed > 0 ? 0.1 : 0;  // the wheels have turned by then
    const State state = solve(system, straight(system, speed), time).at(time);
    const Modes found = modes(system, state);
    ASSERT_EQ(found.eigenvalues.size(), 4) << found.eigenvalues;
    for (const std::complex<double>& eigenvalue : expected) {
      const double nearest = (found.eigenvalues.array() - eigenvalue).abs().minCoeff();
      EXPECT_LE(nearest, 1e-9 * std::abs(eigenvalue)) << "speed " << speed << ", " << eigenvalue;
    }
    // The place (x, y), the heading, the angles of both wheels, and the speed.
    EXPECT_EQ(found.neutral, 6);
  }
}

// Weave becomes stable at the first published speed, capsize unstable at the second one.
TEST(MultibodyBicycle, IsStableBetweenThePublishedSpeeds) {
  const MultibodySystem system = bicycle();
  const auto growth = [&](double speed) {
    return modes(system, solve(system, straight(system, speed), 0).at(0)).eigenvalues[0].real();
  };
  constexpr double margin = 1e-5;  // the rate is 1e-6 there, and its error 1e-10
  EXPECT_GT(growth(4.292382536341 - margin), 0);
  EXPECT_LT(growth(4.292382536341 + margin), 0);
  EXPECT_LT(growth(6.024262015388 - margin), 0);
  EXPECT_GT(growth(6.024262015388 + margin), 0);
}

// A push at 5 m/s dies away, as the eigenvalues say; energy and contacts stay.
TEST(MultibodyBicycle, KeepsItsEnergyAndItsContacts) {
  const MultibodySystem system = bicycle();
  const Initial start = system.initial({{"frame", {{5, -0.045, 0}, {0.05, 0, 0}}}});
  for (const double accuracy : {1e-6, 1e-9, 1e-12}) {
    const Solution motion = solve(system, start, 2, testing::accurate(accuracy));
    ASSERT_EQ(motion.status().stop, Stop::reached_end) << motion.status().message;
    const State first = motion.at(0);
    const State last = motion.at(2);
    EXPECT_NEAR(last.energy, first.energy, 4 * accuracy * first.kinetic_energy);
    EXPECT_LT(last.residual, 1e-12);
    EXPECT_LT(std::abs(system.twist(last.q, last.v, "frame").angular_velocity.x()), 0.05);
    Vector position;
    for (const Constraint& constraint : system.constraints) {
      constraint.function->position(2, last.q, position);
      EXPECT_LE(position.cwiseAbs().maxCoeff(), 1e-14 * 10) << constraint.name;
    }
  }
}

// Forces cancel, and rounding alone tells where it falls: in 2 s by exp(5.53 t) times next to nothing.
TEST(MultibodyBicycle, StandsUprightAtRest) {
  const MultibodySystem system = bicycle();
  for (const double speed : {0.0, 1e-9}) {
    for (const double accuracy : {1e-3, 1e-6, 1e-9, 1e-12}) {
      const Solution motion = solve(system, straight(system, speed), 2, testing::accurate(accuracy));
      ASSERT_EQ(motion.status().stop, Stop::reached_end) << motion.status().message;
      EXPECT_LE(motion.steps(), 100u) << speed << ", " << accuracy;
      const Eigen::Isometry3d frame = system.pose(motion.at(2).q, "frame");
      EXPECT_LE(std::abs(frame.linear()(2, 1)), 1e-9) << speed << ", " << accuracy;  // lean
      EXPECT_NEAR(frame.translation().z(), 0.9, 1e-15);
    }
  }
}

}  // namespace
}  // namespace hybrid_sphere::mechanics::multibody_bicycle_test

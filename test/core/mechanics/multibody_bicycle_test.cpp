// Whipple's bicycle from parts. Parameters and eigenvalues: J. P. Meijaard, J. M. Papadopoulos, A. Ruina, A.
// L. Schwab, Linearized dynamics equations for the balance and steer of a bicycle, Proc. R. Soc. A 463 (2007)
// 1955-1982, tables 1 and 2; x forward, y to the left, z up.
#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <vector>

#include "core/mechanics/particle.hpp"
#include "hybrid_sphere/mechanics/linearization.hpp"
#include "hybrid_sphere/mechanics/multibody_system.hpp"
#include "mechanics/decompositions/cholesky.hpp"
#include "mechanics/decompositions/eigenvalues.hpp"

namespace hybrid_sphere::mechanics::multibody_bicycle_test {
namespace {

using Eigen::Matrix3d;
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

Matrix3d cross_matrix(const Vector3d& a) {
  Matrix3d m;
  m << 0, -a.z(), a.y(), a.z(), 0, -a.x(), -a.y(), a.x(), 0;
  return m;
}

/// A small change y of place, attitude, velocity and angular velocity, all in the world, changes q and v by
/// T y. In q and v themselves the coefficients of the linear equations turn with the wheels.
struct InTheWorld {
  Matrix T;
  Matrix T_rate;

  InTheWorld(const MultibodySystem& system, const State& state) {
    const Index bodies = state.v.size() / 6;
    T.setZero(13 * bodies, 12 * bodies);
    T_rate = T;
    for (Index i = 0; i < bodies; ++i) {
      const Matrix3d R = system.poses(state.q)[static_cast<std::size_t>(i)].linear();
      const Vector3d w = R * state.v.segment<3>(6 * i + 3);
      const Index from = 6 * i, speed = 6 * (bodies + i), place = 7 * i, rate = 7 * bodies + 6 * i;
      T.block<3, 3>(place, from).setIdentity();
      T.block<3, 3>(rate, speed).setIdentity();
      const Eigen::Vector4d quaternion = state.q.segment<4>(place + 3);
      T.block<4, 3>(place + 3, from + 3) = turning(quaternion);
      T_rate.block<4, 3>(place + 3, from + 3) = turning(turning(quaternion) * w);
      T.block<3, 3>(rate + 3, speed + 3) = R.transpose();
      T_rate.block<3, 3>(rate + 3, speed + 3) = -R.transpose() * cross_matrix(w);
      T.block<3, 3>(rate + 3, from + 3) = R.transpose() * cross_matrix(w);
      T_rate.block<3, 3>(rate + 3, from + 3) = -R.transpose() * cross_matrix(w) * cross_matrix(w);
    }
  }

  /// The eigenvalues of y' = A y, along a motion whose angular velocities in the world are constant.
  Eigen::VectorXcd rates_of(const Matrix& A) const {
    const Cholesky square(T.transpose() * T);
    Matrix moved = T.transpose() * (A * T - T_rate);
    for (Index i = 0; i < moved.cols(); ++i) square.solve(moved.col(i));
    return eigenvalues(moved);
  }

  /// (0, w) q / 2 = B w.
  static Eigen::Matrix<double, 4, 3> turning(const Eigen::Vector4d& q) {
    Eigen::Matrix<double, 4, 3> B;
    B << -q[1], -q[2], -q[3], q[0], q[3], -q[2], -q[3], q[0], q[1], q[2], -q[1], q[0];
    return B / 2;
  }
};

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
    const Eigen::VectorXcd found = InTheWorld(system, state).rates_of(linearize(system, state).A);
    for (const std::complex<double>& eigenvalue : expected) {
      const double nearest = (found.array() - eigenvalue).abs().minCoeff();
      EXPECT_LE(nearest, 1e-8 * std::abs(eigenvalue)) << "speed " << speed << ", " << eigenvalue;
    }
    // All others neither grow nor die away: 0, several times, where rounding makes fourth roots of itself,
    // and, off the hinges, which turn with the wheels, i times their angular velocity.
    EXPECT_EQ((found.real().array().abs() > 1e-2).count(), 4) << "speed " << speed << "\n" << found;
  }
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

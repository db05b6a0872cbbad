#include "motion/uniform_motion.hpp"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>

namespace hybrid_sphere::testing::uniform_motion_test {
namespace {

constexpr double unit = 0x1p-53;

const Quaterniond start(0.5, -0.5, 0.5, 0.5);
const Twist twist{{1.5, -0.25}, {2.0, -3.0, 1.25}};
const UniformMotion motion({0.5, -2}, start, twist, 0.25);

Eigen::Matrix3d hat(const Vector3d& w) {
  Eigen::Matrix3d m;
  m << 0, -w.z(), w.y(), w.z(), 0, -w.x(), -w.y(), w.x(), 0;
  return m;
}

/// Returns the exponential of a matrix by its series, after halving the matrix to a norm of at most 1/2. The
/// first term left out is 2^-15/15!, less than the rounding of the sum.
Eigen::Matrix3d exponential(Eigen::Matrix3d a) {
  constexpr int terms = 14;
  int squarings = 0;
  for (; a.norm() > 0.5; ++squarings) a /= 2;
  Eigen::Matrix3d term = Eigen::Matrix3d::Identity();
  Eigen::Matrix3d sum = term;
  for (int k = 1; k <= terms; ++k) {
    const Eigen::Matrix3d product = term * a;
    term = product / k;
    sum += term;
  }
  for (; squarings > 0; --squarings) sum = Eigen::Matrix3d(sum * sum);
  return sum;
}

// q' = (0, omega) q / 2, omega on the fixed axes from the left.
Quaterniond derivative(const Quaterniond& q) {
  const Vector3d& w = twist.angular_velocity;
  return Quaterniond((Quaterniond(0, w.x(), w.y(), w.z()) * q).coeffs() * 0.5);
}

Quaterniond plus(const Quaterniond& q, const Quaterniond& rate, double h) {
  return Quaterniond(Eigen::Vector4d(q.coeffs() + h * rate.coeffs()));
}

double error_of_rk4(int steps, double time) {
  Quaterniond q = start;
  const double h = time / steps;
  for (int i = 0; i < steps; ++i) {
    const Quaterniond a = derivative(q);
    const Quaterniond b = derivative(plus(q, a, h / 2));
    const Quaterniond c = derivative(plus(q, b, h / 2));
    const Quaterniond d = derivative(plus(q, c, h));
    q.coeffs() += h / 6 * (a.coeffs() + 2 * b.coeffs() + 2 * c.coeffs() + d.coeffs());
  }
  return (q.coeffs() - motion.orientation(time).coeffs()).norm();
}

TEST(UniformMotion, OrientationIsTheLimitOfRungeKutta) {
  const double coarse = error_of_rk4(200, 2);
  const double fine = error_of_rk4(400, 2);
  EXPECT_LE(fine, 1e-8);
  EXPECT_NEAR(coarse / fine, 16, 0.5);  // fourth order towards the closed form
}

TEST(UniformMotion, OrientationIsTheExponentialOfTheAngularVelocity) {
  for (const double tau : {0.0, 1e-9, 0.1, 1.0, 7.5}) {
    const Eigen::Matrix3d turn = exponential(tau * hat(twist.angular_velocity));
    const Eigen::Matrix3d expected = turn * start.toRotationMatrix();
    // Scaling and squaring of a matrix of norm |omega| tau doubles its error with each of about log2 of it
    // squarings.
    const double tolerance = 64 * unit * (1 + tau * twist.angular_velocity.norm());
    EXPECT_LE((motion.orientation(tau).toRotationMatrix() - expected).norm(), tolerance) << "after " << tau;
  }
}

TEST(UniformMotion, OrientationKeepsItsLengthAfterManyTurns) {
  EXPECT_NEAR(motion.orientation(1e6).norm(), 1, 8 * unit);
}

TEST(UniformMotion, WithoutSpinKeepsItsOrientation) {
  const UniformMotion still({0, 0}, start, Twist{{1, 2}, {0, 0, 0}}, 1);
  EXPECT_EQ(still.orientation(5).coeffs(), start.coeffs());
}

TEST(UniformMotion, OfTheSmallestAndTheLargestSpinIsFinite) {
  for (const double rate : {5e-324, 1e-200, 1e-160, 1e15}) {
    const UniformMotion fast({0, 0}, start, Twist{{0, 0}, {rate, -rate, rate}}, 1);
    EXPECT_NEAR(fast.orientation(1).norm(), 1, 8 * unit) << "rate " << rate;
  }
}

TEST(UniformMotion, RunsStraight) {
  const Vector2d r = motion.position(4);
  EXPECT_EQ(r, Vector2d(6.5, -3));  // exact in binary64
  EXPECT_EQ(motion.position(0), Vector2d(0.5, -2));
}

}  // namespace
}  // namespace hybrid_sphere::testing::uniform_motion_test

// The sphere's formulas another way: the impulse from the linear system that defines it, the energy from the
// Lagrangian in Euler angles.

#include "hybrid_sphere/sphere/sphere.hpp"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <random>

#include "support/elimination.hpp"

namespace hybrid_sphere::testing::sphere_test {
namespace {

constexpr double unit = 0x1p-53;

struct Case {
  scene::SphereBody body;
  Twist twist;
  double size() const { return twist.velocity.norm() + body.radius * twist.angular_velocity.norm(); }
};

std::vector<Case> random_cases() {
  std::mt19937_64 engine(23);
  const auto number = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(engine);
  };
  std::vector<Case> cases;
  for (int i = 0; i < 500; ++i) {
    const double radius = std::pow(10, number(-3, 3));
    const scene::SphereBody body{std::pow(10, number(-3, 3)), radius, radius * number(0.05, 0.8164)};
    const Twist twist{Vector2d(number(-3, 3), number(-3, 3)),
                      Vector3d(number(-3, 3), number(-3, 3), number(-3, 3)) / radius};
    cases.push_back({body, twist});
  }
  return cases;
}

Twist rolled(const Sphere& sphere, const Twist& before) {
  return sphere.rolling_twist(sphere.conserved_velocity(before), Vector2d::Zero(),
                              before.angular_velocity.z());
}

// (20): m (v2 - v1) = P, m k^2 (w2 - w1) = (R P_y, -R P_x, 0); (22): xd - R w2 = 0, yd + R w1 = 0. Unknown:
// both velocities after, and P. Lengths are measured in R, so that the matrix is well conditioned.
Eigen::Matrix<double, 7, 1> solve_impulse(const Case& c) {
  const double gyration = std::pow(c.body.gyration_radius / c.body.radius, 2);
  Eigen::Matrix<double, 7, 7> matrix = Eigen::Matrix<double, 7, 7>::Zero();
  Eigen::Matrix<double, 7, 1> right = Eigen::Matrix<double, 7, 1>::Zero();
  matrix(0, 0) = matrix(1, 1) = 1;
  matrix(0, 5) = matrix(1, 6) = -1;
  matrix(2, 2) = matrix(3, 3) = matrix(4, 4) = gyration;
  matrix(2, 6) = -1;
  matrix(3, 5) = 1;
  matrix(5, 0) = 1;
  matrix(5, 3) = -1;
  matrix(6, 1) = 1;
  matrix(6, 2) = 1;
  right.head<2>() = c.twist.velocity;
  right.segment<3>(2) = gyration * c.body.radius * c.twist.angular_velocity;
  return solve_by_elimination(matrix, right);
}

TEST(RollingImpulse, SolvesTheImpulsiveEquationsWithTheConstraint) {
  for (const Case& c : random_cases()) {
    const Sphere sphere(c.body);
    const Eigen::Matrix<double, 7, 1> solution = solve_impulse(c);
    const Twist after = rolled(sphere, c.twist);
    const Vector2d impulse = sphere.stopping_impulse(sphere.contact_velocity(c.twist));
    // Seven eliminations on a matrix whose condition is about (R/k)^2 <= 400.
    const double tolerance = 7 * 400 * unit * c.size();
    EXPECT_LE((after.velocity - solution.head<2>()).norm(), tolerance);
    EXPECT_LE((c.body.radius * after.angular_velocity - solution.segment<3>(2)).norm(), tolerance);
    EXPECT_LE((impulse / c.body.mass - solution.tail<2>()).norm(), tolerance);
  }
}

TEST(RollingImpulse, IsTheCorrectedEquation23ComponentByComponent) {
  for (const Case& c : random_cases()) {
    const double R = c.body.radius;
    const double k2 = c.body.gyration_radius * c.body.gyration_radius;
    const double D = R * R + k2;
    const Vector2d v = c.twist.velocity;
    const Vector3d w = c.twist.angular_velocity;
    const Twist after = rolled(Sphere(c.body), c.twist);
    const double tolerance = 16 * unit * c.size();  // about eight roundings on each of the two sides
    EXPECT_NEAR(after.velocity.x(), (R * R * v.x() + R * k2 * w.y()) / D, tolerance);
    EXPECT_NEAR(after.velocity.y(), (R * R * v.y() - R * k2 * w.x()) / D, tolerance);
    EXPECT_NEAR(after.angular_velocity.x(), (-R * v.y() + k2 * w.x()) / D, tolerance / R);
    EXPECT_NEAR(after.angular_velocity.y(), (R * v.x() + k2 * w.y()) / D, tolerance / R);
    EXPECT_EQ(after.angular_velocity.z(), w.z());
  }
}

// The errata: (23) as printed, with R^2 for R in the angular velocities and + for - in the velocity, keeps
// slipping unless R = 1, and there unless omega_1 = 0.
TEST(RollingImpulse, AsPrintedInEquation23ViolatesTheConstraint) {
  const auto printed_slip = [](double R, double k2, const Vector2d& v, const Vector3d& w) {
    const double D = R * R + k2;
    const double xd = (R * R * v.x() + R * k2 * w.y()) / D;
    const double yd = (R * R * v.y() + R * k2 * w.x()) / D;
    const double w1 = (-R * R * v.y() + k2 * w.x()) / D;
    const double w2 = (R * R * v.x() + k2 * w.y()) / D;
    return Vector2d(xd - R * w2, yd + R * w1);
  };
  // R = 2, k = 1, D = 5: residuals -R^2 xd/D and R (-R^2 yd + R yd + 2 k^2 w1)/D.
  const Vector2d slip = printed_slip(2, 1, {1, 1}, {3, 0, 0});
  EXPECT_NEAR(slip.x(), -4.0 / 5, 8 * unit);
  EXPECT_NEAR(slip.y(), 8.0 / 5, 8 * unit);
  EXPECT_NEAR(printed_slip(1, 1, {1, 1}, {0, 2, 0}).norm(), 0, 8 * unit);
  EXPECT_NEAR(printed_slip(1, 1, {1, 1}, {3, 2, 0}).y(), 3, 8 * unit);

  // It even creates energy: m = 1, R = 2, k = 1, xd = 1, at rest otherwise: T1 - T2 = -7/50.
  const Sphere sphere({1, 2, 1});
  const Twist before{{1, 0}, {0, 0, 0}};
  const Twist printed{{4.0 / 5, 0}, {0, 4.0 / 5, 0}};
  EXPECT_NEAR(sphere.kinetic_energy(before) - sphere.kinetic_energy(printed), -7.0 / 50, 8 * unit);
  EXPECT_GT(sphere.kinetic_energy(before), sphere.kinetic_energy(rolled(sphere, before)));
}

TEST(RollingImpulse, StopsTheContactPoint) {
  for (const Case& c : random_cases()) {
    const Sphere sphere(c.body);
    const double slip = sphere.contact_velocity(rolled(sphere, c.twist)).norm();
    EXPECT_LE(slip, 2 * unit * c.size());  // R (v/R): two roundings
  }
}

TEST(RollingImpulse, LeavesARollingSphereAsItIs) {
  for (const Case& c : random_cases()) {
    const Sphere sphere(c.body);
    const Twist once = rolled(sphere, c.twist);
    const Twist twice = rolled(sphere, once);
    EXPECT_LE((twice.velocity - once.velocity).norm(), 16 * unit * c.size());
  }
}

TEST(RollingImpulse, StopsExactlyWhereTheDataSaySo) {
  const Sphere sphere({1, 0.5, 0.25});  // k^2 omega_2 = -R xd
  EXPECT_EQ(sphere.conserved_velocity({{1, 1}, {8, -8, 0.5}}), Vector2d::Zero());
}

TEST(AngularImpulse, IsTheMomentOfTheImpulseAtTheContactPoint) {
  const Sphere sphere({2, 0.25, 0.1});
  const Vector2d P(0.3, -0.7);
  const Vector3d moment = Vector3d(0, 0, -0.25).cross(Vector3d(P.x(), P.y(), 0));
  EXPECT_EQ(sphere.angular_impulse(P), moment);
}

TEST(ContactVelocity, IsThatOfTheLowestMaterialPoint) {
  for (const Case& c : random_cases()) {
    const Vector3d v(c.twist.velocity.x(), c.twist.velocity.y(), 0);
    const Vector3d point = v + c.twist.angular_velocity.cross(Vector3d(0, 0, -c.body.radius));
    EXPECT_LE((Sphere(c.body).contact_velocity(c.twist) - point.head<2>()).norm(), 4 * unit * c.size());
  }
}

TEST(ConservedVelocity, IsTheAngularMomentumAboutTheContactPoint) {
  for (const Case& c : random_cases()) {
    const double k2 = c.body.gyration_radius * c.body.gyration_radius;
    const double R = c.body.radius;
    const Vector3d v(c.twist.velocity.x(), c.twist.velocity.y(), 0);
    const Vector3d momentum = k2 * c.twist.angular_velocity + Vector3d(0, 0, R).cross(v);  // per mass
    const Vector2d expected = Vector2d(momentum.y(), -momentum.x()) * R / (R * R + k2);
    EXPECT_LE((Sphere(c.body).conserved_velocity(c.twist) - expected).norm(), 16 * unit * c.size());
  }
}

TEST(Kappa, IsTwoSeventhsOfASolidAndTwoFifthsOfAHollowSphere) {
  EXPECT_NEAR(Sphere({1, 3, 3 * std::sqrt(2.0 / 5)}).kappa(), 2.0 / 7, 4 * unit);
  EXPECT_NEAR(Sphere({1, 3, 3 * std::sqrt(2.0 / 3)}).kappa(), 2.0 / 5, 4 * unit);
}

// (12), (13): the Lagrangian in the Euler angles z-x-z, and the angular velocity on the fixed axes that
// belongs to them.
TEST(KineticEnergy, IsTheLagrangianInEulerAngles) {
  std::mt19937_64 engine(5);
  std::uniform_real_distribution<double> number(-3, 3);
  for (int i = 0; i < 200; ++i) {
    const scene::SphereBody body{1.75, 0.5, 0.3};
    const double psi = number(engine);
    const double theta = number(engine);
    const Vector3d rates(number(engine), number(engine), number(engine));  // of psi, theta, phi
    const Vector2d v(number(engine), number(engine));
    const Vector3d omega(rates.y() * std::cos(psi) + rates.z() * std::sin(psi) * std::sin(theta),
                         rates.y() * std::sin(psi) - rates.z() * std::cos(psi) * std::sin(theta),
                         rates.x() + rates.z() * std::cos(theta));
    const double lagrangian =
        0.5 * body.mass *
        (v.squaredNorm() + body.gyration_radius * body.gyration_radius *
                               (rates.squaredNorm() + 2 * rates.z() * rates.x() * std::cos(theta)));
    EXPECT_NEAR(Sphere(body).kinetic_energy({v, omega}), lagrangian, 32 * unit * 0.5 * body.mass * 60);
  }
}

TEST(KineticEnergy, LostInTheImpulseIsCarnots) {
  for (const Case& c : random_cases()) {
    const Sphere sphere(c.body);
    const Twist after = rolled(sphere, c.twist);
    const double before = sphere.kinetic_energy(c.twist);
    const Vector2d impulse = sphere.stopping_impulse(sphere.contact_velocity(c.twist));
    const Twist lost{c.twist.velocity - after.velocity, c.twist.angular_velocity - after.angular_velocity};
    const double loss = before - sphere.kinetic_energy(after);
    EXPECT_NEAR(loss, impulse.squaredNorm() / (2 * c.body.mass * sphere.kappa()), 32 * unit * before);
    EXPECT_NEAR(loss, sphere.kinetic_energy(lost), 32 * unit * before);
  }
}

}  // namespace
}  // namespace hybrid_sphere::testing::sphere_test

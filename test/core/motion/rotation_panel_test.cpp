// Against closed forms: a steady precession, and omega linear in time, which is the Landau-Zener problem.

#include "motion/rotation_panel.hpp"

#include <gtest/gtest.h>

#include <cfloat>
#include <cmath>
#include <functional>
#include <random>

#include "core/motion/spinning.hpp"
#include "motion/attitude.hpp"
#include "motion/spin_rules.hpp"

namespace hybrid_sphere::testing::rotation_panel_test {
namespace {

RotationPanel::Spin on_nodes(const SpinFunction& omega, double from, double length) {
  RotationPanel::Spin spin;
  for (int i = 0; i < RotationPanel::size; ++i) {
    spin.row(i) = omega(from + 0.5 * (1 + RotationPanel::node(i)) * length).transpose();
  }
  return spin;
}

double distance(const Quaterniond& a, const Quaterniond& b) { return (a.coeffs() - b.coeffs()).norm(); }

/// omega = exp(rate t e_3) a: the turn is exp(rate t e_3) exp((a - rate e_3) t).
struct Precession {
  Vector3d a;
  double rate;
  Vector3d omega(double t) const {
    const double c = std::cos(rate * t);
    const double s = std::sin(rate * t);
    return {c * a.x() - s * a.y(), s * a.x() + c * a.y(), a.z()};
  }
  Quaterniond turn(double t) const {
    const Vector3d axis = rate * Vector3d::UnitZ();
    return exponential(t * axis) * exponential(t * (a - axis));
  }
};

TEST(RotationPanel, DirectFollowsAPrecession) {
  const Precession motion{{1.2, -0.5, 0.8}, 0.7};
  const auto omega = [&](double t) { return motion.omega(t); };
  const double length = 1.2;
  RotationPanel panel;
  const RotationPanel::Fit fit = panel.fit_direct(on_nodes(omega, 0, length), length);
  EXPECT_NEAR(fit.angle, motion.a.norm() * length, 4 * DBL_EPSILON);
  EXPECT_LE(fit.error, DBL_EPSILON);
  for (const double part : {0.0, 0.123, 0.5, 0.77, 1.0}) {
    const Quaterniond there = panel.at(2 * part - 1);
    EXPECT_LE(distance(there, motion.turn(part * length)), 4 * DBL_EPSILON) << part;
    EXPECT_NEAR(there.norm(), 1, 2 * DBL_EPSILON);
  }
}

polynomials::Powers<3> taylor(const Precession& motion, double middle, double half) {
  polynomials::Powers<3> powers;
  Vector3d omega = motion.omega(middle);
  for (int k = 0; k < polynomials::size; ++k) {
    powers.col(k) = omega;
    omega = motion.rate * half / (k + 1) * Vector3d::UnitZ().cross(omega);
  }
  return powers;
}

TEST(RotationPanel, ExpansionFollowsAPrecession) {
  const Precession motion{{1.2, -0.5, 0.8}, 0.7};
  const Quaterniond start = exponential({0.3, 2, -1});
  const double length = 1.2;
  RotationPanel panel;
  const RotationPanel::Fit fit =
      panel.expand(taylor(motion, 0.5 * length, 0.5 * length), polynomials::size, length, start);
  EXPECT_NEAR(fit.angle, motion.a.norm() * length, 1e-3 * fit.angle);
  EXPECT_NEAR(fit.rate, motion.a.norm(), 4 * DBL_EPSILON);
  EXPECT_LE(fit.error, DBL_EPSILON);
  for (const double part : {0.0, 0.123, 0.5, 0.77, 1.0}) {
    const Quaterniond there = panel.at(2 * part - 1);
    EXPECT_LE(distance(there, motion.turn(part * length) * start), 4 * DBL_EPSILON) << part;
    EXPECT_NEAR(there.norm(), 1, 2 * DBL_EPSILON);
  }
}

TEST(RotationPanel, ExpansionIsWithinItsErrorEstimate) {
  for (double length = 0.5; length < 8; length *= 1.1) {
    for (const double rate : {0.0, 0.1, 0.7, 3.0}) {
      const Precession motion{{1.2, -0.5, 0.8}, rate};
      RotationPanel panel;
      const RotationPanel::Fit fit =
          panel.expand(taylor(motion, 0.5 * length, 0.5 * length), polynomials::size, length);
      const double error = distance(panel.at(1), motion.turn(length));
      EXPECT_LE(error, fit.error + 16 * DBL_EPSILON) << length << ", " << rate;
    }
  }
}

TEST(RotationPanel, SlowFollowsAPrecessionByAnyAngle) {
  for (const double size : {70.0, 1e3, 1e6, 1e9}) {
    const Precession motion{size * Vector3d(0.6, -0.48, 0.64), 0.7};
    const auto omega = [&](double t) { return motion.omega(t); };
    RotationPanel panel;
    const RotationPanel::Fit fit = panel.fit_slow(on_nodes(omega, 0, 1), 1);
    EXPECT_NEAR(fit.angle, size, 1e-13 * size);
    EXPECT_LE(fit.error, 1e-16 * size);
    for (const double part : {0.0, 0.123, 0.5, 0.77, 1.0}) {
      EXPECT_LE(distance(panel.at(2 * part - 1), motion.turn(part)), 8 * DBL_EPSILON * size) << size;
    }
  }
}

// The frame of a slow panel has its third axis along omega, which is a special case of its formula opposite
// to e_3.
TEST(RotationPanel, SlowTurnsAboutAnyAxisCloseToTheThird) {
  constexpr double size = 100;
  for (const double sign : {1.0, -1.0}) {
    for (const double tilt : {0.0, 1e-300, 1e-18, 1e-15, 1e-12, 1e-9, 1e-7, 1e-6, 1.3e-6, 2e-6, 1e-3}) {
      for (const Vector3d& side : {Vector3d(1, 0, 0), Vector3d(0, -1, 0), Vector3d(0.6, -0.8, 0)}) {
        const Vector3d axis = (sign * Vector3d::UnitZ() + tilt * side).normalized();
        RotationPanel panel;
        const RotationPanel::Fit fit = panel.fit_slow(on_nodes([&](double) { return size * axis; }, 0, 1), 1);
        EXPECT_NEAR(fit.angle, size, 1e-13 * size);
        for (const double part : {0.0, 0.5, 1.0}) {
          EXPECT_LE(distance(panel.at(2 * part - 1), exponential(part * size * axis)), 8 * DBL_EPSILON * size)
              << axis.transpose() << ", " << part;
        }
      }
    }
  }
}

// A polynomial of degree 5 in every component, of any strength: half the panel, twice, is the reference.
TEST(RotationPanel, IsWithinItsErrorEstimate) {
  std::mt19937_64 engine(3);
  std::normal_distribution<double> any;
  int judged = 0;
  for (int i = 0; i < 300; ++i) {
    Eigen::Matrix<double, 3, 6> c;
    for (double& x : c.reshaped()) x = any(engine);
    const auto omega = [&](double t) {
      Vector3d sum = c.col(5);
      for (int k = 4; k >= 0; --k) sum = t * sum + c.col(k);
      return sum;
    };
    const double length = 2 * std::uniform_real_distribution<double>(0, 1)(engine);
    RotationPanel whole;
    RotationPanel first;
    RotationPanel second;
    const RotationPanel::Fit fit = whole.fit_direct(on_nodes(omega, 0, length), length);
    if (!(fit.error < 1e-3)) continue;
    ++judged;
    first.fit_direct(on_nodes(omega, 0, 0.5 * length), 0.5 * length);
    second.fit_direct(on_nodes(omega, 0.5 * length, 0.5 * length), 0.5 * length);
    EXPECT_LE(distance(whole.at(1), second.at(1) * first.at(1)), 2 * fit.error + 16 * DBL_EPSILON) << i;
  }
  EXPECT_GE(judged, 100);
}

TEST(RotationPanel, SaysWhereASlowSolutionIsNone) {
  const Precession turning{{3, 0, 1}, 50};
  RotationPanel panel;
  const auto omega = [&](double t) { return turning.omega(t); };
  EXPECT_GT(panel.fit_slow(on_nodes(omega, 0, 20), 20).error, 1e-3);
  const auto reverses = [](double t) { return Vector3d(1, 0, 100 * (0.5 - t)); };
  EXPECT_GT(panel.fit_slow(on_nodes(reverses, 0, 1), 1).error, 1e-3);
}

/// omega = (4, 2 + 3.57 t, -2) rad/s. Printed by test/references/make_spin_references.
struct LinearSpin {
  double time;
  double angle;
  Quaterniond turn;
};
const LinearSpin linear_spins[] = {
    {1,
     5.97,
     {-0.9549677389992038477, -0.008040634544554207224, 0.1432577814790267727, -0.2597097874793647704}},
    {748,
     1.0002e6,
     {0.04599377127303599575, -0.4215828622554576214, -0.8436071481334732833, 0.3293621758409540851}},
    {23668,
     9.9994e8,
     {-0.8408060154998144325, -0.349257327053190986306, -0.0871088424711284210697, -0.404322412639130822795}},
    {748455,
     9.9992e11,
     {-0.596297235838392864963, -0.526251092454321046153, -0.599124161838661057648,
      -0.0924101317172969858141}},
};

TEST(Attitude, CostsNoMoreForALargerAngle) {
  for (const LinearSpin& spin : linear_spins) {
    Spinning motion([](double t) { return Vector3d(4, 2 + 3.57 * t, -2); });
    Attitude attitude;
    attitude.begin(Quaterniond::Identity(), motion);
    const Quaterniond there = attitude.at(spin.time, motion);
    // 4e-16 of the angle, half of it in a quaternion.
    EXPECT_LE(distance(there, spin.turn), 2e-16 * spin.angle + 8 * DBL_EPSILON) << spin.angle;
    EXPECT_LE(motion.asked, 3000) << spin.angle;
  }
}

}  // namespace
}  // namespace hybrid_sphere::testing::rotation_panel_test

// Points well inside of second-order cones, beside closed forms and as the cones' inside vanishes.
#include "mechanics/inside_cones.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace hybrid_sphere::mechanics::inside_cones_test {
namespace {

using Cones = std::vector<SecondOrderCone>;

/// u + s x >= 0 on a line.
SecondOrderCone half_line(double u, double s) { return {u, Vector::Constant(1, s), Vector(), Matrix(0, 1)}; }

/// abs(x - centre) <= radius in a plane.
SecondOrderCone disc(const Eigen::Vector2d& centre, double radius) {
  return {radius, Vector::Zero(2), -centre, Matrix::Identity(2, 2)};
}

double left(const SecondOrderCone& cone, const Vector& x) {
  return cone.u + cone.s.dot(x) - (cone.w + cone.B * x).norm();
}

TEST(InsideCones, IsTheMinimumOfTheBarrier) {
  // x - part (2/(x - 1) - 2/(3 - x)) = 0 between 1 and 3, with half-lines in place of cones.
  const Vector x = inside_cones({half_line(-1, 1), half_line(3, -1)}, 1);
  EXPECT_NEAR(x[0] - 0.01 * (2 / (x[0] - 1) - 2 / (3 - x[0])), 0, 1e-14);
  EXPECT_GT(x[0], 1);
}

TEST(InsideCones, StaysNearZeroWhereThatIsWellInside) {
  const Vector x = inside_cones({disc({0.5, 0}, 2)}, 2);
  EXPECT_LT(x.norm(), 0.01);
  EXPECT_EQ(inside_cones({}, 3), Vector::Zero(3));
}

TEST(InsideCones, StaysInsideAsLittleAsThereIs) {
  for (double width = 0.01; width > 1e-12; width /= 10) {
    const Cones interval{half_line(-1, 1), half_line(1 + width, -1)};
    const double x = inside_cones(interval, 1)[0] - 1;
    EXPECT_GT(x, 0.2 * width) << width;
    EXPECT_LT(x, 0.8 * width) << width;
    const Cones lens{disc({-1, 0}, 1 + width / 2), disc({1, 0}, 1 + width / 2)};
    const Vector there = inside_cones(lens, 2);
    for (const SecondOrderCone& cone : lens) EXPECT_GT(left(cone, there), 0.1 * width) << width;
  }
}

TEST(InsideCones, MissesLeastWhereThereIsNoInside) {
  for (const double gap : {1e-9, 1e-3, 1.0}) {
    const Cones apart{disc({-1, 0}, 1 - gap / 2), disc({1, 0}, 1 - gap / 2)};
    const Vector x = inside_cones(apart, 2);
    for (const SecondOrderCone& cone : apart) EXPECT_NEAR(left(cone, x), -gap / 2, 1e-8 * gap + 1e-13) << gap;
  }
}

TEST(InsideCones, FindsAnInsideOfRandomConesThatHaveOne) {
  std::mt19937 random(11);
  std::normal_distribution<double> number;
  const auto matrix = [&](Index rows, Index cols) {
    return Matrix(Matrix::NullaryExpr(rows, cols, [&] { return number(random); }));
  };
  for (int trial = 0; trial < 300; ++trial) {
    const Index k = 1 + trial % 4;
    const Vector known = matrix(k, 1);
    Cones cones;
    for (int i = 0; i < 6; ++i) {
      const Index m = i % 3;
      SecondOrderCone cone{0, matrix(k, 1), matrix(m, 1), matrix(m, k)};
      cone.u = (cone.w + cone.B * known).norm() - cone.s.dot(known) + std::pow(10.0, -(trial % 6));
      cones.push_back(cone);
    }
    const Vector x = inside_cones(cones, k);
    for (const SecondOrderCone& cone : cones) EXPECT_GT(left(cone, x), 0) << trial;
  }
}

TEST(InsideCones, ChangesSmoothlyWithTheCones) {
  constexpr double h = 1e-4;
  const auto at = [](double t) {
    return inside_cones({disc({std::sin(t), 0}, 1), disc({0, 2 * std::cos(t)}, 1.5), disc({1, 1}, 1)}, 2);
  };
  for (double t = 0; t < 1; t += 0.05) {
    const Vector second = at(t + h) - 2 * at(t) + at(t - h);
    EXPECT_LT(second.norm(), 1e3 * h * h) << t;
  }
}

}  // namespace
}  // namespace hybrid_sphere::mechanics::inside_cones_test

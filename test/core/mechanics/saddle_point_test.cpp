// Against the equations themselves, solutions chosen first, and other units.

#include "mechanics/saddle_point.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cfloat>
#include <cmath>

#include "core/mechanics/saddle_point_problem.hpp"

namespace hybrid_sphere::testing::saddle_point_test {
namespace {

using namespace mechanics;
using Outcome = SaddlePoint::Outcome;

/// How far (x, y) is off both equations, in roundings of the largest of their terms.
double residual_in_roundings(const SaddlePointProblem& problem, const SaddlePointAnswer& answer) {
  const Vector first = problem.mass * answer.x - problem.gradient.transpose() * answer.y - problem.h;
  const Vector second = problem.gradient * answer.x - problem.gamma;
  const double first_size =
      problem.mass.norm() * answer.x.norm() + problem.gradient.norm() * answer.y.norm() + problem.h.norm();
  const double second_size = problem.gradient.norm() * answer.x.norm() + problem.gamma.norm();
  const double second_part = second.size() > 0 ? second.norm() / second_size : 0;
  return std::max(first.norm() / first_size, second_part) / DBL_EPSILON;
}

TEST(SaddlePoint, SolvesBothEquations) {
  RandomMatrices random;
  double largest = 0;
  for (Index n = 1; n <= 12; ++n) {
    for (Index g = 0; g <= n; ++g) {
      const SaddlePointProblem problem{random.mass(n), random.matrix(g, n), random.vector(n),
                                       random.vector(g)};
      const SaddlePointAnswer answer = answer_to(problem);
      ASSERT_EQ(answer.outcome, Outcome::regular) << n << " velocities, " << g << " constraints";
      EXPECT_EQ(answer.rank, g);
      largest = std::max(largest, residual_in_roundings(problem, answer));
    }
  }
  // Householder's and Cholesky's decompositions are backward stable, with less than a rounding of the largest
  // element for each of the 12 unknowns, in scales of the mass matrix that differ by less than 4 here.
  EXPECT_LE(largest, 4 * 12);
}

TEST(SaddlePoint, FindsTheSolutionThatTheProblemIsMadeOf) {
  Matrix mass(3, 3);
  mass << 4, 1, 0, 1, 3, 1, 0, 1, 2;
  Matrix gradient(2, 3);
  gradient << 1, 0, 2, 0, 1, -1;
  const Vector x = Eigen::Vector3d(1, -2, 0.5);
  const Vector y = Eigen::Vector2d(3, -1);
  const SaddlePointAnswer answer = answer_to(with_solution(mass, gradient, x, y));
  ASSERT_EQ(answer.outcome, Outcome::regular);
  // The condition number is below 10, of 5 unknowns.
  EXPECT_LE((answer.x - x).norm(), 50 * DBL_EPSILON);
  EXPECT_LE((answer.y - y).norm(), 50 * DBL_EPSILON);
}

// A velocity without mass, whose constraint gives it its scale, in each place of the order.
TEST(SaddlePoint, FindsAVelocityWithoutMassWhereverItStands) {
  for (Index massless = 0; massless < 3; ++massless) {
    Matrix mass = Eigen::Vector3d(4, 3, 2).asDiagonal();
    mass(massless, massless) = 0;
    Matrix gradient = Matrix::Ones(1, 3);
    gradient(0, massless) = 1e-6;
    const Vector x = Eigen::Vector3d(1, -2, 0.5);
    const Vector y = Vector::Constant(1, 3);
    const SaddlePointAnswer answer = answer_to(with_solution(mass, gradient, x, y));
    ASSERT_EQ(answer.outcome, Outcome::regular) << massless;
    // In scales of its own the condition number is below 10, of 4 unknowns; gamma is rounded beside 1e-6 x.
    for (Index i = 0; i < 3; ++i) {
      EXPECT_NEAR(answer.x[i], x[i], (i == massless ? 1e6 : 1) * 40 * DBL_EPSILON) << massless;
    }
    EXPECT_NEAR(answer.y[0], 3, 1e6 * 40 * DBL_EPSILON) << massless;
  }
}

TEST(SaddlePoint, LeavesASystemWithoutConstraintsToTheMassMatrix) {
  RandomMatrices random;
  const Matrix mass = random.mass(5);
  const Vector x = random.vector(5);
  const SaddlePointAnswer answer = answer_to({mass, Matrix(0, 5), mass * x, Vector(0)});
  ASSERT_EQ(answer.outcome, Outcome::regular);
  EXPECT_EQ(answer.y.size(), 0);
  EXPECT_EQ(answer.rank, 0);
  // Eigenvalues from 1 to about 20.
  EXPECT_LE((answer.x - x).norm(), 20 * 5 * DBL_EPSILON * x.norm());
}

TEST(SaddlePoint, SolvesOneProblemAfterTheOtherOfWhateverSize) {
  RandomMatrices random;
  SaddlePoint saddle_point;
  Vector x;
  Vector y;
  for (const auto& [n, g] : {std::pair<Index, Index>{3, 1}, {7, 4}, {2, 2}, {4, 0}, {3, 1}, {6, 6}}) {
    const SaddlePointProblem problem{random.mass(n), random.matrix(g, n), random.vector(n), random.vector(g)};
    ASSERT_EQ(saddle_point.solve(problem.mass, problem.gradient, problem.h, problem.gamma, x, y),
              Outcome::regular);
    const SaddlePointAnswer alone = answer_to(problem);
    EXPECT_EQ(x, alone.x);
    EXPECT_EQ(y, alone.y);
  }
}

/// The problem in other units: x = S x', row b of C times factor b.
SaddlePointProblem in_units(const SaddlePointProblem& problem, const Vector& velocities, const Vector& rows) {
  return {velocities.asDiagonal() * problem.mass * velocities.asDiagonal(),
          rows.asDiagonal() * problem.gradient * velocities.asDiagonal(), velocities.cwiseProduct(problem.h),
          rows.cwiseProduct(problem.gamma)};
}

TEST(SaddlePoint, GivesTheSameBitsInUnitsThatArePowersOfTwo) {
  RandomMatrices random;
  const SaddlePointProblem problem{random.mass(4), random.matrix(2, 4), random.vector(4), random.vector(2)};
  const Vector velocities = Eigen::Vector4d(0x1p-20, 1, 0x1p30, 8);
  const Vector rows = Eigen::Vector2d(0x1p-40, 0x1p25);
  const SaddlePointAnswer answer = answer_to(problem);
  const SaddlePointAnswer other = answer_to(in_units(problem, velocities, rows));
  ASSERT_EQ(other.outcome, Outcome::regular);
  EXPECT_EQ(Vector(velocities.cwiseProduct(other.x)), answer.x);
  EXPECT_EQ(Vector(rows.cwiseProduct(other.y)), answer.y);
  EXPECT_EQ(other.regularity, answer.regularity);
}

TEST(SaddlePoint, DecidesAlikeInGramsKilometresAndConstraintsTimesAMillion) {
  RandomMatrices random;
  const Vector velocities = Eigen::Vector4d(1e3, 1e-3, 1e6, 1);
  const Vector rows = Eigen::Vector3d(1e6, 1, 1e-9);
  for (int i = 0; i < 40; ++i) {
    SaddlePointProblem problem{random.mass(4), random.matrix(3, 4), random.vector(4), random.vector(3)};
    if (i % 4 == 1) problem.gradient.row(2) = 0.3 * problem.gradient.row(0) - 2 * problem.gradient.row(1);
    if (i % 4 == 2) problem.gradient.row(2) = problem.gradient.row(0) / 3;
    if (i % 4 == 2) problem.gamma[2] = problem.gamma[0] / 3;
    if (i % 4 == 3) problem.mass.row(1).setZero();
    if (i % 4 == 3) problem.mass.col(1).setZero();
    const SaddlePointAnswer answer = answer_to(problem);
    const SaddlePointAnswer other = answer_to(in_units(problem, velocities, rows));
    EXPECT_EQ(other.outcome, answer.outcome);
    EXPECT_EQ(other.rank, answer.rank);
    EXPECT_EQ(other.conflict, answer.conflict);
    if (answer.outcome == Outcome::inconsistent) continue;
    // x does not depend on the units, y of redundant rows does. Condition numbers are below 1e3.
    EXPECT_LE((velocities.cwiseProduct(other.x) - answer.x).norm(), 1e4 * DBL_EPSILON * answer.x.norm());
    if (answer.outcome != Outcome::regular) continue;
    EXPECT_LE((rows.cwiseProduct(other.y) - answer.y).norm(), 1e4 * DBL_EPSILON * answer.y.norm());
  }
}

/// Two velocities whose masses are nearly bound to each other: eigenvalues 2 - delta and delta.
Matrix nearly_singular_mass(double delta) {
  Matrix mass = Matrix::Identity(3, 3);
  mass(0, 1) = mass(1, 0) = 1 - delta;
  return mass;
}

TEST(SaddlePoint, SolvesABadlyConditionedMassToTheAccuracyThatItHas) {
  const double delta = 0x1p-33;  // 1.2e-10; 1 - delta is a number of the machine
  const Matrix mass = nearly_singular_mass(delta);
  for (const auto& [a, b] : {std::pair<double, double>{1, 0}, {1, 1}, {0.25, 0.75}}) {
    Matrix gradient(1, 3);
    gradient << a, b, 1;
    const Vector x = Eigen::Vector3d(1, -0.5, 2);
    const Vector y = Vector::Constant(1, 3);
    const SaddlePointAnswer answer = answer_to(with_solution(mass, gradient, x, y));
    ASSERT_EQ(answer.outcome, Outcome::regular);
    // Roundings of h, of the size of its terms, divided by the smallest eigenvalue.
    EXPECT_LE((answer.x - x).norm(), 10 * DBL_EPSILON / delta * x.norm());
    EXPECT_LE(
        (mass * answer.x - gradient.transpose() * answer.y - (mass * x - gradient.transpose() * y)).norm(),
        20 * DBL_EPSILON * x.norm());
    EXPECT_LE(std::abs((gradient * (answer.x - x))[0]), 20 * DBL_EPSILON * x.norm());
  }
}

// In the metric of this M the rows are nearly parallel, 1e-5 off; they are not dependent for that.
TEST(SaddlePoint, DoesNotTakeRowsAsDependentBecauseTheMassIsNearlySingular) {
  Matrix gradient(2, 3);
  gradient << 1, 0, 0, 0, 1, 0;
  for (const double delta : {0x1p-10, 0x1p-33, 0x1p-45, 0.0}) {
    const SaddlePointAnswer answer = answer_to(
        {nearly_singular_mass(delta), gradient, Eigen::Vector3d(1, 2, 3), Eigen::Vector2d(0.5, -0.25)});
    ASSERT_EQ(answer.outcome, Outcome::regular) << delta;
    EXPECT_EQ(answer.x, Eigen::Vector3d(0.5, -0.25, 3));
  }
}

// M = [1 0 c; 0 1 0; c 0 1] of Euler angles has the pivots 1, 1, 1 - c^2 = sin^2(theta).
TEST(SaddlePoint, MeasuresTheRegularityOfEulerAngles) {
  for (const double theta : {1.5, 0.5, 1e-2, 1e-4, 1e-6}) {
    Matrix mass = 0.0625 * Matrix::Identity(3, 3);
    mass(0, 2) = mass(2, 0) = 0.0625 * std::cos(theta);
    const SaddlePointAnswer answer = answer_to({mass, Matrix(0, 3), Vector::Ones(3), Vector(0)});
    ASSERT_EQ(answer.outcome, Outcome::regular) << theta;
    const double expected = std::sin(theta) * std::sin(theta);
    EXPECT_NEAR(answer.regularity, expected, 3 * DBL_EPSILON) << theta;
  }
}

TEST(SaddlePoint, FindsAStepOfNewtonsMethodOnAnotherHessianMatrix) {
  RandomMatrices random;
  const Matrix mass = random.mass(4);
  const Matrix gradient = random.matrix(2, 4);
  // Negative along a row of C, so not definite, yet definite on the kernel.
  const Matrix hessian = mass - 50 * gradient.transpose() * gradient;
  const Vector x = random.vector(4);
  const Vector y = random.vector(2);
  const SaddlePointProblem problem = with_solution(hessian, gradient, x, y);
  SaddlePoint saddle_point;
  Vector found_x;
  Vector found_y;
  ASSERT_EQ(saddle_point.solve_step(mass, hessian, gradient, problem.h, problem.gamma, Vector::Zero(2),
                                    found_x, found_y),
            Outcome::regular);
  const double condition = 1e3;  // of the whole matrix, by far
  EXPECT_LE((found_x - x).norm(), condition * DBL_EPSILON * hessian.norm());
  EXPECT_LE((found_y - y).norm(), condition * DBL_EPSILON * hessian.norm());
  EXPECT_EQ(saddle_point.solve_step(mass, -mass, gradient, problem.h, problem.gamma, Vector::Zero(2), found_x,
                                    found_y),
            Outcome::singular);
}

TEST(SaddlePoint, MeasuresLengthsInTheMetricOfTheDiagonalOfM) {
  SaddlePoint saddle_point;
  Matrix mass = Matrix::Identity(3, 3);
  mass(0, 0) = 0x1p-10;
  mass(1, 1) = 0x1p+20;
  saddle_point.find_rank(mass, Matrix(0, 3));
  EXPECT_EQ(saddle_point.length(Eigen::Vector3d(0x1p+5, 0, 0)), 1);
  EXPECT_EQ(saddle_point.length(Eigen::Vector3d(3 * 0x1p+5, 4 * 0x1p-10, 0)), 5);
}

}  // namespace
}  // namespace hybrid_sphere::testing::saddle_point_test

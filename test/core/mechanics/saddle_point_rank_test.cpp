// Redundant and contradictory rows of C, and mass matrices that are singular.

#include <gtest/gtest.h>

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <numeric>

#include "core/mechanics/saddle_point_problem.hpp"
#include "mechanics/decompositions/least_norm.hpp"
#include "mechanics/saddle_point.hpp"

namespace hybrid_sphere::testing::saddle_point_rank_test {
namespace {

using namespace mechanics;
using Outcome = SaddlePoint::Outcome;

Matrix row_matrix(std::initializer_list<Eigen::RowVector3d> rows) {
  Matrix matrix(static_cast<Index>(rows.size()), 3);
  Index b = 0;
  for (const Eigen::RowVector3d& row : rows) matrix.row(b++) = row;
  return matrix;
}

// f and 2 f: lambda/5 and 2 lambda/5.
TEST(RedundantRows, ShareTheMultiplierByTheLeastNorm) {
  const Matrix mass = Eigen::Vector3d(2, 3, 5).asDiagonal();
  const Vector h = Eigen::Vector3d(1, -1, 4);
  const Eigen::RowVector3d f(0.3, -0.7, 1.1);
  const SaddlePointAnswer once = answer_to({mass, row_matrix({f}), h, Vector::Constant(1, 0.9)});
  const SaddlePointAnswer twice = answer_to({mass, row_matrix({f, 2 * f}), h, Eigen::Vector2d(0.9, 1.8)});
  ASSERT_EQ(once.outcome, Outcome::regular);
  ASSERT_EQ(twice.outcome, Outcome::redundant);
  EXPECT_EQ(twice.rank, 1);
  EXPECT_LE((twice.x - once.x).norm(), 8 * DBL_EPSILON * once.x.norm());
  EXPECT_NEAR(twice.y[0], once.y[0] / 5, 8 * DBL_EPSILON * std::abs(once.y[0]));
  EXPECT_NEAR(twice.y[1], 2 * once.y[0] / 5, 8 * DBL_EPSILON * std::abs(once.y[0]));
}

TEST(RedundantRows, HaveTheMultipliersOfLeastNormWhateverTheirNumber) {
  RandomMatrices random;
  for (Index n = 2; n <= 6; ++n) {
    for (Index rank = 1; rank <= n; ++rank) {
      const Matrix mass = random.mass(n);
      const Matrix gradient = random.matrix(rank + 3, rank) * random.matrix(rank, n);
      const Vector x = random.vector(n);
      const Vector y = random.vector(rank + 3);
      const SaddlePointAnswer answer = answer_to(with_solution(mass, gradient, x, y));
      ASSERT_EQ(answer.outcome, Outcome::redundant) << n << ", " << rank;
      EXPECT_EQ(answer.rank, rank);
      const Vector least = LeastNorm(gradient.transpose()).solve(gradient.transpose() * y);
      // Products of random matrices have condition numbers up to some 1e3, their decompositions squares of
      // it in part.
      EXPECT_LE((answer.x - x).norm(), 1e5 * DBL_EPSILON * x.norm()) << n << ", " << rank;
      EXPECT_LE((answer.y - least).norm(), 1e6 * DBL_EPSILON * y.norm()) << n << ", " << rank;
    }
  }
}

TEST(RedundantRows, MayDifferByRoundingsOfTheFormulasTheyComeFrom) {
  // One wheel, and the same on the other side of the axle, whose formula adds up another way.
  for (int i = 0; i < 200; ++i) {
    const double theta = 0.1 + 0.7 * i;
    const double pi = std::acos(-1.0);
    const Eigen::RowVector3d left(-std::sin(theta), std::cos(theta), 0);
    const Eigen::RowVector3d right(std::cos(theta + pi / 2), std::sin(theta + pi / 2), 0);
    const Vector gamma =
        Eigen::Vector2d(left * Eigen::Vector3d(0.2, 0.9, 0), right * Eigen::Vector3d(0.2, 0.9, 0));
    const Matrix mass = Eigen::Vector3d(2, 2, 0.5).asDiagonal();
    const SaddlePointAnswer answer =
        answer_to({mass, row_matrix({left, right}), Eigen::Vector3d(1, 2, 3), gamma});
    ASSERT_EQ(answer.outcome, Outcome::redundant) << "theta = " << theta;
    EXPECT_EQ(answer.rank, 1);
    // The rows differ by the rounding of theta, and each has half.
    EXPECT_NEAR(answer.y[0], answer.y[1], 16 * DBL_EPSILON * (theta + 1) * std::abs(answer.y[0]));
  }
}

TEST(RedundantRows, AreTheRowsOfZerosToo) {
  const Matrix mass = Matrix::Identity(3, 3);
  const Vector h = Eigen::Vector3d(1, 2, 3);
  const SaddlePointAnswer alone = answer_to({mass, Matrix::Zero(1, 3), h, Vector::Zero(1)});
  ASSERT_EQ(alone.outcome, Outcome::redundant);
  EXPECT_EQ(alone.rank, 0);
  EXPECT_EQ(alone.x, h);
  EXPECT_EQ(alone.y, Vector::Zero(1));
  const SaddlePointAnswer beside =
      answer_to({mass, row_matrix({{0, 0, 0}, {0, 2, 0}}), h, Eigen::Vector2d(0, 1)});
  ASSERT_EQ(beside.outcome, Outcome::redundant);
  EXPECT_EQ(beside.rank, 1);
  EXPECT_EQ(beside.x, Eigen::Vector3d(1, 0.5, 3));
  EXPECT_EQ(beside.y, Eigen::Vector2d(0, -0.75));
  const SaddlePointAnswer wanted =
      answer_to({mass, row_matrix({{0, 0, 0}, {0, 2, 0}}), h, Eigen::Vector2d(1, 1)});
  EXPECT_EQ(wanted.outcome, Outcome::inconsistent);
  EXPECT_EQ(wanted.conflict, std::vector<Index>{0});
}

TEST(RedundantRows, AreToldByTheRoundingsThatGammaIsSaidToHave) {
  const Matrix mass = Matrix::Identity(3, 3);
  const Matrix gradient = row_matrix({{1, 0, 0}, {2, 0, 0}});
  const Vector gamma = Eigen::Vector2d(1e-16, -1e-16);
  SaddlePoint saddle_point;
  Vector x;
  Vector y;
  EXPECT_EQ(saddle_point.solve(mass, gradient, Vector::Zero(3), gamma, x, y), Outcome::inconsistent);
  const Vector size = Eigen::Vector2d(1, 2);
  EXPECT_EQ(saddle_point.solve(mass, gradient, Vector::Zero(3), gamma, x, y, &size), Outcome::redundant);
}

/// The conflict of rows whose order is changed, in the numbers that the rows had before.
std::vector<Index> conflict_in_order(const Matrix& gradient, const Vector& gamma,
                                     const std::vector<Index>& order) {
  Matrix rows = gradient;
  Vector values = gamma;
  for (std::size_t b = 0; b < order.size(); ++b) {
    rows.row(static_cast<Index>(b)) = gradient.row(order[b]);
    values[static_cast<Index>(b)] = gamma[order[b]];
  }
  Matrix mass = Matrix::Identity(3, 3);
  mass(0, 1) = mass(1, 0) = 0.4;
  SaddlePointAnswer answer = answer_to({mass, rows, Eigen::Vector3d(1, 2, 3), values});
  EXPECT_EQ(answer.outcome, Outcome::inconsistent);
  std::vector<Index> conflict;
  for (const Index b : answer.conflict) conflict.push_back(order[static_cast<std::size_t>(b)]);
  std::sort(conflict.begin(), conflict.end());
  return conflict;
}

void expect_conflict(const Matrix& gradient, const Vector& gamma, const std::vector<Index>& expected) {
  std::vector<Index> order(static_cast<std::size_t>(gradient.rows()));
  std::iota(order.begin(), order.end(), 0);
  do {
    EXPECT_EQ(conflict_in_order(gradient, gamma, order), expected);
  } while (std::next_permutation(order.begin(), order.end()));
}

TEST(Inconsistency, NamesTheRowsInConflictAndNoOthers) {
  const Eigen::RowVector3d a(1, 0, 0), b(0.6, 0.8, 0), c(0.5, 0.1, 1e6);
  expect_conflict(row_matrix({a, a}), Eigen::Vector2d(0, 1), {0, 1});
  expect_conflict(row_matrix({a, 1e9 * a, b}), Eigen::Vector3d(0, 1, 2), {0, 1});
  expect_conflict(row_matrix({b, a, a}), Eigen::Vector3d(5, 0, 1), {1, 2});
  expect_conflict(row_matrix({a, b, a + b, c}), Eigen::Vector4d(1, 2, 3.5, 7), {0, 1, 2});
  // a twice without, b twice with contradiction
  expect_conflict(row_matrix({a, 3 * a, b, -b}), Eigen::Vector4d(1, 3, 1, 1), {2, 3});
  // c is wanted differently, too
  expect_conflict(row_matrix({a, a, c, c}), Eigen::Vector4d(0, 1, 0, 1e3), {0, 1, 2, 3});
}

// Random rows of which some are sums of others; whatever is consistent is not in conflict.
TEST(Inconsistency, IsNotSeenInRoundings) {
  RandomMatrices random;
  for (int i = 0; i < 200; ++i) {
    Matrix gradient = random.matrix(4, 6);
    gradient.row(2) = gradient.row(0) / 3;
    gradient.row(3) = 0.1 * gradient.row(1) - 1e5 * gradient.row(0);
    const Vector x = random.vector(6);
    const SaddlePointAnswer answer = answer_to({random.mass(6), gradient, random.vector(6), gradient * x});
    EXPECT_EQ(answer.outcome, Outcome::redundant);
    EXPECT_EQ(answer.rank, 2);
  }
}

TEST(Inconsistency, IsSeenWhereItIsSmallAndLeavesTheResultsAlone) {
  for (const double gap : {1.0, 1e-3, 1e-6, 1e-9}) {
    SaddlePoint saddle_point;
    Vector x = Vector::Constant(3, 7);
    Vector y = Vector::Constant(2, 8);
    const auto outcome = saddle_point.solve(Matrix::Identity(3, 3), row_matrix({{1, 0, 0}, {1, 0, 0}}),
                                            Vector::Zero(3), Eigen::Vector2d(1, 1 + gap), x, y);
    EXPECT_EQ(outcome, Outcome::inconsistent) << "gap " << gap;
    EXPECT_EQ(x, Vector::Constant(3, 7));
    EXPECT_EQ(y, Vector::Constant(2, 8));
  }
}

TEST(Inconsistency, GivesLeastSquaresToAStepOfNewtonsMethod) {
  SaddlePoint saddle_point;
  Vector x;
  Vector y;
  const Matrix mass = Matrix::Identity(3, 3);
  EXPECT_EQ(saddle_point.solve_step(mass, mass, row_matrix({{1, 0, 0}, {1, 0, 0}}), Eigen::Vector3d(0, 5, 6),
                                    Eigen::Vector2d(1, 2), Vector::Zero(2), x, y),
            Outcome::inconsistent);
  EXPECT_LE((x - Eigen::Vector3d(1.5, 5, 6)).norm(), 16 * DBL_EPSILON);
}

TEST(SingularMass, IsRefusedWhereTheConstraintsLeaveItFree) {
  Matrix euler = Matrix::Identity(3, 3);
  euler(0, 2) = euler(2, 0) = 1;  // Euler angles at theta = 0
  const Vector h = Eigen::Vector3d(1, 2, 3);
  EXPECT_EQ(answer_to({euler, Matrix(0, 3), h, Vector(0)}).outcome, Outcome::singular);
  EXPECT_EQ(answer_to({euler, row_matrix({{0, 1, 0}}), h, Vector::Ones(1)}).outcome, Outcome::singular);
  EXPECT_EQ(answer_to({euler, row_matrix({{1, 0, 1}}), h, Vector::Ones(1)}).outcome, Outcome::singular);
  EXPECT_EQ(answer_to({Matrix::Zero(3, 3), Matrix(0, 3), h, Vector(0)}).outcome, Outcome::singular);
  euler(0, 2) = euler(2, 0) = 1 - DBL_EPSILON;
  EXPECT_EQ(answer_to({euler, Matrix(0, 3), h, Vector(0)}).outcome, Outcome::singular);
  const SaddlePointAnswer indefinite =
      answer_to({Eigen::Vector3d(1, -1, 1).asDiagonal(), row_matrix({{1, 0, 0}}), h, Vector::Ones(1)});
  EXPECT_EQ(indefinite.outcome, Outcome::singular);
  EXPECT_EQ(indefinite.regularity, 0);
}

TEST(SingularMass, IsMadeRegularByConstraints) {
  Matrix euler = Matrix::Identity(3, 3);
  euler(0, 2) = euler(2, 0) = 1;
  // x0 - x2 = 3; the sum is left to the mass: 2 (x0 + x2) = 1 + 3.
  const SaddlePointAnswer angles =
      answer_to({euler, row_matrix({{1, 0, -1}}), Eigen::Vector3d(1, 2, 3), Vector::Constant(1, 3)});
  ASSERT_EQ(angles.outcome, Outcome::regular);
  EXPECT_LE((angles.x - Eigen::Vector3d(2.5, 2, -0.5)).norm(), 20 * DBL_EPSILON);
  EXPECT_NEAR(angles.y[0], 1, 20 * DBL_EPSILON);
  EXPECT_EQ(angles.regularity, 1);

  // A massless velocity: m x0' = lambda + h0, 0 = -2 lambda + h1, x0 - 2 x1 = 0.
  const Matrix massless = Eigen::Vector3d(4, 0, 1).asDiagonal();
  for (const double unit : {1.0, 1e-6, 1e7}) {
    const SaddlePointAnswer answer = answer_to(
        {massless, row_matrix({{1, -2 * unit, 0}}), Eigen::Vector3d(3, 2 * unit, 5), Vector::Zero(1)});
    ASSERT_EQ(answer.outcome, Outcome::regular) << unit;
    EXPECT_NEAR(answer.x[0], 1, 20 * DBL_EPSILON);
    EXPECT_NEAR(answer.x[1], 0.5 / unit, 20 * DBL_EPSILON / unit);
    EXPECT_NEAR(answer.x[2], 5, 20 * DBL_EPSILON);
    EXPECT_NEAR(answer.y[0], 1, 20 * DBL_EPSILON);
  }
}

TEST(SingularMass, MayBeIndefiniteAcrossTheConstraints) {
  const Matrix mass = Eigen::Vector3d(2, -3, 5).asDiagonal();
  const SaddlePointAnswer answer =
      answer_to({mass, row_matrix({{0, 1, 0}}), Eigen::Vector3d(2, 9, 10), Vector::Constant(1, 4)});
  ASSERT_EQ(answer.outcome, Outcome::regular);
  EXPECT_LE((answer.x - Eigen::Vector3d(1, 4, 2)).norm(), 20 * DBL_EPSILON);
  EXPECT_NEAR(answer.y[0], -21, 100 * DBL_EPSILON);
}

}  // namespace
}  // namespace hybrid_sphere::testing::saddle_point_rank_test

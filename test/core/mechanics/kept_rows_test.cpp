// Rows of C that depend on others: which rows are kept, and when.
#include "mechanics/kept_rows.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cfloat>
#include <cmath>

#include "core/mechanics/saddle_point_problem.hpp"
#include "core/mechanics/singular_values.hpp"

namespace hybrid_sphere::testing::kept_rows_test {
namespace {

using namespace mechanics;
using Rows = std::vector<Index>;

KeptRows::Rows shared(const Rows& rows) { return std::make_shared<const Rows>(rows); }

Rows independent_rows(const Matrix& mass, const Matrix& gradient) {
  SaddlePoint saddle_point;
  saddle_point.find_rank(mass, gradient);
  return saddle_point.independent_rows();
}

/// Row i of the result has length 1.
Matrix with_unit_rows(const Matrix& matrix) {
  return matrix.rowwise().norm().cwiseInverse().asDiagonal() * matrix;
}

/// The largest distance of a unit row from the space that the kept ones span, and the condition number of the
/// latter.
struct Span {
  double distance;
  double condition;
};
Span span_of(const Matrix& all, const Rows& rows) {
  KeptRows kept;
  kept.set(shared(rows));
  const Matrix unit = with_unit_rows(all);
  const Matrix kept_rows = kept.of(unit);
  const Matrix beyond = right_singular_vectors(kept_rows).rightCols(all.cols() - kept_rows.rows());
  return {(unit * beyond).rowwise().norm().maxCoeff(), condition_number(kept_rows)};
}

TEST(IndependentRows, SpanTheSpaceOfAllRows) {
  RandomMatrices random;
  for (Index n = 1; n <= 12; ++n) {
    for (Index rank = 1; rank <= n; ++rank) {
      const Matrix gradient = random.matrix(rank + 4, rank) * random.matrix(rank, n);
      const Rows rows = independent_rows(random.mass(n), gradient);
      ASSERT_EQ(Index(rows.size()), rank) << n;
      EXPECT_TRUE(std::is_sorted(rows.begin(), rows.end()));
      const Span span = span_of(gradient, rows);
      // Each element of the product has `rank` roundings, which the kept rows magnify by their condition.
      EXPECT_LE(span.distance, 8 * double(n) * DBL_EPSILON * span.condition) << n << ", " << rank;
    }
  }
}

// Pivots are rows of unit length in scaled velocities: each kept row is the farthest from the span of those
// before it.
TEST(IndependentRows, AreFarFromDependingOnEachOther) {
  RandomMatrices random;
  for (Index rank = 1; rank <= 8; ++rank) {
    const Matrix basis = random.matrix(rank, 2 * rank);
    Matrix gradient(2 * rank, 2 * rank);
    gradient << basis, basis + 1e-3 * random.matrix(rank, rank) * basis;  // each row twice, nearly
    const Rows rows = independent_rows(Matrix::Identity(2 * rank, 2 * rank), gradient);
    ASSERT_EQ(Index(rows.size()), rank);
    KeptRows kept;
    kept.set(shared(rows));
    EXPECT_LE(condition_number(with_unit_rows(kept.of(gradient))),
              4 * condition_number(with_unit_rows(basis)))
        << rank;
  }
}

TEST(IndependentRows, LeaveOutRowsOfZerosAndRepeatedRows) {
  Matrix gradient(5, 3);
  gradient << 0, 0, 0, 1, 2, 3, 2, 4, 6, 0, 1, 0, 1, 3, 3;
  const Rows rows = independent_rows(Matrix::Identity(3, 3), gradient);
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_NE(rows[0], 0);
  EXPECT_LE(span_of(gradient.bottomRows(4), {rows[0] - 1, rows[1] - 1}).distance, 8 * DBL_EPSILON);
}

TEST(IndependentRows, DoNotDependOnUnits) {
  RandomMatrices random;
  for (Index n = 2; n <= 8; ++n) {
    const Matrix mass = random.mass(n), gradient = random.matrix(n + 2, n - 1) * random.matrix(n - 1, n);
    Vector of_rows(n + 2), of_velocities(n);
    for (Index i = 0; i < n + 2; ++i) of_rows[i] = std::ldexp(1, 20 - 7 * int(i));
    for (Index i = 0; i < n; ++i) of_velocities[i] = std::ldexp(1, 30 - 11 * int(i));
    const Matrix other_mass = of_velocities.asDiagonal() * mass * of_velocities.asDiagonal();
    const Matrix other_gradient = of_rows.asDiagonal() * gradient * of_velocities.asDiagonal();
    EXPECT_EQ(independent_rows(mass, gradient), independent_rows(other_mass, other_gradient)) << n;
  }
}

TEST(KeptRows, AreThoseOfMatricesAndVectorsInTheirOrder) {
  KeptRows kept;
  const Matrix matrix = Matrix::NullaryExpr(4, 2, [](Index i, Index j) { return double(10 * i + j); });
  const Vector numbers = Eigen::Vector4d(0, 10, 20, 30);
  EXPECT_TRUE(kept.are_all());
  EXPECT_EQ(kept.of(matrix), matrix);
  EXPECT_EQ(kept.of(numbers), numbers);
  kept.set(shared({1, 3}));
  EXPECT_FALSE(kept.are_all());
  EXPECT_EQ(kept.of(matrix), Eigen::Matrix2d((Eigen::Matrix2d() << 10, 11, 30, 31).finished()));
  EXPECT_EQ(Vector(kept.of(numbers)), Vector(Eigen::Vector2d(10, 30)));
  Vector spread = Vector::Ones(4);
  kept.spread(Eigen::Vector2d(5, 7), spread);
  EXPECT_EQ(spread, Vector(Eigen::Vector4d(0, 5, 0, 7)));
  kept.set(nullptr);
  kept.spread(numbers, spread);
  EXPECT_EQ(spread, numbers);
}

// At a singular position alone the rank is less, too.
TEST(Redundancy, CountsOnceTwoNodesHaveHadTheRank) {
  Redundancy redundancy;
  EXPECT_EQ(redundancy.see(0, 2, 3, {0, 2}), nullptr);
  EXPECT_EQ(redundancy.see(0, 2, 3, {0, 2}), nullptr) << "the same node";
  const KeptRows::Rows kept = redundancy.see(0.1, 2, 3, {0, 1});
  ASSERT_NE(kept, nullptr);
  EXPECT_EQ(*kept, Rows({0, 1})) << "those of the node, not of the one before";
}

TEST(Redundancy, IsNoneWhereTheRankIsLessThanItHasBeen) {
  Redundancy redundancy;
  redundancy.see(0, 2, 3, {0, 2});
  EXPECT_EQ(redundancy.see(0.1, 1, 3, {0}), nullptr);
  EXPECT_NE(redundancy.see(0.2, 2, 3, {0, 2}), nullptr) << "the motion has left the singular position";
}

TEST(Redundancy, EndsWhereTheRankRises) {
  Redundancy redundancy;
  redundancy.see(0, 1, 3, {0});
  EXPECT_NE(redundancy.see(0.1, 1, 3, {0}), nullptr);
  EXPECT_EQ(redundancy.see(0.2, 2, 3, {0, 1}), nullptr);
  EXPECT_EQ(redundancy.see(0.3, 1, 3, {0}), nullptr) << "a singular position from now on";
  EXPECT_NE(redundancy.see(0.4, 2, 3, {0, 1}), nullptr);
}

TEST(Redundancy, IsNoneOfRowsThatAreAllIndependent) {
  Redundancy redundancy;
  for (const double t : {0.0, 0.1, 0.2}) EXPECT_EQ(redundancy.see(t, 3, 3, {0, 1, 2}), nullptr);
}

TEST(Redundancy, BeginsAnewWithASegment) {
  Redundancy redundancy;
  redundancy.see(0, 3, 3, {0, 1, 2});
  EXPECT_EQ(redundancy.see(0.1, 2, 3, {0, 1}), nullptr);
  redundancy.begin();
  EXPECT_EQ(redundancy.see(0.2, 2, 3, {0, 1}), nullptr);
  EXPECT_NE(redundancy.see(0.3, 2, 3, {0, 1}), nullptr);
}

}  // namespace
}  // namespace hybrid_sphere::testing::kept_rows_test

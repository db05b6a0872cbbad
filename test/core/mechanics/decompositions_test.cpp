// Decompositions against the equations that define them.

#include <gtest/gtest.h>

#include <cfloat>
#include <limits>

#include "core/mechanics/saddle_point_problem.hpp"
#include "hybrid_sphere/numerical_error.hpp"
#include "mechanics/decompositions/eigenvalues.hpp"
#include "mechanics/decompositions/pivoted_qr.hpp"
#include "mechanics/decompositions/right_singular_vectors.hpp"

namespace hybrid_sphere::testing::decompositions_test {
namespace {

using namespace mechanics;

// At most 60 reflections of 60 numbers of unit size each: some 60 * 60 roundings.
constexpr double max_error = 1e4 * DBL_EPSILON;

TEST(Eigenvalues, AreThoseOfDiagonalBlocks) {
  Matrix a = Matrix::Zero(5, 5);
  a.diagonal() << -2, -2, 3, 0.5, 0.5;
  a(0, 1) = 4;  // -2 +- 4 i
  a(1, 0) = -4;
  a(3, 4) = 1;  // 0.5 twice, with one eigenvector
  const Eigen::VectorXcd values = eigenvalues(a);
  EXPECT_EQ(values[0], std::complex<double>(-2, 4));
  EXPECT_EQ(values[1], std::complex<double>(-2, -4));
  EXPECT_EQ(values[2], 3.0);
  EXPECT_EQ(values[3], 0.5);
  EXPECT_EQ(values[4], 0.5);
}

TEST(Eigenvalues, OfTheZeroMatrixAreZero) {
  EXPECT_EQ(eigenvalues(Matrix::Zero(3, 3)), Eigen::VectorXcd::Zero(3));
}

TEST(Eigenvalues, RefusesAMatrixThatIsNotFinite) {
  EXPECT_THROW(eigenvalues(Matrix::Constant(2, 2, std::numeric_limits<double>::infinity())), NumericalError);
}

// 48 and more reflections are applied in blocks.
TEST(PivotedQr, IsTheDecompositionOfItsMatrix) {
  RandomMatrices random;
  for (const Index rows : {1, 3, 7, 60}) {
    for (const Index columns : {Index{1}, Index{2}, rows}) {
      const Matrix a = random.matrix(rows, columns);
      PivotedQr qr(a);
      Matrix q;
      qr.evaluate_q(q);
      EXPECT_LE((q.transpose() * q - Matrix::Identity(rows, rows)).norm(), max_error);
      Matrix product = qr.r().triangularView<Eigen::Upper>();
      qr.apply_q(product);
      for (Index i = 0; i < columns; ++i) {
        EXPECT_LE((product.col(i) - a.col(qr.column(i))).norm(), max_error * a.norm())
            << rows << ", " << columns;
      }
      if (columns > rows) continue;
      const Vector b = random.vector(rows);
      EXPECT_LE((a.transpose() * (a * qr.solve(b) - b)).norm(), max_error * a.norm() * (a.norm() + b.norm()));
    }
  }
}

TEST(RightSingularVectors, EndWithTheKernel) {
  RandomMatrices random;
  const Matrix a = random.matrix(5, 3) * random.matrix(3, 7);
  const Matrix v = right_singular_vectors(a);
  EXPECT_LE((v.transpose() * v - Matrix::Identity(7, 7)).norm(), max_error);
  EXPECT_LE((a * v.rightCols(4)).norm(), max_error * a.norm());
}

}  // namespace
}  // namespace hybrid_sphere::testing::decompositions_test

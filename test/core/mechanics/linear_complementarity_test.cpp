#include "mechanics/linear_complementarity.hpp"

#include <gtest/gtest.h>

#include <random>

namespace hybrid_sphere::mechanics::linear_complementarity_test {
namespace {

void expect_solution(const Matrix& A, const Vector& b, const Vector& z, double tolerance) {
  const Vector w = A * z + b;
  EXPECT_GE(z.minCoeff(), 0);
  EXPECT_GE(w.minCoeff(), -tolerance);
  EXPECT_LE((w.array() * z.array()).abs().maxCoeff(), tolerance * (1 + z.maxCoeff()));
}

TEST(LinearComplementarity, IsSolvedForPositiveDefiniteMatrices) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> number(-1, 1);
  for (int i = 0; i < 300; ++i) {
    const Index size = 1 + i % 12;
    const auto any = [&] { return number(random); };
    const Matrix root = Matrix::NullaryExpr(size, size, any);
    const Matrix A = root * root.transpose() + 0.01 * Matrix::Identity(size, size);
    const Vector b = Vector::NullaryExpr(size, any);
    const auto z = solve_complementarity(A, b);
    ASSERT_TRUE(z);
    expect_solution(A, b, *z, 1e-9);
  }
}

// Redundant rows, as of a table with four legs, and rows of zeros on the right.
TEST(LinearComplementarity, IsSolvedForDegenerateProblems) {
  std::mt19937 random(2);
  std::uniform_int_distribution<int> number(-2, 2);
  for (int i = 0; i < 300; ++i) {
    const Index size = 2 + i % 8;
    const Matrix root = Matrix::NullaryExpr(size, (size + 1) / 2, [&] { return double(number(random)); });
    const Matrix A = root * root.transpose();
    const Vector b = A * Vector::NullaryExpr(size, [&] { return double(number(random)); });
    const auto z = solve_complementarity(A, b);
    ASSERT_TRUE(z);
    expect_solution(A, b, *z, 1e-9);
  }
}

TEST(LinearComplementarity, HasNoneWhereThereIsNone) {
  EXPECT_FALSE(solve_complementarity(Matrix::Constant(1, 1, -1), Vector::Constant(1, -1)));
  EXPECT_FALSE(solve_complementarity(Matrix::Zero(2, 2), Vector::Constant(2, -1)));
  const auto none = solve_complementarity(Matrix::Zero(0, 0), Vector(0));
  ASSERT_TRUE(none);
  EXPECT_EQ(none->size(), 0);
}

}  // namespace
}  // namespace hybrid_sphere::mechanics::linear_complementarity_test

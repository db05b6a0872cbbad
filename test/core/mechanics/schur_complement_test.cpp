// The decomposition by blocks against a dense solution of the same equations.

#include "mechanics/schur_complement.hpp"

#include <gtest/gtest.h>

#include <cfloat>
#include <cmath>
#include <random>
#include <set>
#include <utility>
#include <vector>

#include "core/mechanics/saddle_point_problem.hpp"
#include "mechanics/decompositions/linear_equations.hpp"

namespace hybrid_sphere::testing::schur_complement_test {
namespace {

using namespace mechanics;

constexpr Index block = 6;

/// Equations whose M has blocks of six velocities; their terms are not asked for.
class Bodies final : public EquationsOfMotion {
 public:
  explicit Bodies(Index count) : count_(count) {}
  Index coordinates() const override { return block * count_; }
  Index velocities() const override { return block * count_; }
  Index mass_block() const override { return block; }
  void evaluate(double, const Vector&, const Vector&, MotionTerms&) const override {}
  void momentum(double, const Vector&, const Vector&, Vector&, Matrix&) const override {}

 private:
  Index count_;
};

/// Functions of the velocities of some bodies.
class Joint final : public ConstraintFunction {
 public:
  Joint(Index size, std::set<Index> bodies) : size_(size), bodies_(std::move(bodies)) {}
  Index size() const override { return size_; }
  bool depends_on(Index s) const override { return bodies_.count(s / block) > 0; }
  void evaluate(double, const Vector&, const Vector&, const Vector&, ConstraintTerms&) const override {}
  void evaluate(double, const Vector&, const Vector&, Vector&, Matrix&) const override {}
  void add_curvature(double, const Vector&, const Vector&, const Vector&, Matrix&) const override {}

 private:
  Index size_;
  std::set<Index> bodies_;
};

/// A system of bodies with joints, and numbers for its M and C.
struct Mechanism {
  Model model;
  ActiveSet active;
  SaddlePointProblem problem;

  /// @param joints  the bodies of each, and its number of rows
  Mechanism(Index bodies, const std::vector<std::pair<std::set<Index>, Index>>& joints) {
    RandomMatrices random;
    model.equations = std::make_shared<Bodies>(bodies);
    const Index n = block * bodies;
    Index rows = 0;
    for (const auto& [of_joint, size] : joints) {
      active.push_back(model.constraints.size());
      model.constraints.push_back(
          {"joint" + std::to_string(active.size()), std::make_shared<Joint>(size, of_joint), {}});
      rows += size;
    }
    problem = {Matrix::Zero(n, n), Matrix::Zero(rows, n), random.vector(n), random.vector(rows)};
    for (Index body = 0; body < bodies; ++body) {
      problem.mass.block<block, block>(block * body, block * body) =
          random.mass(block) + 8 * Matrix::Identity(block, block);
    }
    Index row = 0;
    for (const auto& [of_joint, size] : joints) {
      for (const Index body : of_joint) {
        problem.gradient.block(row, block * body, size, block) = random.matrix(size, block);
      }
      row += size;
    }
  }
};

/// x and y together, by elimination in the whole matrix.
Vector dense_solution(const SaddlePointProblem& problem) {
  const Index n = problem.mass.rows(), g = problem.gradient.rows();
  Matrix all = Matrix::Zero(n + g, n + g);
  all << problem.mass, -problem.gradient.transpose(), problem.gradient, Matrix::Zero(g, g);
  Vector right(n + g);
  right << problem.h, problem.gamma;
  return solve_linear_equations(all, right);
}

// Both solutions have the round-off of sums of n + g numbers, times the condition of the matrix: below 1e4
// where all pivots are at least 1/64 of the diagonal, and M has eigenvalues from 9 to about 40.
double tolerance(const Vector& solution) {
  return 1e4 * static_cast<double>(solution.size()) * DBL_EPSILON * solution.lpNorm<Eigen::Infinity>();
}

void expect_dense_solution(const SchurComplement& decomposition, const SaddlePointProblem& problem) {
  const Vector dense = dense_solution(problem);
  Vector x, y;
  ASSERT_TRUE(decomposition.solve(problem.h, problem.gamma, x, y));
  EXPECT_LE((x - dense.head(x.size())).lpNorm<Eigen::Infinity>(), tolerance(dense));
  EXPECT_LE((y - dense.tail(y.size())).lpNorm<Eigen::Infinity>(), tolerance(dense));
}

void expect_dense_solution(const Mechanism& mechanism) {
  SchurComplement decomposition;
  decomposition.set_pattern(BlockPattern::of(mechanism.model, mechanism.active));
  ASSERT_TRUE(decomposition.decompose(mechanism.problem.mass, mechanism.problem.gradient));
  expect_dense_solution(decomposition, mechanism.problem);
}

std::vector<std::pair<std::set<Index>, Index>> random_tree(Index bodies, std::mt19937& engine) {
  std::vector<std::pair<std::set<Index>, Index>> joints;
  for (Index body = 0; body < bodies; ++body) {
    const Index parent = static_cast<Index>(engine() % static_cast<unsigned>(body + 1)) - 1;
    std::set<Index> of_joint = {body};
    if (parent >= 0) of_joint.insert(parent);
    joints.emplace_back(of_joint, 1 + static_cast<Index>(engine() % 3));
  }
  return joints;
}

TEST(SchurComplement, SolvesChains) {
  for (const Index bodies : {1, 2, 3, 12}) {
    std::vector<std::pair<std::set<Index>, Index>> joints = {{{0}, 3}};
    for (Index body = 1; body < bodies; ++body) joints.push_back({{body - 1, body}, 3});
    expect_dense_solution(Mechanism(bodies, joints));
  }
}

TEST(SchurComplement, SolvesTrees) {
  std::mt19937 engine(1);
  for (int i = 0; i < 30; ++i) {
    const Index bodies = 2 + static_cast<Index>(engine() % 9);
    expect_dense_solution(Mechanism(bodies, random_tree(bodies, engine)));
  }
}

TEST(SchurComplement, SolvesLoops) {
  std::mt19937 engine(2);
  for (int i = 0; i < 30; ++i) {
    const Index bodies = 5 + static_cast<Index>(engine() % 6);
    auto joints = random_tree(bodies, engine);
    joints.push_back({{0, bodies - 1}, 1});
    joints.push_back({{1, bodies - 2}, 2});
    expect_dense_solution(Mechanism(bodies, joints));
  }
}

TEST(SchurComplement, SolvesConstraintsOnManyBodiesAndBodiesWithoutOne) {
  expect_dense_solution(Mechanism(6, {{{0, 2, 5}, 2}, {{2}, 1}, {{0, 1, 2, 5}, 2}}));
  expect_dense_solution(Mechanism(3, {}));
}

// More rows than there are sizes that the compiler unrolls.
TEST(SchurComplement, SolvesLargeBlocks) {
  expect_dense_solution(Mechanism(5, {{{0, 1, 2, 3}, 8}, {{3, 4}, 3}}));
  RandomMatrices random;
  for (const Index n : {1, 3, 6, 7, 20}) {
    const SaddlePointProblem problem{random.mass(n) + 8 * Matrix::Identity(n, n), random.matrix(n / 4, n),
                                     random.vector(n), random.vector(n / 4)};
    SchurComplement decomposition;
    ASSERT_TRUE(decomposition.decompose(problem.mass, problem.gradient)) << n;
    expect_dense_solution(decomposition, problem);
  }
}

// The same joint twice, which no decomposition of all rows solves.
TEST(SchurComplement, LeavesOutRows) {
  Mechanism mechanism(4, {{{0}, 2}, {{0, 1}, 3}, {{0, 1}, 3}, {{1, 2}, 2}, {{2, 3}, 2}});
  SaddlePointProblem& problem = mechanism.problem;
  problem.gradient.middleRows(5, 2) = problem.gradient.middleRows(2, 2);
  const std::vector<Index> kept = {0, 1, 2, 3, 4, 7, 8, 9, 10, 11};
  SaddlePointProblem rest{problem.mass, Matrix(10, problem.mass.cols()), problem.h, Vector(10)};
  for (Index i = 0; i < 10; ++i) {
    rest.gradient.row(i) = problem.gradient.row(kept[std::size_t(i)]);
    rest.gamma[i] = problem.gamma[kept[std::size_t(i)]];
  }
  SchurComplement decomposition;
  decomposition.set_pattern(BlockPattern::of(mechanism.model, mechanism.active));
  EXPECT_FALSE(decomposition.decompose(problem.mass, problem.gradient));
  ASSERT_TRUE(decomposition.decompose(problem.mass, problem.gradient, &kept));
  expect_dense_solution(decomposition, rest);
  EXPECT_FALSE(decomposition.decompose(problem.mass, problem.gradient));
}

TEST(SchurComplement, AddsTheShortestChange) {
  std::mt19937 engine(3);
  const Mechanism mechanism(7, random_tree(7, engine));
  SaddlePointProblem problem = mechanism.problem;
  problem.h.setZero();
  SchurComplement decomposition;
  decomposition.set_pattern(BlockPattern::of(mechanism.model, mechanism.active));
  ASSERT_TRUE(decomposition.decompose(problem.mass, problem.gradient));
  const Vector dense = dense_solution(problem);
  Vector x = Vector::Ones(problem.h.size());
  decomposition.add_shortest(problem.gamma, x);
  EXPECT_LE((x - Vector::Ones(x.size()) - dense.head(x.size())).lpNorm<Eigen::Infinity>(), tolerance(dense));
}

// The largest x_i with C x = 0 and x.Mx = 1 is the square root of the x_i that a force of 1 along it gives.
TEST(SchurComplement, KnowsTheMobilityOfAVelocity) {
  std::mt19937 engine(4);
  const Mechanism mechanism(7, random_tree(7, engine));
  SaddlePointProblem problem = mechanism.problem;
  problem.gamma.setZero();
  SchurComplement decomposition;
  decomposition.set_pattern(BlockPattern::of(mechanism.model, mechanism.active));
  ASSERT_TRUE(decomposition.decompose(problem.mass, problem.gradient));
  for (Index i = 0; i < problem.h.size(); ++i) {
    problem.h = Vector::Unit(problem.h.size(), i);
    EXPECT_NEAR(decomposition.mobility(i), std::sqrt(dense_solution(problem)[i]), 1e-10) << i;
  }
}

// In a tree the only blocks are those of joints that share a body: elimination adds none.
TEST(BlockPattern, OfAChainHasABlockForEachJointAndEachTwoInARow) {
  constexpr Index bodies = 10;
  std::vector<std::pair<std::set<Index>, Index>> joints = {{{0}, 5}};
  for (Index body = 1; body < bodies; ++body) joints.push_back({{body - 1, body}, 5});
  const Mechanism mechanism(bodies, joints);
  const BlockPattern pattern = BlockPattern::of(mechanism.model, mechanism.active);
  EXPECT_EQ(pattern.triangle_numbers(), (10 + 9) * 25U);
}

}  // namespace
}  // namespace hybrid_sphere::testing::schur_complement_test

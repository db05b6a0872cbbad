// Stages 2 and 3 take no memory once they have seen a system: here every allocation fails.

#include <gtest/gtest.h>

#include <limits>
#include <string>

#include "core/mechanics/saddle_point_problem.hpp"
#include "hybrid_sphere/mechanics/impulse.hpp"
#include "hybrid_sphere/mechanics/multibody_system.hpp"
#include "mechanics/constrained_motion.hpp"
#include "mechanics/saddle_point.hpp"
#include "mechanics/schur_complement.hpp"
#include "support/failing_memory.hpp"

namespace hybrid_sphere::testing::allocation_test {
namespace {

using namespace mechanics;

/// Every allocation in its life fails.
class NoAllocation {
 public:
  NoAllocation() { memory::fail(1, std::numeric_limits<std::size_t>::max()); }
  ~NoAllocation() { EXPECT_FALSE(memory::stop()); }
  NoAllocation(const NoAllocation&) = delete;
  NoAllocation& operator=(const NoAllocation&) = delete;
};

/// L = v M v / 2 with constant M, in memory that is there.
class ConstantMass final : public EquationsOfMotion {
 public:
  explicit ConstantMass(const Matrix& mass) : mass_(mass) {}
  Index coordinates() const override { return mass_.rows(); }
  Index velocities() const override { return mass_.rows(); }
  void evaluate(double, const Vector&, const Vector&, MotionTerms&) const override {}
  void momentum(double, const Vector&, const Vector& v, Vector& p, Matrix& mass) const override {
    p.resize(v.size());
    p.noalias() = mass_ * v;
    mass = mass_;
  }

 private:
  Matrix mass_;
};

/// f = C v - 1.
class ConstantGradient final : public ConstraintFunction {
 public:
  explicit ConstantGradient(const Matrix& gradient) : gradient_(gradient) {}
  Index size() const override { return gradient_.rows(); }
  void evaluate(double, const Vector&, const Vector&, const Vector&, ConstraintTerms&) const override {}
  void evaluate(double, const Vector&, const Vector& v, Vector& value, Matrix& gradient) const override {
    value.resize(size());
    value.noalias() = gradient_ * v;
    value.array() -= 1;
    gradient = gradient_;
  }
  void add_curvature(double, const Vector&, const Vector&, const Vector&, Matrix&) const override {}

 private:
  Matrix gradient_;
};

TEST(SaddlePoint, TakesNoMemoryForASizeThatItHasSeen) {
  RandomMatrices random;
  for (const Index n : {1, 2, 3, 5, 6, 12}) {
    for (const Index g : {Index{0}, n / 2, n}) {
      const SaddlePointProblem first{random.mass(n), random.matrix(g, n), random.vector(n), random.vector(g)};
      const SaddlePointProblem other{random.mass(n), random.matrix(g, n), random.vector(n), random.vector(g)};
      SaddlePoint saddle_point;
      Vector x;
      Vector y;
      saddle_point.solve(first.mass, first.gradient, first.h, first.gamma, x, y);
      const NoAllocation guard;
      EXPECT_EQ(saddle_point.solve(other.mass, other.gradient, other.h, other.gamma, x, y),
                SaddlePoint::Outcome::regular);
    }
  }
}

/// Bars in a row, each on a hinge.
MultibodySystem chain(int bars) {
  MultibodySystem system(Eigen::Vector3d(0, 0, -9.81));
  std::string previous = "world";
  for (int i = 0; i < bars; ++i) {
    const std::string bar = "bar" + std::to_string(i);
    system.body(bar, 1, {0.1, 0.2, 0.2}, Eigen::Vector3d(i + 0.5, 0, 0))
        .hinge("hinge" + std::to_string(i), previous, bar, Eigen::Vector3d(i, 0, 0),
               Eigen::Vector3d::UnitY());
    previous = bar;
  }
  return system;
}

TEST(ConstrainedMotion, TakesNoMemoryForAChainOfBodies) {
  const MultibodySystem system = chain(3);
  const Model& model = system;
  const Initial initial = system.initial();
  ConstrainedMotion motion(model);
  motion.set_active({0, 1, 2});
  Vector v = initial.v;
  motion.evaluate(0, initial.q, v, 1);
  motion.evaluate_stage(0, initial.q, v);
  v.setConstant(0.1);
  const NoAllocation guard;
  motion.evaluate_stage(0, initial.q, v);
}

TEST(SchurComplement, TakesNoMemoryAfterItsPattern) {
  RandomMatrices random;
  const SaddlePointProblem problem{random.mass(12), random.matrix(3, 12), random.vector(12),
                                   random.vector(3)};
  const std::vector<Index> kept = {0, 2};
  const Vector gamma_of_kept = random.vector(2);
  Vector x = Vector::Zero(12);
  Vector y = Vector::Zero(3);
  SchurComplement decomposition;
  decomposition.set_pattern(BlockPattern::dense(12, 3));
  const NoAllocation guard;
  decomposition.decompose(problem.mass, problem.gradient);
  decomposition.solve(problem.h, problem.gamma, x, y);
  decomposition.add_shortest(problem.gamma, x);
  decomposition.mobility(1);
  decomposition.decompose(problem.mass, problem.gradient, &kept);
  decomposition.add_shortest(gamma_of_kept, x);
}

TEST(Impulse, TakesNoMemoryForConstraintsThatItHasSeen) {
  RandomMatrices random;
  Model model;
  model.coordinates = {"a", "b", "c", "d", "e"};
  model.velocities = {"va", "vb", "vc", "vd", "ve"};
  model.equations = std::make_shared<ConstantMass>(random.mass(5));
  model.constraints = {{"first", std::make_shared<ConstantGradient>(random.matrix(2, 5)), {}},
                       {"second", std::make_shared<ConstantGradient>(random.matrix(1, 5)), {}}};
  const ActiveSet active = {0, 1};
  const Vector q = Vector::Zero(5);
  const Vector v1 = random.vector(5);
  ImpulseSolver solver(model);
  Impulse impulse;
  solver.solve(active, 0, q, v1, impulse);
  const Vector v2 = impulse.velocity;
  const Vector drifted = v2 + 1e-9 * v1;
  const NoAllocation guard;
  solver.solve(active, 0, q, v1, impulse);
  EXPECT_EQ(impulse.velocity, v2);
  solver.solve(active, 0, q, drifted, impulse);
  EXPECT_EQ(impulse.iterations, 1);
  solver.solve(active, 0, q, v2, impulse);
  EXPECT_EQ(impulse.iterations, 0);
}

}  // namespace
}  // namespace hybrid_sphere::testing::allocation_test

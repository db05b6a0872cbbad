// What every impulse has: the projection in the metric of the kinetic energy, Carnot's theorem, other units,
// and that a velocity on f = 0 stays as it is.

#include <gtest/gtest.h>

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <limits>

#include "core/mechanics/saddle_point_problem.hpp"
#include "core/mechanics/systems_by_hand.hpp"
#include "mechanics/decompositions/linear_equations.hpp"
#include "mechanics/decompositions/right_singular_vectors.hpp"

namespace hybrid_sphere::testing::impulse_property_test {
namespace {

using namespace mechanics;

std::vector<std::string> coordinate_names(Index n) {
  std::vector<std::string> names;
  for (Index i = 0; i < n; ++i) names.push_back("q" + std::to_string(i));
  return names;
}

Model linear_model(const Matrix& mass, const Matrix& gradient, const Vector& offset) {
  const Index n = mass.rows();
  return model_of(coordinate_names(n), equations_of_mass(n, [=](const Vector&) { return mass; }),
                  {fixed_constraint("constraint", gradient, offset)});
}

/// v M v.
double square(const Matrix& mass, const Vector& v) {
  const Vector p = mass * v;
  return v.dot(p);
}

double distance(const Vector& a, const Vector& b) { return (a - b).norm(); }

// Condition numbers of the random matrices below are at most some hundreds.
constexpr double tolerance = 1e4 * DBL_EPSILON;

// Cortes: v2 is the projection of v1 onto the constraint distribution, orthogonal in the metric of M;
// with a basis N of the kernel of C it is N (N^T M N)^-1 N^T M v1.
TEST(Impulse, IsTheOrthogonalProjectionOntoTheConstraintDistribution) {
  RandomMatrices random;
  double largest = 0;
  for (int i = 0; i < 300; ++i) {
    const Index n = 2 + i % 7;
    const Index g = 1 + i % (n - 1);
    const Matrix mass = random.mass(n);
    const Matrix gradient = random.matrix(g, n);
    const Vector v1 = random.vector(n);
    const Impulse impulse = impulse_of(linear_model(mass, gradient, Vector::Zero(g)), Vector::Zero(n), v1);
    const Matrix basis = right_singular_vectors(gradient).rightCols(n - g);
    const Matrix weighted = basis.transpose() * mass;
    const Vector v2 = basis * solve_linear_equations(weighted * basis, weighted * v1);
    largest = std::max(largest, (impulse.velocity - v2).norm() / v1.norm());
    EXPECT_EQ(impulse.iterations, 1);
    EXPECT_EQ(impulse.rank, g);
    const Vector p = mass * (impulse.velocity - v1);
    EXPECT_LE(distance(impulse.impulse, p), tolerance * mass.norm() * v1.norm());
  }
  EXPECT_LE(largest, tolerance);
}

// Homogeneous f: the loss of energy is the energy of what is lost. In general P.v2 is missing in it.
TEST(Impulse, ObeysCarnotsTheorem) {
  RandomMatrices random;
  for (int i = 0; i < 100; ++i) {
    const Index n = 3 + i % 4;
    const Matrix mass = random.mass(n);
    const Matrix gradient = random.matrix(2, n);
    const Vector v1 = random.vector(n);
    for (const double offset : {0.0, 1.5}) {
      const Vector u = offset * random.vector(2);
      const Vector v2 = impulse_of(linear_model(mass, gradient, u), Vector::Zero(n), v1).velocity;
      const double before = square(mass, v1) / 2;
      const double after = square(mass, v2) / 2;
      const double of_difference = square(mass, v1 - v2) / 2;
      const Vector p = mass * (v2 - v1);
      const double work = offset == 0 ? 0 : v2.dot(p);
      EXPECT_NEAR(before - after, of_difference - work, tolerance * (before + after));
      if (offset == 0) {
        EXPECT_GE(before, after);
      }
    }
  }
}

// d1
TEST(Impulse, OfARedundantConstraintIsThatOfOneWithTheMultipliersOfLeastNorm) {
  RandomMatrices random;
  const Matrix mass = random.mass(3);
  const Constraint once = fixed_constraint("once", Eigen::RowVector3d(0.5, 0, 1), Vector::Ones(1));
  const Constraint twice = fixed_constraint("twice", Eigen::RowVector3d(1, 0, 2), 2 * Vector::Ones(1));
  const auto equations = equations_of_mass(3, [=](const Vector&) { return mass; });
  const Vector v1 = Eigen::Vector3d(1, 0.75, 2);
  const Impulse one = impulse_of(model_of({"x", "y", "z"}, equations, {once}), Vector::Zero(3), v1);
  const Impulse both = impulse_of(model_of({"x", "y", "z"}, equations, {once, twice}), Vector::Zero(3), v1);
  EXPECT_EQ(both.rank, 1);
  EXPECT_LE((both.velocity - one.velocity).norm(), tolerance * v1.norm());
  EXPECT_LE((both.impulse - one.impulse).norm(), tolerance * one.impulse.norm());
  EXPECT_NEAR(both.multipliers[0], one.multipliers[0] / 5, tolerance * one.impulse.norm());
  EXPECT_NEAR(both.multipliers[1], 2 * one.multipliers[0] / 5, tolerance * one.impulse.norm());
}

// speed^2 = c^2 and speed^2 (1 + speed^2) = c^2 (1 + c^2): gradients that are parallel, values that are not.
TEST(Impulse, KnowsRedundantConstraintsThatAgreeOnlyWhereTheyHold) {
  const double c = 3;
  const auto quartic = constraint_by_hand(
      1,
      [=](double, const Vector&, const Vector& v, const Vector&, ConstraintTerms& terms) {
        const double square = v.squaredNorm();
        terms.value[0] = square * (1 + square) - c * c * (1 + c * c);
        terms.gradient = (2 + 4 * square) * v.transpose();
        terms.gamma.setZero();
      },
      [](double, const Vector&, const Vector& v, const Vector& multipliers, Matrix& sum) {
        sum += multipliers[0] * ((2 + 4 * v.squaredNorm()) * Matrix::Identity(2, 2) + 8 * v * v.transpose());
      });
  const Model model =
      model_of({"x", "y"}, equations_of_mass(2, [](const Vector&) { return 2 * Matrix::Identity(2, 2); }),
               {quadratic_constraint("speed", Matrix::Identity(2, 2), c * c), {"energy", quartic, {}}});
  const Vector v1 = Eigen::Vector2d(1.2, -0.9);
  const Impulse impulse = impulse_of(model, Vector::Zero(2), v1);
  EXPECT_EQ(impulse.rank, 1);
  EXPECT_LE((impulse.velocity - v1 * 2).norm(), tolerance);
  // P = 2 (v2 - v1) = v2 = Lambda_1 2 v2 + Lambda_2 (2 + 4 c^2) v2, least norm.
  const Eigen::Vector2d row(2, 2 + 4 * c * c);
  EXPECT_LE((impulse.multipliers - row / row.squaredNorm()).norm(), tolerance);
}

// d6
TEST(Impulse, IsExactlyZeroWhereTheConstraintHoldsAlready) {
  const Matrix mass = Eigen::Vector3d(0.8, 0.8, 0.8).asDiagonal();
  Matrix gradient(1, 3);
  gradient << 0.5, 0, 1;
  const Vector v1 = Eigen::Vector3d(1, 0.75, -0.5);
  const Impulse impulse = impulse_of(linear_model(mass, gradient, Vector::Zero(1)), Vector::Zero(3), v1);
  EXPECT_EQ(impulse.velocity, v1);
  EXPECT_EQ(impulse.multipliers, Vector::Zero(1));
  EXPECT_EQ(impulse.impulse, Vector::Zero(3));
  EXPECT_EQ(impulse.rank, 1);
  EXPECT_EQ(impulse.iterations, 0);
}

TEST(Impulse, ChangesNothingWithoutConstraints) {
  const Model model = linear_model(Matrix::Identity(2, 2), Eigen::RowVector2d(1, 0), Vector::Zero(1));
  ImpulseSolver solver(model);
  Impulse impulse;
  const Vector v1 = Eigen::Vector2d(3, 4);
  solver.solve({}, 0, Vector::Zero(2), v1, impulse);
  EXPECT_EQ(impulse.velocity, v1);
  EXPECT_EQ(impulse.multipliers.size(), 0);
  EXPECT_EQ(impulse.impulse, Vector::Zero(2));
  EXPECT_EQ(impulse.rank, 0);
}

TEST(Impulse, TwiceIsTheSameBitsAsOnce) {
  RandomMatrices random;
  int exact = 0;
  for (int i = 0; i < 5000; ++i) {
    const Index n = 2 + i % 6;
    const Index g = 1 + i % n;
    const Vector u = i % 3 == 0 ? Vector(random.vector(g)) : Vector(Vector::Zero(g));
    const Model model = linear_model(random.mass(n), random.matrix(g, n), u);
    const Impulse once = impulse_of(model, Vector::Zero(n), random.vector(n));
    const Impulse twice = impulse_of(model, Vector::Zero(n), once.velocity);
    EXPECT_EQ(twice.velocity, once.velocity) << i;
    EXPECT_EQ(twice.multipliers, Vector::Zero(g)) << i;
    if (g == n && u.isZero(0)) {
      EXPECT_EQ(once.velocity, Vector::Zero(n)) << "all velocities are taken";
      ++exact;
    }
  }
  EXPECT_GE(exact, 10) << "the case is not among the random ones";
}

TEST(Impulse, OntoANonlinearConstraintTwiceIsTheSameBitsAsOnce) {
  RandomMatrices random;
  for (int i = 0; i < 200; ++i) {
    const Index n = 2 + i % 4;
    const Matrix mass = random.mass(n);
    const Model model =
        model_of(coordinate_names(n), equations_of_mass(n, [=](const Vector&) { return mass; }),
                 {quadratic_constraint("ellipsoid", random.mass(n), 4)});
    const Impulse once = impulse_of(model, Vector::Zero(n), random.vector(n));
    const Impulse twice = impulse_of(model, Vector::Zero(n), once.velocity);
    EXPECT_EQ(twice.velocity, once.velocity) << i;
    EXPECT_EQ(twice.multipliers, Vector::Zero(1)) << i;
  }
}

// f = (v^2 - 1)(v^2 - 9) has its extremum at v^2 = 5, where Newton's steps go anywhere, and at v = 0.
TEST(Impulse, LeadsToTheSolutionOnTheOwnSideOfAnExtremum) {
  const auto shells = constraint_by_hand(
      1,
      [](double, const Vector&, const Vector& v, const Vector&, ConstraintTerms& terms) {
        const double square = v.squaredNorm();
        terms.value[0] = (square - 1) * (square - 9);
        terms.gradient = (4 * square - 20) * v.transpose();
        terms.gamma.setZero();
      },
      [](double, const Vector&, const Vector& v, const Vector& multipliers, Matrix& sum) {
        sum += multipliers[0] * ((4 * v.squaredNorm() - 20) * Matrix::Identity(2, 2) + 8 * v * v.transpose());
      });
  const Model model =
      model_of({"x", "y"}, equations_of_mass(2, [](const Vector&) { return 2 * Matrix::Identity(2, 2); }),
               {{"shells", shells, {}}});
  const Vector e = Eigen::Vector2d(0.6, 0.8);
  for (int i = 1; i < 80; ++i) {
    const double speed = 0.05 * i;
    const double expected = speed < std::sqrt(5.0) ? 1 : 3;
    const Vector v2 = impulse_of(model, Vector::Zero(2), speed * e).velocity;
    // The direction of v1 is that of a rounding more or less, carried over from its length to that of v2.
    EXPECT_LE((v2 - expected * e).norm(), 32 * DBL_EPSILON * (1 + expected / speed)) << speed;
  }
}

/// f = C v - u that loses two digits by adding and taking away 100.
Constraint rounding_constraint(const std::string& name, const Matrix& gradient, const Vector& offset) {
  return {
      name,
      constraint_by_hand(gradient.rows(),
                         [=](double, const Vector&, const Vector& v, const Vector&, ConstraintTerms& terms) {
                           const Vector product = gradient * v;
                           const Vector large = product.array() + 100;
                           terms.value = large.array() - (offset.array() + 100);
                           terms.gradient = gradient;
                           terms.gamma.setZero();
                         }),
      {}};
}

// What Newton's method cannot take away of f is neither a reason to fail nor a contradiction.
TEST(Impulse, BearsTheRoundingsOfTheConstraintsFormulas) {
  RandomMatrices random;
  for (int i = 0; i < 300; ++i) {
    Matrix gradient = random.matrix(3, 4);
    gradient.row(2) = gradient.row(0) / 3 + 0.7 * gradient.row(1);
    Vector offset = random.vector(3);
    offset[2] = offset[0] / 3 + 0.7 * offset[1];
    const Matrix mass = random.mass(4);
    const Model model =
        model_of(coordinate_names(4), equations_of_mass(4, [=](const Vector&) { return mass; }),
                 {rounding_constraint("redundant", gradient, offset)});
    const Impulse impulse = impulse_of(model, Vector::Zero(4), random.vector(4));
    EXPECT_EQ(impulse.rank, 2);
    const Vector value = gradient * impulse.velocity;
    EXPECT_LE(distance(value, offset), 4 * 100 * DBL_EPSILON) << i;
    EXPECT_LE(impulse.iterations, 4) << i;
  }
}

TEST(Impulse, LeadsToTheNearestVelocityOfAnEllipsoid) {
  RandomMatrices random;
  for (int i = 0; i < 100; ++i) {
    const Matrix mass = random.mass(3);
    const Matrix form = random.mass(3);
    const Vector v1 = 0.3 * random.vector(3);
    const Model model =
        model_of(coordinate_names(3), equations_of_mass(3, [=](const Vector&) { return mass; }),
                 {quadratic_constraint("ellipsoid", form, 4)});
    const Vector v2 = impulse_of(model, Vector::Zero(3), v1).velocity;
    const double least = square(mass, v2 - v1);
    // Any other velocity of the ellipsoid is a direction of the right length.
    for (int k = 0; k < 300; ++k) {
      const Vector direction = k < 100 ? Vector(v2 + 0.1 * random.vector(3)) : random.vector(3);
      const Vector other = direction * std::sqrt(4 / square(form, direction));
      EXPECT_GE(square(mass, other - v1), least * (1 - tolerance)) << i;
    }
  }
}

// Two quadrics that the velocity w is on; in four of the cases the path from v1 ends before it reaches them.
TEST(Impulse, FindsAVelocityOfTwoQuadricsThatMeet) {
  RandomMatrices random;
  double largest = 0;
  for (int i = 0; i < 400; ++i) {
    const Matrix mass = random.mass(4);
    const Vector w = random.vector(4);
    const Vector v1 = random.vector(4);
    std::vector<Constraint> constraints;
    for (const char* name : {"first", "second"}) {
      const Matrix root = random.matrix(4, 4);
      const Matrix form = root + root.transpose();
      constraints.push_back(quadratic_constraint(name, form, square(form, w)));
    }
    const Model model =
        model_of(coordinate_names(4), equations_of_mass(4, [=](const Vector&) { return mass; }), constraints);
    const Impulse impulse = impulse_of(model, Vector::Zero(4), v1);
    const Vector p = mass * (impulse.velocity - v1);
    largest = std::max(largest,
                       distance(p, impulse.impulse) / (mass.norm() * (v1.norm() + impulse.velocity.norm())));
    ImpulseSolver solver(model);
    EXPECT_LE(solver.relative_residual({0, 1}, 0, Vector::Zero(4), impulse.velocity), 16 * DBL_EPSILON) << i;
  }
  // The multipliers are some times larger than p where the quadrics meet at a small angle.
  EXPECT_LE(largest, 1e3 * DBL_EPSILON);
}

// One relativistic particle: p = m v/sqrt(1 - v^2/c^2), M = m/sqrt(..) (1 + v v^T/(c^2 - v^2)).
std::shared_ptr<const EquationsOfMotion> relativistic(double m, double c) {
  return equations_by_hand(2, 2, [=](double, const Vector&, const Vector& v, MotionTerms& terms) {
    const double root = std::sqrt(1 - v.squaredNorm() / (c * c));
    terms.lagrangian = -m * c * c * root;
    terms.momentum = m / root * v;
    terms.mass = m / root * (Matrix::Identity(2, 2) + v * v.transpose() / (c * c - v.squaredNorm()));
    terms.rate = v;
    terms.force.setZero();
  });
}

TEST(Impulse, TakesAMomentumThatIsNotLinear) {
  const double m = 1.5;
  const double c = 2;
  for (const double x : {0.0, 0.5, 1.9, -1.99}) {
    // x_dot = 0.4 y_dot: the momentum along (0.4, 1) stays.
    const Model model = model_of({"x", "y"}, relativistic(m, c),
                                 {fixed_constraint("rail", Eigen::RowVector2d(1, -0.4), Vector::Zero(1))});
    const Eigen::Vector2d v1(x, 0.1);
    const Impulse impulse = impulse_of(model, Vector::Zero(2), v1);
    const Eigen::Vector2d e = Eigen::Vector2d(0.4, 1).normalized();
    const double p = m * v1.dot(e) / std::sqrt(1 - v1.squaredNorm() / (c * c));
    const Eigen::Vector2d v2 = p / std::sqrt(m * m + p * p / (c * c)) * e;
    // p(v1) is as sensitive to v1 as 1/(1 - v^2/c^2) is large.
    const double condition = 1 / (1 - v1.squaredNorm() / (c * c));
    EXPECT_LE((impulse.velocity - v2).norm(), 32 * DBL_EPSILON * condition * c) << x;
    EXPECT_GE(impulse.iterations, 2) << x;
    EXPECT_LE(impulse.iterations, std::abs(x) < 1 ? 8 : 100) << x;  // near c in parts of the path
  }
}

TEST(Impulse, DoesNotDependOnTheUnits) {
  RandomMatrices random;
  const Vector units = Eigen::Vector4d(1e3, 1e-3, 1e6, 1);
  const Vector rows = Eigen::Vector2d(1e6, 1e-9);
  for (int i = 0; i < 50; ++i) {
    const Matrix mass = random.mass(4);
    const Matrix gradient = random.matrix(2, 4);
    const Vector offset = random.vector(2);
    const Vector v1 = random.vector(4);
    const Impulse impulse = impulse_of(linear_model(mass, gradient, offset), Vector::Zero(4), v1);
    const Impulse other =
        impulse_of(linear_model(units.asDiagonal() * mass * units.asDiagonal(),
                                rows.asDiagonal() * gradient * units.asDiagonal(), rows.cwiseProduct(offset)),
                   Vector::Zero(4), v1.cwiseQuotient(units));
    EXPECT_EQ(other.iterations, impulse.iterations);
    EXPECT_LE((units.cwiseProduct(other.velocity) - impulse.velocity).norm(), tolerance * v1.norm());
    EXPECT_LE((rows.cwiseProduct(other.multipliers) - impulse.multipliers).norm(),
              tolerance * impulse.multipliers.norm());
  }
}

TEST(Impulse, NeedsAMassOnlyWhereTheConstraintsLeaveTheVelocityFree) {
  // A massless wheel: x_dot = r phi_dot.
  const Matrix mass = Eigen::Vector3d(2, 3, 0).asDiagonal();
  Matrix gradient(2, 3);
  gradient << 1, 0, -0.25, 1, -1, 0;
  const Impulse impulse =
      impulse_of(linear_model(mass, gradient, Vector::Zero(2)), Vector::Zero(3), Eigen::Vector3d(5, 0, 1));
  // 2 x + 3 y stays.
  EXPECT_LE((impulse.velocity - Eigen::Vector3d(2, 2, 8)).norm(), 64 * DBL_EPSILON);
  EXPECT_EQ(impulse.rank, 2);
}

TEST(Impulse, IsRightForABadlyConditionedMass) {
  // Two masses of 1 and 1e-10 in turned coordinates; the light one is stopped.
  const double light = 1e-10;
  const Eigen::Vector2d heavy(0.6, 0.8);
  const Eigen::Vector2d across(-0.8, 0.6);
  const Matrix mass = heavy * heavy.transpose() + light * across * across.transpose();
  const Vector v1 = 2 * heavy + 3 * across;
  const Impulse impulse =
      impulse_of(linear_model(mass, across.transpose(), Vector::Zero(1)), Vector::Zero(2), v1);
  // The elements of M, of size 1, are rounded: its part that couples the two is off by a rounding.
  EXPECT_LE((impulse.velocity - 2 * heavy).norm(), 32 * DBL_EPSILON);
  EXPECT_NEAR(impulse.multipliers[0], -3 * light, 32 * DBL_EPSILON);
}

TEST(RelativeResidual, ComparesFWithItsTerms) {
  Matrix gradient(2, 2);
  gradient << 1, -1, 0, 4;
  const Model model = linear_model(Matrix::Identity(2, 2), gradient, Vector::Zero(2));
  ImpulseSolver solver(model);
  const Vector q = Vector::Zero(2);
  EXPECT_EQ(solver.relative_residual({0}, 0, q, Eigen::Vector2d(3, 0)), 1);
  EXPECT_EQ(solver.relative_residual({0}, 0, q, Eigen::Vector2d(0, 0)), 0);
  EXPECT_EQ(solver.relative_residual({}, 0, q, Eigen::Vector2d(3, 1)), 0);
  const Model affine = linear_model(Matrix::Identity(2, 2), gradient, Eigen::Vector2d(1, 0));
  ImpulseSolver other(affine);
  EXPECT_EQ(other.relative_residual({0}, 0, q, Eigen::Vector2d(3, 0)), 2.0 / 3);
  EXPECT_EQ(other.relative_residual({0}, 0, q, Eigen::Vector2d(0, 0)),
            std::numeric_limits<double>::infinity());
}

}  // namespace
}  // namespace hybrid_sphere::testing::impulse_property_test

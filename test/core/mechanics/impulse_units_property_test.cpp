// Stage 2 in any units, and with coefficients of any size: RapidCheck draws both.

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cfloat>
#include <cmath>

#include "core/mechanics/singular_values.hpp"
#include "core/mechanics/systems_by_hand.hpp"

namespace hybrid_sphere::testing::impulse_units_property_test {
namespace {

using namespace mechanics;

/// 10^k, k from -9 to 9, for each of n.
Vector some_units(Index n) {
  Vector units(n);
  for (Index i = 0; i < n; ++i) units[i] = std::pow(10.0, *rc::gen::inRange(-9, 10));
  return units;
}

/// In [-1, 1], in steps of a thousandth.
double some_number() { return *rc::gen::inRange(-1000, 1001) / 1000.0; }

Matrix some_matrix(Index rows, Index columns) {
  Matrix matrix(rows, columns);
  for (Index i = 0; i < matrix.size(); ++i) matrix(i) = some_number();
  return matrix;
}

struct Problem {
  Matrix mass;
  Matrix gradient;
  Vector offset;
  Vector v1;
};

/// The same with the numbers of the velocities times `units`, and f times `rows`.
Problem in_units(const Problem& problem, const Vector& units, const Vector& rows) {
  const Vector inverse = units.cwiseInverse();
  return {inverse.asDiagonal() * problem.mass * inverse.asDiagonal(),
          rows.asDiagonal() * problem.gradient * inverse.asDiagonal(), rows.cwiseProduct(problem.offset),
          units.cwiseProduct(problem.v1)};
}

Impulse impulse_of(const Problem& problem) {
  const Index n = problem.mass.rows();
  std::vector<std::string> names;
  for (Index i = 0; i < n; ++i) names.push_back("q" + std::to_string(i));
  return testing::impulse_of(
      model_of(names, equations_of_mass(n, [&](const Vector&) { return problem.mass; }),
               {fixed_constraint("rolling", problem.gradient, problem.offset)}),
      Vector::Zero(n), problem.v1);
}

/// Of the rows of C at unit length, in velocities in which M has a unit diagonal.
double condition_of(const Problem& problem) {
  const Vector scale = problem.mass.diagonal().cwiseSqrt();
  const Matrix mass = scale.cwiseInverse().asDiagonal() * problem.mass * scale.cwiseInverse().asDiagonal();
  const Matrix rows = (problem.gradient * scale.cwiseInverse().asDiagonal()).rowwise().normalized();
  return condition_number(rows) * condition_number(mass);
}

/// Length of velocities in the metric of the diagonal of M.
double length(const Problem& problem, const Vector& v) {
  return problem.mass.diagonal().cwiseSqrt().cwiseProduct(v).norm();
}

/// How far v2, found in other units, is off, in roundings of numbers of the size of v1 and v2.
double error_in_roundings(const Problem& problem, const Vector& v2, const Impulse& found,
                          const Vector& units) {
  const double size = length(problem, problem.v1) + length(problem, v2);
  return length(problem, found.velocity.cwiseQuotient(units) - v2) / (DBL_EPSILON * size);
}

// The units round each number of the problem, which moves the solution by as much times the condition; some
// dozens of operations round likewise.
RC_GTEST_PROP(ImpulseInOtherUnits, IsTheSame, ()) {
  const Index n = *rc::gen::inRange(2, 7);
  const Index g = *rc::gen::inRange(1, static_cast<int>(n));
  const Matrix root = some_matrix(n, n);
  Problem problem{root * root.transpose() + Matrix::Identity(n, n), some_matrix(g, n), some_matrix(g, 1),
                  some_matrix(n, 1)};
  if (*rc::gen::arbitrary<bool>()) problem.offset.setZero();
  const Vector rows = problem.gradient.rowwise().norm();
  RC_PRE(rows.minCoeff() > 0);
  RC_PRE(problem.v1.norm() > 0);
  RC_PRE(condition_of(problem) < 1e6);
  const Vector units = some_units(n);
  const Impulse one = impulse_of(problem);
  const Impulse other = impulse_of(in_units(problem, units, some_units(g)));
  const double error = error_in_roundings(problem, one.velocity, other, units);
  RC_LOG() << "error in roundings: " << error << '\n';
  RC_ASSERT(error <= 64 * condition_of(problem));
  RC_ASSERT(one.rank == g);
  RC_ASSERT(other.rank == g);
}

/// An upright disk that comes to roll: x' = R phi' cos theta, y' = R phi' sin theta.
struct Disk {
  double m, R, I, theta;
  Problem problem(const Vector& v1) const {
    Matrix gradient(2, 4);
    gradient << 1, 0, 0, -R * std::cos(theta), 0, 1, 0, -R * std::sin(theta);
    return {Eigen::Vector4d(m, m, 1, I).asDiagonal(), gradient, Vector::Zero(2), v1};
  }
  /// phi2' = (I phi1' + m R v_e)/(I + m R^2).
  Vector expected(const Vector& v1) const {
    const double along = v1[0] * std::cos(theta) + v1[1] * std::sin(theta);
    const double phi_dot = (I * v1[3] + m * R * along) / (I + m * R * R);
    const double speed = R * phi_dot;
    return Eigen::Vector4d(speed * std::cos(theta), speed * std::sin(theta), v1[2], phi_dot);
  }
};

// However large or small R is in these masses, a rounding of a coefficient moves v2 by a rounding: the rows,
// nearly parallel at R = 1e9, have to be solved to that, whatever their condition number.
RC_GTEST_PROP(RollingInOtherUnits, IsTheClosedForm, ()) {
  const Disk disk{1 + std::abs(some_number()), std::pow(10.0, *rc::gen::inRange(-9, 10)),
                  0.1 + std::abs(some_number()), 3 * some_number()};
  const Vector v1 = some_matrix(4, 1);
  RC_PRE(v1.norm() > 0);
  const Problem problem = disk.problem(v1);
  const Vector units = some_units(4);
  const Impulse impulse = impulse_of(in_units(problem, units, some_units(2)));
  const double error = error_in_roundings(problem, disk.expected(v1), impulse, units);
  RC_LOG() << "error in roundings: " << error << '\n';
  RC_ASSERT(error <= 256);
  RC_ASSERT(impulse.rank == 2);
}

// The largest wheel, of a moment of inertia that has nothing to do with its radius: both rows point along
// phi', but for a part of 1e-9.
TEST(Impulse, OfAWheelOfAMillionKilometresIsFound) {
  const double m = 1.5, R = 1e9, I = 0.09;
  for (const double theta : {0.0, 0.3, 1.0, M_PI / 2, 2.5}) {
    const Disk disk{m, R, I, theta};
    const Vector v1 = Eigen::Vector4d(1, -0.5, 0.25, 4);
    const Problem problem = disk.problem(v1);
    const Impulse impulse = impulse_of(problem);
    EXPECT_EQ(impulse.rank, 2) << theta;
    EXPECT_LE(error_in_roundings(problem, disk.expected(v1), impulse, Vector::Ones(4)), 256)
        << theta << ": " << impulse.velocity.transpose();
    // f to roundings of its terms, which are those of x' and y', not those of R phi1'.
    const Vector f = problem.gradient * impulse.velocity;
    const Vector terms = problem.gradient.cwiseAbs() * impulse.velocity.cwiseAbs();
    for (Index b = 0; b < 2; ++b) EXPECT_LE(std::abs(f[b]), 64 * DBL_EPSILON * terms[b]) << theta;
  }
}

}  // namespace
}  // namespace hybrid_sphere::testing::impulse_units_property_test

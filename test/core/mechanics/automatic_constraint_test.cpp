// Constraints and guards from functions against the same terms differentiated by hand.

#include "hybrid_sphere/mechanics/automatic_constraint.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "core/mechanics/expect_terms.hpp"

namespace hybrid_sphere::mechanics::automatic_constraint_test {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

struct Found {
  ConstraintTerms terms;
  Matrix curvature;
};

/// All that a constraint says, its two evaluations compared. @param multipliers  of the curvature
Found all_of(const ConstraintFunction& f, double t, const Vector& q, const Vector& v, const Vector& rate,
             const Vector& multipliers) {
  Found found;
  f.evaluate(t, q, v, rate, found.terms);
  Vector value;
  Matrix gradient;
  f.evaluate(t, q, v, value, gradient);
  EXPECT_EQ(value, found.terms.value);
  EXPECT_EQ(gradient, found.terms.gradient);
  found.curvature = Matrix::Identity(v.size(), v.size());
  f.add_curvature(t, q, v, multipliers, found.curvature);
  found.curvature -= Matrix::Identity(v.size(), v.size());
  return found;
}

TEST(AutomaticConstraint, IsTheKnifeEdge) {
  const auto blade = automatic_constraint<3, 3>(
      "constraint blade",
      [](const auto&, const auto& q, const auto& v) { return v[0] * sin(q[2]) - v[1] * cos(q[2]); });
  const Vector3d q(0.3, -0.4, 0.9);
  const Vector3d v(1.2, -0.7, 0.5);
  const double s = std::sin(q[2]);
  const double c = std::cos(q[2]);
  const auto [terms, curvature] = all_of(*blade, 2, q, v, v, Vector::Constant(1, 3));
  EXPECT_EQ(blade->size(), 1);
  expect_equal(terms.value, Vector::Constant(1, v[0] * s - v[1] * c), 1, "value");
  expect_equal(terms.gradient, Eigen::RowVector3d(s, -c, 0), 1, "gradient");
  expect_equal(terms.gamma, Vector::Constant(1, -(v[0] * c + v[1] * s) * v[2]), 1, "gamma");
  EXPECT_EQ(curvature, Matrix::Zero(3, 3));
}

TEST(AutomaticConstraint, IsAVectorNonlinearInVelocitiesWithTimeAndQuasiVelocities) {
  // Three coordinates with a rate of their own, two velocities.
  const auto function = [](const auto& t, const auto& q, const auto& v) {
    using T = std::decay_t<decltype(v[0])>;
    return Eigen::Matrix<T, 2, 1>(v[0] * v[0] * t + v[0] * v[1] * q[2] - 1, exp(q[0] * t) * v[1] - q[1]);
  };
  const auto f = automatic_constraint<2, 3>("f", function);
  const double t = 0.7;
  const Vector3d q(0.3, -0.4, 0.9);
  const Vector2d v(1.2, -0.7);
  const Vector3d rate(0.2, -1.1, 0.6);
  const double e = std::exp(q[0] * t);
  const auto [terms, curvature] = all_of(*f, t, q, v, rate, Vector2d(2, 5));
  EXPECT_EQ(f->size(), 2);
  expect_equal(terms.value, function(t, q, v), 1, "value");
  expect_equal(terms.gradient,
               (Eigen::Matrix2d() << 2 * v[0] * t + v[1] * q[2], v[0] * q[2], 0, e).finished(), 2,
               "gradient");
  expect_equal(terms.gamma,
               -Vector2d(v[0] * v[0] + v[0] * v[1] * rate[2], e * v[1] * (rate[0] * t + q[0]) - rate[1]), 2,
               "gamma");
  expect_equal(curvature, 2 * (Eigen::Matrix2d() << 2 * t, q[2], q[2], 0).finished(), 4, "curvature");
}

TEST(AutomaticConstraint, TakesConstantsAndExpressions) {
  const Vector2d v(1.2, -0.7);
  const Vector2d q(3, 4);
  const auto moving =
      automatic_constraint<2, 2>("f", [](const auto& t, const auto& q, const auto& v) { return v - t * q; });
  const auto [terms, curvature] = all_of(*moving, 2, q, v, v, Vector2d(1, 1));
  expect_equal(terms.value, v - 2 * q, 10, "value");
  expect_equal(terms.gradient, Eigen::Matrix2d::Identity(), 1, "gradient");
  expect_equal(terms.gamma, q + 2 * v, 10, "gamma");
  EXPECT_EQ(curvature, Matrix::Zero(2, 2));

  const auto constant = automatic_constraint<2, 2>("f", [](auto&&...) { return Vector3d(1, 2, 3); });
  EXPECT_EQ(constant->size(), 3);
  const Found nothing = all_of(*constant, 2, q, v, v, Vector3d(1, 1, 1));
  EXPECT_EQ(nothing.terms.value, Vector3d(1, 2, 3));
  EXPECT_EQ(nothing.terms.gradient, Matrix::Zero(3, 2));
  EXPECT_EQ(nothing.terms.gamma, Vector3d::Zero());
}

TEST(AutomaticConstraint, RefusesVectorsOfOtherSizes) {
  const auto f =
      automatic_constraint<1, 2>("f", [](const auto&, const auto&, const auto& v) { return v[0]; });
  ConstraintTerms terms;
  Matrix sum = Matrix::Zero(1, 1);
  const Vector one = Vector::Ones(1);
  const Vector two = Vector::Ones(2);
  EXPECT_NO_THROW(f->evaluate(0, two, one, two, terms));
  EXPECT_THROW(f->evaluate(0, one, one, two, terms), std::invalid_argument);
  EXPECT_THROW(f->evaluate(0, two, two, two, terms), std::invalid_argument);
  EXPECT_THROW(f->evaluate(0, two, one, one, terms), std::invalid_argument);
  EXPECT_THROW(f->evaluate(0, one, one, terms.value, terms.gradient), std::invalid_argument);
  EXPECT_THROW(f->add_curvature(0, two, one, two, sum), std::invalid_argument);
}

TEST(AutomaticConstraint, NamesItselfWhereItIsNotFinite) {
  const auto f = automatic_constraint<1, 1>(
      "constraint a long name of a blade",
      [](const auto&, const auto& q, const auto& v) { return sqrt(v[0]) + log(q[0]); });
  const auto offender = [&](double x, double y) {
    const Vector q = Vector::Constant(1, x);
    const Vector v = Vector::Constant(1, y);
    ConstraintTerms terms;
    Matrix sum = Matrix::Zero(1, 1);
    const std::string name = not_finite([&] { f->evaluate(0, q, v, v, terms); });
    EXPECT_EQ(not_finite([&] { f->evaluate(0, q, v, terms.value, terms.gradient); }), name);
    EXPECT_EQ(not_finite([&] { f->add_curvature(0, q, v, Vector::Ones(1), sum); }), name);
    return name;
  };
  EXPECT_EQ(offender(1, 1), "");
  EXPECT_EQ(offender(-1, 1), "constraint a long name of a blade");
  EXPECT_EQ(offender(1, 0), "derivative of constraint a long name of a blade");
}

TEST(AutomaticGuard, HasAValueAndARateAlongTheMotion) {
  const auto guard =
      automatic_guard<2>("g", [](const auto& t, const auto& q) { return q[0] * q[0] * t - sin(q[1]) + 3; });
  const Vector2d q(0.7, -0.4);
  const Vector2d rate(1.3, 0.6);
  const double t = 1.7;
  // Five operations on numbers of order one.
  EXPECT_NEAR(guard->value(t, q), q[0] * q[0] * t - std::sin(q[1]) + 3, 16 * DBL_EPSILON);
  EXPECT_NEAR(guard->rate(t, q, rate), 2 * q[0] * rate[0] * t + q[0] * q[0] - std::cos(q[1]) * rate[1],
              16 * DBL_EPSILON);
  EXPECT_THROW(guard->value(t, Vector3d(1, 2, 3)), std::invalid_argument);
  EXPECT_THROW(guard->rate(t, q, Vector3d(1, 2, 3)), std::invalid_argument);
}

TEST(AutomaticGuard, NamesItselfWhereItIsNotFinite) {
  const auto guard = automatic_guard<1>("guard of constraint blade", [](const auto&, const auto& q) {
    using std::sqrt;
    return sqrt(q[0]);
  });
  const Vector one = Vector::Ones(1);
  EXPECT_EQ(not_finite([&] { guard->value(0, one * 0); }), "");
  EXPECT_EQ(not_finite([&] { guard->value(0, -one); }), "guard of constraint blade");
  EXPECT_EQ(not_finite([&] { guard->rate(0, -one, one); }), "guard of constraint blade");
  EXPECT_EQ(not_finite([&] { guard->rate(0, one * 0, one); }), "derivative of guard of constraint blade");
}

}  // namespace
}  // namespace hybrid_sphere::mechanics::automatic_constraint_test

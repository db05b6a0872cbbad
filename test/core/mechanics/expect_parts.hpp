#pragma once

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "core/mechanics/expect_terms.hpp"
#include "hybrid_sphere/mechanics/automatic.hpp"
#include "hybrid_sphere/mechanics/multibody_system.hpp"

/// Expects the terms of a part of two bodies to be those of its formula, differentiated automatically.
namespace hybrid_sphere::mechanics::testing {

using Eigen::Vector3d;

template <class T>
using Vector3 = Eigen::Matrix<T, 3, 1>;
template <class T>
using VectorX = Eigen::Matrix<T, Eigen::Dynamic, 1>;

/// A body's place and attitude among q, by Eigen's own quaternion.
template <class T>
struct Place {
  Place(const VectorX<T>& q, Index body)
      : x(q.template segment<3>(7 * body)),
        turn(Eigen::Quaternion<T>(q[7 * body + 3], q[7 * body + 4], q[7 * body + 5], q[7 * body + 6])
                 .normalized()) {}
  Vector3<T> direction(const Vector3d& d) const { return turn.toRotationMatrix() * d.cast<T>(); }
  Vector3<T> point(const Vector3d& r) const { return x + direction(r); }

  Vector3<T> x;
  Eigen::Quaternion<T> turn;
};

// Points and directions in the world, with the bodies at their placements.
const Vector3d P(0.3, -0.2, 0.7);
const Vector3d D = Vector3d(0.2, 0.5, -0.8).normalized();

inline Eigen::Isometry3d placement(double angle, const Vector3d& axis, const Vector3d& center) {
  return Eigen::Translation3d(center) * Eigen::AngleAxisd(angle, axis.normalized());
}
const Eigen::Isometry3d first_placement = placement(0.7, {1, 2, -1}, {0.5, 0.1, 0.4});
const Eigen::Isometry3d second_placement = placement(-1.1, {0, 1, 3}, {-0.3, 0.6, 1.4});

inline Vector3d point_on(const Eigen::Isometry3d& body, const Vector3d& p) { return body.inverse() * p; }
inline Vector3d direction_on(const Eigen::Isometry3d& body, const Vector3d& d) {
  return body.linear().transpose() * d;
}

inline MultibodySystem two_bodies() {
  MultibodySystem system;
  system.body("one", 2, Inertia(0.4, 0.5, 0.6, 0.05, -0.02, 0.03), first_placement)
      .body("two", 3, Inertia(1.1, 0.7, 0.9, 0.1, 0.04, -0.07), second_placement);
  return system;
}

/// The first derivative along x, and the second where T has one.
template <class T>
Eigen::VectorXd slopes(const VectorX<T>& f) {
  Eigen::VectorXd result(f.size());
  for (Index i = 0; i < f.size(); ++i) result[i] = plain(f[i].derivatives[0]);
  return result;
}

constexpr double rounding = 1e-13;  // of some hundred operations on numbers of order one to ten

/// Random places, with quaternions of any length, and velocities.
struct Random {
  RandomVectors random;
  Vector q() { return random(14) / 2 + Vector::Constant(14, 1.3); }
  Vector v() { return random(12); }
};

/// Terms for functions g(q) that vanish: f = dg/dq q', gamma = -(the second derivative at constant v).
template <class Positions>
void expect_rate_of(const MultibodySystem& system, Positions g) {
  const ConstraintFunction& function = *system.constraints.back().function;
  EXPECT_TRUE(function.has_position());
  Random random;
  for (int i = 0; i < 20; ++i) {
    const Vector q = random.q();
    const Vector v = random.v();
    Matrix directions;
    Vector drift;
    system.equations->directions(q, v, directions, drift);
    using T = Dual<double, 1>;
    const auto moved = [&](const Eigen::VectorXd& rate) {
      VectorX<T> place = Eigen::VectorXd(q).cast<T>();
      for (Index j = 0; j < q.size(); ++j) place[j].derivatives[0] = rate[j];
      return slopes<T>(g(place));
    };
    using Second = Dual<Dual<double, 1>, 1>;
    const Eigen::VectorXd rate = directions * v;
    VectorX<Second> accelerated(q.size());
    for (Index j = 0; j < q.size(); ++j) {
      accelerated[j] = q[j];
      accelerated[j].value.derivatives[0] = rate[j];
      accelerated[j].derivatives[0] = rate[j];
      accelerated[j].derivatives[0].derivatives[0] = drift[j];
    }
    const VectorX<Second> second = g(accelerated);
    ConstraintTerms terms;
    function.evaluate(0.3, q, v, Vector(rate), terms);
    Vector position;
    function.position(0.3, q, position);
    ASSERT_EQ(terms.value.size(), second.size());
    EXPECT_LE((terms.value - moved(rate)).cwiseAbs().maxCoeff(), 10 * rounding);
    for (Index b = 0; b < second.size(); ++b) {
      EXPECT_NEAR(position[b], plain(second[b]), rounding);
      EXPECT_NEAR(terms.gamma[b], -second[b].derivatives[0].derivatives[0], 100 * rounding);
    }
    for (Index j = 0; j < v.size(); ++j) {
      EXPECT_LE((terms.gradient.col(j) - moved(directions.col(j))).cwiseAbs().maxCoeff(), 10 * rounding);
    }
    // The value of positions is linear in any rate of q: what tells how far off they are.
    const Vector any = random.random(14);
    ConstraintTerms other;
    function.evaluate(0.3, q, v, any, other);
    EXPECT_LE((other.value - moved(any)).cwiseAbs().maxCoeff(), 10 * rounding);
  }
}

/// Terms for functions f(q, v) that are linear in v.
template <class Velocities>
void expect_terms_of(const ConstraintFunction& function, const EquationsOfMotion& equations, Velocities f) {
  Random random;
  for (int i = 0; i < 20; ++i) {
    const Vector q = random.q();
    const Vector v = random.v();
    Vector rate;
    equations.rate(q, v, rate);
    using T = Dual<double, 1>;
    VectorX<T> place = Eigen::VectorXd(q).cast<T>();
    for (Index j = 0; j < q.size(); ++j) place[j].derivatives[0] = rate[j];
    const VectorX<T> expected = f(place, Eigen::VectorXd(v));
    ConstraintTerms terms;
    function.evaluate(0.3, q, v, rate, terms);
    ASSERT_EQ(terms.value.size(), expected.size());
    for (Index b = 0; b < expected.size(); ++b) {
      EXPECT_NEAR(terms.value[b], expected[b].value, 10 * rounding);
      EXPECT_NEAR(terms.gamma[b], -expected[b].derivatives[0], 100 * rounding);
    }
    for (Index j = 0; j < v.size(); ++j) {
      const VectorX<T> column = f(place, Eigen::VectorXd(Eigen::VectorXd::Unit(v.size(), j)));
      for (Index b = 0; b < expected.size(); ++b) {
        EXPECT_NEAR(terms.gradient(b, j), column[b].value, 10 * rounding);
      }
    }
    Vector value;
    Matrix gradient;
    function.evaluate(0.3, q, v, value, gradient);
    EXPECT_LE((value - terms.value).cwiseAbs().maxCoeff(), 10 * rounding);
    EXPECT_EQ(gradient, terms.gradient);
    Matrix curvature = Matrix::Zero(v.size(), v.size());
    function.add_curvature(0.3, q, v, Vector::Ones(value.size()), curvature);
    EXPECT_EQ(curvature, Matrix::Zero(v.size(), v.size()));
  }
}

}  // namespace hybrid_sphere::mechanics::testing

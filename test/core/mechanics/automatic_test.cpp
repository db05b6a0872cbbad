// Equations of motion from L and Q against the same equations differentiated by hand.

#include "hybrid_sphere/mechanics/automatic.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "core/mechanics/expect_terms.hpp"
#include "hybrid_sphere/mechanics/by_hand.hpp"

namespace hybrid_sphere::mechanics::automatic_test {
namespace {

/// A double pendulum with its angles from straight down.
struct DoublePendulum {
  double m1 = 1.1, m2 = 0.6, l1 = 0.9, l2 = 1.2, g = 9.81;
  double a = (m1 + m2) * l1 * l1, b = m2 * l2 * l2, c = m2 * l1 * l2;

  template <class T, class Q, class V>
  auto operator()(const T&, const Q& q, const V& v) const {
    using std::cos;
    const auto kinetic = a / 2 * v[0] * v[0] + b / 2 * v[1] * v[1] + c * v[0] * v[1] * cos(q[0] - q[1]);
    return kinetic + (m1 + m2) * g * l1 * cos(q[0]) + m2 * g * l2 * cos(q[1]);
  }

  void by_hand(double, const Vector& q, const Vector& v, MotionTerms& terms) const {
    const double cosine = std::cos(q[0] - q[1]);
    const double sine = std::sin(q[0] - q[1]);
    terms.lagrangian = (*this)(0.0, q, v);
    terms.rate = v;
    terms.mass << a, c * cosine, c * cosine, b;
    terms.momentum = terms.mass * v;
    terms.force << -c * v[1] * v[1] * sine - (m1 + m2) * g * l1 * std::sin(q[0]),
        c * v[0] * v[0] * sine - m2 * g * l2 * std::sin(q[1]);
  }
};

template <class System>
std::shared_ptr<const EquationsOfMotion> by_hand(Index n, System system) {
  return equations_by_hand(n, n, [=](double t, const Vector& q, const Vector& v, MotionTerms& terms) {
    system.by_hand(t, q, v, terms);
  });
}

TEST(AutomaticEquations, AreThoseOfTheDoublePendulum) {
  expect_equal(*automatic_equations<2>(DoublePendulum()), *by_hand(2, DoublePendulum()));
}

/// Chaplygin's sleigh without its blade, drawn by a force along its axis and braked.
struct Sleigh {
  double m = 1.3, J = 0.7, a = 0.4, pull = 0.8, brake = 0.3;

  template <class T, class Q, class V>
  auto operator()(const T&, const Q& q, const V& v) const {
    using std::cos, std::sin;
    const auto w = a * v[2];
    const auto x = v[0] - w * sin(q[2]);
    const auto y = v[1] + w * cos(q[2]);
    return m / 2 * (x * x + y * y) + J / 2 * (v[2] * v[2]);
  }
  Eigen::Vector3d forces(double, const Eigen::Vector3d& q, const Eigen::Vector3d& v) const {
    return {pull * std::cos(q[2]), pull * std::sin(q[2]), -brake * v[2]};
  }

  void by_hand(double, const Vector& q, const Vector& v, MotionTerms& terms) const {
    const double s = std::sin(q[2]);
    const double c = std::cos(q[2]);
    terms.lagrangian = (*this)(0.0, q, v);
    terms.rate = v;
    terms.mass << m, 0, -m * a * s, 0, m, m * a * c, -m * a * s, m * a * c, J + m * a * a;
    terms.momentum = terms.mass * v;
    // dL/dtheta and the change of the third momentum cancel.
    terms.force << pull * c + m * a * c * v[2] * v[2], pull * s + m * a * s * v[2] * v[2], -brake * v[2];
  }
};

TEST(AutomaticEquations, AreThoseOfTheSleighWithForces) {
  const Sleigh sleigh;
  const auto forces = [=](double t, const auto& q, const auto& v) { return sleigh.forces(t, q, v); };
  expect_equal(*automatic_equations<3>(sleigh, forces), *by_hand(3, sleigh));
}

/// (12): a ball with its z-x-z Euler angles psi, theta, phi.
struct Ball {
  double m = 1.3, k2 = 0.4, A = m * k2;

  template <class T, class Q, class V>
  auto operator()(const T&, const Q& q, const V& v) const {
    using std::cos;
    return m / 2 * (v[0] * v[0] + v[1] * v[1]) +
           A / 2 * (v[2] * v[2] + v[3] * v[3] + v[4] * v[4] + 2 * v[4] * v[2] * cos(q[3]));
  }
  void by_hand(double, const Vector& q, const Vector& v, MotionTerms& terms) const {
    const double s = std::sin(q[3]);
    terms.lagrangian = (*this)(0.0, q, v);
    terms.rate = v;
    terms.mass.setZero();
    terms.mass.diagonal() << m, m, A, A, A;
    terms.mass(2, 4) = terms.mass(4, 2) = A * std::cos(q[3]);
    terms.momentum = terms.mass * v;
    terms.force << 0, 0, A * v[4] * v[3] * s, -A * v[4] * v[2] * s, A * v[2] * v[3] * s;
  }
};

TEST(AutomaticEquations, AreThoseOfTheBallInEulerAngles) {
  expect_equal(*automatic_equations<5>(Ball()), *by_hand(5, Ball()));
}

/// Drag by explicit time, a potential and a term that is linear in the velocities, with time as well.
struct Timed {
  double m = 1.3, g = 0.9, gamma = 0.4, B = 0.8;

  template <class T, class Q, class V>
  auto operator()(const T& t, const Q& q, const V& v) const {
    using std::exp;
    return exp(gamma * t) * (m / 2 * v.squaredNorm() - m * g * q[1]) + B * t * (q[0] * v[1] - q[1] * v[0]);
  }
  void by_hand(double t, const Vector& q, const Vector& v, MotionTerms& terms) const {
    const double e = std::exp(gamma * t);
    const Eigen::Vector2d turned(-q[1], q[0]);
    terms.lagrangian = (*this)(t, q, v);
    terms.rate = v;
    terms.mass = m * e * Matrix::Identity(2, 2);
    terms.momentum = m * e * v + B * t * turned;
    terms.force =
        Eigen::Vector2d(2 * B * t * v[1], -2 * B * t * v[0] - m * g * e) - gamma * m * e * v - B * turned;
  }
};

TEST(AutomaticEquations, HoldExplicitTimeAndTermsLinearInTheVelocities) {
  expect_equal(*automatic_equations<2>(Timed()), *by_hand(2, Timed()));
}

/// A relativistic particle: p = m G v, M = m G (1 + G^2 v v^T/c^2), G = 1/sqrt(1 - v^2/c^2).
struct Relativistic {
  double m = 1.3, c = 4;

  template <class T, class Q, class V>
  auto operator()(const T&, const Q& q, const V& v) const {
    using std::sqrt;
    return -m * c * c * sqrt(1 - v.squaredNorm() / (c * c)) - q[0] * q[1];
  }
  void by_hand(double, const Vector& q, const Vector& v, MotionTerms& terms) const {
    const double factor = 1 / std::sqrt(1 - v.squaredNorm() / (c * c));
    terms.lagrangian = -m * c * c / factor - q[0] * q[1];
    terms.rate = v;
    terms.momentum = m * factor * v;
    terms.mass = m * factor * (Matrix::Identity(3, 3) + factor * factor / (c * c) * v * v.transpose());
    terms.force << -q[1], -q[0], 0;
  }
};

TEST(AutomaticEquations, HoldALagrangianThatIsNotQuadratic) {
  expect_equal(*automatic_equations<3>(Relativistic()), *by_hand(3, Relativistic()));
}

// v^T M v/2 - V with M and V of time and coordinates.
const auto some_mass = [](const auto& t, const auto& q) {
  using std::cos;
  using T = std::decay_t<decltype(t)>;
  Eigen::Matrix<T, 2, 2> mass;
  mass << 3 + q[0] * q[0] + t, cos(q[0] - q[1]) * t, cos(q[0] - q[1]) * t, 2 + q[1] * q[1];
  return mass;
};
const auto some_potential = [](const auto& t, const auto& q) { return q[0] * q[1] * q[1] + t * q[0]; };
const auto written_out = [](const auto& t, const auto& q, const auto& v) {
  return 0.5 * v.dot(some_mass(t, q) * v) - some_potential(t, q);
};
const auto some_forces = [](double t, const auto& q, const auto& v) { return t * q - 2.0 * v; };

TEST(AutomaticEquations, AreTheSameWithAMassMatrix) {
  expect_equal(*automatic_equations<2>(with_mass_matrix(some_mass, some_potential), some_forces),
               *automatic_equations<2>(written_out, some_forces));
  const DoublePendulum p;
  const auto mass = [=](const auto&, const auto& q) {
    using T = std::decay_t<decltype(q[0])>;
    const T c = p.c * cos(q[0] - q[1]);
    return (Eigen::Matrix<T, 2, 2>() << p.a, c, c, p.b).finished();
  };
  const auto potential = [=](const auto&, const auto& q) {
    return -(p.m1 + p.m2) * p.g * p.l1 * cos(q[0]) - p.m2 * p.g * p.l2 * cos(q[1]);
  };
  expect_equal(*automatic_equations<2>(with_mass_matrix(mass, potential)), *by_hand(2, p));
}

TEST(AutomaticEquations, TakeTheSymmetricPartOfAMassMatrix) {
  const auto lopsided = [](const auto& t, const auto& q) {
    auto mass = some_mass(t, q);
    mass(0, 1) += q[0];
    mass(1, 0) -= q[0];
    return mass;
  };
  expect_equal(*automatic_equations<2>(with_mass_matrix(lopsided, some_potential)),
               *automatic_equations<2>(with_mass_matrix(some_mass, some_potential)));
}

TEST(AutomaticEquations, TakeConstantsExpressionsAndMatricesOfOne) {
  const auto free = [](const auto&, const auto&, const auto& v) { return 0.5 * v.squaredNorm(); };
  const auto expected = automatic_equations<2>(free);
  const auto nothing = [](auto&&...) { return Eigen::Vector2d::Zero(); };
  expect_equal(*automatic_equations<2>(free, nothing), *expected);
  const auto product = [](const auto&, const auto&, const auto& v) { return v.transpose() * v / 2; };
  expect_equal(*automatic_equations<2>(product), *expected);
  const auto unit_mass = [](const auto&, const auto&) { return Eigen::Matrix2d::Identity(); };
  const auto no_potential = [](const auto&, const auto&) { return 0; };
  expect_equal(*automatic_equations<2>(with_mass_matrix(unit_mass, no_potential)), *expected);

  MotionTerms terms;
  automatic_equations<2>([](auto&&...) { return 5; })->evaluate(0, Vector::Ones(2), Vector::Ones(2), terms);
  EXPECT_EQ(terms.lagrangian, 5);
  EXPECT_EQ(terms.momentum, Vector::Zero(2));
  EXPECT_EQ(terms.mass, Matrix::Zero(2, 2));
  EXPECT_EQ(terms.force, Vector::Zero(2));
}

TEST(AutomaticEquations, KeepTheMemoryOfTheTerms) {
  const auto equations = automatic_equations<5>(Ball());
  MotionTerms terms;
  equations->evaluate(0, Vector::Ones(5), Vector::Ones(5), terms);
  const double* const before[] = {terms.rate.data(), terms.momentum.data(), terms.mass.data(),
                                  terms.force.data()};
  equations->evaluate(1, Vector::Zero(5), Vector::Zero(5), terms);
  const double* const after[] = {terms.rate.data(), terms.momentum.data(), terms.mass.data(),
                                 terms.force.data()};
  for (int i = 0; i < 4; ++i) EXPECT_EQ(before[i], after[i]) << i;
}

TEST(AutomaticEquations, RefuseVectorsOfOtherSizes) {
  const auto equations = automatic_equations<2>(DoublePendulum());
  MotionTerms terms;
  Vector p;
  Matrix mass;
  const Vector two = Vector::Ones(2);
  const Vector three = Vector::Ones(3);
  EXPECT_THROW(equations->evaluate(0, three, two, terms), std::invalid_argument);
  EXPECT_THROW(equations->evaluate(0, two, three, terms), std::invalid_argument);
  EXPECT_THROW(equations->momentum(0, two, three, p, mass), std::invalid_argument);
  EXPECT_THROW(equations->rate(three, two, p), std::invalid_argument);
}

/// What is not finite of L(q, v) + v^2/2 (one coordinate) and of Q, at q = x and v = y.
template <class L, class Forces>
std::string offender(L lagrangian, Forces forces, double x, double y) {
  const auto whole = [=](const auto&, const auto& q, const auto& v) {
    return lagrangian(q[0], v[0]) + 0.5 * v[0] * v[0];
  };
  MotionTerms terms;
  return not_finite([&] {
    automatic_equations<1>(whole, forces)->evaluate(0, Vector::Constant(1, x), Vector::Constant(1, y), terms);
  });
}

TEST(AutomaticEquations, NameTheFunctionThatIsNotFinite) {
  const auto none = [](double, const auto&, const auto&) { return 0; };
  const auto logarithm = [](const auto& q, const auto&) { return log(q); };
  const auto root = [](const auto& q, const auto&) { return sqrt(q); };
  const auto speed = [](const auto&, const auto& v) { return sqrt(v * v); };
  EXPECT_EQ(offender(logarithm, none, 2, 1), "");
  EXPECT_EQ(offender(logarithm, none, -1, 1), "lagrangian");
  EXPECT_EQ(offender(logarithm, none, 0, 1), "lagrangian");
  EXPECT_EQ(offender(root, none, 0, 1), "derivative of lagrangian");
  EXPECT_EQ(offender(speed, none, 0, 1), "");
  EXPECT_EQ(offender(speed, none, 0, 0), "derivative of lagrangian");
  const auto friction = [](double, const auto&, const auto& v) { return -v / v.norm(); };
  EXPECT_EQ(offender(root, friction, 1, 1), "");
  EXPECT_EQ(offender(root, friction, 1, 0), "forces");

  Vector p;
  Matrix mass;
  const Vector zero = Vector::Zero(1);
  const auto slow =
      automatic_equations<1>([](const auto&, const auto&, const auto& v) { return sqrt(v[0]); });
  EXPECT_EQ(not_finite([&] { slow->momentum(0, zero, zero, p, mass); }), "derivative of lagrangian");
}

TEST(AutomaticEquations, NameTheMassMatrixAndThePotentialThatAreNotFinite) {
  const auto root = [](const auto&, const auto& q) { return sqrt(q[0]); };
  const auto one = [](const auto&, const auto&) { return 1; };
  const auto offender = [&](auto mass, auto potential, double x) {
    MotionTerms terms;
    const auto equations = automatic_equations<1>(with_mass_matrix(mass, potential));
    return not_finite([&] { equations->evaluate(0, Vector::Constant(1, x), Vector::Ones(1), terms); });
  };
  EXPECT_EQ(offender(root, root, 1), "");
  EXPECT_EQ(offender(root, one, -1), "mass matrix");
  EXPECT_EQ(offender(root, one, 0), "derivative of mass matrix");
  EXPECT_EQ(offender(one, root, -1), "potential");
  EXPECT_EQ(offender(one, root, 0), "derivative of potential");
}

}  // namespace
}  // namespace hybrid_sphere::mechanics::automatic_test

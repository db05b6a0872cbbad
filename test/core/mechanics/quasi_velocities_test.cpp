// Equations in quasi-velocities: the Boltzmann-Hamel terms against motions known otherwise.

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "core/mechanics/expect_terms.hpp"
#include "hybrid_sphere/mechanics/automatic.hpp"
#include "mechanics/decompositions/cholesky.hpp"

namespace hybrid_sphere::mechanics::quasi_velocities_test {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

template <class T>
using Vector3 = Eigen::Matrix<T, 3, 1>;
template <class T>
using Vector4 = Eigen::Matrix<T, 4, 1>;

Vector acceleration_of(const MotionTerms& terms) {
  Vector acceleration = terms.force;
  Cholesky(terms.mass).solve(acceleration);
  return acceleration;
}

template <class Q>
auto quaternion(const Q& q) {
  return Eigen::Quaternion<typename Q::Scalar>(q[0], q[1], q[2], q[3]);
}

/// (w, x, y, z)' = q omega/2, omega on the body's axes.
const auto body_rate = [](const auto& q, const auto& w) {
  using T = std::decay_t<decltype(q[0])>;
  const Vector4<T> rate = (quaternion(q) * Eigen::Quaternion<T>(T(0), w[0], w[1], w[2])).coeffs() / 2;
  return Vector4<T>(rate[3], rate[0], rate[1], rate[2]);
};
/// (w, x, y, z)' = omega q/2, omega on the fixed axes.
const auto space_rate = [](const auto& q, const auto& w) {
  using T = std::decay_t<decltype(q[0])>;
  const Vector4<T> rate = (Eigen::Quaternion<T>(T(0), w[0], w[1], w[2]) * quaternion(q)).coeffs() / 2;
  return Vector4<T>(rate[3], rate[0], rate[1], rate[2]);
};

const Vector3d inertia(1.1, 2.3, 3.7);
const Vector3d arm(0.3, -0.2, 0.9);  // from the fixed point to the mass centre, on the body's axes
constexpr double weight = 2.5;

const auto height = [](const auto& q) {
  using T = std::decay_t<decltype(q[0])>;
  return (quaternion(q) * arm.cast<T>())[2];
};
/// A heavy top, omega on the body's axes.
const auto body_top = [](const auto&, const auto& q, const auto& w) {
  return 0.5 * w.dot(inertia.cwiseProduct(w)) - weight * height(q);
};
/// The same, omega on the fixed axes.
const auto space_top = [](const auto&, const auto& q, const auto& w) {
  const auto on_body = (quaternion(q).conjugate() * w).eval();
  return 0.5 * on_body.dot(inertia.cwiseProduct(on_body)) - weight * height(q);
};

/// omega' of Euler's equations on the body's axes: J omega' = (J omega) x omega + arm x (weight downwards).
Vector3d euler_acceleration(const Vector4<double>& q, const Vector3d& w) {
  const Vector3d momentum = inertia.cwiseProduct(w);
  const Vector3d down = quaternion(q).conjugate() * Vector3d(0, 0, -weight);
  return (momentum.cross(w) + arm.cross(down)).cwiseQuotient(inertia);
}

TEST(QuasiVelocities, GiveEulersEquationsOnTheBodysAxes) {
  const auto top = automatic_equations<3, 4>(body_rate, body_top);
  RandomVectors random;
  MotionTerms terms;
  for (int i = 0; i < 20; ++i) {
    const Vector4<double> q = random(4).normalized();
    const Vector3d w = random(3);
    top->evaluate(0, q, w, terms);
    expect_equal(terms.mass, Matrix3d(inertia.asDiagonal()), 10, "mass");
    expect_equal(terms.momentum, inertia.cwiseProduct(w), 10, "momentum");
    expect_equal(terms.force, inertia.cwiseProduct(euler_acceleration(q, w)), 10, "force");
    expect_equal(terms.rate, body_rate(q, w), 10, "rate");
    Vector rate;
    top->rate(q, w, rate);
    EXPECT_EQ(rate, terms.rate);
  }
}

TEST(QuasiVelocities, GiveTheSameMotionOnTheFixedAxes) {
  const auto top = automatic_equations<3, 4>(space_rate, space_top);
  RandomVectors random;
  MotionTerms terms;
  for (int i = 0; i < 20; ++i) {
    const Vector4<double> q = random(4).normalized();
    const Vector3d w = random(3);
    const auto turn = quaternion(q);
    top->evaluate(0, q, turn * w, terms);
    // The change of omega is the same on both sets of axes.
    const Vector3d acceleration = acceleration_of(terms);
    expect_equal(acceleration, turn * euler_acceleration(q, w), 30, "acceleration");
  }
}

TEST(QuasiVelocities, GiveTheSameMotionAsEulerAngles) {
  // omega on the body's axes of z-x-z angles psi, theta, phi.
  const auto spin = [](const auto& q, const auto& v) {
    using T = std::decay_t<decltype(q[0] * v[0])>;
    return Vector3<T>(v[0] * sin(q[1]) * sin(q[2]) + v[1] * cos(q[2]),
                      v[0] * sin(q[1]) * cos(q[2]) - v[1] * sin(q[2]), v[0] * cos(q[1]) + v[2]);
  };
  const auto orientation = [](const auto& q) {
    using T = std::decay_t<decltype(q[0])>;
    const auto z = [](const T& a) { return Eigen::Quaternion<T>(cos(a / 2), T(0), T(0), sin(a / 2)); };
    const Eigen::Quaternion<T> x(cos(q[1] / 2), sin(q[1] / 2), T(0), T(0));
    const Eigen::Quaternion<T> turn = z(q[0]) * x * z(q[2]);
    return Vector4<T>(turn.w(), turn.x(), turn.y(), turn.z());
  };
  const auto angles = automatic_equations<3>(
      [=](const auto& t, const auto& q, const auto& v) { return body_top(t, orientation(q), spin(q, v)); });
  RandomVectors random;
  MotionTerms terms;
  for (int i = 0; i < 20; ++i) {
    Vector q = random(3);
    q[1] = 0.5 + 0.1 * i;  // 0 < theta < pi
    const Vector v = random(3);
    angles->evaluate(0, q, v, terms);
    const Vector acceleration = acceleration_of(terms);
    using T = Dual<double, 1>;
    Vector3<T> moving = q.cast<T>();
    Vector3<T> speeding = v.cast<T>();
    for (int k = 0; k < 3; ++k) {
      moving[k].derivatives[0] = v[k];
      speeding[k].derivatives[0] = acceleration[k];
    }
    const Vector3<T> w = spin(moving, speeding);
    const Vector3d value(w[0].value, w[1].value, w[2].value);
    const Vector3d change(w[0].derivatives[0], w[1].derivatives[0], w[2].derivatives[0]);
    // The mass matrix of the angles is nearly singular near sin(theta) = 0: 1/sin^2 of 0.5 is 4.
    expect_equal(change, euler_acceleration(orientation(Vector3d(q)), value), 200, "acceleration");
  }
}

TEST(QuasiVelocities, TurnAFreeSphereSteadilyOnTheFixedAxes) {
  const auto sphere = automatic_equations<3, 4>(
      space_rate, [](const auto&, const auto&, const auto& w) { return 0.7 * w.squaredNorm(); });
  RandomVectors random;
  MotionTerms terms;
  sphere->evaluate(0, random(4).normalized(), random(3), terms);
  expect_equal(terms.force, Vector3d::Zero(), 10, "force");
}

// A frame of the plane, and a system with all kinds of terms in coordinates and in that frame.
const auto frame_rate = [](const auto& q, const auto& v) {
  using std::cos, std::sin;
  using T = std::decay_t<decltype(q[0] * v[0])>;
  return Eigen::Matrix<T, 2, 1>((3 + q[0] * q[0]) * v[0] + q[1] * v[1],
                                sin(q[0]) * v[0] + (4 + cos(q[1])) * v[1]);
};
const auto in_coordinates = [](const auto& t, const auto& q, const auto& v) {
  return (1 + t) * v[0] * v[0] + (2 + q[0] * q[0]) * v[1] * v[1] + q[1] * v[0] * v[1] +
         t * q[1] * q[1] * v[0] - q[0] * q[0] * q[1];
};
const auto forces = [](double t, const auto& q, const auto& v) { return t * q - v; };

TEST(QuasiVelocities, AgreeWithCoordinatesForAnyLagrangianAndFrame) {
  const auto in_frame = [](const auto& t, const auto& q, const auto& v) {
    return in_coordinates(t, q, frame_rate(q, v));
  };
  // The virtual work of Q along the direction B_j is B_j . Q.
  const auto forces_in_frame = [](double t, const auto& q, const auto& v) {
    const Eigen::Vector2d work = forces(t, q, frame_rate(q, v));
    return Eigen::Vector2d(work.dot(frame_rate(q, Eigen::Vector2d(1, 0))),
                           work.dot(frame_rate(q, Eigen::Vector2d(0, 1))));
  };
  const auto plain = automatic_equations<2>(in_coordinates, forces);
  const auto quasi = automatic_equations<2, 2>(frame_rate, in_frame, forces_in_frame);
  MotionTerms expected;
  MotionTerms found;
  RandomVectors random;
  for (int i = 0; i < 20; ++i) {
    const double t = 0.2 * i;
    const Vector q = random(2);
    const Vector v = random(2) / 4;
    quasi->evaluate(t, q, v, found);
    plain->evaluate(t, q, found.rate, expected);
    const Eigen::Vector2d acceleration = acceleration_of(found);
    // q'' = (B v)' along the motion
    using T = Dual<double, 1>;
    Eigen::Matrix<T, 2, 1> moving = q.cast<T>();
    Eigen::Matrix<T, 2, 1> speeding = v.cast<T>();
    for (int k = 0; k < 2; ++k) {
      moving[k].derivatives[0] = found.rate[k];
      speeding[k].derivatives[0] = acceleration[k];
    }
    const Eigen::Matrix<T, 2, 1> rate = frame_rate(moving, speeding);
    const Vector change = Eigen::Vector2d(rate[0].derivatives[0], rate[1].derivatives[0]);
    expect_equal(expected.mass * change, expected.force, 300, "M q'' = h");
    EXPECT_NEAR(found.lagrangian, expected.lagrangian, 64 * DBL_EPSILON * 100);
  }
}

TEST(QuasiVelocities, TakeAMassMatrix) {
  const auto mass = [](const auto&, const auto& q) {
    using T = std::decay_t<decltype(q[0])>;
    const Eigen::Matrix<T, 3, 3> turn = quaternion(q).toRotationMatrix();
    return Eigen::Matrix<T, 3, 3>(turn * inertia.cast<T>().asDiagonal() * turn.transpose());
  };
  const auto potential = [](const auto&, const auto& q) { return weight * height(q); };
  const auto found = automatic_equations<3, 4>(space_rate, with_mass_matrix(mass, potential));
  const auto expected = automatic_equations<3, 4>(space_rate, space_top);
  MotionTerms a;
  MotionTerms b;
  RandomVectors random;
  for (int i = 0; i < 20; ++i) {
    const Vector4<double> q = random(4).normalized();
    const Vector w = random(3);
    found->evaluate(0, q, w, a);
    expected->evaluate(0, q, w, b);
    expect_equal(a, b, 30);
    Vector p;
    Matrix m;
    found->momentum(0, q, w, p, m);
    expect_equal(p, b.momentum, 30, "momentum()");
    expect_equal(m, b.mass, 30, "mass of momentum()");
  }
}

const auto half_square = [](const auto&, const auto&, const auto& v) { return 0.5 * v.squaredNorm(); };

TEST(QuasiVelocities, RefuseARateThatIsNotLinear) {
  const auto quadratic =
      automatic_equations<1, 1>([](const auto&, const auto& v) { return v[0] * v[0]; }, half_square);
  const auto affine =
      automatic_equations<1, 1>([](const auto&, const auto& v) { return v[0] + 1; }, half_square);
  MotionTerms terms;
  for (const auto& equations : {quadratic, affine}) {
    EXPECT_THROW(equations->evaluate(0, Vector::Ones(1), Vector::Ones(1), terms), std::invalid_argument);
  }
}

TEST(QuasiVelocities, RefuseDirectionsThatAreNotClosedUnderBrackets) {
  // The bracket of (1, 0, 0) and (0, 1, x) is (0, 0, 1).
  const auto rate = [](const auto& q, const auto& v) {
    using T = std::decay_t<decltype(q[0])>;
    return Vector3<T>(v[0], v[1], q[0] * v[1]);
  };
  const auto equations = automatic_equations<2, 3>(rate, half_square);
  MotionTerms terms;
  EXPECT_THROW(equations->evaluate(0, Vector::Ones(3), Vector::Ones(2), terms), std::invalid_argument);
}

TEST(QuasiVelocities, NameTheRateThatIsNotFinite) {
  const auto offender = [](auto rate, double x) {
    const auto equations = automatic_equations<1, 1>(rate, half_square);
    MotionTerms terms;
    return not_finite([&] { equations->evaluate(0, Vector::Constant(1, x), Vector::Ones(1), terms); });
  };
  const auto root = [](const auto& q, const auto& v) { return (1 + sqrt(q[0])) * v[0]; };
  const auto plain = [](const auto& q, const auto& v) { return q[0] * v[0]; };
  EXPECT_EQ(offender(root, 1), "");
  EXPECT_EQ(offender(root, -1), "rate");
  EXPECT_EQ(offender(root, 0), "derivative of rate");
  EXPECT_EQ(offender(plain, 1), "");
  EXPECT_EQ(offender(plain, 0), "inverse of rate");
  Vector rate;
  const auto equations = automatic_equations<1, 1>(root, half_square);
  EXPECT_EQ(not_finite([&] { equations->rate(-Vector::Ones(1), Vector::Ones(1), rate); }), "rate");
}

}  // namespace
}  // namespace hybrid_sphere::mechanics::quasi_velocities_test

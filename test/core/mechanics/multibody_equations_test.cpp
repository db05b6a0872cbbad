// The equations of rigid bodies against those of their Lagrangian.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <limits>

#include "core/mechanics/expect_terms.hpp"
#include "hybrid_sphere/mechanics/multibody_system.hpp"

namespace hybrid_sphere::mechanics::multibody_equations_test {
namespace {

using Eigen::Vector3d;

constexpr double rounding = 1e-13;  // of some dozens of operations on numbers of order one to ten
const Eigen::Isometry3d placement =
    Eigen::Translation3d(0.5, 0.1, 0.4) * Eigen::AngleAxisd(0.7, Vector3d(1, 2, -1).normalized());

// One body: the same equations from its Lagrangian.
TEST(MultibodyEquations, AreThoseOfTheLagrangian) {
  const Vector3d gravity(0.3, -0.5, -9.81);
  MultibodySystem bodies(gravity);
  bodies.body("one", 2, Inertia(0.4, 0.5, 0.6, 0.05, -0.02, 0.03), placement);
  Eigen::Matrix3d I;
  I << 0.4, 0.05, -0.02, 0.05, 0.5, 0.03, -0.02, 0.03, 0.6;
  const auto rate = [](const auto& q, const auto& v) {
    using T = std::decay_t<decltype(q[0] * v[0])>;
    const Eigen::Quaternion<T> turn(q[3], q[4], q[5], q[6]);
    const Eigen::Quaternion<T> w(T(0.0), T(v[3]), T(v[4]), T(v[5]));
    const Eigen::Quaternion<T> change = turn * w;
    Eigen::Matrix<T, 7, 1> result;
    result << T(v[0]), T(v[1]), T(v[2]), T(0.5 * change.w()), T(0.5 * change.x()), T(0.5 * change.y()),
        T(0.5 * change.z());
    return result;
  };
  const auto lagrangian = [=](auto, const auto& q, const auto& v) {
    using T = std::decay_t<decltype(q[0] * v[0])>;
    T sum = T(0.0);
    for (Index i = 0; i < 3; ++i) {
      sum += v[i] * v[i] + 2 * gravity[i] * q[i];
      for (Index j = 0; j < 3; ++j) sum += I(i, j) / 2 * v[3 + i] * v[3 + j];
    }
    return sum;
  };
  const System<6, 7> formulas({"x", "y", "z", "qw", "qx", "qy", "qz"}, {"vx", "vy", "vz", "w1", "w2", "w3"},
                              rate, lagrangian);
  expect_equal(*bodies.equations, *formulas.equations);
  RandomVectors random;
  for (int i = 0; i < 20; ++i) {
    const Vector q = random(7);
    const Vector v = random(6);
    Matrix directions, expected_directions;
    Vector drift, expected_drift;
    bodies.equations->directions(q, v, directions, drift);
    formulas.equations->directions(q, v, expected_directions, expected_drift);
    EXPECT_LE((directions - expected_directions).cwiseAbs().maxCoeff(), rounding);
    EXPECT_LE((drift - expected_drift).cwiseAbs().maxCoeff(), 10 * rounding);
  }
}

// Bodies do not know of each other, and what is applied in the world acts on the body's axes.
TEST(MultibodyEquations, AreOneBodyAfterAnother) {
  const auto wrench = [](double t, const BodyState& body) {
    return Wrench{t * body.twist.velocity + body.pose.translation(), body.twist.angular_velocity};
  };
  MultibodySystem one, two, both;
  one.body("one", 2, {0.4, 0.5, 0.6}, placement).apply("one", wrench);
  two.body("two", 3, {1.1, 0.7, 0.9}, placement);
  both.body("one", 2, {0.4, 0.5, 0.6}, placement).body("two", 3, {1.1, 0.7, 0.9}, placement);
  both.apply("one", wrench);
  RandomVectors random;
  const Vector q = random(14);
  const Vector v = random(12);
  MotionTerms first, second, together;
  one.equations->evaluate(0.7, q.head<7>(), v.head<6>(), first);
  two.equations->evaluate(0.7, q.tail<7>(), v.tail<6>(), second);
  both.equations->evaluate(0.7, q, v, together);
  EXPECT_DOUBLE_EQ(together.lagrangian, first.lagrangian + second.lagrangian);
  EXPECT_EQ(together.force.head<6>(), first.force);
  EXPECT_EQ(together.force.tail<6>(), second.force);
  EXPECT_EQ(together.rate.tail<7>(), second.rate);
  EXPECT_EQ((together.mass.topLeftCorner<6, 6>()), first.mass);
  EXPECT_EQ((together.mass.topRightCorner<6, 6>()), Matrix::Zero(6, 6));
  // A torque along the angular velocity is the same on either axes.
  const Vector3d w = v.segment<3>(3);
  const Vector3d turning = first.force.tail<3>() + w.cross(Vector3d(Vector3d(0.4, 0.5, 0.6).cwiseProduct(w)));
  EXPECT_LE((turning - w).norm(), rounding);
  const Vector3d pushing = 0.7 * v.head<3>() + q.head<3>() + Vector3d(0, 0, -2 * 9.81);
  EXPECT_LE((first.force.head<3>() - pushing).norm(), rounding);
}

TEST(MultibodyEquations, NameWhatIsNotFinite) {
  MultibodySystem system;
  system.body("one", 2, {0.4, 0.5, 0.6}, placement).hinge("pivot", "world", "one", {0, 0, 0}, {0, 0, 1});
  system.contact("ground", "one", ContactShape::disk(1, {0, 1, 0}));
  Vector q = system.initial().q;
  const Vector v = Vector::Zero(6);
  q[3] = std::numeric_limits<double>::quiet_NaN();
  MotionTerms terms;
  ConstraintTerms constraint;
  Vector value;
  const auto name = [&](auto call) { return not_finite(call); };
  EXPECT_EQ(name([&] { system.equations->evaluate(0, q, v, terms); }), "rigid bodies");
  EXPECT_EQ(name([&] { system.constraints[0].function->position(0, q, value); }), "constraint pivot");
  EXPECT_EQ(name([&] { system.constraints[0].function->evaluate(0, q, v, Vector::Zero(7), constraint); }),
            "constraint pivot");
  EXPECT_EQ(name([&] { system.constraints[1].schedule.guard->value(0, q); }), "guard of constraint ground");
  EXPECT_EQ(name([&] { system.constraints[1].schedule.guard->rate(0, q, Vector::Zero(7)); }),
            "derivative of guard of constraint ground");
  system.apply("one", [](double, const BodyState&) {
    return Wrench{{std::numeric_limits<double>::infinity(), 0, 0}, {0, 0, 0}};
  });
  EXPECT_EQ(name([&] { system.equations->evaluate(0, system.initial().q, v, terms); }), "wrench of body one");
}

}  // namespace
}  // namespace hybrid_sphere::mechanics::multibody_equations_test

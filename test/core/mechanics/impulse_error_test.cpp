// Constraints that have no impulse: what is refused, and that the message names what it is about.

#include <gtest/gtest.h>

#include <cfloat>
#include <cmath>
#include <limits>

#include "core/mechanics/systems_by_hand.hpp"

namespace hybrid_sphere::testing::impulse_error_test {
namespace {

using namespace mechanics;
using Reason = ConstraintError::Reason;
using std::cos;
using std::sin;

Model particle(const std::vector<Constraint>& constraints) {
  return model_of({"x", "y", "z"},
                  equations_of_mass(3, [](const Vector&) { return 0.8 * Matrix::Identity(3, 3); }),
                  constraints);
}

/// a x_dot + b y_dot + c z_dot = u
Constraint plane(const std::string& name, double a, double b, double c, double u) {
  return fixed_constraint(name, Eigen::RowVector3d(a, b, c), Vector::Constant(1, u));
}

struct Refusal {
  Reason reason;
  std::string message;
};

Refusal refusal_of(const Model& model, const Vector& q, const Vector& v1) {
  try {
    impulse_of(model, q, v1);
  } catch (const ConstraintError& error) {
    return {error.reason(), error.what()};
  }
  ADD_FAILURE() << "nothing was refused";
  return {};
}

void expect_parts(const std::string& message, const std::vector<std::string>& parts) {
  for (const std::string& part : parts) {
    EXPECT_NE(message.find(part), std::string::npos) << '"' << part << "\" is not in: " << message;
  }
}

const Vector somewhere = Eigen::Vector3d(0.25, -0.5, 3);

// d2
TEST(ImpulseError, NamesTheConstraintsInContradictionAndNoOthers) {
  const Model model = particle({plane("side", 0, 1, 0.5, 0.25), plane("stop", 1, 0, 0, 0),
                                plane("lift", 0, 0, 1, 7), plane("belt", 1, 0, 0, 1)});
  const Refusal refusal = refusal_of(model, somewhere, Eigen::Vector3d(1, 0.75, 2));
  EXPECT_EQ(refusal.reason, Reason::inconsistent);
  expect_parts(refusal.message, {"the constraints stop, belt contradict each other", "t = 0", "x = 0.25",
                                 "y = -0.5", "z = 3", "x_dot = 1", "y_dot = 0.75", "z_dot = 2"});
  EXPECT_EQ(refusal.message.find("side"), std::string::npos) << refusal.message;
  EXPECT_EQ(refusal.message.find("lift"), std::string::npos) << refusal.message;
}

TEST(ImpulseError, SeesAContradictionHoweverSmall) {
  for (const double gap : {1e-3, 1e-6, 1e-9, 1e-12}) {
    for (const double speed : {0.0, 1.0, 1e4}) {
      const Model model = particle({plane("stop", 1, 0, 0, 1), plane("belt", 1, 0, 0, 1 + gap)});
      const Refusal refusal = refusal_of(model, somewhere, Eigen::Vector3d(speed, 0.75, 2));
      EXPECT_EQ(refusal.reason, Reason::inconsistent) << gap << ", " << speed;
    }
  }
}

TEST(ImpulseError, SeesAConstraintThatContradictsItself) {
  Matrix gradient(2, 3);
  gradient << 1, 2, 0, 2, 4, 0;
  const Model model = particle({fixed_constraint("clamp", gradient, Eigen::Vector2d(0, 1))});
  const Refusal refusal = refusal_of(model, somewhere, Eigen::Vector3d(1, 0.75, 2));
  EXPECT_EQ(refusal.reason, Reason::inconsistent);
  expect_parts(refusal.message, {"constraint clamp contradicts itself"});
}

TEST(ImpulseError, SeesNonlinearConstraintsInContradiction) {
  const Matrix identity = Matrix::Identity(3, 3);
  const Model model = particle({quadratic_constraint("slow", identity, 1),
                                quadratic_constraint("fast", identity, 4), plane("level", 0, 0, 1, 0)});
  const Refusal refusal = refusal_of(model, somewhere, Eigen::Vector3d(1, 0.75, 0));
  EXPECT_EQ(refusal.reason, Reason::inconsistent);
  expect_parts(refusal.message, {"slow, fast"});
  EXPECT_EQ(refusal.message.find("level"), std::string::npos) << refusal.message;
}

// d3
TEST(ImpulseError, NamesAConstraintThatHasNoDirectionAtThisVelocity) {
  const Matrix cone = Eigen::Vector3d(1, 1, -0.25).asDiagonal();
  const Model model = particle({plane("level", 1, 0, 0, 0), quadratic_constraint("wheel", cone, 0)});
  const Refusal refusal = refusal_of(model, somewhere, Vector::Zero(3));
  EXPECT_EQ(refusal.reason, Reason::no_direction);
  expect_parts(refusal.message, {"constraint wheel has no direction: df/dv = 0 at t = 0, x = 0.25",
                                 "x_dot = 0, y_dot = 0, z_dot = 0"});
  EXPECT_EQ(refusal.message.find("differentiate"), std::string::npos) << refusal.message;
}

// d4
TEST(ImpulseError, TellsThatAPositionalConstraintHasToBeDifferentiated) {
  const auto surface = constraint_by_hand(
      2, [](double, const Vector& q, const Vector& v, const Vector&, ConstraintTerms& terms) {
        terms.value << v[0], q[2] - q[0] * q[1];
        terms.gradient << 1, 0, 0, 0, 0, 0;
        terms.gamma.setZero();
      });
  const Model model = particle({{"surface", surface, {}}});
  // On the surface as well as off it.
  for (const double z : {-0.125, 2.0}) {
    const Refusal refusal = refusal_of(model, Eigen::Vector3d(0.25, -0.5, z), Eigen::Vector3d(1, 2, 3));
    EXPECT_EQ(refusal.reason, Reason::no_direction);
    expect_parts(refusal.message, {"function 2 of constraint surface", "differentiate it once"});
  }
}

Model turntable_ball() {
  const double radius = 0.5;
  const auto mass = [](const Vector& q) {
    Matrix matrix = Matrix::Identity(5, 5);
    matrix.bottomRightCorner(3, 3) *= 0.0625;
    matrix(2, 4) = matrix(4, 2) = 0.0625 * cos(q[3]);
    return matrix;
  };
  const auto rolling = [=](const Vector& q) {
    Matrix gradient(2, 5);
    gradient << 1, 0, 0, -radius * sin(q[2]), radius * sin(q[3]) * cos(q[2]),  //
        0, 1, 0, radius * cos(q[2]), radius * sin(q[3]) * sin(q[2]);
    return std::pair(gradient, Vector(2 * Eigen::Vector2d(-q[1], q[0])));
  };
  return model_of({"x", "y", "psi", "theta", "phi"}, equations_of_mass(5, mass),
                  {linear_constraint("rolling", 2, rolling)});
}

// d5
TEST(ImpulseError, RefusesEulerAnglesWhereTheyDegenerate) {
  Vector q(5);
  q << 0.75, -0.25, 0.5, 0, -0.5;
  Vector v(5);
  v << -0.5, -0.75, -0.5, 0.5, 1.75;
  const Refusal refusal = refusal_of(turntable_ball(), q, v);
  EXPECT_EQ(refusal.reason, Reason::singular);
  expect_parts(refusal.message, {"mass matrix", "rolling", "theta = 0", "psi_dot = -0.5"});
  q[3] = 1e-3;
  const Impulse impulse = impulse_of(turntable_ball(), q, v);
  EXPECT_EQ(impulse.rank, 2);
}

// d7
TEST(ImpulseError, TellsThatNoRealVelocitySatisfiesTheConstraint) {
  const Model model = particle({quadratic_constraint("speed", Matrix::Identity(3, 3), -9)});
  const Refusal refusal = refusal_of(model, somewhere, Eigen::Vector3d(1.5, -1.5, 0));
  EXPECT_EQ(refusal.reason, Reason::no_velocity);
  expect_parts(refusal.message, {"speed", "x_dot = 1.5", "with f = "});
}

TEST(ImpulseError, TellsThatConstraintsMissEachOther) {
  const Model model =
      particle({quadratic_constraint("speed", Matrix::Identity(3, 3), 1), plane("push", 1, 0, 0, 2)});
  const Refusal refusal = refusal_of(model, somewhere, Eigen::Vector3d(0.3, 0.2, 0.1));
  EXPECT_EQ(refusal.reason, Reason::no_velocity);
  expect_parts(refusal.message, {"speed, push"});
}

// On the axis of the cone no generator is nearer than the others.
TEST(ImpulseError, DoesNotChooseAmongVelocitiesThatAreEquallyNear) {
  const Matrix cone = Eigen::Vector3d(1, 1, -0.25).asDiagonal();
  const Model model = particle({quadratic_constraint("wheel", cone, 0)});
  const Reason axis = refusal_of(model, somewhere, Eigen::Vector3d(0, 0, 2)).reason;
  EXPECT_TRUE(axis == Reason::no_velocity || axis == Reason::no_direction);
  const Reason across = refusal_of(model, somewhere, Eigen::Vector3d(1, 1, 0)).reason;
  EXPECT_TRUE(across == Reason::no_velocity || across == Reason::no_direction);
}

TEST(ImpulseError, NamesTheFunctionThatIsNotFinite) {
  const auto root = constraint_by_hand(
      1, [](double, const Vector&, const Vector& v, const Vector&, ConstraintTerms& terms) {
        terms.value[0] = std::sqrt(v[0]) - 2;
        terms.gradient << 0.5 / std::sqrt(v[0]), 0, 0;
        terms.gamma.setZero();
      });
  const Model model = particle({{"root", root, {}}});
  EXPECT_THROW(impulse_of(model, somewhere, Eigen::Vector3d(-1, 0, 0)), NotFinite);
  // From 100 a whole step leads to -60, where the root is not defined; parts of the path do not.
  EXPECT_NEAR(impulse_of(model, somewhere, Eigen::Vector3d(100, 0, 0)).velocity[0], 4, 64 * DBL_EPSILON);
}

}  // namespace
}  // namespace hybrid_sphere::testing::impulse_error_test

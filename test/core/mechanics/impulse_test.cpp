// Stage 2 against the 30-digit references and closed forms of classical systems.

#include "hybrid_sphere/mechanics/impulse.hpp"

#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include <Eigen/Geometry>
#include <cfloat>
#include <cmath>

#include "core/mechanics/systems_by_hand.hpp"

namespace hybrid_sphere::testing::impulse_test {
namespace {

using namespace mechanics;
using std::cos;
using std::sin;

/// An impulse of test/data/mechanics/general_systems.json, with the parameters of its system.
class Reference {
 public:
  explicit Reference(const std::string& name) {
    const YAML::Node file = YAML::LoadFile(TEST_DATA_DIR "/mechanics/general_systems.json");
    for (const YAML::Node& system : file["systems"]) {
      if (system["name"].as<std::string>() == name) system_ = system;
    }
  }
  double parameter(const std::string& name) const { return system_["parameters"][name].as<double>(); }
  Vector vector(const std::string& name) const {
    const YAML::Node list = system_["impulse"][name];
    Vector values(static_cast<Index>(list.size()));
    for (std::size_t i = 0; i < list.size(); ++i) values[static_cast<Index>(i)] = list[i].as<double>();
    return values;
  }
  double number(const std::string& name) const { return system_["impulse"][name].as<double>(); }

 private:
  YAML::Node system_;
};

// q and v1 are the references' rounded to 53 bits, which moves the results by as much times the condition
// number of C M^-1 C^T and M, below 10 here; some twenty operations round on the way.
constexpr double tolerance = 32 * DBL_EPSILON;

void expect_reference(const Reference& reference, const Model& model, int max_iterations) {
  const Vector q = reference.vector("q");
  const Vector v1 = reference.vector("qd_before");
  const Impulse impulse = impulse_of(model, q, v1);
  const Vector v2 = reference.vector("qd_after");
  const Vector multipliers = reference.vector("Lambda");
  const Vector p = reference.vector("P");
  EXPECT_LE((impulse.velocity - v2).norm(), tolerance * v1.norm());
  EXPECT_LE((impulse.multipliers - multipliers).norm(), tolerance * multipliers.norm());
  EXPECT_LE((impulse.impulse - p).norm(), tolerance * p.norm());
  EXPECT_EQ(impulse.rank, multipliers.size());
  EXPECT_GE(impulse.iterations, 1);
  EXPECT_LE(impulse.iterations, max_iterations);
  const double before = reference.number("T_before");
  EXPECT_NEAR(kinetic_energy(model, q, v1), before, tolerance * before);
  EXPECT_NEAR(kinetic_energy(model, q, impulse.velocity), reference.number("T_after"), tolerance * before);
}

Model sleigh(double m, double inertia, double a) {
  return model_of({"x", "y", "theta"},
                  equations_of_mass(3,
                                    [=](const Vector& q) {
                                      Matrix mass = m * Matrix::Identity(3, 3);
                                      mass(0, 2) = mass(2, 0) = -m * a * sin(q[2]);
                                      mass(1, 2) = mass(2, 1) = m * a * cos(q[2]);
                                      mass(2, 2) = inertia + m * a * a;
                                      return mass;
                                    }),
                  {linear_constraint("blade", 1, [](const Vector& q) {
                    Matrix gradient(1, 3);
                    gradient << -sin(q[2]), cos(q[2]), 0;
                    return std::pair(gradient, Vector::Zero(1).eval());
                  })});
}

TEST(Impulse, OfTheChaplyginSleighIsTheReference) {
  const Reference reference("g1_chaplygin_sleigh");
  expect_reference(reference,
                   sleigh(reference.parameter("m"), reference.parameter("I"), reference.parameter("a")), 1);
}

// Lambda = -(V_n - a w)/(1/m + a^2/I), V_n += Lambda/m, w -= a Lambda/I, V_e unchanged; V of the mass centre.
TEST(Impulse, OfTheChaplyginSleighHasItsClosedForm) {
  const double m = 1.7;
  const double inertia = 0.4;
  const double a = 0.6;
  for (const double theta : {0.0, 1.0, 2.5, -3.0}) {
    const Vector q = Eigen::Vector3d(0.5, -2, theta);
    const Vector v1 = Eigen::Vector3d(0.9, -1.3, 2.1);
    const Eigen::Vector2d e(cos(theta), sin(theta));
    const Eigen::Vector2d normal(-sin(theta), cos(theta));
    const double v_n = v1.head<2>().dot(normal) + a * v1[2];
    const double lambda = -(v_n - a * v1[2]) / (1 / m + a * a / inertia);
    const double w = v1[2] - a * lambda / inertia;
    const Eigen::Vector2d v = v1.head<2>().dot(e) * e + (v_n + lambda / m - a * w) * normal;
    const Impulse impulse = impulse_of(sleigh(m, inertia, a), q, v1);
    EXPECT_NEAR(impulse.multipliers[0], lambda, tolerance * v1.norm());
    EXPECT_LE((impulse.velocity - Eigen::Vector3d(v[0], v[1], w)).norm(), tolerance * v1.norm());
  }
}

TEST(Impulse, OfTheKnifeEdgeOnAnInclineIsTheReference) {
  const Reference reference("g3_knife_edge_incline");
  const double m = reference.parameter("m");
  const double inertia = reference.parameter("I");
  const Matrix mass = Eigen::Vector3d(m, m, inertia).asDiagonal();
  const Model model = model_of({"x", "y", "theta"}, equations_of_mass(3, [=](const Vector&) { return mass; }),
                               {linear_constraint("blade", 1, [](const Vector& q) {
                                 Matrix gradient(1, 3);
                                 gradient << sin(q[2]), -cos(q[2]), 0;
                                 return std::pair(gradient, Vector::Zero(1).eval());
                               })});
  expect_reference(reference, model, 1);
}

TEST(Impulse, OfTheParticleOfConstantSpeedIsTheReference) {
  const Reference reference("g5_constant_speed_particle");
  const double m = reference.parameter("m");
  const double c = reference.parameter("c");
  const Model model =
      model_of({"x", "y"}, equations_of_mass(2, [=](const Vector&) { return m * Matrix::Identity(2, 2); }),
               {quadratic_constraint("speed", Matrix::Identity(2, 2), c * c)});
  expect_reference(reference, model, 8);
}

TEST(Impulse, OfTheBallOnATurntableInEulerAnglesIsTheReference) {
  const Reference reference("g7_ball_on_turntable_euler");
  const double m = reference.parameter("m");
  const double radius = reference.parameter("R");
  const double rate = reference.parameter("W");
  const double inertia = m * std::pow(reference.parameter("k"), 2);
  const auto mass = [=](const Vector& q) {
    Matrix matrix = Vector(Eigen::VectorXd::Constant(5, inertia)).asDiagonal();
    matrix(0, 0) = matrix(1, 1) = m;
    matrix(2, 4) = matrix(4, 2) = inertia * cos(q[3]);
    return matrix;
  };
  const auto rolling = [=](const Vector& q) {
    Matrix gradient(2, 5);
    gradient << 1, 0, 0, -radius * sin(q[2]), radius * sin(q[3]) * cos(q[2]),  //
        0, 1, 0, radius * cos(q[2]), radius * sin(q[3]) * sin(q[2]);
    return std::pair(gradient, Vector(rate * Eigen::Vector2d(-q[1], q[0])));
  };
  expect_reference(reference,
                   model_of({"x", "y", "psi", "theta", "phi"}, equations_of_mass(5, mass),
                            {linear_constraint("rolling", 2, rolling)}),
                   1);
}

// phd2 = (I phd1 + m R v_e)/(I + m R^2), v2 = R phd2 e, thd unchanged.
TEST(Impulse, OfTheUprightRollingDiskHasItsClosedForm) {
  const double m = 1.3;
  const double radius = 0.4;
  const double inertia = 0.09;
  const Matrix mass = Eigen::Vector4d(m, m, 0.05, inertia).asDiagonal();
  const Model model =
      model_of({"x", "y", "theta", "phi"}, equations_of_mass(4, [=](const Vector&) { return mass; }),
               {linear_constraint("rolling", 2, [=](const Vector& q) {
                 Matrix gradient(2, 4);
                 gradient << 1, 0, 0, -radius * cos(q[2]), 0, 1, 0, -radius * sin(q[2]);
                 return std::pair(gradient, Vector::Zero(2).eval());
               })});
  for (const double theta : {0.0, 0.8, 3.0, -1.2}) {
    const Eigen::Vector2d e(cos(theta), sin(theta));
    const Vector v1 = Eigen::Vector4d(1.1, -0.6, 2.5, 4);
    const double phi_dot =
        (inertia * v1[3] + m * radius * v1.head<2>().dot(e)) / (inertia + m * radius * radius);
    const Impulse impulse = impulse_of(model, Eigen::Vector4d(0, 0, theta, 0), v1);
    const Eigen::Vector4d v2(radius * phi_dot * e[0], radius * phi_dot * e[1], v1[2], phi_dot);
    EXPECT_LE((impulse.velocity - v2).norm(), tolerance * v1.norm());
    EXPECT_LE((impulse.multipliers - m * (v2 - v1).head<2>()).norm(), tolerance * m * v1.norm());
    EXPECT_EQ(impulse.rank, 2);
  }
}

// f = zd - y xd: Lambda = -m f/(1 + y^2).
TEST(Impulse, OfTheNonholonomicParticleHasItsClosedForm) {
  const double m = 0.8;
  const Model model = model_of(
      {"x", "y", "z"}, equations_of_mass(3, [=](const Vector&) { return m * Matrix::Identity(3, 3); }),
      {linear_constraint("plane", 1, [](const Vector& q) {
        Matrix gradient(1, 3);
        gradient << -q[1], 0, 1;
        return std::pair(gradient, Vector::Zero(1).eval());
      })});
  for (const double y : {-0.5, 0.0, 3.0, 40.0}) {
    const Vector v1 = Eigen::Vector3d(1, 0.75, 2);
    const double lambda = -m * (v1[2] - y * v1[0]) / (1 + y * y);
    const Impulse impulse = impulse_of(model, Eigen::Vector3d(0.3, y, -1), v1);
    const Eigen::Vector3d v2(v1[0] - y * lambda / m, v1[1], v1[2] + lambda / m);
    EXPECT_LE((impulse.velocity - v2).norm(), tolerance * v1.norm()) << y;
    EXPECT_NEAR(impulse.multipliers[0], lambda, tolerance * m * v1.norm()) << y;
    EXPECT_EQ(impulse.iterations, 1);
  }
}

Model appell_hamel(double m, double a) {
  const Matrix form = Eigen::Vector3d(1, 1, -a * a).asDiagonal();
  return model_of({"x", "y", "z"},
                  equations_of_mass(3, [=](const Vector&) { return m * Matrix::Identity(3, 3); }),
                  {quadratic_constraint("wheel", form, 0)});
}

// u2 = a (a u1 + w1)/(1 + a^2), zd2 = sign(zd1) u2/a, Lambda = m (1 - u1/u2)/2: the nearest velocity of the
// cone, on the side on which v1 is.
TEST(Impulse, OfAppellAndHamelIsTheNearestOnTheSameSideOfTheCone) {
  const double m = 1.6;
  for (const double a : {0.25, 0.75, 4.0}) {
    for (const double ratio : {1e-6, 1e-2, 0.3, 1.0, 5.0, 1e2, 1e6}) {
      int most = 0;
      for (const double side : {1.0, -1.0}) {
        const double u1 = 1.2;
        const double w1 = u1 * ratio;
        const Vector v1 = Eigen::Vector3d(0.6 * u1, 0.8 * u1, side * w1);
        const double u2 = a * (a * u1 + w1) / (1 + a * a);
        const Impulse impulse = impulse_of(appell_hamel(m, a), Vector::Zero(3), v1);
        const Eigen::Vector3d v2(0.6 * u2, 0.8 * u2, side * u2 / a);
        // Where u1 is small beside w1, so is the direction of u2: u1 fixes it with its own relative accuracy.
        const double condition = 1 + ratio;
        EXPECT_LE((impulse.velocity - v2).norm(), condition * tolerance * v2.norm()) << a << ", " << ratio;
        EXPECT_NEAR(impulse.multipliers[0], m * (1 - u1 / u2) / 2, condition * tolerance * m * (1 + u1 / u2))
            << a << ", " << ratio;
        most = std::max(most, impulse.iterations);
      }
      // The path is followed in parts only where the nearest velocity is hardly nearer than others.
      if (std::abs(std::log(ratio * a)) < 1.5) {
        EXPECT_LE(most, 8) << "iterations; " << a << ", " << ratio;
      }
    }
  }
}

// v2 = c v1/|v1|, Lambda = m (1 - |v1|/c)/2, the same direction however slow or fast v1 is.
TEST(Impulse, OntoASpeedKeepsTheDirection) {
  const double m = 2;
  const Model model =
      model_of({"x", "y"}, equations_of_mass(2, [=](const Vector&) { return m * Matrix::Identity(2, 2); }),
               {quadratic_constraint("speed", Matrix::Identity(2, 2), 9)});
  for (const double speed : {1e-3, 0.1, 1.0, 2.9, 3.5, 50.0, 1e6}) {
    const Eigen::Vector2d e(-0.28, 0.96);
    const Impulse impulse = impulse_of(model, Vector::Zero(2), speed * e);
    // A direction that is turned by a rounding, carried over from |v1| to c.
    EXPECT_LE((impulse.velocity - 3 * e).norm(), 3 * tolerance * (1 + 3 / speed)) << speed;
    EXPECT_NEAR(impulse.multipliers[0], m * (1 - speed / 3) / 2, tolerance * m * (1 + speed + 3 / speed))
        << speed;
    EXPECT_LE(impulse.iterations, 60) << speed;
  }
}

}  // namespace
}  // namespace hybrid_sphere::testing::impulse_test

// Point masses and thin rods against known motions.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/mechanics/particle.hpp"
#include "hybrid_sphere/mechanics/multibody_system.hpp"

namespace hybrid_sphere::mechanics::multibody_slender_test {
namespace {

using Eigen::AngleAxisd;
using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr double gravity = 9.81;
constexpr double nan = std::numeric_limits<double>::quiet_NaN();
const Vector3d no_gravity(0, 0, 0);
const Vector3d origin(0, 0, 0);
const Vector3d y(0, 1, 0);

class MultibodySlender : public ::testing::TestWithParam<double> {
 protected:
  Solution motion_of(const Model& model, const Initial& start, double duration) const {
    return solve(model, start, duration, testing::accurate(GetParam()));
  }
  /// Error of q and v for a scale of motion. The scale is an estimate, hence the factor.
  double tolerance(double scale) const { return 4 * GetParam() * scale; }
};

INSTANTIATE_TEST_SUITE_P(Accuracies, MultibodySlender, ::testing::Values(1e-6, 1e-9, 1e-12));

// A point mass falls; its attitude stays, and so does its energy.
TEST_P(MultibodySlender, PointMassFalls) {
  MultibodySystem system;
  system.point_mass("stone", 2, {1, 2, 3});
  const Solution motion = motion_of(system, system.initial({{"stone", {{1, 0, 2}, {5, 6, 7}}}}), 2);
  ASSERT_EQ(motion.status().stop, Stop::reached_end) << motion.status().message;
  const State last = motion.at(2);
  EXPECT_LE((last.q.head<3>() - Vector3d(3, 2, 3 + 4 - 2 * gravity)).norm(), tolerance(40) + 1e-14);
  EXPECT_EQ(last.q.tail<4>(), testing::vector({1, 0, 0, 0}));
  EXPECT_NEAR(last.energy, 5 + 2 * gravity * 3, tolerance(400) + 1e-13);  // 2 (1 + 4) / 2 + m g z
}

// A spherical pendulum of a rod without mass, as a cone: W^2 = g / (l cos(angle)).
TEST_P(MultibodySlender, PointMassOnARodMakesAConicalPendulum) {
  constexpr double l = 0.8, angle = 0.6, m = 1.5;
  const double W = std::sqrt(gravity / (l * std::cos(angle))), speed = W * l * std::sin(angle);
  const Vector3d center(l * std::sin(angle), 0, -l * std::cos(angle));
  MultibodySystem system;
  system.point_mass("bob", m, center).rod("rod", "world", "bob", origin, center);
  const Solution motion = motion_of(system, system.initial({{"bob", {{0, speed, 0}, origin}}}), 3);
  ASSERT_EQ(motion.status().stop, Stop::reached_end) << motion.status().message;
  const State last = motion.at(3);
  const Vector3d expected = AngleAxisd(W * 3, Vector3d::UnitZ()) * center;
  EXPECT_LE((last.q.head<3>() - expected).norm(), tolerance(speed * 3));
  EXPECT_NEAR(last.multipliers[0], -m * gravity / std::cos(angle), tolerance(10 * m * gravity));
}

// Two point masses and a spring between them.
TEST_P(MultibodySlender, PointMassesOscillateOnASpring) {
  constexpr double k = 30, m1 = 2, m2 = 3, l0 = 0.8, l = 1;
  MultibodySystem system(no_gravity);
  const Vector3d along = Vector3d(1, 2, 2) / 3, at(0.3, -0.7, 0.2);
  system.point_mass("one", m1, at)
      .point_mass("two", m2, at + l * along)
      .spring("s", "one", "two", at, at + l * along, k, l0);
  const Solution motion = motion_of(system, system.initial(), 3);
  ASSERT_EQ(motion.status().stop, Stop::reached_end) << motion.status().message;
  const State last = motion.at(3);
  const double w = std::sqrt(k * (1 / m1 + 1 / m2));
  EXPECT_NEAR((last.q.segment<3>(7) - last.q.head<3>()).norm(), l0 + (l - l0) * std::cos(3 * w),
              tolerance((l - l0) * 3 * w) + 1e-14);
  EXPECT_NEAR(last.energy, k / 2 * (l - l0) * (l - l0), tolerance(4 * k * l * (l - l0)));
}

/// From a joint to the end of a rod that has turned by an angle from the vertical, in the plane y = 0.
Vector3d hanging(double length, double angle) {
  return {length * std::sin(angle), 0, -length * std::cos(angle)};
}

// A rod on a ball joint in a plane: (m l^2 / 3) angle'' = -m g l / 2 sin(angle).
TEST_P(MultibodySlender, ThinRodIsAPendulum) {
  constexpr double m = 2, l = 0.9, angle = 1.2, rate = 1.5;
  const Vector3d end = hanging(l, angle);
  MultibodySystem system;
  system.thin_rod("rod", m, origin, end).ball("pivot", "world", "rod", origin);
  const Vector3d w = -rate * y;
  const Solution motion = motion_of(system, system.initial({{"rod", {w.cross(end / 2), w}}}), 4);
  ASSERT_EQ(motion.status().stop, Stop::reached_end) << motion.status().message;
  const System<1> pendulum({"angle"}, [](auto, const auto& q, const auto& v) {
    using std::cos;
    return m * l * l / 6 * v[0] * v[0] + m * gravity * l / 2 * cos(q[0]);
  });
  const Solution expected = solve(pendulum, {0, {angle}, {rate}}, 4, testing::accurate(1e-13));
  for (int i = 0; i <= 16; ++i) {
    const State state = motion.at(i / 4.0);
    const State known = expected.at(state.time);
    EXPECT_LE((state.q.head<3>() - hanging(l / 2, known.q[0])).norm(), tolerance(20));
    EXPECT_LE((system.twist(state.q, state.v, "rod").angular_velocity + known.v[0] * y).norm(),
              tolerance(40));
    EXPECT_NEAR(state.energy, known.energy, tolerance(100));
  }
}

// A double pendulum of two thin rods and a point mass at the end of the second one.
TEST_P(MultibodySlender, DoublePendulumIsThatOfItsLagrangian) {
  constexpr double m1 = 1, l1 = 1, m2 = 0.5, l2 = 0.7, m3 = 0.8, a = 1, b = 0.4;
  const Vector3d elbow = hanging(l1, a), tip = elbow + hanging(l2, b);
  MultibodySystem system;
  system.thin_rod("upper", m1, origin, elbow)
      .thin_rod("lower", m2, elbow, tip)
      .point_mass("bob", m3, tip)
      .ball("shoulder", "world", "upper", origin)
      .ball("elbow", "upper", "lower", elbow)
      .ball("tip", "lower", "bob", tip);
  const System<2> formulas({"a", "b"}, [](auto, const auto& q, const auto& v) {
    using std::cos;
    const auto both = l1 * l2 * cos(q[0] - q[1]) * v[0] * v[1];
    const auto kinetic = m1 * l1 * l1 / 6 * v[0] * v[0] +
                         m2 / 2 * (l1 * l1 * v[0] * v[0] + both + l2 * l2 / 3 * v[1] * v[1]) +
                         m3 / 2 * (l1 * l1 * v[0] * v[0] + 2 * both + l2 * l2 * v[1] * v[1]);
    return kinetic + gravity * ((m1 / 2 + m2 + m3) * l1 * cos(q[0]) + (m2 / 2 + m3) * l2 * cos(q[1]));
  });
  const Solution expected = solve(formulas, {0, {a, b}, {0.0, 0.0}}, 2, testing::accurate(1e-13));
  const Solution motion = motion_of(system, system.initial(), 2);
  ASSERT_EQ(motion.status().stop, Stop::reached_end) << motion.status().message;
  for (int i = 0; i <= 8; ++i) {
    const State state = motion.at(i / 4.0);
    const State known = expected.at(state.time);
    const Vector3d bob = hanging(l1, known.q[0]) + hanging(l2, known.q[1]);
    EXPECT_LE((system.pose(state.q, "bob").translation() - bob).norm(), tolerance(40)) << i;
    EXPECT_NEAR(state.energy, known.energy, tolerance(200)) << i;
  }
}

// A rod on a ball joint as a cone: W^2 cos(angle) l / 3 = g / 2. Nothing determines the rotation about its
// line.
TEST_P(MultibodySlender, ThinRodOnABallJointMakesACone) {
  constexpr double m = 1.5, l = 0.8, angle = 0.6;
  const double W = std::sqrt(1.5 * gravity / (l * std::cos(angle)));
  const Vector3d end(l * std::sin(angle), 0, -l * std::cos(angle)), at(0.3, 0.2, 0.1);
  MultibodySystem system;
  system.thin_rod("rod", m, at, at + end).ball("pivot", "world", "rod", at);
  const Vector3d w(0, 0, W);
  const Initial start = system.initial({{"rod", {w.cross(end / 2), w}}});
  const Solution motion = motion_of(system, start, 3);
  ASSERT_EQ(motion.status().stop, Stop::reached_end) << motion.status().message;
  const State last = motion.at(3);
  const Vector3d expected = at + AngleAxisd(W * 3, Vector3d::UnitZ()) * (end / 2);
  EXPECT_LE((last.q.head<3>() - expected).norm(), tolerance(W * l * 3));
  const double kinetic = m * l * l / 6 * W * W * std::sin(angle) * std::sin(angle);
  EXPECT_NEAR(motion.at(0).kinetic_energy, kinetic, 1e-14);
  EXPECT_NEAR(last.kinetic_energy, kinetic, tolerance(40 * kinetic));
}

// A thrown rod with a force at its end that follows it: as a body with any moment about its line.
TEST_P(MultibodySlender, ThinRodIsABodyWhoseRotationAboutItsLineIsNotSeen) {
  constexpr double m = 1.2, l = 0.7, J = m * l * l / 12;
  const auto push = [](double t, const BodyState& rod) {
    return force_at({std::sin(3 * t), 0.5, -1}, rod.pose * Vector3d(0, 0, l / 2), rod);
  };
  MultibodySystem rod, body;
  rod.thin_rod("rod", m, {0, 0, 1}, {0, 0, 1 + l}).apply("rod", push);
  body.body("rod", m, {J, J, 0.1 * J}, Vector3d(0, 0, 1 + l / 2)).apply("rod", push);
  const Twist twist{{0.1, 0.2, 0.3}, {1, -2, 0}};
  const Solution motion = motion_of(rod, rod.initial({{"rod", twist}}), 2);
  const Solution expected = solve(body, body.initial({{"rod", twist}}), 2, testing::accurate(1e-13));
  ASSERT_EQ(motion.status().stop, Stop::reached_end) << motion.status().message;
  const Isometry3d found = rod.pose(motion.at(2).q, "rod"), known = body.pose(expected.at(2).q, "rod");
  EXPECT_LE((found.translation() - known.translation()).norm(), tolerance(40));
  EXPECT_LE((found.linear().col(2) - known.linear().col(2)).norm(), tolerance(40));
}

// A point mass lands on the ground and stays there.
TEST_P(MultibodySlender, PointMassLands) {
  MultibodySystem system;
  system.point_mass("stone", 2, {0, 0, 1.1}).contact("ground", "stone", ContactShape::sphere(0.1));
  const Solution motion = motion_of(system, system.initial({{"stone", {{1, 0, 0}, origin}}}), 1);
  ASSERT_EQ(motion.status().stop, Stop::reached_end) << motion.status().message;
  EXPECT_NEAR(motion.at(1).q[0], 1, tolerance(4));
  EXPECT_NEAR(motion.at(1).q[2], 0.1, tolerance(10));
  EXPECT_NEAR(motion.at(1).multipliers[0], 2 * gravity, tolerance(100));
}

// A torque that is meant turns what cannot be turned.
TEST(MultibodySlenderBody, EndsTheMotionAtATorqueWithoutInertia) {
  MultibodySystem pushed;
  pushed.point_mass("bob", 1, {1, 0, 0}).apply("bob", Wrench{{1, 0, 0}, {0, 0, 0.5}});
  const Solution motion = solve(pushed, pushed.initial(), 1);
  EXPECT_EQ(motion.status().stop, Stop::undefined);
  EXPECT_NE(motion.status().message.find("wrench of body bob has a torque on body bob about an axis without"),
            std::string::npos)
      << motion.status().message;
  MultibodySystem rod;
  rod.thin_rod("rod", 1, {1, 0, 0}, {1, 0, 2}).apply("rod", Wrench{{0, 0, 0}, {0.1, 0, 0}});
  EXPECT_EQ(solve(rod, rod.initial(), 1).status().stop, Stop::reached_end);
  rod.apply("rod", Wrench{{0, 0, 0}, {0, 0, 0.1}});
  EXPECT_EQ(solve(rod, rod.initial(), 1).status().stop, Stop::undefined);
}

template <class Call>
std::string refusal(Call call) {
  try {
    call();
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

TEST(MultibodySlenderBody, RefusesPartsThatTurnWhatHasNoInertia) {
  MultibodySystem system;
  const Vector3d end(0.3, 0.4, 1.2), x(1, 0, 0), at(5, 6, 7);
  system.thin_rod("rod", 1, origin, end).point_mass("bob", 2, at).body("box", 1, {1, 1, 1}, x);
  EXPECT_EQ(refusal([&] { system.hinge("pivot", "world", "rod", origin, y); }),
            "constraint \"pivot\": a part that acts on the rotation of thin rod \"rod\" about its line is "
            "refused; allowed: parts that act at points of its line, or a body() with moments of inertia");
  EXPECT_EQ(refusal([&] { system.spring("s", "bob", "box", at + x, x, 1, 1); }),
            "spring \"s\": a part that acts on the rotation of point mass \"bob\" is refused; allowed: parts "
            "that act at its position, or a body() with moments of inertia");
  EXPECT_NE(refusal([&] { system.ball("b", "world", "rod", x); }), "");
  EXPECT_NE(refusal([&] { system.ball("b", "box", "bob", x); }), "");
  EXPECT_NE(refusal([&] { system.rod("b", "world", "bob", origin, x); }), "");
  EXPECT_NE(refusal([&] { system.weld("w", "box", "bob", at); }), "");
  EXPECT_NE(refusal([&] { system.slider("w", "bob", "world", at, y); }), "");
  EXPECT_NE(refusal([&] { system.planar("p", "world", "rod", origin, y); }), "");
  EXPECT_NE(refusal([&] { system.rolling("r", "bob", ContactShape::sphere(1)); }), "");
  EXPECT_NE(refusal([&] { system.damper("d", "rod", "box", origin + x, at, 1); }), "");
  EXPECT_TRUE(system.constraints.empty());
  EXPECT_EQ(
      refusal([&] {
        system.ball("b", "world", "rod", 0.7 * end)
            .ball("c", "rod", "bob", at)
            .spring("s", "rod", "bob", 0.1 * end, at, 1, 1)
            .damper("d", "bob", "box", at, end, 1)
            .contact("ground", "bob", ContactShape::sphere(0.1));
      }),
      "constraint \"c\": a part that acts on the rotation of thin rod \"rod\" about its line is refused; "
      "allowed: parts that act at points of its line, or a body() with moments of inertia");
  EXPECT_EQ(refusal([&] {
              system.rod("c", "rod", "bob", end, at)
                  .spring("s", "rod", "bob", 0.1 * end, at, 1, 1)
                  .damper("d", "bob", "box", at, end, 1)
                  .contact("ground", "bob", ContactShape::sphere(0.1));
            }),
            "");
}

TEST(MultibodySlenderBody, RefusesBadInput) {
  MultibodySystem system;
  EXPECT_EQ(refusal([&] { system.point_mass("p", -1, origin); }),
            "body \"p\": mass = -1 is refused; allowed: a number > 0");
  EXPECT_EQ(refusal([&] {
              system.point_mass("p", 1, {nan, 0, 0});
            }),
            "body \"p\": position = (nan, 0, 0) is refused; allowed: finite numbers");
  EXPECT_EQ(refusal([&] { system.thin_rod("r", 1, y, y); }),
            "body \"r\": length = 0 is refused; allowed: a number > 0");
  EXPECT_NE(refusal([&] { system.thin_rod("r", 0, origin, y); }), "");
  EXPECT_NE(refusal([&] { system.thin_rod("r", 1, origin, {0, nan, 0}); }), "");
  EXPECT_NE(refusal([&] { system.thin_rod("r", 1, {nan, 0, 0}, y); }), "");
  EXPECT_NE(refusal([&] { system.thin_rod("r", 1, origin, {1e-170, 0, 0}); }), "");
  EXPECT_NE(refusal([&] { system.thin_rod("world", 1, origin, y); }), "");
  EXPECT_EQ(system.coordinates.size(), 0u);
  system.thin_rod("r", 1, origin, -2 * y);
  EXPECT_NE(refusal([&] { system.point_mass("r", 1, origin); }), "");
  const Isometry3d pose = system.pose(system.initial().q, "r");
  EXPECT_LE((pose * Vector3d(0, 0, 1) + 2 * y).norm(), 1e-15);
  EXPECT_LE((pose * Vector3d(0, 0, -1)).norm(), 1e-15);
}

}  // namespace
}  // namespace hybrid_sphere::mechanics::multibody_slender_test

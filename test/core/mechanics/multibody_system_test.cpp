// Rigid bodies and joints against known motions.
#include "hybrid_sphere/mechanics/multibody_system.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/mechanics/particle.hpp"

namespace hybrid_sphere::mechanics::multibody_system_test {
namespace {

using Eigen::AngleAxisd;
using Eigen::Isometry3d;
using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double gravity = 9.81;
const Vector3d no_gravity(0, 0, 0);

class Multibody : public ::testing::TestWithParam<double> {
 protected:
  Solution motion_of(const Model& model, const Initial& start, double duration) const {
    return solve(model, start, duration, testing::accurate(GetParam()));
  }
  /// The error of q and v relative to the scale of motion; a few of it where the scale is an estimate.
  double tolerance(double scale) const { return 4 * GetParam() * scale; }
};

INSTANTIATE_TEST_SUITE_P(Accuracies, Multibody, ::testing::Values(1e-6, 1e-9, 1e-12));

Isometry3d turned(double angle, const Vector3d& axis, const Vector3d& center) {
  return Eigen::Translation3d(center) * AngleAxisd(angle, axis.normalized());
}

// Euler's top keeps its energy and its angular momentum in the world; its centre goes straight on.
TEST_P(Multibody, TorqueFreeBodyKeepsItsAngularMomentum) {
  const Inertia inertia(1.1, 1.6, 2.3, 0.1, -0.2, 0.15);
  MultibodySystem system(no_gravity);
  system.body("top", 2, inertia, turned(0.8, {1, 2, 3}, {1, -1, 0.5}));
  const Vector3d v(0.3, -0.2, 0.1), w(0.4, 3, 0.5);
  const Solution motion = motion_of(system, system.initial({{"top", {v, w}}}), 10);
  ASSERT_EQ(motion.status().stop, Stop::reached_end) << motion.status().message;
  const auto spin = [&](const State& state) {
    const Matrix3d R = system.pose(state.q, "top").linear();
    return Vector3d(R * inertia.matrix * R.transpose() *
                    system.twist(state.q, state.v, "top").angular_velocity);
  };
  const State first = motion.at(0);
  for (int i = 0; i <= 10; ++i) {
    const State state = motion.at(i);
    EXPECT_LE((spin(state) - spin(first)).norm(), tolerance(spin(first).norm()));
    EXPECT_NEAR(state.energy, first.energy, tolerance(2 * first.energy));
    EXPECT_LE((system.pose(state.q, "top").translation() - Vector3d(1, -1, 0.5) - i * v).norm(),
              tolerance(v.norm() * 10) + 1e-14);
    EXPECT_NEAR(state.q.tail<4>().norm(), 1, 1e-15);
  }
}

// A symmetric top on a ball joint precesses steadily where A W^2 cos(theta) - C w3 W + m g l = 0.
TEST_P(Multibody, HeavyTopPrecessesSteadily) {
  constexpr double m = 1.5, l = 0.4, A = 0.3, C = 0.12, theta = 0.5, W = 1.5;
  constexpr double about_pivot = A + m * l * l;
  const double w3 = (about_pivot * W * W * std::cos(theta) + m * gravity * l) / (C * W);
  const Matrix3d tilt = AngleAxisd(theta, Vector3d::UnitY()).toRotationMatrix();
  const Vector3d axis = tilt.col(2);
  const Vector3d w = W * Vector3d::UnitZ() + (w3 - W * std::cos(theta)) * axis;
  Isometry3d placement(tilt);
  placement.pretranslate(l * axis);
  MultibodySystem system;
  system.body("top", m, {A, A, C}, placement).ball("pivot", "world", "top", {0, 0, 0});
  const Solution motion = motion_of(system, system.initial({{"top", {w.cross(l * axis), w}}}), 3);
  ASSERT_EQ(motion.status().stop, Stop::reached_end) << motion.status().message;
  for (int i = 0; i <= 6; ++i) {
    const State state = motion.at(i / 2.0);
    const Matrix3d expected = AngleAxisd(W * state.time, Vector3d::UnitZ()).toRotationMatrix() * tilt *
                              AngleAxisd((w3 - W * std::cos(theta)) * state.time, Vector3d::UnitZ());
    const Isometry3d pose = system.pose(state.q, "top");
    EXPECT_LE((pose.linear() - expected).norm(), tolerance(1));
    EXPECT_LE((pose.translation() - l * expected.col(2)).norm(), tolerance(1));
    // The pivot gives the centre its acceleration, W^2 times its distance from the vertical.
    const Vector3d out(pose.translation().x(), pose.translation().y(), 0);
    const Vector3d force = -m * W * W * out + m * gravity * Vector3d::UnitZ();
    EXPECT_LE((state.multipliers.head<3>() - force).norm(), tolerance(10 * w3 * m * gravity));
  }
}

// A compound pendulum, (I + m l^2) angle'' = -m g l sin(angle), about an axis that is not the body's.
TEST_P(Multibody, HingeMakesAPendulum) {
  constexpr double m = 2, l = 0.5, about_axis = 0.17, angle = 1.2, rate = 1.5;
  MultibodySystem system;
  const Matrix3d turn = AngleAxisd(0.7, Vector3d(1, 1, 2).normalized()).toRotationMatrix();
  const Vector3d moments(0.2, about_axis, 0.15);  // about the world's axes where it hangs
  const Vector3d center(-l * std::sin(angle), 3, -l * std::cos(angle));
  Isometry3d placement = turned(angle, Vector3d::UnitY(), center);
  const Matrix3d inertia = turn.transpose() * moments.asDiagonal() * turn;
  placement.linear() = placement.linear() * turn;
  system.body("rod", m, Inertia(inertia), placement).hinge("pivot", "world", "rod", {0, 3, 0}, {0, 2, 0});
  const Vector3d w(0, rate, 0);
  const Initial start = system.initial({{"rod", {w.cross(center - Vector3d(0, 3, 0)), w}}});
  const System<1> pendulum({"angle"}, [](auto, const auto& q, const auto& v) {
    using std::cos;
    return (about_axis + m * l * l) / 2 * v[0] * v[0] + m * gravity * l * cos(q[0]);
  });
  const Solution expected = solve(pendulum, {0, {angle}, {rate}}, 5, testing::accurate(1e-13));
  const Solution motion = motion_of(system, start, 5);
  ASSERT_EQ(motion.status().stop, Stop::reached_end) << motion.status().message;
  for (int i = 0; i <= 20; ++i) {
    const State state = motion.at(i / 4.0);
    const State known = expected.at(state.time);
    const Vector3d place(-l * std::sin(known.q[0]), 3, -l * std::cos(known.q[0]));
    EXPECT_LE((system.pose(state.q, "rod").translation() - place).norm(), tolerance(5)) << state.time;
    EXPECT_NEAR(system.twist(state.q, state.v, "rod").angular_velocity.y(), known.v[0], tolerance(20));
    EXPECT_LT(system.velocity(state.q, state.v, "rod", placement.inverse() * Vector3d(0, 3, 0)).norm(),
              1e-13);
  }
}

// Two bodies that are welded move as one, whose moments are theirs by Steiner's theorem.
TEST_P(Multibody, WeldMakesOneBodyOfTwo) {
  const Vector3d one(0, 0, 0), other(0.6, 0.2, -0.1), joint(1, 2, 3);
  constexpr double m1 = 2, m2 = 1;
  const Inertia I1(0.4, 0.5, 0.6), I2(0.2, 0.25, 0.3, 0.01, 0.02, -0.03);
  const Vector3d center = (m1 * one + m2 * other) / (m1 + m2);
  const auto steiner = [&](double m, const Vector3d& r) {
    return Matrix3d(m * (r.squaredNorm() * Matrix3d::Identity() - r * r.transpose()));
  };
  const Matrix3d whole = I1.matrix + I2.matrix + steiner(m1, one - center) + steiner(m2, other - center);
  MultibodySystem two(no_gravity), single(no_gravity);
  two.body("one", m1, I1, one).body("other", m2, I2, other).weld("weld", "one", "other", joint);
  single.body("whole", m1 + m2, Inertia(whole), center);
  const Vector3d v(0.1, 0.2, 0.3), w(1, 2, -0.5);
  const Initial start = two.initial({{"one", {v, w}}});
  const Solution motion = motion_of(two, start, 4);
  const Solution expected =
      solve(single, single.initial({{"whole", {v + w.cross(center - one), w}}}), 4, testing::accurate(1e-13));
  ASSERT_EQ(motion.status().stop, Stop::reached_end) << motion.status().message;
  const Isometry3d pose = single.pose(expected.at(4).q, "whole");
  const State last = motion.at(4);
  EXPECT_LE((two.pose(last.q, "one").linear() - pose.linear()).norm(), tolerance(10));
  EXPECT_LE((two.pose(last.q, "one").translation() - pose * (one - center)).norm(), tolerance(10));
  EXPECT_LE((two.pose(last.q, "other").translation() - pose * (other - center)).norm(), tolerance(10));
}

// On a straight guide a body falls with the component of gravity along it, and the guide bears the rest.
TEST_P(Multibody, SliderFallsAlongItsAxis) {
  const Vector3d axis = Vector3d(1, 0, -2).normalized();
  MultibodySystem system;
  system.body("slide", 3, {0.1, 0.2, 0.25}, turned(0.4, {1, 1, 0}, {0, 0, 1}))
      .slider("guide", "world", "slide", {0, 0, 1}, axis);
  const Solution motion = motion_of(system, system.initial(), 2);
  ASSERT_EQ(motion.status().stop, Stop::reached_end) << motion.status().message;
  const State last = motion.at(2);
  const Vector3d way = 2 * 2 / 2.0 * axis * axis.dot(Vector3d(0, 0, -gravity));
  EXPECT_LE((system.pose(last.q, "slide").translation() - Vector3d(0, 0, 1) - way).norm(),
            tolerance(way.norm()) + 1e-13);
  EXPECT_NEAR(last.multipliers.head<2>().norm(), 3 * gravity * Vector3d::UnitZ().cross(axis).norm(), 1e-12);
  EXPECT_LE(last.multipliers.tail<3>().norm(), 1e-12);
}

// A body on a level table goes on and turns about the normal; the table bears its weight.
TEST_P(Multibody, PlanarGoesStraightOnAndTurns) {
  MultibodySystem system;
  system.body("puck", 2, {0.3, 0.4, 0.5, 0.05}, Vector3d(0, 0, 1))
      .planar("table", "world", "puck", {0, 0, 1}, {0, 0, 1});
  const Solution motion = motion_of(system, system.initial({{"puck", {{1, 2, 0}, {0, 0, 3}}}}), 2);
  ASSERT_EQ(motion.status().stop, Stop::reached_end) << motion.status().message;
  const Isometry3d pose = system.pose(motion.at(2).q, "puck");
  EXPECT_LE((pose.translation() - Vector3d(2, 4, 1)).norm(), tolerance(5) + 1e-14);
  EXPECT_LE((pose.linear() - AngleAxisd(6, Vector3d::UnitZ()).toRotationMatrix()).norm(), tolerance(6));
  EXPECT_NEAR(motion.at(2).multipliers[0], 2 * gravity, 1e-12);
}

// A conical pendulum, W^2 = g / (l cos(angle)); the rod pulls with m g / cos(angle).
TEST_P(Multibody, RodMakesAConicalPendulum) {
  constexpr double l = 0.8, angle = 0.6, m = 1.5;
  const double W = std::sqrt(gravity / (l * std::cos(angle)));
  const Vector3d center(l * std::sin(angle), 0, -l * std::cos(angle));
  MultibodySystem system;
  system.body("bob", m, {0.1, 0.1, 0.1}, center).rod("rod", "world", "bob", {0, 0, 0}, center);
  const double speed = W * l * std::sin(angle);
  const Solution motion = motion_of(system, system.initial({{"bob", {{0, speed, 0}, {0, 0, 0}}}}), 3);
  ASSERT_EQ(motion.status().stop, Stop::reached_end) << motion.status().message;
  const State last = motion.at(3);
  const Vector3d expected = AngleAxisd(W * 3, Vector3d::UnitZ()) * center;
  EXPECT_LE((system.pose(last.q, "bob").translation() - expected).norm(), tolerance(speed * 3));
  EXPECT_NEAR(last.multipliers[0], -m * gravity / std::cos(angle), tolerance(10 * m * gravity));
}

// A hinge twice: the motion is unique, the multipliers are halves.
TEST_P(Multibody, RedundantHingesShareTheLoad) {
  MultibodySystem system;
  system.body("door", 20, {2, 1.5, 1}, Vector3d(0.4, 0, 1))
      .hinge("upper", "world", "door", {0, 0, 1.8}, {0, 0, 1})
      .hinge("lower", "world", "door", {0, 0, 0.2}, {0, 0, 1});
  const Vector3d w(0, 0, 1);
  const Solution motion = motion_of(system, system.initial({{"door", {w.cross(Vector3d(0.4, 0, 0)), w}}}), 2);
  ASSERT_EQ(motion.status().stop, Stop::reached_end) << motion.status().message;
  const State last = motion.at(2);
  EXPECT_LE((system.twist(last.q, last.v, "door").angular_velocity - w).norm(), tolerance(1));
  EXPECT_NEAR(last.multipliers[2] + last.multipliers[7], 20 * gravity, tolerance(2000));
  EXPECT_NEAR(last.multipliers[2], last.multipliers[7], tolerance(2000));
}

TEST_P(Multibody, WrenchesActInTheWorld) {
  MultibodySystem system(no_gravity);
  system.body("pushed", 2, {0.5, 0.6, 0.7}, turned(M_PI / 2, Vector3d::UnitZ(), {0, 0, 0}))
      .body("braked", 3, {1, 1, 1}, Vector3d(0, 5, 0))
      .apply("pushed", Wrench{{1, 0, 0}, {0.3, 0, 0}})
      .apply("braked", [](double t, const BodyState& body) {
        return Wrench{-6 * body.twist.velocity, {0, 0, t * body.pose.translation().y()}};
      });
  const Solution motion = motion_of(system, system.initial({{"braked", {{2, 0, 0}, {0, 0, 0}}}}), 2);
  ASSERT_EQ(motion.status().stop, Stop::reached_end) << motion.status().message;
  const State last = motion.at(2);
  EXPECT_LE((system.pose(last.q, "pushed").translation() - Vector3d(0.5 * 0.5 * 4, 0, 0)).norm(),
            tolerance(2));
  // The world's x is the body's -y.
  EXPECT_NEAR(system.twist(last.q, last.v, "pushed").angular_velocity.x(), 0.3 / 0.6 * 2, tolerance(4));
  EXPECT_NEAR(last.v[6], 2 * std::exp(-2.0 * 2), tolerance(8));
  EXPECT_NEAR(last.v[11], 5 * 2 * 2 / 2.0, tolerance(40));
}

TEST(MultibodyWhen, IsThatOfAnySystem) {
  MultibodySystem system(no_gravity);
  system.body("bar", 2, {0.2, 0.3, 0.4}, Vector3d(0, 0, 0));
  system.blade("late", "bar", {0.5, 0, 0}, {1, 0, 0}, from(0.5))
      .blade("while", "bar", {0, 0, 0}, {1, 0, 0},
             while_positive([](auto, const auto& q) { return (q[0] - 2) * (3 - q[0]); }))
      .blade("once", "bar", {0, 0, 0}, {0, 1, 0}, between(10, 11));
  EXPECT_EQ(system.constraints[0].schedule.begin, 0.5);
  EXPECT_EQ(system.constraints[2].schedule.end, 11);
  const Solution motion = solve(system, system.initial({{"bar", {{1, 0.3, 0}, {0, 0, 0}}}}), 6);
  ASSERT_EQ(motion.status().stop, Stop::reached_end) << motion.status().message;
  ASSERT_GE(motion.switches().size(), 2u);
  EXPECT_EQ(motion.switches()[0].time, 0.5);
  EXPECT_EQ(motion.switches()[0].applied, ActiveSet{0});
  EXPECT_EQ(motion.switches()[1].applied, ActiveSet{1});
  EXPECT_NEAR(motion.switches()[1].q[0], 2, 1e-9);
  // The guard of a joint of two bodies is of the first of them.
  MultibodySystem two(no_gravity);
  two.body("one", 1, {1, 1, 1}, Vector3d(-1, 0, 0)).body("two", 1, {1, 1, 1}, Vector3d(1, 0, 0));
  two.ball("joint", "world", "two", {1, 0, 0}, while_positive([](auto, const auto& q) { return q[0]; }));
  EXPECT_EQ(two.constraints[0].schedule.guard->value(0, two.initial().q), 1);
  Vector rate = Vector::Zero(14);
  rate[7] = 3;
  EXPECT_EQ(two.constraints[0].schedule.guard->rate(0, two.initial().q, rate), 3);
}

TEST(MultibodyWhen, TakesAnIntervalWithAGuardByHand) {
  const auto by_hand = automatic_guard<7>("guard", [](auto, const auto& q) { return 3 - q[0]; });
  MultibodySystem system(no_gravity);
  system.body("bar", 2, {0.2, 0.3, 0.4}, Vector3d(0, 0, 0));
  system.blade("blade", "bar", {0, 0, 0}, {1, 0, 0}, {between(1, 9), by_hand})
      .blade("late", "bar", {0, 0, 0}, {1, 0, 0}, {from(20), nullptr});
  EXPECT_EQ(system.constraints[1].schedule.guard, nullptr);
  const Solution motion = solve(system, system.initial({{"bar", {{1, 0, 0}, {0, 0, 0}}}}), 6);
  ASSERT_EQ(motion.switches().size(), 2u) << motion.status().message;
  EXPECT_EQ(motion.switches()[0].time, 1);
  EXPECT_NEAR(motion.switches()[1].time, 3, 1e-9);
}

/// A parallelogram of cranks of length 1, upright, and a coupler. Twenty functions leave one of eighteen
/// velocities: three of them say nothing new.
MultibodySystem parallelogram() {
  MultibodySystem linkage;
  const Vector3d axis(0, 1, 0);
  linkage.body("crank", 1, {0.1, 0.1, 0.1}, Vector3d(0, 0, 0.5))
      .body("coupler", 2, {0.1, 0.1, 0.1}, Vector3d(1, 0, 1))
      .body("rocker", 1, {0.1, 0.1, 0.1}, Vector3d(2, 0, 0.5))
      .hinge("a", "world", "crank", {0, 0, 0}, axis)
      .hinge("b", "crank", "coupler", {0, 0, 1}, axis)
      .hinge("c", "coupler", "rocker", {2, 0, 1}, axis)
      .hinge("d", "rocker", "world", {2, 0, 0}, axis);
  return linkage;
}

// (2 (0.1 + 1/4) + 2) angle'^2 / 2 + (1 + 2) g cos(angle): a redundant linkage moves as one pendulum.
TEST_P(Multibody, RedundantLinkageMovesAsAPendulum) {
  const MultibodySystem linkage = parallelogram();
  const System<1> pendulum({"angle"}, [](auto, const auto& q, const auto& v) {
    using std::cos;
    return 2.7 / 2 * v[0] * v[0] - 3 * gravity * cos(q[0]);
  });
  const Solution expected = solve(pendulum, {0, {0.0}, {2.0}}, 0.4, testing::accurate(1e-13));
  const Solution motion = motion_of(linkage, linkage.initial({{"crank", {{1, 0, 0}, {0, 2, 0}}}}), 0.4);
  ASSERT_EQ(motion.status().stop, Stop::reached_end) << motion.status().message;
  const State last = motion.at(0.4);
  const double angle = expected.at(0.4).q[0];
  EXPECT_LE(
      (linkage.pose(last.q, "coupler").translation() - Vector3d(1 + std::sin(angle), 0, std::cos(angle)))
          .norm(),
      tolerance(2));
  EXPECT_NEAR(linkage.twist(last.q, last.v, "rocker").angular_velocity.y(), expected.at(0.4).v[0],
              tolerance(10));
}

// What is not given is found: of a linkage one speed says all.
TEST(MultibodyInitial, FindsTheVelocitiesOfTheOtherBodies) {
  const MultibodySystem linkage = parallelogram();
  const Initial start = linkage.initial({{"crank", {{1, 0, 0}, {0, 2, 0}}}});
  const Twist rocker = linkage.twist(start.q, start.v, "rocker");
  EXPECT_LE((rocker.velocity - Vector3d(1, 0, 0)).norm(), 1e-14);
  EXPECT_LE((rocker.angular_velocity - Vector3d(0, 2, 0)).norm(), 1e-14);
  EXPECT_LE((linkage.twist(start.q, start.v, "coupler").velocity - Vector3d(2, 0, 0)).norm(), 1e-14);
  EXPECT_EQ(linkage.initial().v, Vector::Zero(18));
  // Of a pair that a ball joint holds, the free one takes the least energy: it does not turn.
  MultibodySystem pair;
  pair.body("one", 1, {1, 1, 1}, Vector3d(0, 0, 0)).body("two", 2, {1, 1, 1}, Vector3d(0, 0, 0));
  pair.ball("joint", "one", "two", {0, 0, 0});
  const Initial pulled = pair.initial({{"one", {{1, 2, 3}, {4, 5, 6}}}});
  EXPECT_LE((pulled.v.tail<6>() - testing::vector({1, 2, 3, 0, 0, 0})).norm(), 1e-14);
}

TEST(MultibodySystem, NamesItsCoordinatesAndGivesItsPoses) {
  MultibodySystem system;
  const Isometry3d placement = turned(0.9, {1, -2, 0.5}, {1, 2, 3});
  system.body("a", 1, {1, 1, 1}, placement).body("b", 1, {1, 1, 1}, Vector3d(4, 5, 6));
  EXPECT_EQ(system.coordinates[10], "b.qw");
  EXPECT_EQ(system.velocities[3], "a.w1");
  check(system);
  const Initial start = system.initial({{"a", {{1, 0, 0}, {0, 0, 2}}}});
  const std::vector<Isometry3d> poses = system.poses(start.q);
  ASSERT_EQ(poses.size(), 2u);
  EXPECT_LE((poses[0].matrix() - placement.matrix()).norm(), 1e-15);
  EXPECT_EQ(poses[1].translation(), Vector3d(4, 5, 6));
  const Vector3d arm = placement.linear() * Vector3d(0.1, 0.2, 0.3);
  const Vector3d expected = Vector3d(1, 0, 0) + Vector3d(0, 0, 2).cross(arm);
  EXPECT_LE((system.velocity(start.q, start.v, "a", {0.1, 0.2, 0.3}) - expected).norm(), 1e-15);
  // A copy is its own.
  MultibodySystem copy = system;
  copy.body("c", 1, {1, 1, 1}, Vector3d(0, 0, 0)).apply("a", Wrench{{1, 0, 0}, {0, 0, 0}});
  EXPECT_EQ(system.equations->velocities(), 12);
  EXPECT_EQ(copy.equations->velocities(), 18);
  const Model sliced = copy;
  EXPECT_EQ(solve(sliced, copy.initial(), 1).status().stop, Stop::reached_end);
}

}  // namespace
}  // namespace hybrid_sphere::mechanics::multibody_system_test

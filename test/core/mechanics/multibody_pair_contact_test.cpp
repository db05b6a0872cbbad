// Contacts between two bodies, against known motions.
#include <gtest/gtest.h>

#include <cmath>

#include "core/mechanics/particle.hpp"
#include "hybrid_sphere/mechanics/multibody_system.hpp"

namespace hybrid_sphere::mechanics::multibody_pair_contact_test {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr double gravity = 9.81;

class MultibodyPairContact : public ::testing::TestWithParam<double> {
 protected:
  Solution motion_of(const Model& model, const Initial& start, double duration) const {
    return solve(model, start, duration, testing::accurate(GetParam()));
  }
  /// The error of q and v relative to the scale of motion; a few of it where the scale is an estimate.
  double tolerance(double scale) const { return 4 * GetParam() * scale; }
};

INSTANTIATE_TEST_SUITE_P(Accuracies, MultibodyPairContact, ::testing::Values(1e-6, 1e-9, 1e-12));

constexpr double m = 0.5, r = 0.1, I = 0.4 * m * r * r, M = 2;
constexpr double top = 0.05;  // height of the plank's surface [m]

/// A ball on a plank that slides on smooth ground.
MultibodySystem ball_on_a_plank(const Vector3d& place) {
  MultibodySystem system;
  system.body("plank", M, {0.1, 1, 1.1}, Vector3d(0, 0, top / 2))
      .body("ball", m, {I, I, I}, place)
      .planar("ice", "world", "plank", {0, 0, 0}, {0, 0, 1});
  return system;
}
const Plane top_of_plank{{0, 0, top}, {0, 0, 1}, "plank"};

Vector3d momentum(const MultibodySystem& system, const State& state) {
  return m * system.twist(state.q, state.v, "ball").velocity +
         M * system.twist(state.q, state.v, "plank").velocity;
}

// Friction mu m g changes the slip by mu g (1 + 5/2 + m/M): of the ball, of its rotation and of the plank. A
// slip across the line through both centres would turn the plank.
TEST_P(MultibodyPairContact, BallSlidesAndRollsOnAFreePlank) {
  constexpr double mu = 0.2;
  const Vector3d along(1, 0, 0), v0 = 3 * along;
  MultibodySystem system = ball_on_a_plank({0.2, 0, top + r});
  system.contact("touch", "ball", ContactShape::sphere(r), 0, top_of_plank).friction("grip", "touch", mu);
  const Solution motion = motion_of(system, system.initial({{"ball", {v0, {0, 0, 0}}}}), 2);
  ASSERT_EQ(motion.status().stop, Stop::reached_end) << motion.status().message;
  ASSERT_EQ(motion.switches().size(), 1u);
  const double end_of_slip = v0.norm() / (mu * gravity * (3.5 + m / M));
  EXPECT_NEAR(motion.switches()[0].time, end_of_slip, tolerance(1));
  const State sliding = motion.at(end_of_slip / 2), last = motion.at(2);
  const Index touch = system.multiplier_of(1), grip = system.multiplier_of(2);
  EXPECT_NEAR(sliding.multipliers[touch], m * gravity, 1e-12);
  EXPECT_NEAR(sliding.multipliers.segment(grip, 2).norm(), mu * m * gravity, 1e-12);
  const double lost = mu * gravity * end_of_slip;
  EXPECT_LE((system.twist(last.q, last.v, "ball").velocity - v0 + lost * along).norm(), tolerance(3));
  EXPECT_LE((system.twist(last.q, last.v, "plank").velocity - lost * m / M * along).norm(), tolerance(3));
  const Vector3d spin = 2.5 * lost / r * Vector3d::UnitZ().cross(along);
  EXPECT_LE((system.twist(last.q, last.v, "ball").angular_velocity - spin).norm(), tolerance(30));
  EXPECT_LE((momentum(system, last) - m * v0).norm(), 1e-13);
  EXPECT_LE(last.multipliers.segment(grip, 2).norm(), 1e-12);  // rolls on without a force
}

// The height of the ball above the plank stays 0, and its rate is far less than the round-off of the other
// velocities.
TEST(MultibodyPairContactThatHolds, IsNotReleasedByRoundoff) {
  for (const double accuracy : {1e-6, 1e-8, 1e-9, 1e-10}) {
    MultibodySystem system = ball_on_a_plank({0.2, -0.1, top + r});
    system.contact("touch", "ball", ContactShape::sphere(r), 0, top_of_plank).friction("grip", "touch", 0.2);
    const Initial start = system.initial({{"ball", {3 * Vector3d(2, -1, 0).normalized(), {0, 0, 0}}}});
    const Solution motion = solve(system, start, 2, testing::accurate(accuracy));
    ASSERT_EQ(motion.status().stop, Stop::reached_end) << motion.status().message;
    EXPECT_EQ(motion.switches().size(), 1u) << accuracy;
    EXPECT_EQ(motion.at(2).active, (ActiveSet{0, 1, 2})) << accuracy;
  }
}

// F pushes the plank below the ball, which rolls: its force f = 2/7 m a leaves F - f = M a. The ball stays on
// the line of F, so that the plank does not turn.
TEST_P(MultibodyPairContact, BallRollsOnAPlankThatIsPushed) {
  constexpr double F = 4, a = F / (M + 2 * m / 7);
  MultibodySystem system = ball_on_a_plank({0, 0, top + r});
  system.rolling("roll", "ball", ContactShape::sphere(r), always(), top_of_plank)
      .apply("plank", {{F * 0.6, F * 0.8, 0}, {0, 0, 0}});
  const Vector3d along(0.6, 0.8, 0);
  const Solution motion = motion_of(system, system.initial(), 1);
  ASSERT_EQ(motion.status().stop, Stop::reached_end) << motion.status().message;
  const State last = motion.at(1);
  EXPECT_LE((system.twist(last.q, last.v, "plank").velocity - a * along).norm(), tolerance(2));
  EXPECT_LE((system.twist(last.q, last.v, "ball").velocity - 2 * a / 7 * along).norm(), tolerance(2));
  const Vector3d spin = -5 * a / (7 * r) * Vector3d::UnitZ().cross(along);
  EXPECT_LE((system.twist(last.q, last.v, "ball").angular_velocity - spin).norm(), tolerance(20));
  EXPECT_LE((system.pose(last.q, "ball").translation() - Vector3d(0, 0, top + r) - a / 7 * along).norm(),
            tolerance(1));
  EXPECT_LT(last.residual, 1e-12);
}

struct Momenta {
  Vector3d linear, angular;
  double energy;

  Momenta(const MultibodySystem& system, const Vector& q, const Vector& v) {
    linear.setZero();
    angular.setZero();
    energy = 0;
    const auto add = [&](const char* name, double mass, const Vector3d& moments) {
      const auto [velocity, w] = system.twist(q, v, name);
      const Isometry3d pose = system.pose(q, name);
      const Vector3d spin = pose.linear() * (moments.asDiagonal() * (pose.linear().transpose() * w));
      linear += mass * velocity;
      angular += spin + mass * pose.translation().cross(velocity);
      energy += (mass * velocity.dot(velocity) + spin.dot(w)) / 2;
    };
    add("ball", m, {I, I, I});
    add("plank", M, {0.1, 1, 1.1});
  }
};

// In free space a spinning ball strikes a free plank beside its centre, with friction: the impulse is the
// same on both, along the same line.
TEST_P(MultibodyPairContact, ImpactKeepsMomentumAndAngularMomentum) {
  for (const double mu : {0.0, 0.1, 2.0}) {
    MultibodySystem system(Vector3d(0, 0, 0));
    system.body("plank", M, {0.1, 1, 1.1}, Vector3d(0, 0, 0))
        .body("ball", m, {I, I, I}, Vector3d(0.6, 0.1, 0.5))
        .contact("touch", "ball", ContactShape::sphere(r), mu == 0 ? 1 : 0.6,
                 {{0, 0, top}, {0, 0, 1}, "plank"})
        .friction("grip", "touch", mu);
    const Initial start = system.initial(
        {{"ball", {{0.4, -0.3, -2}, {3, -5, 2}}}, {"plank", {{0.1, 0, 0.2}, {0.1, 0.3, -0.2}}}});
    const Solution motion = motion_of(system, start, 0.4);
    ASSERT_GE(motion.switches().size(), 1u);
    const Switch& impact = motion.switches()[0];
    const Momenta before(system, impact.q, impact.v_before), after(system, impact.q, impact.v_after);
    EXPECT_LE((after.linear - before.linear).norm(), 1e-14);
    EXPECT_LE((after.angular - before.angular).norm(), 1e-14);
    EXPECT_GT(impact.multipliers[0], 1);
    if (mu == 0) {
      EXPECT_NEAR(after.energy, before.energy, 1e-14);
    } else {
      EXPECT_LT(after.energy, before.energy);
      EXPECT_LE(impact.multipliers.tail(2).norm(), mu * impact.multipliers[0] * (1 + 1e-14));
    }
  }
}

/// A plank that tilts about the y axis through the middle of its top, and a wheel that rolls on it without
/// slipping: by their Lagrangian. q: the angle of the plank and the place of the wheel along it. With the
/// unit vectors e = (cos a, 0, -sin a) along and n = (sin a, 0, cos a) across the plank, the centre is at s e
/// + r n, and the wheel turns with a' + s'/r.
System<2> wheel_on_a_see_saw(double wheel_moment, double plank_moment) {
  return {{"a", "s"}, [=](auto, const auto& q, const auto& v) {
            using std::cos;
            using std::sin;
            const auto along = v[1] + r * v[0];
            const auto across = -q[1] * v[0];
            const auto turn = v[0] + v[1] / r;
            const auto height = -q[1] * sin(q[0]) + r * cos(q[0]);
            return (plank_moment * v[0] * v[0] + m * (along * along + across * across) +
                    wheel_moment * turn * turn) /
                       2 -
                   m * gravity * height;
          }};
}

TEST_P(MultibodyPairContact, BallAndWheelRollOnATiltingPlank) {
  constexpr double J = 0.8, s0 = 0.3, duration = 0.8;
  for (const ContactShape& shape : {ContactShape::sphere(r), ContactShape::disk(r, {0, 1, 0})}) {
    MultibodySystem system;
    system.body("plank", M, {0.1, J, J}, Vector3d(0, 0, 0))
        .body("ball", m, {I, I, I}, Vector3d(s0, 0, r))
        .hinge("axis", "world", "plank", {0, 0, 0}, {0, 1, 0})
        .rolling("roll", "ball", shape, always(), {{0, 0, 0}, {0, 0, 1}, "plank"});
    const double a1 = -0.4, s1 = -0.5;
    const Vector3d velocity(s1 + r * a1, 0, -s0 * a1);
    const Initial start =
        system.initial({{"plank", {{0, 0, 0}, {0, a1, 0}}}, {"ball", {velocity, {0, a1 + s1 / r, 0}}}});
    const Solution motion = motion_of(system, start, duration);
    ASSERT_EQ(motion.status().stop, Stop::reached_end) << motion.status().message;
    const Solution reference =
        solve(wheel_on_a_see_saw(I, J), {0, {0.0, s0}, {a1, s1}}, duration, testing::accurate(1e-13));
    for (const double t : {0.2, 0.5, duration}) {
      const State state = motion.at(t), known = reference.at(t);
      const double a = known.q[0], s = known.q[1];
      EXPECT_NEAR(system.angle(state.q, "axis"), a, tolerance(2)) << t;
      const Vector3d center(s * std::cos(a) + r * std::sin(a), 0, -s * std::sin(a) + r * std::cos(a));
      EXPECT_LE((system.pose(state.q, "ball").translation() - center).norm(), tolerance(2)) << t;
      EXPECT_NEAR(system.twist(state.q, state.v, "ball").angular_velocity.y(), known.v[0] + known.v[1] / r,
                  tolerance(40));
    }
  }
}

// The blow of two smooth balls is along the line of their centres: (1 + e) w m1 m2/(m1 + m2), with the
// velocity w at which these approach.
TEST_P(MultibodyPairContact, BallsExchangeMomentumAlongTheLineOfTheirCentres) {
  constexpr double r2 = 0.2, e = 0.7, offset = 0.15, v0 = 2, distance = 1;
  MultibodySystem system(Vector3d(0, 0, 0));
  system.body("one", m, {I, I, I}, Vector3d(0, offset, 0))
      .body("two", M, {0.1, 0.1, 0.1}, Vector3d(distance, 0, 0))
      .contact("click", "one", ContactShape::sphere(r), "two", ContactShape::sphere(r2), e);
  const Solution motion = motion_of(system, system.initial({{"one", {{v0, 0, 0}, {1, 2, 3}}}}), 1);
  ASSERT_EQ(motion.status().stop, Stop::reached_end) << motion.status().message;
  ASSERT_EQ(motion.switches().size(), 1u);
  const double reach = std::sqrt((r + r2) * (r + r2) - offset * offset);
  EXPECT_NEAR(motion.switches()[0].time, (distance - reach) / v0, tolerance(1));
  const Vector3d n = Vector3d(-reach, offset, 0) / (r + r2);  // from two to one
  const double blow = (1 + e) * v0 * -n.x() * m * M / (m + M);
  EXPECT_NEAR(motion.switches()[0].multipliers[0], blow, tolerance(4));
  const State last = motion.at(1);
  EXPECT_LE((system.twist(last.q, last.v, "one").velocity - Vector3d(v0, 0, 0) - blow / m * n).norm(),
            tolerance(10));
  EXPECT_LE((system.twist(last.q, last.v, "two").velocity + blow / M * n).norm(), tolerance(10));
}

// A ball that spins about the vertical strikes an equal one at rest. Friction that grips brings the surfaces
// to the same velocity: their slip r w changes by 2 (1 + 5/2)/m times the impulse.
TEST_P(MultibodyPairContact, SpinPassesFromBallToBall) {
  constexpr double v0 = 2, spin = 4, mu = 1;
  MultibodySystem system(Vector3d(0, 0, 0));
  system.body("one", m, {I, I, I}, Vector3d(0, 0, 0))
      .body("two", m, {I, I, I}, Vector3d(1, 0, 0))
      .contact("click", "one", ContactShape::sphere(r), "two", ContactShape::sphere(r), 1)
      .friction("grip", "click", mu);
  const Solution motion = motion_of(system, system.initial({{"one", {{v0, 0, 0}, {0, 0, spin}}}}), 0.6);
  ASSERT_GE(motion.switches().size(), 1u);
  const Switch& click = motion.switches()[0];
  const double grip = m * r * spin / 7;
  const auto one = system.twist(click.q, click.v_after, "one"),
             two = system.twist(click.q, click.v_after, "two");
  EXPECT_LE((one.velocity - Vector3d(0, -grip / m, 0)).norm(), tolerance(4));
  EXPECT_LE((two.velocity - Vector3d(v0, grip / m, 0)).norm(), tolerance(4));
  EXPECT_NEAR(one.angular_velocity.z(), spin - grip * r / I, tolerance(10));
  EXPECT_NEAR(two.angular_velocity.z(), -grip * r / I, tolerance(10));
}

// Two balls that press against one another, one of them on the axis that their slip is measured from.
TEST(MultibodyPairContactOfBalls, EndsWhereTheirSlipHasNoDirection) {
  MultibodySystem system(Vector3d(0, 0, 0));
  system.body("one", m, {I, I, I}, Vector3d(-2 * r, 0, 0))
      .body("two", M, {0.1, 0.1, 0.1}, Vector3d(0, 0, 0))
      .contact("touch", "one", ContactShape::sphere(r), "two", ContactShape::sphere(r))
      .friction("grip", "touch", 0.3);
  Initial start = system.initial();
  start.q[0] = 0;
  start.q[2] = 2 * r;  // above it: the axis is z
  start.v[2] = -1;
  const Solution motion = solve(system, start, 1);
  EXPECT_EQ(motion.status().stop, Stop::undefined);
}

}  // namespace
}  // namespace hybrid_sphere::mechanics::multibody_pair_contact_test

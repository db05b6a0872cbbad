// Coordinates, drives and limits of joints against known motions.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/mechanics/expect_terms.hpp"
#include "core/mechanics/particle.hpp"
#include "hybrid_sphere/mechanics/multibody_system.hpp"

namespace hybrid_sphere::mechanics::multibody_joints_test {
namespace {

using Eigen::AngleAxisd;
using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr double gravity = 9.81;
constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();
const Vector3d no_gravity(0, 0, 0);
const Vector3d origin(0, 0, 0);
const Vector3d axis = Vector3d(1, 2, 2) / 3;

class MultibodyJoints : public ::testing::TestWithParam<double> {
 protected:
  Solution motion_of(const Model& model, const Initial& start, double duration) const {
    return solve(model, start, duration, testing::accurate(GetParam()));
  }
  /// Error of q and v for a scale of motion. The scale is an estimate, hence the factor.
  double tolerance(double scale) const { return 4 * GetParam() * scale; }
};

INSTANTIATE_TEST_SUITE_P(Accuracies, MultibodyJoints, ::testing::Values(1e-6, 1e-9, 1e-12));

Isometry3d turned(double angle, const Vector3d& about, const Vector3d& center) {
  return Eigen::Translation3d(center) * AngleAxisd(angle, about.normalized());
}

/// Two wheels on one free axis, with their centres on it.
MultibodySystem two_wheels(double first, double second) {
  MultibodySystem system(no_gravity);
  const Isometry3d across = turned(0.6, {1, -1, 0}, origin);
  const auto inertia = [](const Isometry3d& placement, double about_axis) {
    const Vector3d a = placement.linear().transpose() * axis;
    return Inertia(0.8 * about_axis * Eigen::Matrix3d::Identity() + 0.2 * about_axis * a * a.transpose());
  };
  const Isometry3d other = turned(-1.3, {0, 1, 2}, 0.4 * axis);
  system.body("one", 2, inertia(across, first), across)
      .body("two", 1, inertia(other, second), other)
      .hinge("shaft", "one", "two", 0.2 * axis, 5 * axis);
  return system;
}

// The angle grows with the difference of both speeds and stays within (-pi, pi].
TEST_P(MultibodyJoints, AngleOfAHingeFollowsTheRotation) {
  const MultibodySystem system = two_wheels(0.3, 0.2);
  constexpr double first = -0.7, second = 2;
  const Initial start = system.initial({{"one", {origin, first * axis}}, {"two", {origin, second * axis}}});
  const Solution motion = motion_of(system, start, 6);
  ASSERT_EQ(motion.status().stop, Stop::reached_end) << motion.status().message;
  for (int i = 0; i <= 24; ++i) {
    const State state = motion.at(i / 4.0);
    const double angle = std::remainder((second - first) * state.time, 2 * M_PI);
    EXPECT_NEAR(std::remainder(system.angle(state.q, "shaft") - angle, 2 * M_PI), 0, tolerance(20)) << i;
    EXPECT_LE(std::abs(system.angle(state.q, "shaft")), M_PI);
    EXPECT_NEAR(system.angle_rate(state.q, state.v, "shaft"), second - first, tolerance(10));
  }
}

TEST(MultibodyJoint, AngleIsZeroAtThePlacementAndPiOnTheOtherSide) {
  const MultibodySystem system = two_wheels(0.3, 0.2);
  Vector q = system.initial().q;
  EXPECT_NEAR(system.angle(q, "shaft"), 0, 1e-15);
  const Eigen::Quaterniond placed(q[10], q[11], q[12], q[13]);
  for (const double sign : {-1.0, 1.0}) {
    const Eigen::Quaterniond turn = Eigen::Quaterniond(AngleAxisd(sign * M_PI, axis)) * placed;
    q.segment<4>(10) << turn.w(), turn.vec();
    EXPECT_NEAR(std::abs(system.angle(q, "shaft")), M_PI, 1e-14);
    EXPECT_GT(system.angle(q, "shaft"), -M_PI);
  }
}

// About an axis of the coordinates most velocities are 0 up to the round-off of round-off.
TEST_P(MultibodyJoints, TurnAboutAnAxisOfTheWorld) {
  MultibodySystem system(no_gravity);
  const Vector3d z(0, 0, 1);
  system.body("one", 2, {0.3, 0.3, 0.3}, origin)
      .body("two", 1, {0.2, 0.2, 0.2}, 0.4 * z)
      .hinge("shaft", "one", "two", 0.2 * z, z);
  const Initial start = system.initial({{"one", {origin, 0.5 * z}}, {"two", {origin, 2 * z}}});
  const Solution motion = motion_of(system, start, 2);
  ASSERT_EQ(motion.status().stop, Stop::reached_end) << motion.status().message;
  for (int i = 0; i <= 1000; ++i) {
    const State state = motion.at(2 * i / 1000.0);
    ASSERT_NEAR(system.angle(state.q, "shaft"), 1.5 * state.time, tolerance(8)) << i;
  }
}

// Large swings of a compound pendulum, whose motor feels its own angle and rate.
TEST_P(MultibodyJoints, DrivenPendulumIsThatOfItsLagrangian) {
  constexpr double m = 2, l = 0.5, about_axis = 0.17;
  MultibodySystem system;
  system.body("rod", m, {about_axis, about_axis, 0.02}, Vector3d(0, 0, -l))
      .hinge("pivot", "world", "rod", origin, {0, -1, 0})
      .torque("pivot", [](double t, double angle, double rate) {
        return 3 * std::sin(2 * t) - 1.5 * std::sin(angle) - 0.2 * rate;
      });
  const System<1> pendulum(
      {"angle"},
      [](auto, const auto& q, const auto& v) {
        using std::cos;
        return (about_axis + m * l * l) / 2 * v[0] * v[0] + m * gravity * l * cos(q[0]);
      },
      [](double t, const auto& q, const auto& v) {
        using std::sin;
        return Eigen::Matrix<double, 1, 1>(3 * sin(2 * t) - 1.5 * sin(q[0]) - 0.2 * v[0]);
      });
  const Solution expected = solve(pendulum, {0, {0.0}, {5.0}}, 4, testing::accurate(1e-13));
  const Initial start = system.initial({{"rod", {{2.5, 0, 0}, {0, -5, 0}}}});
  const Solution motion = motion_of(system, start, 4);
  ASSERT_EQ(motion.status().stop, Stop::reached_end) << motion.status().message;
  for (int i = 0; i <= 16; ++i) {
    const State state = motion.at(i / 4.0);
    const State known = expected.at(state.time);
    EXPECT_NEAR(system.angle(state.q, "pivot"), std::remainder(known.q[0], 2 * M_PI), tolerance(20));
    EXPECT_NEAR(system.angle_rate(state.q, state.v, "pivot"), known.v[0], tolerance(60));
  }
}

// Two wheels and a torsion spring: the relative angle is a sine, the angular momentum stays.
TEST_P(MultibodyJoints, TorsionSpringOscillates) {
  constexpr double k = 3, I1 = 0.3, I2 = 0.2, first = 0.5, second = 2, duration = 3;
  MultibodySystem system = two_wheels(I1, I2);
  system.torque("shaft", [=](double, double angle, double) { return -k * angle; });
  const Initial start = system.initial({{"one", {origin, first * axis}}, {"two", {origin, second * axis}}});
  const Solution motion = motion_of(system, start, duration);
  ASSERT_EQ(motion.status().stop, Stop::reached_end) << motion.status().message;
  const double w = std::sqrt(k * (1 / I1 + 1 / I2));
  for (int i = 0; i <= 12; ++i) {
    const State state = motion.at(duration * i / 12);
    EXPECT_NEAR(system.angle(state.q, "shaft"), (second - first) / w * std::sin(w * state.time),
                tolerance(second * duration * w));
    const Vector3d spin = I1 * system.twist(state.q, state.v, "one").angular_velocity +
                          I2 * system.twist(state.q, state.v, "two").angular_velocity;
    EXPECT_LE((spin - (I1 * first + I2 * second) * axis).norm(), tolerance(10 * second));
    EXPECT_LE(system.pose(state.q, "one").translation().norm(), tolerance(second * duration) + 1e-14);
  }
}

// A motor against viscous friction: rate = T/c (1 - exp(-c t / I)).
TEST_P(MultibodyJoints, MotorReachesItsSpeed) {
  constexpr double T = 0.6, c = 0.4, I = 0.25;
  MultibodySystem system(no_gravity);
  system.body("rotor", 3, {I, I, I}, turned(0.4, {1, 1, 0}, {1, 0, 0}))
      .hinge("motor", "rotor", "world", {1, 0, 0}, axis)  // the world is the second one: the sign is reversed
      .torque("motor", [=](double, double, double rate) { return -T - c * rate; });
  const Solution motion = motion_of(system, system.initial(), 2);
  ASSERT_EQ(motion.status().stop, Stop::reached_end) << motion.status().message;
  const State state = motion.at(2);
  const double rate = T / c * (1 - std::exp(-c * 2 / I));
  EXPECT_LE((system.twist(state.q, state.v, "rotor").angular_velocity - rate * axis).norm(), tolerance(8));
  EXPECT_NEAR(system.angle_rate(state.q, state.v, "motor"), -rate, tolerance(8));
}

// Two bodies on a guide off their centres, with a spring along it. They turn together as one body does, whose
// moment of inertia changes with the displacement: momentum, angular momentum and energy stay.
TEST_P(MultibodyJoints, ForceOfASliderKeepsTheMomenta) {
  constexpr double k = 12, m1 = 2, m2 = 3;
  const Inertia I1(0.4, 0.5, 0.6), I2(0.5, 0.4, 0.3);
  MultibodySystem system(no_gravity);
  const Vector3d center(0.7, -0.2, 0.3);
  system.body("one", m1, I1, origin)
      .body("two", m2, I2, center)
      .slider("guide", "one", "two", {0.3, 0.4, 0}, axis)
      .force("guide", [=](double, double position, double) { return -k * position; });
  const Vector3d v(0.1, 0.2, -0.3), w(0.4, 1, -0.5);
  const Initial start = system.initial({{"one", {v, w}}, {"two", {v + w.cross(center) + 0.8 * axis, w}}});
  EXPECT_NEAR(system.displacement_rate(start.q, start.v, "guide"), 0.8, 1e-15);
  const Solution motion = motion_of(system, start, 3);
  ASSERT_EQ(motion.status().stop, Stop::reached_end) << motion.status().message;
  const auto momentum = [&](const State& state) {
    Eigen::Matrix<double, 6, 1> sum = Eigen::Matrix<double, 6, 1>::Zero();
    const auto add = [&](const char* name, double m, const Inertia& I) {
      const Isometry3d pose = system.pose(state.q, name);
      const Twist twist = system.twist(state.q, state.v, name);
      const Eigen::Matrix3d R = pose.linear();
      sum.head<3>() += m * twist.velocity;
      sum.tail<3>() += pose.translation().cross(m * twist.velocity) +
                       R * I.matrix * R.transpose() * twist.angular_velocity;
    };
    add("one", m1, I1);
    add("two", m2, I2);
    return sum;
  };
  const auto energy = [&](const State& state) {
    const double position = system.displacement(state.q, "guide");
    return state.energy + k / 2 * position * position;
  };
  const State first = motion.at(0);
  for (int i = 1; i <= 6; ++i) {
    const State state = motion.at(i / 2.0);
    EXPECT_LE((momentum(state) - momentum(first)).norm(), tolerance(40)) << i;
    EXPECT_NEAR(energy(state), energy(first), tolerance(40)) << i;
  }
}

// Along a guide that does not turn: w^2 = k (1/m1 + 1/m2).
TEST_P(MultibodyJoints, ForceOfASliderOscillates) {
  constexpr double k = 12, m1 = 2, m2 = 3, speed = 0.8, duration = 3;
  MultibodySystem system(no_gravity);
  system.body("one", m1, {1, 1, 1}, origin)
      .body("two", m2, {1, 1, 1}, 0.5 * axis)
      .slider("guide", "one", "two", 0.3 * axis, axis)
      .force("guide", [=](double, double position, double) { return -k * position; });
  const Solution motion = motion_of(
      system, system.initial({{"one", {origin, origin}}, {"two", {speed * axis, origin}}}), duration);
  ASSERT_EQ(motion.status().stop, Stop::reached_end) << motion.status().message;
  const double w = std::sqrt(k * (1 / m1 + 1 / m2));
  for (int i = 0; i <= 12; ++i) {
    const State state = motion.at(duration * i / 12);
    EXPECT_NEAR(system.displacement(state.q, "guide"), speed / w * std::sin(w * state.time),
                tolerance(speed * duration * w));
    EXPECT_NEAR(system.displacement_rate(state.q, state.v, "guide"), speed * std::cos(w * state.time),
                tolerance(speed * duration * w));
  }
}

// A wheel between two stops: each impact halves its speed.
TEST_P(MultibodyJoints, LimitsOfAHingeReflect) {
  constexpr double I = 0.25, w = 2;
  MultibodySystem system(no_gravity);
  system.body("wheel", 3, {I, I, I}, origin)
      .hinge("axle", "world", "wheel", origin, axis)
      .limit("axle", -0.3, 0.5, 0.5);
  ASSERT_EQ(system.constraints.size(), 3u);
  EXPECT_EQ(system.constraints[1].name, "axle.lower");
  EXPECT_EQ(system.constraints[2].name, "axle.upper");
  const Solution motion = motion_of(system, system.initial({{"wheel", {origin, w * axis}}}), 3);
  ASSERT_EQ(motion.status().stop, Stop::reached_end) << motion.status().message;
  ASSERT_EQ(motion.switches().size(), 3u);
  const double times[] = {0.25, 0.25 + 0.8, 0.25 + 0.8 + 1.6};
  double rate = w;
  for (std::size_t i = 0; i < 3; ++i) {
    const Switch& impact = motion.switches()[i];
    const std::size_t limit = i == 1 ? 1 : 2;
    EXPECT_NEAR(impact.time, times[i], tolerance(10 * times[i]));
    EXPECT_NEAR(impact.multipliers[system.multiplier_of(limit)], I * 1.5 * std::abs(rate), tolerance(10));
    rate *= -0.5;
    EXPECT_NEAR(system.angle_rate(impact.q, impact.v_after, "axle"), rate, tolerance(10));
  }
}

// A pendulum falls onto a stop and rests there: the stop bears m g l sin(angle).
TEST_P(MultibodyJoints, LimitOfAHingeBearsAPendulum) {
  constexpr double m = 2, l = 0.5;
  MultibodySystem system;
  system.body("rod", m, {0.17, 0.17, 0.02}, Vector3d(0, 0, l))
      .hinge("pivot", "world", "rod", origin, {0, 1, 0})
      .limit("pivot", -1, 1);
  const Solution motion = motion_of(system, system.initial({{"rod", {{l, 0, 0}, {0, 1, 0}}}}), 2);
  ASSERT_EQ(motion.status().stop, Stop::reached_end) << motion.status().message;
  const State last = motion.at(2);
  EXPECT_NEAR(system.angle(last.q, "pivot"), 1, tolerance(4));
  EXPECT_NEAR(last.multipliers[system.multiplier_of(2)], m * gravity * l * std::sin(1), tolerance(400));
  EXPECT_EQ(last.multipliers[system.multiplier_of(1)], 0);
}

// A weight on a vertical guide falls onto its lower end and bounces.
TEST_P(MultibodyJoints, LimitOfASliderReflects) {
  constexpr double height = 0.5;
  MultibodySystem system;
  system.body("weight", 2, {1, 1, 1}, turned(0.3, {1, 1, 0}, {0, 0, 2}))
      .slider("guide", "world", "weight", {0.1, 0, 1}, {0, 0, 1})
      .limit("guide", -height, infinity, 0.5);
  ASSERT_EQ(system.constraints.size(), 2u);
  const double fall = std::sqrt(2 * height / gravity), impact = gravity * fall;
  const Solution motion = motion_of(system, system.initial(), 1.5 * fall);
  ASSERT_EQ(motion.status().stop, Stop::reached_end) << motion.status().message;
  ASSERT_EQ(motion.switches().size(), 1u);
  EXPECT_NEAR(motion.switches()[0].time, fall, tolerance(fall));
  EXPECT_NEAR(motion.switches()[0].multipliers[5], 2 * 1.5 * impact, tolerance(20 * impact));
  const State last = motion.at(1.5 * fall);
  EXPECT_NEAR(system.displacement(last.q, "guide"),
              -height + impact / 2 * fall / 2 - gravity / 2 * fall * fall / 4, tolerance(4 * height));
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

TEST(MultibodyJoint, RefusesJointsThatAreNotThere) {
  MultibodySystem system = two_wheels(0.3, 0.2);
  const Initial start = system.initial();
  const auto none = [](double, double, double) { return 0.0; };
  EXPECT_EQ(refusal([&] { system.angle(start.q, "axle"); }),
            "angle: hinge = \"axle\" is refused; allowed: shaft");
  EXPECT_EQ(refusal([&] { system.displacement(start.q, "shaft"); }),
            "displacement: slider = \"shaft\" is refused; allowed: none, as there is no slider");
  EXPECT_EQ(refusal([&] { MultibodySystem().limit("j", 0, 1); }),
            "limit of joint \"j\": joint = \"j\" is refused; allowed: none, as there is no hinge or slider");
  EXPECT_NE(refusal([&] { system.angle_rate(start.q, start.v, "axle"); }), "");
  EXPECT_NE(refusal([&] { system.displacement_rate(start.q, start.v, "shaft"); }), "");
  EXPECT_EQ(refusal([&] { system.torque("axle", none); }),
            "torque of joint \"axle\": hinge = \"axle\" is refused; allowed: shaft");
  EXPECT_EQ(refusal([&] { system.torque("shaft", DriveFunction()); }),
            "torque of joint \"shaft\": no function is refused; allowed: a function");
  EXPECT_NE(refusal([&] { system.force("shaft", none); }), "");
  EXPECT_EQ(refusal([&] { system.angle(Vector::Zero(3), "shaft"); }),
            "q of 3 numbers is refused; allowed: 14 numbers");
  EXPECT_EQ(refusal([&] { system.angle_rate(start.q, Vector::Zero(3), "shaft"); }),
            "v of 3 numbers is refused; allowed: 12 numbers");
  system.torque("shaft", [](double, double, double) { return nan; });
  MotionTerms terms;
  EXPECT_EQ(not_finite([&] { system.equations->evaluate(0, start.q, start.v, terms); }),
            "torque of joint shaft");
}

TEST(MultibodyJoint, RefusesLimitsThatMakeNoSense) {
  MultibodySystem system = two_wheels(0.3, 0.2);
  EXPECT_EQ(refusal([&] { system.limit("shaft", -4, 1); }),
            "limit of joint \"shaft\": lower = -4 is refused; allowed: a number > -pi");
  EXPECT_EQ(refusal([&] { system.limit("shaft", -1, infinity); }),
            "limit of joint \"shaft\": upper = inf is refused; allowed: a number < pi");
  EXPECT_EQ(refusal([&] { system.limit("shaft", 1, -1); }),
            "limit of joint \"shaft\": upper = -1 is refused; allowed: a number > lower = 1");
  EXPECT_EQ(refusal([&] { system.limit("shaft", -1, 1, 1.5); }),
            "limit of joint \"shaft\": restitution = 1.5 is refused; allowed: 0 to 1");
  EXPECT_NE(refusal([&] { system.limit("shaft", nan, 1); }), "");
  EXPECT_NE(refusal([&] { system.limit("shaft", -1, nan); }), "");
  EXPECT_NE(refusal([&] { system.limit("shaft", -1, 1, nan); }), "");
  EXPECT_EQ(system.constraints.size(), 1u);
  system.body("slide", 1, {1, 1, 1}, origin).slider("guide", "world", "slide", origin, axis);
  EXPECT_NE(refusal([&] { system.limit("guide", nan, 1); }), "");
  EXPECT_NE(refusal([&] { system.limit("guide", infinity, infinity); }), "");
  EXPECT_NE(refusal([&] { system.limit("guide", -1, nan); }), "");
  EXPECT_EQ(system.constraints.size(), 2u);
}

}  // namespace
}  // namespace hybrid_sphere::mechanics::multibody_joints_test

// Friction along a plane: Coulomb's cone, docs/theory.md 7.8.
#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "hybrid_sphere/mechanics/multibody_system.hpp"
#include "hybrid_sphere/mechanics/plant.hpp"
#include "hybrid_sphere/mechanics/solve.hpp"
#include "hybrid_sphere/mechanics/system.hpp"

namespace hybrid_sphere::mechanics {
namespace {

constexpr double g = 9.81;
constexpr double pi = 3.141592653589793;

const auto slip_of_block = [](auto /*t*/, const auto& /*q*/, const auto& v) { return v; };

/// A block of 1 kg on a level plane, on which a force acts. @param force  (t) [N]
template <class Force>
System<2> block(double coefficient, Force force, std::optional<double> static_coefficient = {}) {
  System<2> system(
      {"x", "y"},
      [](auto /*t*/, const auto& /*q*/, const auto& v) { return (v[0] * v[0] + v[1] * v[1]) / 2; },
      [force](const auto& t, const auto& /*q*/, const auto& /*v*/) { return force(t); });
  system.friction(
      "ground", slip_of_block, coefficient, [](double, const auto&, const auto&) { return g; },
      static_coefficient);
  return system;
}

template <class T>
CheckedVector<T, 2> none(const T& /*t*/) {
  return {T(0), T(0)};
}

Options accurate(double accuracy) {
  Options options;
  options.accuracy = accuracy;
  return options;
}

}  // namespace

// SimBenchmark's "sliding", bullet3 2590: the same way in every direction, v^2/(2 mu g), on a straight line.
TEST(FrictionCone, StopsABlockAfterTheSameWayInEveryDirection) {
  constexpr double mu = 0.5;
  constexpr double speed = 3;
  const double way = speed * speed / (2 * mu * g);
  for (int degrees = 0; degrees < 360; degrees += 15) {
    const Eigen::Vector2d direction(std::cos(degrees * pi / 180), std::sin(degrees * pi / 180));
    const System<2> system = block(mu, [](const auto& t) { return none(t); });
    const Solution motion = solve(system, {0, Vector::Zero(2), Vector(speed * direction)}, 3);
    ASSERT_EQ(motion.status().stop, Stop::reached_end) << motion.status().message;
    const State end = motion.at(3);
    EXPECT_LT((end.q - way * direction).norm(), 1e-9 * way) << degrees;
    ASSERT_EQ(motion.switches().size(), 1U);
    EXPECT_NEAR(motion.switches()[0].time, speed / (mu * g), 1e-9);
    EXPECT_EQ(motion.switches()[0].active.size(), 1U);
  }
}

// A force at a right angle to the slip bends the way. With the angle phi between the slip and the force,
// d ln(speed)/d phi = (F cos(phi) - mu g)/(-F sin(phi)), so that the block comes to rest in the direction of
// the force: speed = c tan(phi/2)^k/sin(phi), k = mu g/F.
TEST(FrictionCone, TurnsTheSlipOfABlockTowardsTheForce) {
  constexpr double mu = 0.4;
  constexpr double force = 2;  // less than mu g = 3.924: it stops
  constexpr double k = mu * g / force;
  const System<2> system = block(mu, [](const auto& t) {
    using T = std::decay_t<decltype(t)>;
    return CheckedVector<T, 2>{T(0), T(force)};
  });
  const Solution motion = solve(system, {0, Vector::Zero(2), {3, 0}}, 3);
  ASSERT_EQ(motion.status().stop, Stop::reached_end) << motion.status().message;
  ASSERT_EQ(motion.switches().size(), 1U);
  for (const double part : {0.1, 0.5, 0.9, 0.99}) {
    const Vector v = motion.at(part * motion.switches()[0].time).v;
    const double phi = std::atan2(v[0], v[1]);
    EXPECT_NEAR(v.norm(), 3 * std::pow(std::tan(phi / 2), k) / std::sin(phi), 1e-8) << part;
  }
  // (F cos(phi) + mu g) speed decreases at the constant rate (mu g)^2 - F^2, which gives the time to the
  // stop.
  const double end = 3 * mu * g / (mu * mu * g * g - force * force);
  EXPECT_NEAR(motion.switches()[0].time, end, 1e-8);
  const State rest = motion.at(3);
  EXPECT_EQ(rest.active.size(), 1U);
  EXPECT_NEAR(rest.multipliers[0], 0, 1e-9);
  EXPECT_NEAR(rest.multipliers[1], -force, 1e-9);
}

// A bead starts from rest on a circular wire: its slip turns with the wire from the first step on. A constant
// force along the wire gives it the speed (F - mu g) t.
TEST(FrictionCone, LetsABeadStartAlongItsWire) {
  constexpr double mu = 0.3;
  constexpr double force = 5;
  constexpr double a = force - mu * g;
  System<2> bead(
      {"x", "y"},
      [](auto /*t*/, const auto& /*q*/, const auto& v) { return (v[0] * v[0] + v[1] * v[1]) / 2; },
      [](const auto& /*t*/, const auto& q, const auto& /*v*/) {
        using T = std::decay_t<decltype(q[0])>;
        return CheckedVector<T, 2>{-force * q[1], force * q[0]};
      });
  bead.holonomic(
          "wire", [](auto /*t*/, const auto& q) { return q[0] * q[0] + q[1] * q[1] - 1.0; }, always())
      .friction("ground", slip_of_block, mu, [](double, const auto&, const auto&) { return g; });
  for (const double accuracy : {1e-3, 1e-4, 1e-6, 1e-9, 1e-12}) {
    const Solution motion = solve(bead, {0, {1, 0}, {0, 0}}, 1, accurate(accuracy));
    ASSERT_EQ(motion.status().stop, Stop::reached_end) << motion.status().message;
    for (const double t : {0.01, 0.1, 0.5, 1.0}) {
      const State state = motion.at(t);
      const Eigen::Vector2d along(-std::sin(a * t * t / 2), std::cos(a * t * t / 2));
      EXPECT_LT((state.v - a * t * along).norm(), 5 * accuracy * a) << accuracy << ' ' << t;
    }
  }
}

TEST(FrictionCone, HoldsAsLongAsTheReactionIsInTheCone) {
  constexpr double mu = 0.5;
  for (const double degrees : {0.0, 20.0, 45.0, 130.0}) {
    const double a = degrees * pi / 180;
    const System<2> system = block(mu, [a](const auto& t) {
      using T = std::decay_t<decltype(t)>;
      return CheckedVector<T, 2>{T(std::cos(a) * t), T(std::sin(a) * t)};
    });
    const Solution motion = solve(system, {0, Vector::Zero(2), Vector::Zero(2)}, 6);
    ASSERT_EQ(motion.status().stop, Stop::reached_end) << motion.status().message;
    ASSERT_EQ(motion.switches().size(), 1U) << degrees;
    EXPECT_NEAR(motion.switches()[0].time, mu * g, 1e-9);
    const double after = 6 - mu * g;
    EXPECT_NEAR(motion.at(6).v[0], std::cos(a) * after * after / 2, 1e-9);
    EXPECT_NEAR(motion.at(6).v[1], std::sin(a) * after * after / 2, 1e-9);
  }
}

// The force turns while the block is released: the slip begins in the direction of the reaction.
TEST(FrictionCone, ReleasesTowardsAForceThatTurns) {
  constexpr double mu = 0.3;
  const System<2> system = block(mu, [](const auto& t) {
    using std::cos, std::sin;
    using T = std::decay_t<decltype(t)>;
    return CheckedVector<T, 2>{T(2 * t * cos(t)), T(2 * t * sin(t))};
  });
  const Solution motion = solve(system, {0, Vector::Zero(2), Vector::Zero(2)}, 4, accurate(1e-10));
  ASSERT_EQ(motion.status().stop, Stop::reached_end) << motion.status().message;
  ASSERT_GE(motion.switches().size(), 1U);
  const double release = motion.switches()[0].time;
  EXPECT_NEAR(release, mu * g / 2, 1e-9);
  const Vector v = motion.at(release + 1e-3).v;
  EXPECT_NEAR(std::atan2(v[1], v[0]), release, 1e-2);
  const Solution coarse = solve(system, {0, Vector::Zero(2), Vector::Zero(2)}, 4, accurate(1e-7));
  EXPECT_LT((coarse.at(4).v - motion.at(4).v).norm(), 1e-5);
  EXPECT_LT(motion.evaluations(), 100000U);
}

TEST(FrictionCone, HasAStaticCoefficient) {
  const System<2> system = block(
      0.3,
      [](const auto& t) {
        using T = std::decay_t<decltype(t)>;
        return CheckedVector<T, 2>{T(0.6 * t), T(0.8 * t)};
      },
      0.5);
  const Solution motion = solve(system, {0, Vector::Zero(2), Vector::Zero(2)}, 6);
  ASSERT_EQ(motion.status().stop, Stop::reached_end) << motion.status().message;
  ASSERT_EQ(motion.switches().size(), 1U);
  const double release = 0.5 * g;
  EXPECT_NEAR(motion.switches()[0].time, release, 1e-9);
  const double speed = (36 - release * release) / 2 - 0.3 * g * (6 - release);
  EXPECT_LT((motion.at(6).v - speed * Eigen::Vector2d(0.6, 0.8)).norm(), 1e-8);
}

namespace {

MultibodySystem ball_on_ground(double radius, double mu) {
  MultibodySystem system;
  const double inertia = 0.4 * radius * radius;
  system.body("ball", 1, {inertia, inertia, inertia}, Eigen::Vector3d(0, 0, radius));
  system.contact("ground", "ball", ContactShape::sphere(radius)).friction("grip", "ground", mu);
  return system;
}

}  // namespace

// The slip of a ball keeps its direction and decreases at the rate 7/2 mu g, whatever its spin; then it
// rolls: as the package's sphere does, docs/theory.md 4.2.
TEST(FrictionCone, MakesABallRollInEveryDirection) {
  constexpr double mu = 0.3;
  constexpr double radius = 0.1;
  const MultibodySystem system = ball_on_ground(radius, mu);
  for (const double spin : {0.0, 7.0}) {
    for (const double degrees : {0.0, 14.036243467926479, 30.0, 45.0, 200.0}) {
      const Eigen::Vector3d v(2 * std::cos(degrees * pi / 180), 2 * std::sin(degrees * pi / 180), 0);
      const Eigen::Vector3d w(spin, -spin, 3 * spin);
      const Eigen::Vector3d slip = v - radius * w.cross(Eigen::Vector3d::UnitZ());
      const double rolls = slip.norm() / (3.5 * mu * g);
      const Solution motion = solve(system, system.initial({{"ball", {v, w}}}), 2);
      ASSERT_EQ(motion.status().stop, Stop::reached_end) << motion.status().message;
      EXPECT_NEAR(motion.at(0.01).multipliers.tail(2).norm(), mu * g, 1e-9);
      ASSERT_EQ(motion.switches().size(), 1U) << degrees;
      EXPECT_NEAR(motion.switches()[0].time, rolls, 1e-9);
      const Eigen::Vector3d end_velocity = v - 2.0 / 7 * slip;
      const Eigen::Vector3d way = rolls * (v + end_velocity) / 2 + (2 - rolls) * end_velocity;
      const Eigen::Vector3d place = system.pose(motion.at(2).q, "ball").translation();
      EXPECT_LT((place - way - Eigen::Vector3d(0, 0, radius)).norm(), 1e-8) << degrees;
      EXPECT_LT((system.twist(motion.at(2).q, motion.at(2).v, "ball").velocity - end_velocity).norm(), 1e-9);
    }
  }
}

// A ball that strikes the ground with a tangential velocity in any direction gets the impulse mu (1 + e) m w
// against it, or what makes it roll.
TEST(FrictionCone, BoundsTheImpulseOfABallThatStrikes) {
  constexpr double mu = 0.2;
  for (const double degrees : {10.0, 45.0, 100.0}) {
    const Eigen::Vector3d direction(std::cos(degrees * pi / 180), std::sin(degrees * pi / 180), 0);
    MultibodySystem system;
    system.body("ball", 1, {0.004, 0.004, 0.004}, Eigen::Vector3d(0, 0, 1.1));
    system.contact("ground", "ball", ContactShape::sphere(0.1), 0.5).friction("grip", "ground", mu);
    const Solution motion =
        solve(system, system.initial({{"ball", {5 * direction, Eigen::Vector3d::Zero()}}}), 0.6);
    ASSERT_EQ(motion.status().stop, Stop::reached_end) << motion.status().message;
    const Switch& strike = motion.switches().front();
    const double fall = std::sqrt(2 * g);
    EXPECT_NEAR(strike.multipliers[0], 1.5 * fall, 1e-9);
    const Eigen::Vector3d v = system.twist(strike.q, strike.v_after, "ball").velocity;
    EXPECT_LT((v - (5 - mu * 1.5 * fall) * direction - Eigen::Vector3d(0, 0, 0.5 * fall)).norm(), 1e-8);
  }
}

TEST(FrictionCone, RefusesTwoFrictionsOfOneContact) {
  MultibodySystem system;
  system.body("ball", 1, {0.004, 0.004, 0.004}, Eigen::Vector3d(0, 0, 0.1));
  system.contact("ground", "ball", ContactShape::sphere(0.1));
  system.friction("one", "ground", Slip::along, 0.3).friction("two", "ground", Slip::across, 0.3);
  try {
    check(system);
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_EQ(
        std::string(error.what()),
        "friction two: constraint ground has the friction one already; for all directions along a plane "
        "a friction has a slip velocity of two components");
  }
}

// The motion is the same in any periods of advance().
TEST(FrictionCone, DoesNotDependOnThePeriodsOfAdvance) {
  const System<2> system = block(
      0.3,
      [](const auto& t) {
        using std::cos, std::sin;
        using T = std::decay_t<decltype(t)>;
        return CheckedVector<T, 2>{T(6 * sin(2 * t)), T(4 * cos(3 * t))};
      },
      0.5);
  const Initial start{0, Vector::Zero(2), {1, -2}};
  Plant whole(system, start);
  Plant pieces(system, start);
  whole.advance(3);
  for (int i = 1; i <= 300; ++i) pieces.advance(i * 0.01);
  EXPECT_LT((whole.state().q - pieces.state().q).norm(), 1e-9);
  EXPECT_LT((whole.state().v - pieces.state().v).norm(), 1e-8);
}

namespace {

/// A box of 1 kg on feet, whose friction its weight loads. @param feet  3 or 4 @param mu  of each foot
MultibodySystem box_on_feet(std::size_t feet, double mu) {
  MultibodySystem system;
  constexpr double radius = 0.01;
  system.body("box", 1, {0.02, 0.03, 0.04}, Eigen::Vector3d(0, 0, 0.1));
  const std::vector<Eigen::Vector2d> three = {{-0.2, -0.15}, {-0.2, 0.15}, {0.2, 0}};
  const std::vector<Eigen::Vector2d> four = {{-0.2, -0.15}, {-0.2, 0.15}, {0.2, -0.15}, {0.2, 0.15}};
  for (const Eigen::Vector2d& place : feet == 3 ? three : four) {
    const std::string name = "foot " + std::to_string(system.constraints.size() / 2);
    system.contact(name, "box", ContactShape::sphere(radius, {place.x(), place.y(), radius}));
    system.friction("grip of " + name, name, mu);
  }
  return system;
}

}  // namespace

// SimBenchmark's "sliding" of a body on several contacts, and a spin that is slowed down as well: the
// friction of each foot is within its cone and against its slip, and energy only decreases.
TEST(FrictionCone, IsKeptByAllFeetOfABox) {
  constexpr double mu = 0.4;
  for (const std::size_t feet : {std::size_t(3), std::size_t(4)}) {
    SCOPED_TRACE(feet);
    const MultibodySystem system = box_on_feet(feet, mu);
    const Initial start = system.initial({{"box", {{1.5, 0.4, 0}, {0, 0, 3}}}});
    const Solution motion = solve(system, start, 1, accurate(1e-8));
    ASSERT_EQ(motion.status().stop, Stop::reached_end) << motion.status().message;
    double energy = motion.at(0).energy;
    for (int i = 0; i <= 100; ++i) {
      const State state = motion.at(0.01 * i);
      EXPECT_LE(state.energy, energy + 1e-9) << state.time;
      energy = state.energy;
      for (std::size_t foot = 0; foot < feet; ++foot) {
        const Vector reactions = state.multipliers.segment(Index(3 * foot), 3);
        EXPECT_GE(reactions[0], -1e-9);
        EXPECT_LE(reactions.tail(2).norm(), mu * reactions[0] + 1e-7) << state.time;
      }
    }
    EXPECT_LT(motion.at(1).v.norm(), 1e-9);
  }
}

}  // namespace hybrid_sphere::mechanics

// Forces between bodies against known motions and conservation laws.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/mechanics/expect_terms.hpp"
#include "core/mechanics/particle.hpp"
#include "hybrid_sphere/mechanics/multibody_system.hpp"

namespace hybrid_sphere::mechanics::multibody_forces_test {
namespace {

using Eigen::AngleAxisd;
using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
const Vector3d no_gravity(0, 0, 0);
const Vector3d origin(0, 0, 0);

class MultibodyForces : public ::testing::TestWithParam<double> {
 protected:
  Solution motion_of(const Model& model, const Initial& start, double duration) const {
    return solve(model, start, duration, testing::accurate(GetParam()));
  }
  /// Error of q and v for a scale of motion. The scale is an estimate, hence the factor.
  double tolerance(double scale) const { return 4 * GetParam() * scale; }
};

INSTANTIATE_TEST_SUITE_P(Accuracies, MultibodyForces, ::testing::Values(1e-6, 1e-9, 1e-12));

struct Momenta {
  Vector3d linear = Vector3d::Zero();
  Vector3d angular = Vector3d::Zero();  // about the origin
};

/// Two bodies with general moments of inertia and attitudes.
struct Pair {
  const double m1 = 2, m2 = 3;
  const Inertia I1{0.4, 0.5, 0.6, 0.05, -0.02, 0.03}, I2{1.1, 0.7, 0.9, 0.1, 0.04, -0.07};
  MultibodySystem system{no_gravity};

  Pair() {
    system
        .body("one", m1, I1,
              Isometry3d(Eigen::Translation3d(0.5, 0.1, 0.4) * AngleAxisd(0.7, axis(1, 2, -1))))
        .body("two", m2, I2,
              Isometry3d(Eigen::Translation3d(-0.3, 0.6, 1.4) * AngleAxisd(-1.1, axis(0, 1, 3))));
  }
  static Vector3d axis(double x, double y, double z) { return Vector3d(x, y, z).normalized(); }
  Initial start() const {
    return system.initial(
        {{"one", {{0.3, -0.2, 0.5}, {1, 0.4, -0.6}}}, {"two", {{-0.1, 0.4, 0.2}, {-0.5, 0.8, 0.3}}}});
  }
  Momenta momenta(const State& state) const {
    Momenta sum;
    const auto add = [&](const char* name, double mass, const Inertia& inertia) {
      const Isometry3d pose = system.pose(state.q, name);
      const Twist twist = system.twist(state.q, state.v, name);
      const Vector3d p = mass * twist.velocity;
      sum.linear += p;
      sum.angular += pose.translation().cross(p) +
                     pose.linear() * inertia.matrix * pose.linear().transpose() * twist.angular_velocity;
    };
    add("one", m1, I1);
    add("two", m2, I2);
    return sum;
  }
};

// Forces and torques of any kind between two bodies: their momenta stay. Both are sums of a dozen terms of
// order one.
TEST_P(MultibodyForces, AppliedToAPairKeepMomentumAndAngularMomentum) {
  Pair pair;
  pair.system.apply("one", "two", [](double t, const BodyState& one, const BodyState& two) {
    const Vector3d relative = two.twist.angular_velocity - one.twist.angular_velocity;
    const Vector3d at = one.pose * Vector3d(0.3, 0.1, -0.2);
    Wrench wrench = force_at(Vector3d(std::sin(3 * t), 1, -2 * two.twist.velocity.x()), at, two);
    wrench.torque += -0.3 * relative + two.pose.linear().col(0);
    return wrench;
  });
  const Solution motion = motion_of(pair.system, pair.start(), 3);
  ASSERT_EQ(motion.status().stop, Stop::reached_end) << motion.status().message;
  const Momenta first = pair.momenta(motion.at(0));
  for (int i = 1; i <= 6; ++i) {
    const Momenta now = pair.momenta(motion.at(i / 2.0));
    EXPECT_LE((now.linear - first.linear).norm(), tolerance(20)) << i;
    EXPECT_LE((now.angular - first.angular).norm(), tolerance(60)) << i;
  }
}

// The same function as a pair with the world is a wrench of one body, and of the opposite sign if the world
// is the second one.
TEST(MultibodyForces, OfTheWorldAreThoseOfOneBody) {
  const auto wrench = [](double t, const BodyState& body) {
    return force_at(t * body.twist.velocity, body.pose * Vector3d(0.1, 0.2, 0.3), body);
  };
  Pair single, second, first;
  single.system.apply("one", wrench);
  second.system.apply("world", "one", [&](double t, const BodyState& world, const BodyState& body) {
    EXPECT_TRUE(world.pose.isApprox(Isometry3d::Identity()));
    EXPECT_EQ(world.twist.velocity, origin);
    return wrench(t, body);
  });
  first.system.apply("one", "world", [&](double t, const BodyState& body, const BodyState&) {
    const Vector3d point = body.pose * Vector3d(0.1, 0.2, 0.3);
    const Vector3d force = -t * body.twist.velocity;
    return Wrench{force, point.cross(force)};  // about the origin
  });
  RandomVectors random;
  for (int i = 0; i < 20; ++i) {
    const Vector q = random(14), v = random(12);
    MotionTerms expected, found;
    single.system.equations->evaluate(0.7, q, v, expected);
    for (const Pair* pair : {&second, &first}) {
      pair->system.equations->evaluate(0.7, q, v, found);
      EXPECT_LE((found.force - expected.force).cwiseAbs().maxCoeff(), 1e-13);  // some dozens of roundings
    }
  }
}

// Two bodies on a line and a spring: w^2 = k (1/m1 + 1/m2). The length is a cosine about the natural length.
TEST_P(MultibodyForces, SpringOscillates) {
  constexpr double k = 30, l0 = 0.8, m1 = 2, m2 = 3, start = 1.1, duration = 4;
  MultibodySystem system(no_gravity);
  const Vector3d along = Vector3d(1, 2, -2) / 3, half(0.1, 0.2, -0.2);
  system.body("one", m1, {0.1, 0.1, 0.1}, origin)
      .body("two", m2, {0.1, 0.1, 0.1}, (start + 0.6) * along)
      .spring("s", "one", "two", half, (start + 0.6) * along - half, k, l0);
  const Solution motion = motion_of(system, system.initial(), duration);
  ASSERT_EQ(motion.status().stop, Stop::reached_end) << motion.status().message;
  const double w = std::sqrt(k * (1 / m1 + 1 / m2));
  double worst = 0;
  for (int i = 0; i <= 20; ++i) {
    const State state = motion.at(duration * i / 20);
    const Vector3d apart =
        system.pose(state.q, "two").translation() - system.pose(state.q, "one").translation();
    const double length = l0 + (start - l0) * std::cos(w * state.time);
    worst = std::max(worst, (apart - (length + 0.6) * along).norm());
    EXPECT_NEAR(state.energy, k / 2 * (start - l0) * (start - l0), tolerance(4 * k * start * (start - l0)));
  }
  // The phase w t multiplies the error.
  EXPECT_LE(worst, tolerance((start - l0) * w * duration) + 1e-14);
}

// A spring between points off the centres: energy, momentum and angular momentum stay.
TEST_P(MultibodyForces, SpringKeepsEnergyAndMomenta) {
  Pair pair;
  pair.system.spring("s", "one", "two", {0.7, 0.3, 0.4}, {-0.2, 0.4, 1.1}, 12, 0.5);
  const Solution motion = motion_of(pair.system, pair.start(), 5);
  ASSERT_EQ(motion.status().stop, Stop::reached_end) << motion.status().message;
  const State start = motion.at(0);
  const Momenta first = pair.momenta(start);
  double worst = 0;
  for (int i = 1; i <= 10; ++i) {
    const State state = motion.at(i / 2.0);
    worst = std::max(worst, std::abs(state.energy - start.energy));
    const Momenta now = pair.momenta(state);
    EXPECT_LE((now.linear - first.linear).norm(), tolerance(20)) << i;
    EXPECT_LE((now.angular - first.angular).norm(), tolerance(60)) << i;
  }
  // The error of a length of 4 * accuracy times a tension of some 10 N, and speeds times momenta of 20.
  EXPECT_LE(worst, tolerance(100));
}

// Without a natural length a spring to the world makes two harmonic oscillations; it may pass length 0.
TEST_P(MultibodyForces, SpringOfNoNaturalLengthPassesThroughZero) {
  constexpr double k = 8, m = 2, w = 2;
  MultibodySystem system(no_gravity);
  system.body("bob", m, {0.1, 0.1, 0.1}, Vector3d(1, 0, 0))
      .spring("s", "world", "bob", origin, {1, 0, 0}, k, 0);
  const Solution motion = motion_of(system, system.initial(), 5);
  ASSERT_EQ(motion.status().stop, Stop::reached_end) << motion.status().message;
  for (int i = 0; i <= 10; ++i) {
    const State state = motion.at(i / 2.0);
    EXPECT_NEAR(state.q[0], std::cos(w * state.time), tolerance(w * 5));
    EXPECT_NEAR(state.energy, k / 2, tolerance(4 * k));
  }
}

// A damper between two bodies on a line: their relative speed decays with c (1/m1 + 1/m2).
TEST_P(MultibodyForces, DamperDecays) {
  constexpr double c = 1.5, m1 = 2, m2 = 3;
  MultibodySystem system(no_gravity);
  system.body("one", m1, {0.1, 0.1, 0.1}, origin)
      .body("two", m2, {0.1, 0.1, 0.1}, Vector3d(0, 1, 0))
      .damper("d", "one", "two", origin, {0, 1, 0}, c);
  const Initial start = system.initial({{"two", {{0, 2, 0}, {0, 0, 0}}}});
  const Solution motion = motion_of(system, start, 2);
  ASSERT_EQ(motion.status().stop, Stop::reached_end) << motion.status().message;
  const double rate = c * (1 / m1 + 1 / m2);
  for (int i = 0; i <= 8; ++i) {
    const State state = motion.at(i / 4.0);
    EXPECT_NEAR(state.v[7] - state.v[1], 2 * std::exp(-rate * state.time), tolerance(2 * 4));
    EXPECT_NEAR(state.q[8] - state.q[1], 1 + 2 / rate * (1 - std::exp(-rate * state.time)), tolerance(2 * 4));
  }
  // Nothing damps a motion across the line.
  const Initial across = system.initial({{"two", {{2, 0, 0}, {0, 0, 0}}}});
  EXPECT_EQ(system.equations->velocities(), 12);
  MotionTerms terms;
  system.equations->evaluate(0, across.q, across.v, terms);
  EXPECT_EQ(terms.force.norm(), 0);
}

// The force of a spring is the slope of its potential energy, in all directions of both bodies.
TEST(MultibodyForces, OfASpringAreTheSlopeOfItsEnergy) {
  Pair pair;
  pair.system.spring("s", "one", "two", {0.7, 0.3, 0.4}, {-0.2, 0.4, 1.1}, 12, 0.5);
  const Vector q = pair.start().q, rest = Vector::Zero(12);
  MotionTerms terms;
  pair.system.equations->evaluate(0, q, rest, terms);
  const Vector force = terms.force;
  constexpr double h = 1e-5;  // error of the difference: h^2 and 1e-16 / h times numbers of order 10
  for (Index i = 0; i < 12; ++i) {
    Vector rate;
    pair.system.equations->rate(q, Vector::Unit(12, i), rate);
    pair.system.equations->evaluate(0, q + h * rate, rest, terms);
    const double up = terms.lagrangian;
    pair.system.equations->evaluate(0, q - h * rate, rest, terms);
    EXPECT_NEAR((up - terms.lagrangian) / (2 * h), force[i], 1e-8) << i;
  }
}

TEST(MultibodyForces, NameTheSpringWhosePointsMeet) {
  MultibodySystem system(no_gravity);
  system.body("bob", 1, {0.1, 0.1, 0.1}, Vector3d(1, 0, 0))
      .spring("coil", "world", "bob", origin, {1, 0, 0}, 1, 0.5);
  Initial start = system.initial();
  start.q[0] = 0;
  const Solution motion = solve(system, start, 1);
  EXPECT_EQ(motion.status().stop, Stop::undefined);
  EXPECT_NE(motion.status().message.find("the points of spring coil coincide"), std::string::npos)
      << motion.status().message;
  // Far from the origin the round-off of the places is larger.
  MultibodySystem far(no_gravity);
  far.body("bob", 1, {0.1, 0.1, 0.1}, Vector3d(1e6 + 1, 0, 0))
      .damper("oil", "world", "bob", {1e6, 0, 0}, {1e6 + 1, 0, 0}, 1);
  start = far.initial();
  start.q[0] = 1e6 + 1e-5;
  EXPECT_EQ(solve(far, start, 1).status().stop, Stop::undefined);
  start.q[0] = 1e6 + 1e-3;
  EXPECT_EQ(solve(far, start, 1).status().stop, Stop::reached_end);
}

TEST(MultibodyForces, NameWhatIsNotFinite) {
  Pair pair;
  pair.system.apply("one", "world", [](double, const BodyState&, const BodyState&) {
    return Wrench{{nan, 0, 0}, {0, 0, 0}};
  });
  MotionTerms terms;
  EXPECT_EQ(not_finite([&] { pair.system.equations->evaluate(0, pair.start().q, pair.start().v, terms); }),
            "wrench between one and world");
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

TEST(MultibodyForces, RefuseBadInput) {
  MultibodySystem system = Pair().system;
  const Vector3d bad(0, nan, 0), x(1, 0, 0);
  EXPECT_EQ(refusal([&] { system.apply("one", "two", PairWrenchFunction()); }),
            "wrench between \"one\" and \"two\": no function is refused; allowed: a function");
  const auto none = [](double, const BodyState&, const BodyState&) { return Wrench{}; };
  EXPECT_EQ(
      refusal([&] { system.apply("one", "one", none); }),
      "wrench between \"one\" and \"one\": \"one\" twice is refused; allowed: two bodies, or one and the "
      "world");
  EXPECT_EQ(refusal([&] { system.spring("s", "one", "three", origin, x, 1, 1); }),
            "spring \"s\": body = \"three\" is refused; allowed: world, one, two");
  EXPECT_EQ(refusal([&] { system.spring("s", "one", "two", origin, x, -2, 1); }),
            "spring \"s\": stiffness = -2 is refused; allowed: a number > 0");
  EXPECT_EQ(refusal([&] { system.spring("s", "one", "two", origin, x, 1, -0.5); }),
            "spring \"s\": natural length = -0.5 is refused; allowed: a number >= 0");
  EXPECT_NE(refusal([&] { system.spring("s", "one", "two", origin, x, 1, nan); }), "");
  EXPECT_EQ(refusal([&] { system.spring("s", "one", "two", x, x, 1, 1); }),
            "spring \"s\": distance of its points = 0 is refused; allowed: a number > 0");
  EXPECT_EQ(refusal([&] { system.spring("s", "one", "two", x, x, 1, 0); }), "");
  EXPECT_NE(refusal([&] { system.spring("s", "one", "two", bad, x, 1, 1); }), "");
  EXPECT_NE(refusal([&] { system.spring("s", "one", "two", x, bad, 1, 1); }), "");
  EXPECT_EQ(refusal([&] { system.damper("d", "one", "two", origin, x, 0); }),
            "damper \"d\": coefficient = 0 is refused; allowed: a number > 0");
  EXPECT_NE(refusal([&] { system.damper("d", "one", "two", x, x, 1); }), "");
  EXPECT_NE(refusal([&] { system.damper("d", "two", "two", origin, x, 1); }), "");
  EXPECT_NE(refusal([&] { system.damper("d", "one", "two", bad, x, 1); }), "");
}

}  // namespace
}  // namespace hybrid_sphere::mechanics::multibody_forces_test

// Against numbers computed with 60 digits, the equation itself, and the linear invariant.

#include "motion/dry_friction.hpp"

#include <gtest/gtest.h>

#include <cfloat>
#include <cmath>

#include "core/motion/integrated.hpp"

namespace hybrid_sphere::testing::dry_friction_test {
namespace {

struct Case {
  Vector2d start, drive;
  double friction, time;
  double end;
  Vector2d value, integral;
};

// In this order: ordinary; A/abs(b) = 1 + 1e-9; very strong friction; nearly opposite to the drive; nearly
// along it; A = abs(b); A < abs(b); tiny drive; tiny friction; everything tiny.
const Case cases[] = {
    {{3, -2},
     {0.5, 0.25},
     1.5,
     0.75,
     3.3075235681011530011,
     {2.4070701259378814728, -1.2403007957302353529},
     {2.0316542089982856209, -1.2083291431309317557}},
    {{3, -2},
     {0.5, 0.25},
     1.5,
     2.5,
     3.3075235681011530011,
     {0.78716271570126281833, -0.047633492114851742075},
     {4.8701131021019564972, -2.1860725476627505394}},
    {{1, 0.5},
     {2.4999999975000002, 0},
     2.5,
     0.5,
     423606837.96008581954,
     {1.0531617075449280111, 0.15749091347941773995},
     {0.51790379414963050283, 0.14890068966232094108}},
    {{1, 0.5},
     {2.4999999975000002, 0},
     2.5,
     1000,
     423606837.96008581954,
     {1.0590144944046931568, 0},
     {1059.0028961040054341, 0.2157378649561607565}},
    {{1, 0.5},
     {2.4999999975000002, 0},
     2.5,
     2e8,
     423606837.96008581954,
     {0.55901704185211238897, 0},
     {161803403.61280853018, 0.2157378649561607565}},
    {{2, 0.5},
     {0.3, -0.1},
     3433500,
     3e-7,
     6.0042317547553414318e-7,
     {1.0007048039381285269, 0.2501761645800155259},
     {4.5010572080120168719e-7, 1.1252642384507255266e-7}},
    {{-1, 1e-9},
     {1, 0},
     0.5,
     0.66,
     never,
     {-0.0099999999999999551914, 2.1544346900318807212e-10},
     {-0.33330000000000000046, 4.9892278265498409637e-10}},
    {{-1, 1e-9},
     {1, 0},
     0.5,
     3,
     never,
     {1.1666666666666666668, 2.1428571428571432567e-28},
     {1.027777777777777778, 5.0000000000000005276e-10}},
    {{1, 1e-12},
     {1, 0},
     1.5,
     1.25,
     2,
     {0.375, 5.2734374999999998939e-14},
     {0.859375, 4.9011230468749999014e-13}},
    {{0.6, 0.8},
     {1, 0},
     1,
     50,
     never,
     {0.8, 6.5158590068791539718e-28},
     {39.909999999999999989, 0.69333333333333337774}},
    {{0.6, 0.8},
     {1, 0},
     0.5,
     1e4,
     never,
     {5000.7333333333327874, 0.00012798122941968511297},
     {25007333.217777780508, 11.267818750262541237}},
    {{0.6, 0.8},
     {1e-200, 1e-200},
     2,
     0.3,
     0.5000000000000000111,
     {0.24000000000000001243, 0.32000000000000004619},
     {0.12599999999999999387, 0.16800000000000000737}},
    {{0.6, 0.8},
     {5, -1},
     1e-9,
     2,
     never,
     {10.599999998047146164, -1.20000000009656074},
     {11.199999998083541779, -0.40000000029010205419}},
    {{6e-160, 8e-160},
     {3e-160, 1e-160},
     2e-160,
     2,
     never,
     {9.1684000329998802247e-160, 7.1908744820995550492e-160},
     {1.5291151878252165934e-159, 1.5068603110849189488e-159}},
};

TEST(DryFriction, IsGoodToSomeUlpInEveryContactMode) {
  for (const Case& c : cases) {
    const DryFriction friction(c.start, c.drive, c.friction);
    const DryFriction::Value now = friction.at(c.time);
    // Some ten roundings; the drive uses up digits of w_0 where it turns it back.
    const double tolerance = 8 * DBL_EPSILON;
    EXPECT_DOUBLE_EQ(friction.end(), c.end);
    EXPECT_LE((now.value - c.value).stableNorm(),
              tolerance * std::max(c.value.stableNorm(), c.start.stableNorm()));
    EXPECT_LE((now.integral - c.integral).stableNorm(), tolerance * c.integral.stableNorm());
  }
}

TEST(DryFriction, SolvesItsEquation) {
  for (const double friction : {0.1, 0.4, 0.55, 0.6, 3.0}) {  // abs(b) = 0.559
    const Vector2d drive(0.5, 0.25);
    const DryFriction closed({-1, 2}, drive, friction);
    const double time = std::min(2.0, 0.9 * closed.end());
    const auto slope = [&](const std::array<double, 4>& y, double) {
      const Vector2d w(y[0], y[1]);
      const Vector2d change = drive - friction * w / w.norm();
      return std::array<double, 4>{change.x(), change.y(), w.x(), w.y()};
    };
    const auto y = integrated<4>({-1, 2, 0, 0}, time, slope);
    const DryFriction::Value now = closed.at(time);
    // Errors of the steps add up over some hundred.
    EXPECT_LE((now.value - Vector2d(y[0], y[1])).norm(), 100 * integration_error);
    EXPECT_LE((now.integral - Vector2d(y[2], y[3])).norm(), 100 * integration_error);
    EXPECT_LE((now.derivative - (drive - friction * now.value.normalized())).norm(), 8 * DBL_EPSILON * 4);
  }
}

TEST(DryFriction, UsesUpItsLinearInvariantAtAConstantRate) {
  const Vector2d drive(-0.3, 0.4);
  for (const double friction : {0.2, 0.5, 0.7, 20.0}) {
    const DryFriction closed({2, 1}, drive, friction);
    const auto invariant = [&](double t) {
      const Vector2d w = closed.at(t).value;
      return friction * w.norm() + drive.dot(w);
    };
    const double rate = (friction - 0.5) * (friction + 0.5);
    for (double t = 0.1; t < std::min(3.0, closed.end()); t += 0.1) {
      EXPECT_NEAR(invariant(0) - invariant(t), rate * t, 16 * DBL_EPSILON * (1 + friction) * (3 + t)) << t;
    }
  }
}

TEST(DryFriction, EndsExactlyAtZeroAndStaysThere) {
  for (const double friction : {0.56, 1.0, 1e5}) {
    const DryFriction closed({3, -2}, {0.5, 0.25}, friction);
    const double end = closed.end();
    EXPECT_EQ(closed.at(end).value, Vector2d(0, 0));
    EXPECT_EQ(closed.at(2 * end).value, Vector2d(0, 0));
    EXPECT_EQ(closed.at(2 * end).integral, closed.at(end).integral);
    EXPECT_GT(closed.at(end * (1 - 1e-12)).value.norm(), 0);
    // It ends along the drive.
    EXPECT_LE((closed.at(end).direction - Vector2d(0.5, 0.25).normalized()).norm(), 2 * DBL_EPSILON);
  }
}

TEST(DryFriction, IsStraightWhereNothingTurnsIt) {
  const DryFriction alone({3, -4}, {0, 0}, 2);
  EXPECT_TRUE(alone.straight());
  EXPECT_EQ(alone.end(), 2.5);
  EXPECT_EQ(alone.at(1.25).value, Vector2d(1.5, -2));
  EXPECT_EQ(alone.at(2.5).integral, Vector2d(3.75, -5));

  const DryFriction opposite({-6, 8}, {0.75, -1}, 0.25);
  EXPECT_TRUE(opposite.straight());
  EXPECT_DOUBLE_EQ(opposite.end(), 10 / 1.5);

  const DryFriction along({-6, 8}, {-0.75, 1}, 0.25);
  EXPECT_TRUE(along.straight());
  EXPECT_EQ(along.end(), never);
  EXPECT_TRUE(along.at(4).value.isApprox(Vector2d(-8.4, 11.2), 4 * DBL_EPSILON));
}

TEST(DryFriction, SlidesOffFromRestOnlyIfTheDriveIsStronger) {
  const DryFriction off({0, 0}, {3, 4}, 4);
  EXPECT_EQ(off.end(), never);
  EXPECT_TRUE(off.at(2).value.isApprox(Vector2d(1.2, 1.6), 4 * DBL_EPSILON));
  EXPECT_EQ(DryFriction({0, 0}, {3, 4}, 5).end(), 0);
  EXPECT_EQ(DryFriction({0, 0}, {0, 0}, 0).end(), 0);
}

TEST(DryFriction, IsAParabolaWithoutFriction) {
  const DryFriction free({1, -2}, {0.5, 0.25}, 0);
  EXPECT_TRUE(free.straight());
  EXPECT_EQ(free.end(), never);
  EXPECT_EQ(free.at(4).value, Vector2d(3, -1));
  EXPECT_EQ(free.at(4).integral, Vector2d(8, -6));
}

TEST(DryFriction, BarelyTurnedAwayIsContinuousWithStraight) {
  const Vector2d drive(1, 0);
  const DryFriction straight({-1, 0}, drive, 0.5);
  const DryFriction turned_away({-1, 1e-30}, drive, 0.5);
  EXPECT_EQ(turned_away.end(), never);
  // The straight one ends at 2/3 s; the other one goes on through almost zero and off along the drive.
  EXPECT_LE((turned_away.at(0.6).value - straight.at(0.6).value).norm(), 4 * DBL_EPSILON);
  EXPECT_LE((turned_away.at(2).value - Vector2d(0.5 * (2 - 2.0 / 3), 0)).norm(), 8 * DBL_EPSILON);
}

/// As often as outputs come at a round time at which a slip that is opposite to its drive is used up.
TEST(DryFriction, IsANumberWhereItPassesZeroWithinRounding) {
  const Vector2d drive(1, 0);
  for (const double friction : {0.25, 1 - 0x1p-30, 1.0}) {
    const double zero = 1 / (1 + friction);  // its time
    for (double across = 1e-6; across >= 1e-320; across *= 1e-2) {
      const DryFriction motion({-1, across}, drive, friction);
      double time = zero * (1 - 8 * DBL_EPSILON);
      for (; time <= zero * (1 + 8 * DBL_EPSILON); time = std::nextafter(time, never)) {
        const DryFriction::Value now = motion.at(time);
        // w' <= A + abs(b) from the corner on, where w is no longer than the component across.
        const double most = 1.01 * (across + (1 + friction) * (std::abs(time - zero) + 4 * DBL_EPSILON));
        ASSERT_LE(now.value.norm(), most) << friction << ", " << across << ", " << time - zero;
        ASSERT_NEAR(now.integral.x(), -0.5 * zero, 2 * across + 8 * DBL_EPSILON);
        ASSERT_TRUE(now.direction.allFinite() && now.derivative.allFinite());
      }
    }
  }
}

// A slope that friction just balances: what is left of w after it has passed zero is rounding, and so is all
// that would turn it.
TEST(DryFriction, DoesNotTurnInItsExpansionWhereItBalancesTheDrive) {
  const Vector2d drive(-3.9528470752104745, 1.3176156916368249);
  int turned = 0;
  for (int i = 0; i < 200; ++i) {
    const double friction = drive.norm() * (1 + (i % 9 - 4) * DBL_EPSILON / 2);
    const int across = i / 9 - 11;
    const DryFriction w(-0.24 * drive + Vector2d(0, across * 0x1p-54), drive, friction);
    for (const double time : {0.5, 1.3, 1.3511209542427, 1.4, 4.0}) {
      if (time >= w.end()) continue;
      const DryFriction::Value now = w.at(time);
      if (w.straight() || now.value.isZero(0)) continue;
      ++turned;
      constexpr double length = 0.25;
      const polynomials::Powers<2> powers = w.expand(now, length);
      const double moved = powers.rightCols(polynomials::size - 1).cwiseAbs().maxCoeff();
      EXPECT_LE(moved, 8 * DBL_EPSILON * length * friction + 0x1p-40 * now.value.norm())
          << i << ", t = " << time;
    }
  }
  EXPECT_GT(turned, 100);
}

TEST(DryFriction, HasItsCornerWhereItCrossesTheDrive) {
  const Vector2d drive(0.6, 0.8);
  for (const double friction : {0.25, 1.0, 4.0}) {
    const DryFriction motion({-2, -1.25}, drive, friction);
    const DryFriction::Corner corner = motion.corner();
    const Vector2d there = motion.at(corner.time).value;
    EXPECT_GT(corner.time, 0);
    // The change of w within the rounding of the time.
    const double rounding = 16 * DBL_EPSILON * (friction + 1) * corner.time;
    EXPECT_NEAR(there.dot(drive), 0, rounding) << friction;
    EXPECT_NEAR(corner.width, there.norm() / (friction + 1), rounding) << friction;
  }
  const DryFriction past({2, 1}, drive, 0.25);
  EXPECT_EQ(past.corner().time, 0);
  EXPECT_NEAR(past.corner().width, std::sqrt(5) / 1.25, 8 * DBL_EPSILON);
  EXPECT_EQ(DryFriction({2, 1}, {0, 0}, 1).corner().width, never);
}

}  // namespace
}  // namespace hybrid_sphere::testing::dry_friction_test

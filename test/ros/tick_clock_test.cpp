#include "ros/node/tick_clock.hpp"

#include <gtest/gtest.h>

namespace hybrid_sphere::ros_interface::tick_clock_test {
namespace {

using std::chrono::milliseconds;

const ros::Time epoch(1700000000, 123456789);
const TickClock::Wall::time_point start{std::chrono::hours(5)};

TickClock running(double rate, double factor = 1, const ros::Time& first = epoch) {
  TickClock clock(rate, factor, first);
  clock.run(start);
  return clock;
}

TEST(TickClock, TimesAreQuotients) {
  TickClock clock = running(333);
  for (int n = 0; n < 2000; ++n) {
    EXPECT_EQ(clock.advance(clock.deadline()).late(), 0U);
    EXPECT_EQ(clock.time(), n / 333.0);
  }
}

TEST(TickClock, DeadlinesDoNotDrift) {
  TickClock clock = running(1000);
  for (int n = 0; n < 100000; ++n) {
    ASSERT_EQ(clock.deadline() - start, milliseconds(n));
    clock.advance(clock.deadline());
  }
}

TEST(TickClock, ALateTickWithinAPeriodIsTaken) {
  TickClock clock = running(100);
  clock.advance(start);
  EXPECT_EQ(clock.advance(start + milliseconds(19)).late(), 0U);
  EXPECT_EQ(clock.time(), 0.01);
}

TEST(TickClock, TicksThatAreOverAreLeftOut) {
  TickClock clock = running(100);
  clock.advance(start);
  const TickClock::Lateness lateness = clock.advance(start + milliseconds(203));
  EXPECT_EQ(lateness.left_out, 19U);
  EXPECT_EQ(lateness.lost, 0);
  EXPECT_EQ(clock.time(), 0.2);
  EXPECT_EQ(clock.deadline(), start + milliseconds(210));
}

TEST(TickClock, WhatIsTooLateIsNotMadeUpFor) {
  TickClock clock = running(100);
  clock.advance(start);
  const TickClock::Lateness lateness = clock.advance(start + milliseconds(5000));
  EXPECT_EQ(lateness.left_out, 0U);
  EXPECT_EQ(lateness.late(), 1U);
  EXPECT_EQ(clock.time(), 0.01);
  EXPECT_EQ(clock.deadline(), start + milliseconds(5010));
  EXPECT_NEAR(lateness.lost, 4.99, 1e-9);
  EXPECT_EQ(clock.lag(), lateness.lost);
  clock.stand();
  clock.run(start + milliseconds(6000));
  EXPECT_EQ(clock.lag(), 0) << "it counts since time began to pass";
}

TEST(TickClock, CatchesUpWhereItIsTold) {
  TickClock clock = running(100);
  clock.catch_up_always();
  clock.advance(start);
  EXPECT_EQ(clock.advance(start + milliseconds(5000)).left_out, 499U);
  EXPECT_EQ(clock.time(), 5);
  EXPECT_EQ(clock.lag(), 0);
  EXPECT_EQ(clock.deadline(), start + milliseconds(5010));
}

TEST(TickClock, AFactorStretchesTheWallTimeAlone) {
  TickClock clock = running(100, 10);
  for (int n = 0; n < 1000; ++n) {
    ASSERT_EQ(clock.deadline() - start, milliseconds(n));
    clock.advance(clock.deadline());
    ASSERT_EQ(clock.time(), n / 100.0);
  }
}

TEST(TickClock, WithTheFactor0EveryTickIsDue) {
  TickClock clock = running(100, 0);
  for (int n = 0; n < 1000; ++n) {
    ASSERT_LE(clock.deadline(), start);
    EXPECT_EQ(clock.advance(start + milliseconds(n * n)).late(), 0U);
    ASSERT_EQ(clock.time(), n / 100.0);
  }
}

TEST(TickClock, AnotherFactorNeitherSprintsNorWaits) {
  TickClock clock = running(100);
  for (int n = 0; n <= 50; ++n) clock.advance(clock.deadline());
  const auto change = start + milliseconds(504);  // 0.4 of the way to the next tick
  clock.set_factor(0.1, change);
  EXPECT_EQ(clock.deadline(), change + milliseconds(60));
  clock.set_factor(6, change + milliseconds(30));  // 0.7 of the way
  EXPECT_EQ(clock.deadline(), change + milliseconds(30) + std::chrono::microseconds(500));
  EXPECT_EQ(clock.time(), 0.5);
}

TEST(TickClock, AnotherRateGoesOnAtItsOwnMultiples) {
  TickClock clock = running(100);
  for (int n = 0; n <= 7; ++n) clock.advance(clock.deadline());
  clock.set_rate(40, start + milliseconds(70));
  EXPECT_EQ(clock.next_time(), 0.075);
  EXPECT_EQ(clock.deadline(), start + milliseconds(75));
  clock.set_rate(1000, start + milliseconds(70));
  EXPECT_EQ(clock.next_time(), 0.071);
}

TEST(TickClock, WhileTimeStandsNoTickIsDue) {
  TickClock clock = running(100);
  clock.advance(start);
  clock.stand();
  EXPECT_EQ(clock.deadline(), TickClock::Wall::time_point::max());
  clock.run(start + milliseconds(60000));
  EXPECT_EQ(clock.deadline(), start + milliseconds(60010));
  EXPECT_EQ(clock.advance(clock.deadline()).late(), 0U);
  EXPECT_EQ(clock.time(), 0.01);
}

TEST(TickClock, EachTimeThatTimeBeginsToPassIsAStart) {
  TickClock clock(100, 1, epoch);
  EXPECT_EQ(clock.starts(), 0U);
  clock.run(start);
  clock.run(start);
  EXPECT_EQ(clock.starts(), 1U);
  clock.stand();
  EXPECT_EQ(clock.starts(), 1U);
  clock.run(start);
  EXPECT_EQ(clock.starts(), 2U);
}

TEST(TickClock, StepsComeToTheTimesOfAFreeRun) {
  TickClock clock(100, 1, epoch);
  clock.advance(start);
  for (int n = 1; n < 5000; ++n) {  // each sum is rounded
    const double end = clock.end_of_step(0.01);
    ASSERT_EQ(end, n / 100.0);
    ASSERT_EQ(clock.next_time(), end);
    clock.advance(start);
  }
}

TEST(TickClock, AStepMayEndBetweenTwoTicks) {
  TickClock clock(100, 1, epoch);
  clock.advance(start);
  const double end = clock.end_of_step(0.0035);
  EXPECT_EQ(end, 0.0035);
  clock.move_to(end);
  EXPECT_EQ(clock.time(), 0.0035);
  EXPECT_EQ(clock.stamp(clock.time()), epoch + ros::Duration(0, 3500000));
  EXPECT_EQ(clock.next_time(), 0.01);
  clock.run(start);
  EXPECT_EQ(clock.deadline(), start + std::chrono::microseconds(6500));
}

// Stamps as doubles, as Python's tf2 has them, are 2.4e-7 s apart.
TEST(TickClock, TimesThatAreCloseTogetherHaveStampsAMicrosecondApart) {
  TickClock clock(100, 1, epoch);
  clock.advance(start);
  ros::Time last = clock.stamp(0);
  const auto expect_later_stamp = [&] {
    EXPECT_GE(clock.stamp(clock.time()), last + ros::Duration(0, 999)) << "t = " << clock.time();
    EXPECT_GT(clock.stamp(clock.time()).toSec(), last.toSec());
    last = clock.stamp(clock.time());
  };
  for (const double end : {1e-10, 2e-10, 3e-10, 1e-9, 1e-6, 3e-6, 0.01 - 1e-10}) {
    clock.move_to(end);
    EXPECT_EQ(clock.time(), end);
    expect_later_stamp();
  }
  clock.advance(start);
  EXPECT_EQ(clock.time(), 0.01);
  expect_later_stamp();
}

TEST(TickClock, ANewInitialStateHasAStampOfItsOwnWhileTimeStands) {
  TickClock clock(100, 1, epoch);
  clock.advance(start);
  clock.restart();
  EXPECT_EQ(clock.time(), 0);
  EXPECT_EQ(clock.stamp(0), epoch + ros::Duration(0, 1000));
  EXPECT_EQ(clock.next_time(), 0.01);
}

TEST(TickClock, StampsGoOnWhereTheyWereAfterARestart) {
  TickClock clock = running(300);
  ros::Time last(0, 1);
  for (int n = 0; n < 3000; ++n) {
    clock.advance(clock.deadline());
    const ros::Time stamp = clock.stamp(clock.time());
    ASSERT_GT(stamp, last);
    last = stamp;
    if (n % 7 == 0) {
      clock.restart();
      EXPECT_EQ(clock.time(), 0);
      ASSERT_EQ(clock.stamp(0), stamp + ros::Duration(0, 1000));
    }
  }
  const double restarts = 429;  // each has a stamp of its own
  EXPECT_NEAR((last - epoch).toSec(), 2999 / 300.0 + restarts * 1e-6, 1e-6);
  EXPECT_NEAR(std::chrono::duration<double>(clock.deadline() - start).count(), 3000 / 300.0 + restarts * 1e-6,
              1e-6);
}

TEST(TickClock, AfterAHaltTimeGoesOnWhereItStood) {
  TickClock clock = running(300);
  for (int n = 0; n <= 200; ++n) clock.advance(clock.deadline());
  const ros::Time stamp = clock.stamp(clock.time());
  const double halt = 50.5 / 300;  // between two ticks
  clock.resume(halt);
  EXPECT_EQ(clock.time(), 50 / 300.0);
  EXPECT_EQ(clock.stamp(clock.time()), stamp);
  EXPECT_GT(clock.stamp(halt), stamp);
  clock.advance(clock.deadline());
  EXPECT_EQ(clock.time(), 51 / 300.0);
  EXPECT_GT(clock.stamp(clock.time()), clock.stamp(halt));
}

// At 1e9 s binary64 has steps of 1.2e-7 s.
TEST(TickClock, AStampIsRightToTheNanosecondWithTheRestOfItsTime) {
  const TickClock clock = running(100, 1, ros::Time(100));
  EXPECT_EQ(clock.stamp(1e9, 41.4e-9), ros::Time(1000000100, 41));
  EXPECT_EQ(clock.stamp(1e9, -41.4e-9), ros::Time(1000000099, 999999959));
}

TEST(TickClock, AStampIsRoundedToTheNanosecond) {
  const TickClock clock = running(100);
  EXPECT_EQ(clock.stamp(0), epoch);
  EXPECT_EQ(clock.stamp(0.1234567894), epoch + ros::Duration(0, 123456789));
}

// 34 years on, binary64 counts seconds in steps of 2.4e-7 s; a time since a new initial state is finer.
TEST(TickClock, AStampIsRoundedToTheNanosecondAlsoLateAfterTheStart) {
  constexpr double late = 1U << 30U;
  TickClock clock = running(1 / late);
  clock.advance(start);
  clock.advance(clock.deadline());
  ASSERT_EQ(clock.time(), late);
  clock.restart();
  EXPECT_EQ(clock.stamp(0), ros::Time(2773741824, 123457789));
  EXPECT_EQ(clock.stamp(0.000000001), ros::Time(2773741824, 123457790));
  EXPECT_EQ(clock.stamp(0.876542211), ros::Time(2773741825, 0));
}

TEST(TickClock, StampsReachTheLastTimeOfRosAndNoFurther) {
  const TickClock clock = running(1, 1, ros::Time(0, 0));
  EXPECT_EQ(clock.stamp(4294967295.0), ros::Time(4294967295, 0));
  EXPECT_THROW(clock.stamp(4294967296.0), StampError);
  EXPECT_THROW(clock.stamp(1e300), StampError);
}

TEST(TickClock, WhileATickIsComputedItIsTheNextOne) {
  TickClock clock = running(100);
  for (int n = 0; n < 10; ++n) clock.advance(clock.deadline());
  const ros::Time before = clock.stamp(clock.time());
  clock.advance(clock.deadline());
  EXPECT_EQ(clock.time(), 0.1);
  clock.wait_at(0.093);
  EXPECT_EQ(clock.time(), 0.093);
  EXPECT_EQ(clock.next_time(), 0.1);
  EXPECT_EQ(clock.deadline(), start + milliseconds(100));
  EXPECT_GT(clock.stamp(clock.time()), before);
  clock.arrive();
  EXPECT_EQ(clock.time(), 0.1);
  EXPECT_EQ(clock.next_time(), 0.11);
}

TEST(TickClock, WhileATickIsComputedStampsGoOnWithTheWallClockAndTimeStands) {
  TickClock clock = running(100, 2);
  clock.advance(start);
  clock.advance(clock.deadline());
  clock.wait_at(0.004);
  ros::Time last = clock.stamp(0.004);
  EXPECT_EQ(clock.hold(start + milliseconds(255)), 51U);  // 250 ms are 500 of simulated time
  EXPECT_DOUBLE_EQ(clock.held(), 0.51);
  EXPECT_EQ(clock.time(), 0.004);
  EXPECT_EQ(clock.deadline(), start + milliseconds(260));
  for (int n = 0; n < 1000; ++n) {
    ASSERT_GT(clock.stamp(0.004), last);
    last = clock.stamp(0.004);
    ASSERT_EQ(clock.hold(clock.deadline()), 1U);
  }
  EXPECT_EQ(clock.deadline(), start + milliseconds(5260));
  EXPECT_NEAR((clock.stamp(0.004) - epoch).toSec(), 10.51 + 0.004, 1e-9);
  clock.hasten(start + milliseconds(5255));
  clock.arrive();
  EXPECT_EQ(clock.time(), 0.01);
  EXPECT_GT(clock.stamp(0.01), last);
  EXPECT_EQ(clock.deadline(), start + milliseconds(5260));
}

TEST(TickClock, TheEpochMayComeWithTheFirstTick) {
  TickClock clock(100, 1, epoch);
  clock.set_epoch(epoch + ros::Duration(0.08));
  clock.run(start);
  clock.advance(start);
  EXPECT_EQ(clock.stamp(clock.time()), epoch + ros::Duration(0.08));
}

// A loop over the ticks in between would take an hour.
TEST(TickClock, AStepOverATrillionOfTicksEndsAtOnce) {
  for (const double rate : {1e6, 1e5 / 3}) {
    TickClock clock(rate, 1, ros::Time(1));
    clock.run(start);
    clock.advance(start);
    clock.stand();
    constexpr double end = 1e9 + 0.1;
    clock.move_to(end);
    EXPECT_EQ(clock.time(), end);
    EXPECT_GT(clock.next_time(), end);
    EXPECT_LE(clock.next_time() - end, 1.001 / rate);
  }
}

TEST(TickClock, TheEpochIsNotBeforeStampsThatWereGiven) {
  TickClock clock(100, 1, epoch);
  clock.set_epoch(ros::Time(1.5));
  EXPECT_EQ(clock.stamp(0), epoch);
}

TEST(TickClock, OfSomebodyElseTakesEveryLateTickAndTheLastOneAfterAJump) {
  TickClock clock = running(100);
  clock.follow(start);
  const TickClock::Wall::time_point late = start + milliseconds(203);
  for (int n = 1; n <= 20; ++n) {
    EXPECT_LE(clock.deadline(), late);
    EXPECT_EQ(clock.follow(late).late(), 0U);
    EXPECT_EQ(clock.time(), n / 100.0);
  }
  EXPECT_GT(clock.deadline(), late);
  EXPECT_EQ(clock.follow(start + milliseconds(5000)).left_out, 479U);
  EXPECT_EQ(clock.time(), 5);
  EXPECT_EQ(clock.deadline(), start + milliseconds(5010));
}

TEST(TickClock, OfSomebodyElseLosesNoTimeToAnotherRate) {
  TickClock clock = running(100);
  clock.follow(start);
  clock.set_rate(1000, start + milliseconds(100), true);
  EXPECT_EQ(clock.next_time(), 0.001);
  EXPECT_EQ(clock.deadline(), start + milliseconds(1));
}

TEST(TickClock, GoesToALaterStampAndToNoEarlierOne) {
  TickClock clock = running(100);
  clock.advance(start);
  clock.go_to_stamp(epoch + ros::Duration(3));
  EXPECT_EQ(clock.stamp(clock.time()), epoch + ros::Duration(3));
  clock.go_to_stamp(epoch + ros::Duration(1));
  EXPECT_EQ(clock.stamp(clock.time()), epoch + ros::Duration(3));
  EXPECT_EQ(clock.time(), 0);
}

TEST(TickClock, BeginsAnewWithAnEarlierStamp) {
  TickClock clock = running(100);
  clock.advance(start);
  clock.advance(start + milliseconds(10));
  const ros::Time earlier(5, 0);
  clock.rebase(earlier, start + milliseconds(20));
  EXPECT_EQ(clock.time(), 0);
  EXPECT_EQ(clock.stamp(0), earlier);
  EXPECT_EQ(clock.next_time(), 0.01);
  EXPECT_EQ(clock.deadline(), start + milliseconds(30));
}

}  // namespace
}  // namespace hybrid_sphere::ros_interface::tick_clock_test

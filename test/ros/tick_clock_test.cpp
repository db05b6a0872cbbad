#include "hybrid_sphere/ros/tick_clock.hpp"

#include <gtest/gtest.h>

namespace hybrid_sphere::ros_interface {
namespace {

using std::chrono::milliseconds;

const ros::Time epoch(1700000000, 123456789);
const TickClock::Wall::time_point start{std::chrono::hours(5)};

TEST(TickClock, TimesAreQuotients) {
  TickClock clock(333, epoch, start);
  for (int n = 0; n < 2000; ++n) {
    EXPECT_EQ(clock.advance(clock.deadline()), 0U);
    EXPECT_EQ(clock.time(), n / 333.0);
  }
}

TEST(TickClock, DeadlinesDoNotDrift) {
  TickClock clock(1000, epoch, start);
  for (int n = 0; n < 100000; ++n) {
    ASSERT_EQ(clock.deadline() - start, milliseconds(n));
    clock.advance(clock.deadline());
  }
}

TEST(TickClock, ALateTickWithinAPeriodIsTaken) {
  TickClock clock(100, epoch, start);
  clock.advance(start);
  EXPECT_EQ(clock.advance(start + milliseconds(19)), 0U);
  EXPECT_EQ(clock.time(), 0.01);
}

TEST(TickClock, TicksThatAreOverAreLeftOut) {
  TickClock clock(100, epoch, start);
  clock.advance(start);
  EXPECT_EQ(clock.advance(start + milliseconds(1003)), 99U);
  EXPECT_EQ(clock.time(), 1.0);
  EXPECT_EQ(clock.deadline(), start + milliseconds(1010));
}

TEST(TickClock, StampsGoOnWhereTheyWereAfterARestart) {
  TickClock clock(300, epoch, start);
  ros::Time last(0, 1);
  for (int n = 0; n < 3000; ++n) {
    clock.advance(clock.deadline());
    const ros::Time stamp = clock.stamp(clock.time());
    ASSERT_GT(stamp, last);
    last = stamp;
    if (n % 7 == 0) {
      clock.restart();
      EXPECT_EQ(clock.time(), 0);
      ASSERT_EQ(clock.stamp(0), stamp);
    }
  }
  EXPECT_NEAR((last - epoch).toSec(), 2999 / 300.0, 2e-9);
}

TEST(TickClock, AfterAHaltTimeGoesOnWhereItStood) {
  TickClock clock(300, epoch, start);
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
  const TickClock clock(100, ros::Time(100), start);
  EXPECT_EQ(clock.stamp(1e9, 41.4e-9), ros::Time(1000000100, 41));
  EXPECT_EQ(clock.stamp(1e9, -41.4e-9), ros::Time(1000000099, 999999959));
}

TEST(TickClock, AStampIsRoundedToTheNanosecond) {
  const TickClock clock(100, epoch, start);
  EXPECT_EQ(clock.stamp(0), epoch);
  EXPECT_EQ(clock.stamp(0.1234567894), epoch + ros::Duration(0, 123456789));
}

// 30 years on, binary64 counts seconds in steps of 1.2e-7 s; a time since a new initial state is finer.
TEST(TickClock, AStampIsRoundedToTheNanosecondAlsoLateAfterTheStart) {
  TickClock clock(1, epoch, start);
  clock.advance(start);
  clock.advance(start + std::chrono::seconds(1'000'000'000));
  clock.restart();
  EXPECT_EQ(clock.stamp(0), ros::Time(2700000000, 123456789));
  EXPECT_EQ(clock.stamp(0.000000001), ros::Time(2700000000, 123456790));
  EXPECT_EQ(clock.stamp(0.876543211), ros::Time(2700000001, 0));
}

TEST(TickClock, StampsReachTheLastTimeOfRosAndNoFurther) {
  const TickClock clock(1, ros::Time(0, 0), start);
  EXPECT_EQ(clock.stamp(4294967295.0), ros::Time(4294967295, 0));
  EXPECT_THROW(clock.stamp(4294967296.0), std::out_of_range);
  EXPECT_THROW(clock.stamp(1e300), std::out_of_range);
}

}  // namespace
}  // namespace hybrid_sphere::ros_interface

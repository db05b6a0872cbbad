#include "ros/node/computation.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>

#include "interrupt/interrupt.hpp"
#include "support/patience.hpp"

namespace hybrid_sphere::ros_interface::computation_test {
namespace {

/// Work of so many turns, of which none is done twice.
class Turns {
 public:
  Turns(Computation& computation, int count) : computation_(computation), left_(count) {}

  void operator()() {
    while (left_ > 0) {
      if (computation_.should_stop()) throw Interrupted();
      testing::give_way();
      --left_;
    }
  }
  int left() const { return left_; }

 private:
  Computation& computation_;
  std::atomic<int> left_;
};

void wait_for_end(Computation& computation) {
  testing::wait_until([&] { return computation.finish(); });
}

TEST(Computation, WhatIsShortIsDoneAtOnce) {
  Computation computation;
  bool done = false;
  EXPECT_TRUE(computation.attempt([&done] { done = true; }));
  EXPECT_TRUE(done);
  EXPECT_FALSE(computation.under_way());
}

TEST(Computation, WhatIsLongIsInterruptedAndGoesOnInAnotherThread) {
  Computation computation;
  Turns turns(computation, 200);
  EXPECT_FALSE(computation.attempt([&] { turns(); }));
  EXPECT_GT(turns.left(), 0);
  std::atomic<int> ended{0};
  computation.go_on([&] { turns(); }, [&ended] { ++ended; });
  EXPECT_TRUE(computation.under_way());
  wait_for_end(computation);
  EXPECT_EQ(turns.left(), 0);
  EXPECT_EQ(ended, 1);
  EXPECT_FALSE(computation.under_way());
}

TEST(Computation, WhatIsUnderWayIsInterrupted) {
  Computation computation;
  Turns turns(computation, 1'000'000);
  computation.go_on([&] { turns(); }, [] {});
  EXPECT_FALSE(computation.finish());
  computation.interrupt();
  EXPECT_FALSE(computation.under_way());
  const int left = turns.left();
  EXPECT_GT(left, 0);
  EXPECT_FALSE(computation.should_stop());
  EXPECT_FALSE(computation.attempt([&] { turns(); }));
  EXPECT_LT(turns.left(), left);
}

TEST(Computation, WhatTheWorkThrowsComesToWhoeverAsks) {
  Computation computation;
  const auto fail = [] { throw std::domain_error("no number"); };
  EXPECT_THROW(computation.attempt(fail), std::domain_error);
  EXPECT_FALSE(computation.should_stop());
  computation.go_on(fail, [] {});
  EXPECT_THROW(wait_for_end(computation), std::domain_error);
  EXPECT_FALSE(computation.under_way());
  computation.go_on(fail, [] {});
  EXPECT_THROW(computation.interrupt(), std::domain_error);
  EXPECT_FALSE(computation.under_way());
}

TEST(Computation, ItsEndInterruptsWhatIsUnderWay) {
  Turns* turns = nullptr;
  {
    Computation computation;
    turns = new Turns(computation, 1'000'000);
    computation.go_on([turns] { (*turns)(); }, [] {});
  }
  EXPECT_GT(turns->left(), 0);
  delete turns;
}

}  // namespace
}  // namespace hybrid_sphere::ros_interface::computation_test

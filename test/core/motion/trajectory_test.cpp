#include "motion/trajectory.hpp"

#include <gtest/gtest.h>

#include <deque>
#include <random>
#include <stdexcept>

#include "core/motion/random_equations.hpp"
#include "core/motion/random_steps.hpp"

namespace hybrid_sphere::testing::trajectory_test {
namespace {

using numeric::time_of;

/// A motion of 300 steps: more than a block of nodes holds.
class LongTrajectory : public ::testing::Test {
 protected:
  LongTrajectory() {
    trajectory_.begin(equations_, segment_.start(equations_));
    while (trajectory_.size() < 300) trajectory_.extend();
  }
  double time(std::size_t i) const { return time_of(trajectory_.node(i).y); }

  RandomSegment segment_ = RandomSegments(1).next(numeric::EquationForm::rolling);
  numeric::Equations equations_ = segment_.equations();
  numeric::Trajectory trajectory_{{scene::Solver::Method::rk4, 1e-9, 1e-3}};
};

TEST_F(LongTrajectory, FindsTheNodeBeforeATime) {
  EXPECT_EQ(trajectory_.index_at(-1), 0U);
  for (std::size_t i = 0; i < trajectory_.size(); ++i) {
    ASSERT_EQ(trajectory_.index_at(time(i)), i);
    ASSERT_EQ(trajectory_.index_at(time(i) + 1e-5), i);
  }
}

TEST_F(LongTrajectory, SaysTheSameAfterOtherTimesHaveBeenForgotten) {
  const double late = time(200) + 4e-4;
  const numeric::State before = trajectory_.at(late);
  trajectory_.forget_before(time(1));
  EXPECT_EQ(trajectory_.forgotten(), 1U);
  EXPECT_EQ(trajectory_.size(), 299U);
  const double begin = time(0);
  EXPECT_THROW(trajectory_.at(begin - 1e-5), std::runtime_error);
  trajectory_.forget_before(late);
  EXPECT_EQ(trajectory_.forgotten(), 200U);
  EXPECT_TRUE((trajectory_.at(late) == before).all());
}

TEST_F(LongTrajectory, MovesNoNodeWhenItGrows) {
  const numeric::Node* first = &trajectory_.node(0);
  while (trajectory_.size() < 3000) trajectory_.extend();
  EXPECT_EQ(&trajectory_.node(0), first);
}

TEST(NodeQueue, HoldsTheSameAsADeque) {
  std::mt19937 random(1);
  integration::NodeQueue queue;
  std::deque<double> expected;
  double next = 0;
  for (int round = 0; round < 2000; ++round) {
    for (std::size_t i = random() % (round % 500 == 0 ? 20000 : 40); i > 0; --i) {
      numeric::Node node;
      node.step = next;
      queue.push_back(node);
      expected.push_back(next++);
    }
    const std::size_t count = random() % (expected.size() + 1) / (random() % 4 + 1);
    queue.pop_front(count);
    expected.erase(expected.begin(), expected.begin() + static_cast<std::ptrdiff_t>(count));
    if (random() % 100 == 0) {
      queue.clear();
      expected.clear();
    }
    queue.release(random() % 3);
    ASSERT_EQ(queue.size(), expected.size());
    for (std::size_t i = 0; i < expected.size(); ++i) ASSERT_EQ(queue[i].step, expected[i]);
    if (!expected.empty()) {
      ASSERT_EQ(queue.back().step, expected.back());
    }
  }
}

}  // namespace
}  // namespace hybrid_sphere::testing::trajectory_test

#include "ros/node/guarded_queue.hpp"

#include <gtest/gtest.h>

#include <stdexcept>
#include <string>
#include <vector>

#include "ros/node/callback_queue_call.hpp"

namespace hybrid_sphere::ros_interface::guarded_queue_test {
namespace {

TEST(GuardedQueue, NoExceptionLeavesItAndTheOthersAreCalled) {
  std::vector<std::string> failures;
  GuardedQueue queue([&failures](const std::string& reason) { failures.push_back(reason); });
  int called = 0;
  post(queue, [&called] { ++called; });
  post(queue, [] { throw std::domain_error("no number"); });
  post(queue, [] { throw std::bad_alloc(); });
  post(queue, [&called] { ++called; });
  EXPECT_NO_THROW(queue.callAvailable());
  EXPECT_EQ(called, 2);
  ASSERT_EQ(failures.size(), 2U);
  EXPECT_EQ(failures[0], "no number");
  EXPECT_TRUE(queue.isEmpty());
}

}  // namespace
}  // namespace hybrid_sphere::ros_interface::guarded_queue_test

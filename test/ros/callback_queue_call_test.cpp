#include "ros/node/callback_queue_call.hpp"

#include <gtest/gtest.h>
#include <ros/callback_queue.h>

#include <atomic>
#include <future>
#include <thread>

namespace hybrid_sphere::ros_interface::callback_queue_call_test {
namespace {

const ros::WallDuration moment(0.05);

/// Handles a queue in a thread of its own.
class Spinner {
 public:
  explicit Spinner(ros::CallbackQueue& queue)
      : thread_([this, &queue] {
          while (!ends_) queue.callAvailable(moment);
        }) {}
  ~Spinner() {
    ends_ = true;
    thread_.join();
  }
  std::thread::id id() const { return thread_.get_id(); }

 private:
  std::atomic<bool> ends_{false};
  std::thread thread_;
};

bool never() { return false; }

TEST(CallbackQueueCall, RunsInTheThreadOfTheQueueAndIsWaitedFor) {
  ros::CallbackQueue queue;
  const Spinner spinner(queue);
  for (int i = 0; i < 100; ++i) {
    std::thread::id where;  // no atomic: what is written there is seen here
    EXPECT_TRUE(run_in(
        queue, [&] { where = std::this_thread::get_id(); }, never));
    EXPECT_EQ(where, spinner.id());
  }
}

TEST(CallbackQueueCall, OfTwoCallersRunsOneAtATime) {
  ros::CallbackQueue queue;
  const Spinner spinner(queue);
  int count = 0;  // guarded by the one thread of the queue
  const auto add_hundred = [&] {
    for (int i = 0; i < 100; ++i)
      run_in(
          queue, [&] { ++count; }, never);
  };
  std::thread other(add_hundred);
  add_hundred();
  other.join();
  EXPECT_EQ(count, 200);
}

TEST(CallbackQueueCall, GivenUpNeverRuns) {
  ros::CallbackQueue queue;
  bool ran = false;
  EXPECT_FALSE(run_in(
      queue, [&] { ran = true; }, [] { return true; }));
  queue.callAvailable();
  EXPECT_FALSE(ran);
}

TEST(CallbackQueueCall, ThatThrowsIsNotDone) {
  ros::CallbackQueue queue;
  std::atomic<bool> gives_up{false};
  auto done = std::async(std::launch::async, [&] {
    return run_in(
        queue, [] { throw std::runtime_error("broken"); }, [&] { return gives_up.load(); });
  });
  EXPECT_THROW(while (true) queue.callAvailable(moment), std::runtime_error);
  gives_up = true;
  EXPECT_FALSE(done.get());
}

TEST(CallbackQueueCall, PostedRunsLater) {
  ros::CallbackQueue queue;
  int count = 0;
  post(queue, [&] { ++count; });
  EXPECT_EQ(count, 0);
  queue.callAvailable();
  EXPECT_EQ(count, 1);
}

}  // namespace
}  // namespace hybrid_sphere::ros_interface::callback_queue_call_test

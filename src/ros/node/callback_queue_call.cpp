#include "ros/node/callback_queue_call.hpp"

#include <boost/make_shared.hpp>
#include <chrono>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <utility>

namespace hybrid_sphere::ros_interface {
namespace {

constexpr std::chrono::milliseconds patience(20);  // between two looks whether to give up

class Call : public ros::CallbackInterface {
 public:
  explicit Call(std::function<void()> function) : function_(std::move(function)) {}
  CallResult call() override {
    function_();
    return Success;
  }

 private:
  std::function<void()> function_;
};

/// What the two threads share; the function is called under the mutex, so that it is not left behind.
struct PendingCall {
  enum class Progress { waiting, begun, done, given_up };
  std::mutex mutex;
  std::condition_variable changed;
  Progress progress = Progress::waiting;
};

}  // namespace

void post(ros::CallbackQueueInterface& queue, std::function<void()> function) {
  queue.addCallback(boost::make_shared<Call>(std::move(function)));
}

bool run_in(ros::CallbackQueueInterface& queue, const std::function<void()>& function,
            const std::function<bool()>& give_up) {
  using Progress = PendingCall::Progress;
  const auto call = std::make_shared<PendingCall>();
  post(queue, [call, &function] {
    {
      const std::lock_guard<std::mutex> lock(call->mutex);
      if (call->progress == Progress::given_up) return;  // the function may be gone
      call->progress = Progress::begun;
      function();
      call->progress = Progress::done;
    }
    call->changed.notify_one();
  });
  std::unique_lock<std::mutex> lock(call->mutex);
  while (call->progress == Progress::waiting && !give_up()) call->changed.wait_for(lock, patience);
  if (call->progress == Progress::waiting) call->progress = Progress::given_up;
  return call->progress == Progress::done;
}

}  // namespace hybrid_sphere::ros_interface

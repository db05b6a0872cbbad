#pragma once

#include <atomic>
#include <functional>
#include <string>
#include <thread>

#include "ros/node/guarded_queue.hpp"

namespace hybrid_sphere::ros_interface {

/// A callback queue and the thread that handles it. What has its callbacks there, such as a service, has to
/// go before this does, and after stop().
class CallbackThread {
 public:
  /// @param work     what fails where a callback throws: "a map request", for the console
  /// @param between  called in the thread after each wait, at least ten times a second
  explicit CallbackThread(const std::string& work, std::function<void()> between = {});
  ~CallbackThread() { stop(); }
  CallbackThread(const CallbackThread&) = delete;
  CallbackThread& operator=(const CallbackThread&) = delete;

  ros::CallbackQueue& queue() { return queue_; }
  /// Once, or again while it runs.
  void start();
  /// Has it end after the callback that it is in; waits for it. It does not start again.
  void stop();
  /// Whether a callback that waits for something has to give up: stop() has been called, or ROS shuts down.
  bool ends() const;

  /// Has a function called in the thread of another queue and waits until it has returned. For callbacks.
  /// @return false: the end has come before it has begun, and it will never be called
  bool run_in(ros::CallbackQueueInterface& other, const std::function<void()>& function) const;

 private:
  void run();

  std::function<void()> between_;
  std::atomic<bool> ends_{false};
  GuardedQueue queue_;
  std::thread thread_;
};

}  // namespace hybrid_sphere::ros_interface

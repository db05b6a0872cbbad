#pragma once

#include <ros/callback_queue_interface.h>

#include <functional>

/// Work handed to the thread that handles a callback queue.
namespace hybrid_sphere::ros_interface {

/// Has the function called in the thread of the queue; does not wait.
void post(ros::CallbackQueueInterface& queue, std::function<void()> function);

/// Has the function called in the thread of the queue and waits until it has returned.
/// @param give_up  asked many times a second as long as the function has not begun
/// @return         false: given up, and the function will never be called; or it has thrown, over there
bool run_in(ros::CallbackQueueInterface& queue, const std::function<void()>& function,
            const std::function<bool()>& give_up);

}  // namespace hybrid_sphere::ros_interface

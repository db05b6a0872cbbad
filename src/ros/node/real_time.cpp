#include "ros/node/real_time.hpp"

#include <pthread.h>
#include <ros/poll_manager.h>
#include <sched.h>
#include <sys/mman.h>

#include <atomic>
#include <cerrno>
#include <cstring>
#include <memory>

namespace hybrid_sphere::ros_interface {
namespace {

/// @return 0, or the number of the error
int schedule_this_thread(int policy, int priority) noexcept {
  sched_param parameters{};
  parameters.sched_priority = priority;
  return sched_setscheduler(0, policy, &parameters) == 0 ? 0 : errno;
}

/// roscpp lets everybody have a look at each turn of its thread: at the first one it is given the priority.
void schedule_sockets_thread(int priority) {
  const auto done = std::make_shared<std::atomic<bool>>(false);
  ros::PollManager::instance()->addPollThreadListener([done, priority] {
    if (!done->exchange(true)) schedule_this_thread(SCHED_FIFO, priority);
  });
}

}  // namespace

std::string enter_real_time(int priority) {
  std::string refused;
  const int error = schedule_this_thread(SCHED_FIFO | SCHED_RESET_ON_FORK, priority);
  if (error == 0) {
    schedule_sockets_thread(priority);
  } else {
    refused = "the priority (" + std::string(std::strerror(error)) +
              "; \"rtprio\" in /etc/security/limits.conf or the capability CAP_SYS_NICE permits it)";
  }
  // Pages are locked when they are first touched: thread stacks and the like do not grow by it.
  if (mlockall(MCL_CURRENT | MCL_FUTURE | MCL_ONFAULT) != 0) {
    const std::string reason = std::strerror(errno);
    refused +=
        (refused.empty() ? "" : " or ") + ("locked memory (" + reason) +
        "; \"memlock unlimited\" in /etc/security/limits.conf or the capability CAP_IPC_LOCK permits it)";
  }
  return refused;
}

void leave_real_time() noexcept { schedule_this_thread(SCHED_OTHER, 0); }

}  // namespace hybrid_sphere::ros_interface

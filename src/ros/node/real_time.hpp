#pragma once

#include <string>

/// Scheduling by the kernel's real-time class.
namespace hybrid_sphere::ros_interface {

/// Gives the calling thread, and the one in which roscpp reads and writes its sockets, a real-time priority
/// (SCHED_FIFO), and keeps the memory of the process from being paged out. Threads that the caller starts
/// later have none. What the system does not permit is left out.
/// @param priority  1 to 99
/// @return          what was not permitted, and what permits it; empty where all was
std::string enter_real_time(int priority);

/// The calling thread is scheduled like any other from now on.
void leave_real_time() noexcept;

}  // namespace hybrid_sphere::ros_interface

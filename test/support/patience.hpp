#pragma once

#include <sys/time.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <stdexcept>
#include <thread>

/// The only clocks of the C++ tests. They protect against hangs; a test counts, and a benchmark measures.
namespace hybrid_sphere::testing {

/// Lets other threads and processes run. No result depends on the duration.
inline void give_way(std::chrono::milliseconds duration = std::chrono::milliseconds(1)) {
  std::this_thread::sleep_for(duration);
}

/// Waits until a condition holds.
/// @throws std::runtime_error  after five minutes: something hangs
template <class Condition>
void wait_until(const Condition& condition) {
  constexpr int max_turns = 300'000;  // of a millisecond or more
  for (int turns = 0; !condition(); ++turns) {
    if (turns == max_turns) throw std::runtime_error("the test has waited for five minutes: something hangs");
    give_way();
  }
}

/// Ends the test program if a scope takes a minute of processor time, a hundred times as long as it needs.
class HangGuard {
 public:
  HangGuard() {
    signal(SIGPROF, end);
    set(60);
  }
  ~HangGuard() { set(0); }
  HangGuard(const HangGuard&) = delete;
  HangGuard& operator=(const HangGuard&) = delete;

 private:
  static void set(time_t seconds) {
    const itimerval limit{{}, {seconds, 0}};
    setitimer(ITIMER_PROF, &limit, nullptr);
  }
  static void end(int) {
    constexpr char message[] = "the test computes for a minute: something hangs\n";
    const ssize_t written = write(STDERR_FILENO, message, sizeof message - 1);
    _exit(written < 0 ? 2 : 1);
  }
};

}  // namespace hybrid_sphere::testing

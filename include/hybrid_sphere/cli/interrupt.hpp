#pragma once

#include <array>
#include <atomic>
#include <csignal>

namespace hybrid_sphere::cli {

/// While one lives, the first SIGINT (Ctrl-C) or SIGTERM (kill) is noted instead of ending the process;
/// another one of the same kind ends it as usual. Where one of them is ignored it stays so. There is one at a
/// time.
class Interrupt {
 public:
  Interrupt();
  ~Interrupt();
  Interrupt(const Interrupt&) = delete;
  Interrupt& operator=(const Interrupt&) = delete;

  bool seen() const { return signal() != 0; }

  /// The last one that has come; 0: none.
  int signal() const { return noted.load(std::memory_order_relaxed); }

 private:
  static void note(int signal) { noted.store(signal, std::memory_order_relaxed); }

  static inline std::atomic<int> noted{0};
  static_assert(std::atomic<int>::is_always_lock_free, "a signal handler may set it");
  static constexpr std::array<int, 2> signals{SIGINT, SIGTERM};
  std::array<struct sigaction, signals.size()> before_;
};

}  // namespace hybrid_sphere::cli

#pragma once

#include <array>
#include <csignal>
#include <iosfwd>

namespace hybrid_sphere::cli {

/// While one lives, the first SIGINT (Ctrl-C) or SIGTERM (kill) is noted instead of ending the process;
/// another one of the same kind ends it as usual. Where one of them is ignored it stays so. There is one at a
/// time.
class Interrupt {
 public:
  /// @param notes_second  whether a second one of the same kind is noted, too, and the third ends the process
  explicit Interrupt(bool notes_second = false);
  ~Interrupt();
  Interrupt(const Interrupt&) = delete;
  Interrupt& operator=(const Interrupt&) = delete;

  bool seen() const { return signal() != 0; }

  /// The first one that has come; 0: none.
  int signal() const { return noted; }

  /// Whether another one has been noted after it.
  bool seen_again() const { return again != 0; }

 private:
  static void note(int signal);

  // Not atomic, which would keep loops that look at it from having their values in registers.
  static inline volatile std::sig_atomic_t noted = 0;
  static inline volatile std::sig_atomic_t again = 0;
  static constexpr std::array<int, 2> signals{SIGINT, SIGTERM};
  std::array<struct sigaction, signals.size()> before_;
};

/// Says that a signal has ended a run, and when. @return the exit code
int ended_by(const char* program, int signal, double time, std::ostream& err);

}  // namespace hybrid_sphere::cli

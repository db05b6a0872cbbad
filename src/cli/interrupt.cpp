#include "cli/interrupt.hpp"

#include <cstring>
#include <ostream>

#include "cli/exit_code.hpp"

namespace hybrid_sphere::cli {

void Interrupt::note(int signal) {
  if (noted == 0) {
    noted = signal;
  } else {
    again = signal;
    std::signal(signal, SIG_DFL);
  }
}

Interrupt::Interrupt(bool notes_second) : before_{} {
  noted = again = 0;
  for (std::size_t i = 0; i < signals.size(); ++i) {
    sigaction(signals[i], nullptr, &before_[i]);
    if (before_[i].sa_handler == SIG_IGN) continue;
    struct sigaction action {};
    action.sa_handler = note;
    action.sa_flags = static_cast<int>(SA_RESTART | (notes_second ? 0 : SA_RESETHAND));
    sigemptyset(&action.sa_mask);
    sigaction(signals[i], &action, nullptr);
  }
}

Interrupt::~Interrupt() {
  for (std::size_t i = 0; i < signals.size(); ++i) sigaction(signals[i], &before_[i], nullptr);
}

int ended_by(const char* program, int signal, double time, std::ostream& err) {
  err << program << ": ended by signal " << signal << " (" << strsignal(signal) << ") at t = " << time
      << " s: everything up to there is written\n";
  return by_signal + signal;
}

}  // namespace hybrid_sphere::cli

#include "hybrid_sphere/cli/interrupt.hpp"

#include <atomic>

namespace hybrid_sphere::cli {
namespace {

std::atomic<bool> noted{false};
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler may set it");

void note(int /*signal*/) { noted = true; }

}  // namespace

Interrupt::Interrupt() : before_{} {
  noted = false;
  sigaction(SIGINT, nullptr, &before_);
  if (before_.sa_handler == SIG_IGN) return;
  struct sigaction action {};
  action.sa_handler = note;
  action.sa_flags = static_cast<int>(SA_RESETHAND | SA_RESTART);
  sigemptyset(&action.sa_mask);
  sigaction(SIGINT, &action, nullptr);
}

Interrupt::~Interrupt() { sigaction(SIGINT, &before_, nullptr); }

bool Interrupt::seen() const { return noted; }

}  // namespace hybrid_sphere::cli

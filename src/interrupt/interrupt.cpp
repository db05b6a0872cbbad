#include "hybrid_sphere/interrupt/interrupt.hpp"

#include <utility>

namespace hybrid_sphere {

InterruptScope::InterruptScope(const ShouldStop& should_stop)
    : before_(std::exchange(detail::should_stop, should_stop ? &should_stop : nullptr)) {}

InterruptScope::~InterruptScope() { detail::should_stop = before_; }

void InterruptScope::count_from_here() { detail::turns = 0; }

void detail::ask_whether_to_stop() {
  turns = 0;
  if ((*should_stop)()) throw Interrupted();
}

}  // namespace hybrid_sphere

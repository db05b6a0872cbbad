#include "interrupt/interrupt.hpp"

namespace hybrid_sphere {

void detail::ask_whether_to_stop() {
  turns = 0;
  if ((*should_stop)()) throw Interrupted();
}

}  // namespace hybrid_sphere

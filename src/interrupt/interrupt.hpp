#pragma once

#include <cstdint>
#include <functional>
#include <utility>

#include "hybrid_sphere/interrupt/interrupted.hpp"

/// Long computations can be asked to stop. Every loop whose length depends on numbers of the user passes an
/// interruption point in each turn; now and then one asks a function of the caller whether to stop, and
/// throws Interrupted if so. Loops keep what they have computed, so that they can go on later.
namespace hybrid_sphere {

/// Whether to stop. What it throws ends the computation like Interrupted.
using ShouldStop = std::function<bool()>;

namespace detail {

/// Turns of loops, of a microsecond or so each, between two questions. Tests ask more often.
inline thread_local std::uint32_t turns_between_questions = 256;

inline thread_local const ShouldStop* should_stop = nullptr;
inline thread_local std::uint32_t turns = 0;

void ask_whether_to_stop();

}  // namespace detail

/// While one lives, the interruption points that its thread passes ask a function. Of several, the last one
/// is asked; with none, or an empty function, nobody is.
class InterruptScope {
 public:
  /// @param should_stop  has to live as long as this
  explicit InterruptScope(const ShouldStop& should_stop)
      : before_(std::exchange(detail::should_stop, should_stop ? &should_stop : nullptr)) {}
  ~InterruptScope() { detail::should_stop = before_; }
  InterruptScope(const InterruptScope&) = delete;
  InterruptScope& operator=(const InterruptScope&) = delete;

  /// The caller has been asked by other ways just now.
  static void count_from_here() { detail::turns = 0; }

 private:
  const ShouldStop* before_;
};

/// Passed in each turn of a loop.
/// @param turns  that this one is worth, where it takes longer than a microsecond
/// @throws Interrupted  where the computation should stop
inline void interruption_point(std::uint32_t turns = 1) {
  if (detail::should_stop == nullptr) return;
  detail::turns += turns;
  if (detail::turns >= detail::turns_between_questions) detail::ask_whether_to_stop();
}

}  // namespace hybrid_sphere

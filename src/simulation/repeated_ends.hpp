#pragma once

#include <cmath>
#include <utility>

#include "sphere/contact_mode.hpp"

namespace hybrid_sphere {

/// Motions that end as soon as they begin, one after another at one instant, where rounding hides which mode
/// the contact has.
class RepeatedEnds {
 public:
  void clear() { modes_ = 0; }

  /// A motion ends. @return whether one of this mode has ended at this instant before, as soon as it began:
  /// this would repeat endlessly. So would motions that each last too short a time for the forces to change
  /// anything.
  /// @param lasted  [s]
  /// @param scale   time in which the forces change the motion [s]
  bool count(ContactMode mode, double lasted, double scale, double now) {
    constexpr double no_time = 0x1p-60;
    const double brief = scale < never ? no_time * scale : 0;
    const bool at_once = lasted <= brief;
    const auto bit = static_cast<unsigned>(1) << static_cast<unsigned>(mode);
    const double last_end = std::exchange(ended_at_, now);
    if (!at_once || now > std::nextafter(last_end + brief, never)) modes_ = 0;
    const bool repeats = at_once && (modes_ & bit) != 0;
    modes_ |= at_once ? bit : 0U;
    return repeats;
  }

  /// Whether the ground has already been taken to hold the sphere at this instant; sets this to true.
  bool was_held() { return was(held); }
  /// The same for being brought to rest.
  bool was_stopped() { return was(stopped); }

 private:
  static constexpr unsigned held = 1U << 31U;
  static constexpr unsigned stopped = 1U << 30U;
  bool was(unsigned bit) { return (std::exchange(modes_, modes_ | bit) & bit) != 0; }

  unsigned modes_ = 0;   // that have ended at this instant, and the two above
  double ended_at_ = 0;  // the last one [s]
};

}  // namespace hybrid_sphere

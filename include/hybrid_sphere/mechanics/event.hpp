#pragma once

#include <functional>
#include <string>

#include "hybrid_sphere/mechanics/vector.hpp"

namespace hybrid_sphere::mechanics {

/// In which direction a function changes its sign.
enum class Crossing {
  falling,  ///< from positive to negative
  rising,   ///< from negative to positive
  either
};

/// An event of the user's own: it occurs when a function g(t, q, v) changes its sign, once for each crossing.
/// It is reported as a Switch, and may reset the velocities. Parameters and discrete states, such as a gear,
/// are changed by Plant::set_input in on_switch. Source: docs/theory.md 7.9.
/// @code
/// mechanics::Event half;
/// half.name = "half way";
/// half.function = [](double t, const mechanics::Vector& q, const mechanics::Vector& v) { return q[0] - 0.5;
/// }; half.crossing = mechanics::Crossing::rising;
/// @endcode
struct Event {
  std::string name;
  std::function<double(double t, const Vector& q, const Vector& v)> function;  ///< g
  Crossing crossing = Crossing::either;
  /// Returns the velocities after the event (n); empty: they stay. Constraints and contacts then respond as
  /// in a collision.
  std::function<Vector(double t, const Vector& q, const Vector& v)> reset{};
};

}  // namespace hybrid_sphere::mechanics

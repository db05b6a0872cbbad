#pragma once

#include <cstdint>

#include "hybrid_sphere/sphere/twist.hpp"

namespace hybrid_sphere {

/// Curves of the centre whose meetings with an edge have a formula.
enum class CurveForm : std::uint8_t {
  parabola,  ///< start + velocity tau + acceleration tau^2/2; a straight line where the last is 0
  arc,       ///< a circle, run through at a constant rate
  general,
};

struct Curve {
  CurveForm form = CurveForm::general;
  Vector2d start = Vector2d::Zero();         ///< [m]
  Vector2d velocity = Vector2d::Zero();      ///< at the start [m/s]
  Vector2d acceleration = Vector2d::Zero();  ///< at the start; constant for a parabola [m/s^2]
  Vector2d orbit_center = Vector2d::Zero();  ///< of an arc [m]
  Vector2d arm = Vector2d::Zero();           ///< of an arc: from orbit_center to start [m]
  double rate = 0;                           ///< of an arc: angular, counter-clockwise [rad/s]
};

}  // namespace hybrid_sphere

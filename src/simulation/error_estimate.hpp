#pragma once

#include <algorithm>
#include <cfloat>
#include <cmath>

#include "simulation/motion_kind.hpp"
#include "simulation/segment.hpp"

namespace hybrid_sphere {

/// The expected relative error of the outputs of a scene, excluding the conditioning of the path:
/// docs/theory.md 5.1.
class ErrorEstimate {
 public:
  explicit ErrorEstimate(const scene::Scene& scene)
      : ErrorEstimate(Dynamics(Sphere(scene.sphere), scene.forces), scene.surface) {}
  ErrorEstimate(const Dynamics& dynamics, const scene::Surface& surface) {
    phase_rate_ = std::sqrt(dynamics.spring_rate);
    add(dynamics, surface.base);
    for (const scene::Region& region : surface.regions) add(dynamics, region.material);
  }

  /// @param segments     between switches
  /// @param duration      [s]
  /// @param fastest_spin  abs(omega) [rad/s]
  /// @param of_steps      Simulation::estimated_error()
  double operator()(double segments, double duration, double fastest_spin, double of_steps) const {
    const double rounding =
        DBL_EPSILON * (4 + segments + phase_rate_ * duration) + angle_error_ * fastest_spin * duration;
    return rounding + of_steps;
  }

 private:
  // An ulp for each segment; the phases of oscillations and circles; the angle turned: the exponential map of
  // half of it, or of the steps of Attitude.
  static constexpr double of_exponential_ = 0.5 * DBL_EPSILON;
  static constexpr double of_steps_ = 1e-15;

  void add(const Dynamics& dynamics, const scene::Material& material) {
    phase_rate_ = std::max(phase_rate_, dynamics.kappa * std::abs(material.turntable_rate));
    for (const ContactMode mode : contact_modes_on(dynamics, material)) {
      const double omega_3 = material.turntable_rate + 1;  // nothing special
      if (motion_kind(dynamics, mode, material, omega_3) != MotionKind::uniform) angle_error_ = of_steps_;
    }
  }

  double phase_rate_ = 0;  // [rad/s]
  double angle_error_ = of_exponential_;
};

}  // namespace hybrid_sphere

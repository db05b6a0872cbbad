#pragma once

#include "core/solver/random_equations.hpp"
#include "hybrid_sphere/solver/departure.hpp"

namespace hybrid_sphere::testing {

/// What starts to grow from 0, beside what.
enum class Start { slip, slip_of_skid, slip_beside_roll, roll_beside_slip, both };

constexpr Start starts[] = {Start::slip, Start::slip_of_skid, Start::slip_beside_roll,
                            Start::roll_beside_slip, Start::both};

/// Turns all that drives the stretch into one line, on ground that does not turn.
inline void lay_on_a_line(RandomStretch& stretch) {
  const auto laid = [](const Vector2d& v) { return Vector2d(v.x() < 0 ? -v.norm() : v.norm(), 0); };
  stretch.velocity = laid(stretch.velocity);
  stretch.slip = laid(stretch.slip);
  stretch.nu = laid(stretch.nu);
  stretch.dynamics.free = laid(stretch.dynamics.free);
  stretch.dynamics.spin = laid(stretch.dynamics.spin);
  stretch.dynamics.spring_center = stretch.position + laid(stretch.dynamics.spring_center);
  stretch.ground.turntable_rate = 0;
  stretch.ground.belt = laid(stretch.ground.belt);
}

inline solver::Departure departure_of(const RandomStretch& stretch, const solver::Equations& equations) {
  return solver::Departure(equations, stretch.slip, stretch.nu);
}

/// Where dry friction has just let go: it holds half of what drives, or a little less than all.
class RandomDepartures {
 public:
  explicit RandomDepartures(unsigned seed) : random_(seed) {}

  RandomStretches& numbers() { return random_; }

  /// @param small  times the slip or the roll beside which another starts
  RandomStretch next(Start start, bool on_a_line, double small = 1) {
    RandomStretch stretch = random_.next(regime_of(start));
    if (on_a_line) lay_on_a_line(stretch);
    stretch.slip *= small;
    stretch.nu *= small;
    if (start != Start::roll_beside_slip) stretch.slip.setZero();
    if (start == Start::roll_beside_slip || start == Start::both) stretch.nu.setZero();
    if (start != Start::slip) {
      stretch.velocity = stretch.slip + stretch.nu + ground_velocity(stretch.ground, stretch.position);
    }
    const solver::Equations equations = stretch.equations();
    const solver::State y = stretch.start(equations);
    const solver::Instant now = equations.instant(y);
    const double kappa = stretch.dynamics.kappa;
    double& friction = stretch.ground.friction;
    double& resistance = stretch.ground.rolling_resistance;
    if (start == Start::both) {
      friction = random_.part() * now.forcing.norm() / stretch.dynamics.slip_decay(1);
      resistance = part() * (now.spin.norm() + (1 - kappa) * stretch.dynamics.slip_decay(friction)) /
                   stretch.dynamics.spinning_decay(1);
    } else if (start == Start::roll_beside_slip) {
      resistance = part() * equations.dry_vector(1, y, now).drive.norm() / stretch.dynamics.spinning_decay(1);
    } else {
      const double drive = equations.dry_vector(0, y, now).drive.norm();
      friction *= part() * drive / equations.decay();
    }
    return stretch;
  }

 private:
  static solver::Regime regime_of(Start start) {
    if (start == Start::slip) return solver::Regime::sliding;
    return start == Start::slip_of_skid ? solver::Regime::skidding : solver::Regime::scrubbing;
  }
  double part() { return random_.one_in(2) ? 1 - 1e-3 * random_.part() : 0.5 + 0.5 * random_.part(); }

  RandomStretches random_;
};

}  // namespace hybrid_sphere::testing

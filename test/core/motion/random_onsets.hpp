#pragma once

#include "core/motion/random_equations.hpp"
#include "motion/slip_onset.hpp"

namespace hybrid_sphere::testing {

/// What starts to grow from 0, beside what.
enum class Start { slip, slip_of_skid, slip_beside_roll, roll_beside_slip, both };

constexpr Start starts[] = {Start::slip, Start::slip_of_skid, Start::slip_beside_roll,
                            Start::roll_beside_slip, Start::both};

/// Turns all that drives the segment into one line, on ground that does not turn.
inline void lay_on_a_line(RandomSegment& segment) {
  const auto laid = [](const Vector2d& v) { return Vector2d(v.x() < 0 ? -v.norm() : v.norm(), 0); };
  segment.velocity = laid(segment.velocity);
  segment.slip = laid(segment.slip);
  segment.nu = laid(segment.nu);
  segment.dynamics.free = laid(segment.dynamics.free);
  segment.dynamics.spin = laid(segment.dynamics.spin);
  segment.dynamics.spring_center = segment.position + laid(segment.dynamics.spring_center);
  segment.ground.turntable_rate = 0;
  segment.ground.belt = laid(segment.ground.belt);
}

inline numeric::SlipOnset onset_of(const RandomSegment& segment, const numeric::Equations& equations) {
  return numeric::SlipOnset(equations, segment.slip, segment.nu);
}

/// Where dry friction has just let go: it holds half of what drives, or a little less than all.
class RandomOnsets {
 public:
  explicit RandomOnsets(unsigned seed) : random_(seed) {}

  RandomSegments& numbers() { return random_; }

  /// @param small  times the slip or the roll beside which another starts
  RandomSegment next(Start start, bool on_a_line, double small = 1) {
    RandomSegment segment = random_.next(form_of(start));
    if (on_a_line) lay_on_a_line(segment);
    segment.slip *= small;
    segment.nu *= small;
    if (start != Start::roll_beside_slip) segment.slip.setZero();
    if (start == Start::roll_beside_slip || start == Start::both) segment.nu.setZero();
    if (start != Start::slip) {
      segment.velocity = segment.slip + segment.nu + ground_velocity(segment.ground, segment.position);
    }
    const numeric::Equations equations = segment.equations();
    const numeric::State y = segment.start(equations);
    const numeric::Instant now = equations.instant(y);
    const double kappa = segment.dynamics.kappa;
    double& friction = segment.ground.friction;
    double& resistance = segment.ground.rolling_resistance;
    if (start == Start::both) {
      friction = random_.part() * now.forcing.norm() / segment.dynamics.slip_decay(1);
      resistance = part() * (now.spin.norm() + (1 - kappa) * segment.dynamics.slip_decay(friction)) /
                   segment.dynamics.spinning_decay(1);
    } else if (start == Start::roll_beside_slip) {
      resistance = part() * equations.dry_vector(1, y, now).drive.norm() / segment.dynamics.spinning_decay(1);
    } else {
      const double drive = equations.dry_vector(0, y, now).drive.norm();
      friction *= part() * drive / equations.decay();
    }
    return segment;
  }

 private:
  static numeric::EquationForm form_of(Start start) {
    if (start == Start::slip) return numeric::EquationForm::sliding;
    return start == Start::slip_of_skid ? numeric::EquationForm::skidding
                                        : numeric::EquationForm::resisted_sliding;
  }
  double part() { return random_.one_in(2) ? 1 - 1e-3 * random_.part() : 0.5 + 0.5 * random_.part(); }

  RandomSegments random_;
};

}  // namespace hybrid_sphere::testing

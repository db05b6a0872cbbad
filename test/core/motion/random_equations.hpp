#pragma once

#include <cmath>
#include <random>

#include "motion/equations.hpp"

namespace hybrid_sphere::testing {

/// A segment of motion that is integrated, of any forces.
struct RandomSegment {
  Dynamics dynamics;
  scene::Material ground;
  numeric::EquationForm form;
  Vector2d position;
  Vector2d velocity;
  Vector2d slip;                   ///< while sliding, skidding or resisted_sliding
  Vector2d nu = Vector2d::Zero();  ///< while resisted_sliding

  numeric::Equations equations() const {
    numeric::Equations equations(form, dynamics, ground, position);
    if (form == numeric::EquationForm::sliding) {
      const Vector2d sigma = slip + ground_velocity(ground, position);
      equations.set_momentum(velocity - dynamics.kappa * sigma);
    }
    return equations;
  }
  numeric::State start(const numeric::Equations& equations) const {
    if (form == numeric::EquationForm::resisted_sliding) return equations.start(slip, nu);
    if (equations.slides()) return equations.start(slip);
    if (form == numeric::EquationForm::resisted_rolling)
      return equations.start(velocity - equations.ground(Vector2d::Zero()));
    return equations.start(velocity);
  }
};

/// Numbers over four decades, a good part of them 0.
class RandomSegments {
 public:
  explicit RandomSegments(unsigned seed) : engine_(seed) {}

  double size() { return std::pow(10.0, std::uniform_real_distribution<double>(-2, 2)(engine_)); }
  double some() { return one_in(2) ? 0 : size(); }
  bool one_in(int n) { return std::uniform_int_distribution<int>(1, n)(engine_) == 1; }
  double part() { return std::uniform_real_distribution<double>(0, 1)(engine_); }
  Vector2d vector(double length) {
    const double angle = std::uniform_real_distribution<double>(0, 2 * M_PI)(engine_);
    return length * Vector2d(std::cos(angle), std::sin(angle));
  }

  RandomSegment next(numeric::EquationForm form) {
    const double radius = size();
    const scene::SphereBody body{size(), radius, radius * std::sqrt(0.1 + 0.5 * part())};
    scene::Forces forces;
    forces.gravity.head<2>() = vector(some());
    forces.wrench.torque = {body.mass * radius * some(), 0, 0};
    forces.drag.translational = body.mass * some();
    forces.drag.rotational = body.mass * body.gyration_radius * body.gyration_radius * some();
    forces.drag.quadratic = one_in(3) ? body.mass * size() : 0;
    forces.spring = {vector(size()), body.mass * some()};
    scene::Material ground(scene::Law::coulomb);
    ground.friction = size();
    const bool resists = form == numeric::EquationForm::resisted_rolling ||
                         form == numeric::EquationForm::skidding ||
                         form == numeric::EquationForm::resisted_sliding;
    ground.rolling_resistance = resists ? 0.3 * size() : 0;
    if (one_in(2)) {
      ground.turntable_rate = (one_in(2) ? 1 : -1) * size();
      ground.turntable_center = vector(size());
    } else {
      ground.belt = vector(some());
    }
    const Vector2d position = vector(some());
    const Vector2d velocity = vector(size());
    const Vector2d slip = vector(size());
    return with_slip({Dynamics(Sphere(body), forces), ground, form, position, velocity, slip});
  }

 private:
  /// The velocity is that of what slips and turns on the ground.
  RandomSegment with_slip(RandomSegment segment) {
    const bool slides_resisted = segment.form == numeric::EquationForm::resisted_sliding;
    if (!slides_resisted && segment.form != numeric::EquationForm::skidding) return segment;
    if (slides_resisted) segment.nu = vector(size());
    segment.velocity = segment.slip + segment.nu + ground_velocity(segment.ground, segment.position);
    return segment;
  }

  std::mt19937 engine_;
};

}  // namespace hybrid_sphere::testing

// The power series with which a slip begins satisfies the equations as far as it says that it does.

#include "hybrid_sphere/solver/departure.hpp"

#include <gtest/gtest.h>

#include <cfloat>

#include "core/solver/random_equations.hpp"
#include "hybrid_sphere/simulation/simulation.hpp"

namespace hybrid_sphere::testing {
namespace {

using solver::Equations;
using solver::Regime;
using solver::State;

/// Rolling that has just lost its grip, by half of what the friction holds or by less.
RandomStretch slipping(RandomStretches& random, bool on_a_line) {
  RandomStretch stretch = random.next(Regime::sliding);
  if (on_a_line) {
    const auto laid = [](const Vector2d& v) { return Vector2d(v.x() < 0 ? -v.norm() : v.norm(), 0); };
    stretch.velocity = laid(stretch.velocity);
    stretch.dynamics.free = laid(stretch.dynamics.free);
    stretch.dynamics.spin = laid(stretch.dynamics.spin);
    stretch.dynamics.spring_center = stretch.position + laid(stretch.dynamics.spring_center);
    stretch.ground.turntable_rate = 0;
    stretch.ground.belt = laid(stretch.ground.belt);
  }
  stretch.slip.setZero();
  const Equations equations = stretch.equations();
  const double forcing = equations.instant(equations.start(Vector2d::Zero())).forcing.norm();
  const double part = random.one_in(2) ? 1 - 1e-3 * random.part() : 0.5 + 0.5 * random.part();
  stretch.ground.friction = part * forcing / stretch.dynamics.slip_decay(1);
  return stretch;
}

TEST(ADeparture, SatisfiesTheEquationsUpToItsEnd) {
  constexpr double step = 1e-4;  // of the difference quotient, in tau: squared, times third derivatives
  constexpr double error = 1e-5;
  RandomStretches random(11);
  int departures = 0;
  for (int n = 0; n < 2000; ++n) {
    SCOPED_TRACE(n);
    const Equations equations = slipping(random, n % 2 == 0).equations();
    const solver::Departure departure(equations);
    if (departure.end() == 0) continue;
    ++departures;
    for (const double part : {0.1, 0.4, 0.7, 0.99}) {
      const double tau = part * departure.end();
      const State quotient =
          (departure.at((1 + step) * tau) - departure.at((1 - step) * tau)) / (2 * step * tau);
      const State y = departure.at(tau);
      const State rate = equations.derivative(y) / equations.pace(y);
      const double rounding = 4 * DBL_EPSILON * y.segment<2>(4).matrix().norm() / (step * tau);
      const double size = equations.instant(y).forcing.norm() + equations.decay();
      ASSERT_LE((quotient - rate).head<2>().matrix().norm(), error * size) << part;
      ASSERT_LE((quotient - rate).segment<2>(4).matrix().norm(), error * size + rounding) << part;
    }
  }
  EXPECT_GT(departures, 1000);
}

TEST(ADeparture, IsNoneWhereFrictionHolds) {
  RandomStretches random(12);
  for (int n = 0; n < 1000; ++n) {
    auto stretch = slipping(random, n % 2 == 0);
    const Equations equations = stretch.equations();
    const double forcing = equations.instant(equations.start(Vector2d::Zero())).forcing.norm();
    stretch.ground.friction = (1 + 1e-5 + random.part()) * forcing / stretch.dynamics.slip_decay(1);
    const Equations held = stretch.equations();
    EXPECT_EQ(solver::Departure(held).end(), 0) << n;
  }
}

// Quadratic drag goes with abs(v), whose series ends where v has doubled: on ground that hardly moves, at
// once.
TEST(ADeparture, BesideQuadraticDragDoesNotHangOnGroundThatHardlyMoves) {
  for (const scene::Law law : {scene::Law::coulomb, scene::Law::rough}) {
    const auto end_on_belt = [&](double speed) {
      scene::Scene scene{};
      scene.sphere = {1, 1, 0.5};
      scene.surface.base = law;
      scene.surface.base.friction = law == scene::Law::coulomb ? 0.01 : 0;
      scene.surface.base.rolling_resistance = law == scene::Law::rough ? 0.002 : 0;
      scene.surface.base.belt = {0, speed};
      scene.initial_state.velocity = {0, speed};
      scene.forces.gravity = {0, 0, -1};
      scene.forces.wrench.force = {0, 0.4};
      scene.forces.drag.quadratic = 1;
      Simulation simulation(scene);
      EXPECT_NO_THROW(simulation.advance_to(1, {})) << speed;
      EXPECT_EQ(simulation.time(), 1) << speed;
      return simulation.state().position.y();
    };
    const double at_rest = end_on_belt(0);
    EXPECT_GT(at_rest, 0.1);
    for (const double speed : {1e-40, 1e-30, 1e-20, 1e-16, 1e-14, 1e-12, 1e-9}) {
      EXPECT_NEAR(end_on_belt(speed), at_rest, speed + 1e-9) << speed;
    }
  }
}

}  // namespace
}  // namespace hybrid_sphere::testing

#include "motion/step_path.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "motion/trajectory.hpp"

namespace hybrid_sphere::testing::step_path_test {
namespace {

using numeric::EquationForm;
using numeric::Equations;
using numeric::State;

const Sphere sphere({1, 0.5, 0.25});

Equations slide(bool dry) {
  scene::Forces forces;
  forces.gravity = {0.5, -1, -8};
  forces.drag.translational = 0.25;
  scene::Material ground(dry ? scene::Law::coulomb : scene::Law::smooth);
  if (dry) ground.friction = 0.125;
  Equations equations(dry ? EquationForm::sliding : EquationForm::free, Dynamics(sphere, forces), ground,
                      Vector2d::Zero());
  equations.set_momentum({1, 2});
  return equations;
}

// The derivative of the place by the time, and the bound on the second one, against differences of places.
void check(const Equations& equations, scene::Solver::Method method, double step) {
  numeric::Trajectory trajectory({method, 1e-3, step});
  trajectory.begin(equations, equations.start({3, -1}));
  for (int i = 0; i < 24; ++i) trajectory.extend();
  const double until = numeric::time_of(trajectory.last());
  constexpr int parts = 4096;
  const double h = until / parts;
  const auto place = [&](double time) { return numeric::displacement(trajectory.at(time)); };
  // Differences err by h^2/6 of the third derivative or, where steps meet, by h times the second one.
  const double most = trajectory.path_bend(0, until);
  for (int i = 1; i + 1 < parts; ++i) {
    const double time = i * h;
    const Vector2d before = place(time - h);
    const Vector2d after = place(time + h);
    Vector2d velocity = equations.instant(trajectory.at(time)).velocity;  // so it is at a node
    const Vector2d here = numeric::displacement(trajectory.at(time, &velocity));
    EXPECT_LE(((after - before) / (2 * h) - velocity).norm(), most * h) << time;
    const double rounding = 0x1p-48 * here.norm() / (h * h);
    EXPECT_LE((after + before - 2 * here).norm() / (h * h),
              trajectory.path_bend(time - h, time + h) + rounding)
        << time;
  }
}

TEST(StepPath, HasTheVelocityAndTheBendOfThePlaces) {
  using Method = scene::Solver::Method;
  for (const Method method : {Method::euler, Method::lie_midpoint, Method::rk4}) {
    for (const double step : {0.03125, 0.25}) {
      check(slide(false), method, step);
      check(slide(true), method, step);
    }
  }
}

// By Euler's method under a constant acceleration: from -2 a to 4 a, as the cubic of h v, v and v + h a says.
TEST(StepPath, OfEulersMethodBendsFourTimesAsMuchAsTheForces) {
  scene::Forces forces;
  forces.gravity = {0.5, -1, -8};
  const Equations equations(EquationForm::free, Dynamics(sphere, forces), scene::Law::smooth,
                            Vector2d::Zero());
  numeric::Trajectory trajectory({scene::Solver::Method::euler, 1e-3, 0.5});
  trajectory.begin(equations, equations.start({3, -1}));
  for (int i = 0; i < 5; ++i) trajectory.extend();
  const double a = std::hypot(0.5, 1);
  for (double time = 0; time < 2.5; time += 0.25) {
    EXPECT_NEAR(trajectory.path_bend(time, time), 4 * a, 1e-13) << time;
  }
}

// However many steps have been let go.
TEST(StepPath, OfManyStepsBendsAsTheOneThatBendsMost) {
  const Equations equations = slide(false);
  numeric::Trajectory trajectory({scene::Solver::Method::euler, 1e-3, 0.125});
  trajectory.begin(equations, equations.start({3, -1}));
  for (int i = 0; i < 100; ++i) trajectory.extend();
  for (const int first : {0, 1, 7, 40, 64}) {
    trajectory.forget_before(first * 0.125);
    for (int i = 0; i < 37; ++i) trajectory.extend();
    for (std::size_t from = 0; from + 1 < trajectory.size(); ++from) {
      double most = 0;
      for (std::size_t until = from; until + 1 < trajectory.size(); ++until) {
        most = std::max(most, trajectory.node(until + 1).bend);
        const double start = numeric::time_of(trajectory.node(from).y);
        ASSERT_EQ(trajectory.path_bend(start, numeric::time_of(trajectory.node(until).y)), most);
      }
    }
  }
}

TEST(StepPath, IsThatOfTheStatesByAdaptiveMethods) {
  const Equations equations = slide(false);
  numeric::Trajectory trajectory({scene::Solver::Method::dopri5, 1e-3, 0.125});
  trajectory.begin(equations, equations.start({3, -1}));
  trajectory.extend();
  Vector2d velocity = Vector2d::Constant(never);
  trajectory.at(0.5 * numeric::time_of(trajectory.last()), &velocity);
  EXPECT_FALSE(velocity.allFinite());
  EXPECT_EQ(trajectory.path_bend(0, numeric::time_of(trajectory.last())), 0);
}

}  // namespace
}  // namespace hybrid_sphere::testing::step_path_test

// Between the nodes a trajectory follows the equations as well as at them.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/motion/random_steps.hpp"
#include "hybrid_sphere/simulation/simulation.hpp"

namespace hybrid_sphere::testing::dense_output_test {
namespace {

using integration::error_of_better;
using numeric::EquationForm;
using numeric::Equations;
using numeric::Instant;
using numeric::State;
using Method = scene::Solver::Method;

constexpr Method methods[] = {Method::dopri5,      Method::dopri87,     Method::arkode_erk,
                              Method::arkode_erk5, Method::cvode_adams, Method::cvode_bdf};

/// By Runge and Kutta's method.
State small_step(const Equations& equations, const State& y, double h) {
  const State a = equations.derivative(y);
  const State b = equations.derivative(y + 0.5 * h * a);
  const State c = equations.derivative(y + 0.5 * h * b);
  const State d = equations.derivative(y + h * c);
  return y + h / 6 * (a + 2 * b + 2 * c + d);
}

/// The largest speed that the state stands for, but for that of the ground.
double speed_of(const Equations& equations, const State& y) {
  const Instant now = equations.instant(y);
  const double w = equations.is_dry() ? y.head<2>().matrix().norm() : 0;
  return std::max({now.velocity.norm(), now.nu.norm(), w});
}

/// Errors of a trajectory within a step that begins without error, over the largest speed in it.
struct StepErrors {
  double between = 0;  // the nodes
  double at_end = 0;

  void include(const StepErrors& other) {
    between = std::max(between, other.between);
    at_end = std::max(at_end, other.at_end);
  }
};

/// Places and times count as what they make of a velocity in all the time since the beginning.
double difference(const Equations& equations, const State& a, const State& b, double speed) {
  const Instant at_a = equations.instant(a);
  const Instant at_b = equations.instant(b);
  const double time = numeric::time_of(b);
  return std::max({(at_a.velocity - at_b.velocity).norm(), (at_a.nu - at_b.nu).norm(),
                   (a - b).head<2>().matrix().norm(), (a - b).segment<2>(2).matrix().norm() / time,
                   std::abs(numeric::time_of(a) - time) / time * speed});
}

StepErrors errors(const Equations& equations, numeric::Trajectory& trajectory, std::size_t i) {
  constexpr int places = 16;
  constexpr int parts = 8;  // between two of them: what is compared with is wrong by (step/128)^4
  StepErrors errors;
  const double step = trajectory.node(i).step;
  State y = trajectory.node(i).y;
  double speed = speed_of(equations, y);
  for (int k = 1; k <= places; ++k) {
    for (int j = 0; j < parts; ++j) y = small_step(equations, y, step / (places * parts));
    speed = std::max(speed, speed_of(equations, y));
    const bool ends = k == places;
    const State found = ends ? trajectory.node(i + 1).y : trajectory.after(i, step * k / places);
    const double error = difference(equations, found, y, speed) / speed;
    double& largest = ends ? errors.at_end : errors.between;
    largest = std::max(largest, error);
  }
  return errors;
}

/// The largest ones of random segments.
StepErrors errors(Method method, EquationForm form, double accuracy) {
  RandomSegments random(5);
  StepErrors errors;
  for (int n = 0; n < 30; ++n) {
    const RandomSegment segment = random.next(form);
    const Equations equations = segment.equations();
    numeric::Trajectory trajectory({method, accuracy});
    trajectory.begin(equations, segment.start(equations));
    try {
      for (int i = 0; i < 12; ++i) trajectory.extend();
    } catch (const std::runtime_error&) {
      continue;  // it dies
    }
    for (std::size_t i = 0; i + 1 < trajectory.size(); ++i) {
      errors.include(dense_output_test::errors(equations, trajectory, i));
    }
  }
  return errors;
}

// Step by step, against many small steps from the node before. The polynomials are of the order of the
// method's error, with coefficients of about the same size: measured are up to 2.2 times the error at the
// ends of steps, and up to 0.02 of the accuracy.
TEST(DenseOutput, IsAsGoodBetweenTheNodesAsAtThem) {
  constexpr double accuracy = 1e-6;
  for (const Method method : methods) {
    double largest = 0;
    for (const EquationForm form : forms) {
      SCOPED_TRACE(::testing::Message() << scene::to_string(method) << " " << static_cast<int>(form));
      const StepErrors found = errors(method, form, accuracy);
      EXPECT_LE(found.between, 3 * found.at_end);
      EXPECT_LE(found.between, 0.05 * accuracy);
      largest = std::max(largest, found.between);
    }
    EXPECT_GT(largest, 1e-3 * accuracy) << "what is far off everywhere tests nothing";
  }
}

// In whole motions: against one of far higher accuracy.
TEST(DenseOutput, IsAsGoodBetweenTheNodesAsTheAccuracySays) {
  for (const Method method : methods) {
    for (const EquationForm form : forms) {
      RandomSegments random(5);
      for (int n = 0; n < 12; ++n) {
        const RandomSegment segment = random.next(form);
        constexpr double accuracy = 1e-6;
        NumericMotion motion(segment.dynamics, {method, accuracy});
        NumericMotion reference(segment.dynamics, {Method::dopri87, 1e-13});
        begin(motion, segment);
        begin(reference, segment);
        SCOPED_TRACE(::testing::Message() << scene::to_string(method) << " " << n);
        const double horizon =
            std::min(0.9 * std::min(motion.end_before(0.5), reference.end_before(0.5)), 0.5);
        double speed = 0;
        double way = 0;
        for (int k = 1; k <= samples; ++k) {
          const double t = horizon * k / samples;
          const PointState a = motion.center(t);
          const PointState b = reference.center(t);
          speed = std::max(speed, b.velocity.norm() + segment.slip.norm());
          way = std::max(way, (b.position - segment.position).norm() + speed * t);
          ASSERT_LE((a.velocity - b.velocity).norm(), 2 * accuracy * speed) << t;
          ASSERT_LE((a.position - b.position).norm(), 2 * accuracy * way) << t;
        }
      }
    }
  }
}

// Steps of seconds, in which the slopes of the equation are a billion times the rounding of the velocities.
TEST(DenseOutput, IsAsGoodBetweenTheNodesWhereADragHoldsTheSphere) {
  scene::Scene scene{};
  scene.sphere = {1, 1, 0.3125};
  scene.surface.base = scene::Material(scene::Law::rough);
  scene.surface.base.rolling_resistance = 0.1875;
  scene.surface.base.turntable_center = {6, 7};
  scene.surface.base.turntable_rate = -1.25;
  scene.forces.gravity = {0, 0, -8};
  scene.forces.drag = {1e9, 0.015625, 1.75};
  scene.forces.spring = {{9, -0.5}, 3.25};
  const double speed = 1.25 * std::hypot(6, 7);  // of the ground
  for (const Method method : {Method::automatic, Method::cvode_bdf}) {
    scene.solver.method = method;
    Simulation simulation(scene);
    simulation.advance_to(2, {});
    const Vector2d held = simulation.state().twist.velocity;
    EXPECT_LT(held.norm(), 1e-7);
    for (double time = 2; time < 8; time += 0.04) {
      simulation.advance_to(time, {});
      const Vector2d change = simulation.state().twist.velocity - held;
      ASSERT_LE(change.norm(), scene.solver.accuracy * speed) << scene::to_string(method) << " " << time;
    }
  }
}

TEST(ErrorOfBetter, IsThatOfOneOrderMoreAndNeverMoreThanTheDifference) {
  EXPECT_NEAR(error_of_better(1e-8, 4), 1e-10, 1e-24);
  EXPECT_NEAR(error_of_better(1e-6, 2), 1e-9, 1e-23);
  EXPECT_EQ(error_of_better(1, 4), 1);
  EXPECT_EQ(error_of_better(3, 4), 3);
}

}  // namespace
}  // namespace hybrid_sphere::testing::dense_output_test

// Methods of fixed step against closed forms: their errors fall with the power of the step that is their
// order, in the orientation as well.

#include <gtest/gtest.h>

#include <cmath>

#include "hybrid_sphere/simulation/simulation.hpp"

namespace hybrid_sphere::method_order_test {
namespace {

using Method = scene::Solver::Method;

struct Errors {
  double place = 0;
  double velocity = 0;
  double orientation = 0;
};

scene::Scene base_scene() {
  scene::Scene scene{};
  scene.sphere = {2, 0.25, 0.15};
  scene.initial_state.position = {0.4, -0.3};
  scene.initial_state.velocity = {1, 0.5};
  scene.initial_state.angular_velocity = {2, -3, 1.5};
  return scene;
}

/// Rolling on a turntable that is tilted: the velocity turns.
scene::Scene turntable_with_force() {
  scene::Scene scene = base_scene();
  scene.surface.base.law = scene::Law::rough;
  scene.surface.base.turntable_rate = 2;
  scene.forces.gravity = {0.5, -0.25, -9.81};
  return scene;
}

/// Sliding up an incline, slower and slower, with a velocity that turns.
scene::Scene sliding_on_an_incline() {
  scene::Scene scene = base_scene();
  scene.surface.base.law = scene::Law::coulomb;
  scene.surface.base.friction = 0.05;
  scene.forces.gravity = {-1, 0.5, -9.81};
  return scene;
}

/// Through the air with drag and a spring.
scene::Scene free_with_drag() {
  scene::Scene scene = base_scene();
  scene.forces.drag.translational = 0.8;
  scene.forces.drag.rotational = 0.02;
  scene.forces.spring.stiffness = 6;
  return scene;
}

Errors errors(scene::Scene scene, Method method, double step) {
  constexpr double time = 1;
  const auto ignore = [](const Switch&) {};
  Simulation exact(scene);
  exact.advance_to(time, ignore);
  const State expected = exact.state();
  scene.solver.method = method;
  scene.solver.step = step;
  Simulation simulation(scene);
  simulation.advance_to(time, ignore);
  const State& found = simulation.state();
  return {(found.position - expected.position).norm(),
          (found.twist.velocity - expected.twist.velocity).norm(),
          (found.orientation.coeffs() * (found.orientation.dot(expected.orientation) < 0 ? -1 : 1) -
           expected.orientation.coeffs())
              .norm()};
}

struct Order {
  Method method;
  double order;
};

class FixedStep : public ::testing::TestWithParam<Order> {};

// From one step to half of it; the next term of the error is a part of the first like the step of the time in
// which the motion changes, here about a tenth of an order.
TEST_P(FixedStep, HasItsOrder) {
  constexpr double slack = 0.3;
  const auto [method, order] = GetParam();
  for (const scene::Scene& scene : {turntable_with_force(), sliding_on_an_incline(), free_with_drag()}) {
    const Errors coarse = errors(scene, method, 1. / 64);
    const Errors fine = errors(scene, method, 1. / 128);
    EXPECT_GE(std::log2(coarse.place / fine.place), order - slack);
    EXPECT_GE(std::log2(coarse.velocity / fine.velocity), order - slack);
    EXPECT_GE(std::log2(coarse.orientation / fine.orientation), order - slack);
    EXPECT_GT(fine.orientation, 0);
  }
}

// The steps do not depend on what is asked for.
TEST_P(FixedStep, IsTheSameHoweverOftenItIsLookedAt) {
  scene::Scene scene = turntable_with_force();
  scene.solver.method = GetParam().method;
  scene.solver.step = 0.01;
  const auto ignore = [](const Switch&) {};
  Simulation once(scene);
  once.advance_to(1, ignore);
  const State expected = once.state();
  Simulation often(scene);
  for (int i = 1; i <= 1000; ++i) {
    often.advance_to(i / 1000.0, ignore);
    often.state();
  }
  EXPECT_EQ(often.state().position, expected.position);
  EXPECT_EQ(often.state().orientation.coeffs(), expected.orientation.coeffs());
}

INSTANTIATE_TEST_SUITE_P(Methods, FixedStep,
                         ::testing::Values(Order{Method::euler, 1}, Order{Method::lie_midpoint, 2},
                                           Order{Method::rk4, 4}, Order{Method::rkmk4, 4}),
                         [](const auto& info) { return std::string(to_string(info.param.method)); });

// The exponential map keeps the orientation on the group; what is left is the rounding of unit quaternions.
TEST(FixedStepOrientation, OfConstantSpinIsExactByTheMethodsOfTheGroup) {
  scene::Scene scene = base_scene();
  for (const Method method : {Method::lie_midpoint, Method::rkmk4}) {
    EXPECT_LE(errors(scene, method, 0.1).orientation, 1e-14) << to_string(method);
  }
  for (const Method method : {Method::euler, Method::rk4}) {
    EXPECT_GT(errors(scene, method, 0.1).orientation, 1e-9) << to_string(method);
  }
}

// Rolling down a slope, until it turns too far in a step.
TEST(FixedStep, HaltsAtTheSameTimeHoweverOftenItIsLookedAt) {
  scene::Scene scene = base_scene();
  scene.forces.gravity = {4, 0, -9};
  scene.surface.base.law = scene::Law::rough;
  scene.solver = {Method::euler, 1e-9, 0.1};
  const auto halt = [&scene](double rate) {
    Simulation simulation(scene);
    EXPECT_THROW(
        for (int i = 1; i <= 100 * rate; ++i) {
          simulation.advance_to(i / rate, {});
          simulation.state();
        },
        HaltedError);
    return std::pair(simulation.time(), Vector2d(simulation.state().position));
  };
  const auto [time, position] = halt(0.01);
  EXPECT_GT(time, 1);
  EXPECT_EQ(halt(7).first, time);
  EXPECT_EQ(halt(7).second, position);
}

// What is lost in the first steps is as large as the motion then, and nothing of it later.
TEST(FixedStep, FollowsAMotionFromRest) {
  scene::Scene scene = base_scene();
  scene.initial_state.velocity.setZero();
  scene.initial_state.angular_velocity.setZero();
  scene.forces.gravity = {-2, 0.25, -8};
  scene.solver.step = 0x1p-10;
  for (const Method method : {Method::euler, Method::lie_midpoint, Method::rk4, Method::rkmk4}) {
    scene.solver.method = method;
    Simulation simulation(scene);
    simulation.advance_to(0.25, {});
    const Vector2d way = simulation.state().position - scene.initial_state.position;
    const Vector2d velocity = simulation.state().twist.velocity;
    // Of the way a t^2/2 Euler's rule loses a t h/2.
    EXPECT_LE((way - 0.125 * velocity).norm(), 0x1p-11 * velocity.norm() * (1 + 1e-9)) << to_string(method);
  }
}

TEST(FixedStep, ThatTurnsTheSphereTooFarHaltsInsteadOfDelivering) {
  scene::Scene scene = base_scene();
  scene.initial_state.angular_velocity = {20, -30, 15};
  scene.solver.step = 1;
  for (const Method method : {Method::euler, Method::rk4}) {
    scene.solver.method = method;
    Simulation simulation(scene);
    EXPECT_THROW(simulation.advance_to(10, [](const Switch&) {}), HaltedError) << to_string(method);
    EXPECT_TRUE(simulation.state().orientation.coeffs().allFinite());
  }
}

TEST(FixedStep, ThatIsTooLongForStiffDragHaltsInsteadOfDelivering) {
  scene::Scene scene = free_with_drag();
  // The product of step and rate: beyond 2 (Euler) and 2.8 (order 4) the numbers grow, slowly or quickly.
  for (const auto& [method, product] : {std::pair{Method::euler, 2.1},
                                        {Method::euler, 1e7},
                                        {Method::lie_midpoint, 2.1},
                                        {Method::lie_midpoint, 1e4},
                                        {Method::rk4, 2.9},
                                        {Method::rk4, 1e7},
                                        {Method::rkmk4, 30.0}}) {
    scene.solver.step = 0.01;
    scene.forces.drag.translational = product / scene.solver.step * scene.sphere.mass;
    scene.solver.method = method;
    Simulation simulation(scene);
    try {
      simulation.advance_to(1000, [](const Switch&) {});
      ADD_FAILURE() << to_string(method) << " delivers " << simulation.state().position.transpose();
    } catch (const std::runtime_error& error) {
      EXPECT_NE(std::string(error.what()).find("the fixed step is too long"), std::string::npos)
          << error.what();
    }
  }
}

}  // namespace
}  // namespace hybrid_sphere::method_order_test

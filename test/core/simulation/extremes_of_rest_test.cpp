// What dies out and what stands: oscillations that vanish in one direction, speeds next to nothing.

#include <gtest/gtest.h>

#include <cfloat>
#include <cmath>

#include "hybrid_sphere/simulation/simulation.hpp"
#include "sphere/constants.hpp"

namespace hybrid_sphere::testing::extremes_of_rest_test {
namespace {

/// The sphere of Mei's example on a spring, rough ground on one side of an edge through the spring's centre.
scene::Scene oscillation() {
  scene::Scene scene{};
  scene.sphere = {2, 0.25, 0.25 * std::sqrt(0.4)};
  scene.surface.regions = {{"half", scene::HalfPlane{{0, 0}, {1, 0}}, scene::Law::rough}};
  scene.initial_state = {{-1, 0.5}, Quaterniond::Identity(), {2, -0.75}, {4, 5, -2}};
  scene.forces.spring.stiffness = 1;
  return scene;
}

// Across the edge the oscillation dies out by 3/7 at each return, to 1e-303 m in the end; along it not. The
// time of a return does not depend on that. Exact values: half periods and complete impulses in 60 digits.
TEST(ExtremesOfRest, AnOscillationThatDiesOutAcrossAnEdgeKeepsItsTimeFromThatAlongIt) {
  struct Exact {
    double time;
    double y;
    std::uint64_t switches;
  };
  constexpr Exact cases[] = {{300, 0.0795492994289049668, 62},   {420, 0.0140022296955513367, 87},
                             {460, -0.0664061320091232342, 95},  {1000, 0.113749093536271743, 207},
                             {3000, 0.0237043742268327825, 619}, {8000, -0.0463640314795265373, 1650}};
  Simulation simulation(oscillation());
  const auto ignore = [](const Switch&) {};
  for (const Exact& exact : cases) {
    simulation.advance_to(exact.time, ignore);
    // The speed along the edge is below 1 m/s. The rounding of kappa and of the frequency moves the phase,
    // and that of each switch the amplitude and the time.
    const double bound = 4 * DBL_EPSILON * (exact.time + static_cast<double>(exact.switches));
    EXPECT_NEAR(simulation.state().position.y(), exact.y, bound) << exact.time;
    EXPECT_EQ(simulation.switches(), exact.switches) << exact.time;
  }
}

/// The same with its edge turned and moved, the spring's centre on it.
scene::Scene moved_oscillation(double angle, const Vector2d& center) {
  scene::Scene scene = oscillation();
  const Eigen::Rotation2Dd turn(angle);
  scene.surface.regions[0].shape = scene::HalfPlane{center, turn * Vector2d(1, 0)};
  scene.initial_state.position = center + turn * scene.initial_state.position;
  scene.initial_state.velocity = turn * scene.initial_state.velocity;
  scene.initial_state.angular_velocity.head<2>() = turn * Vector2d(4, 5);
  scene.forces.spring.center = center;
  return scene;
}

double halted_at(Simulation& simulation, double until) {
  try {
    simulation.advance_to(until, [](const Switch&) {});
  } catch (const HaltedError& error) {
    EXPECT_NE(std::string(error.what()).find("rounding hides when"), std::string::npos) << error.what();
    EXPECT_EQ(error.time(), simulation.state().time);
    return error.time();
  }
  return never;
}

// The place has an ulp of 1e-16 m there. The oscillation across is below that at 400 s: a switch's time is
// any then.
TEST(ExtremesOfRest, AnOscillationThatDiesOutAcrossAnEdgeHaltsWhereRoundingDoesNotTellWhenItReturns) {
  struct Case {
    double angle;
    Vector2d center;
  };
  for (const Case& c : {Case{0.5, {0, 0}}, Case{0, {1, 0}}, Case{2, {-3, 5}}}) {
    Simulation simulation(moved_oscillation(c.angle, c.center));
    const double halt = halted_at(simulation, 1000);
    EXPECT_GT(halt, 200) << c.angle;
    EXPECT_LT(halt, 420) << c.angle;
  }
}

TEST(ExtremesOfRest, AnOscillationThatDiesOutAcrossAnEdgeHaltsWhereItsSpeedUnderflows) {
  Simulation simulation(oscillation());
  const double halt = halted_at(simulation, 1e4);
  EXPECT_GT(halt, 8000);
  EXPECT_LT(halt, 9000);
}

// Where its switches cannot be told apart it is as good as at rest.
TEST(ExtremesOfRest, AnOscillationThatDiesOutAltogetherComesToRestOnTheEdge) {
  for (const double angle : {0.0, 0.5, 2.0}) {
    scene::Scene scene = moved_oscillation(angle, {1, 0});
    scene.forces.drag.translational = 2;
    Simulation simulation(scene);
    ASSERT_NO_THROW(simulation.advance_to(1e4, [](const Switch&) {})) << angle;
    EXPECT_LE((simulation.state().position - Vector2d(1, 0)).norm(), 4 * DBL_EPSILON) << angle;
  }
}

scene::Scene rolling_east() {
  scene::Scene scene{};
  scene.sphere = {1, 0.25, 0.1};
  scene.initial_state.velocity = {1, 0};
  return scene;
}

const Simulation::SwitchSink ignore = [](const Switch&) {};

// x = ln(1 + q v/c)/q in the end, q = 1/m and c = drag/m.
TEST(ExtremesOfRest, ASphereThatBothDragsHaveStoppedStaysWhereItIs) {
  for (const double drag : {264.0, 1e4, 1e6}) {
    scene::Scene scene = rolling_east();
    scene.forces.drag = {drag, 0, 1};
    Simulation simulation(scene);
    for (const double time : {10.0, 400.0, 1e15}) {
      ASSERT_NO_THROW(simulation.advance_to(time, ignore)) << drag;
      EXPECT_NEAR(simulation.state().position.x(), std::log1p(1 / drag), 1e-9 / drag) << drag;
    }
    EXPECT_LE(simulation.state().twist.velocity.norm(), 1e-90) << drag;
  }
}

TEST(ExtremesOfRest, ASphereThatASpringAndBothDragsBringToRestStaysAtTheSpringsCentre) {
  for (const double start : {0.0, -3.0}) {
    scene::Scene scene = rolling_east();
    scene.initial_state.position.x() = start;
    scene.forces.drag = {10, 0, 1};
    scene.forces.spring.stiffness = 1;
    Simulation simulation(scene);
    ASSERT_NO_THROW(simulation.advance_to(1e15, ignore));
    EXPECT_NEAR(simulation.state().position.x(), 0, scene.solver.accuracy);
    EXPECT_EQ(simulation.state().twist.velocity, Vector2d(0, 0));
  }
}

TEST(ExtremesOfRest, ADenormalQuadraticDragIsNone) {
  scene::Scene scene = rolling_east();
  scene.forces.drag.quadratic = 1e-310;
  Simulation simulation(scene);
  ASSERT_NO_THROW(simulation.advance_to(1, ignore));
  EXPECT_NEAR(simulation.state().position.x(), 1, 4 * DBL_EPSILON);  // a few roundings
}

// What the first motion does before it has grown beyond 1e-100 of its size is below the last figure later.
TEST(ExtremesOfRest, AResistedRollFromATinySpeedIsThatFromRest) {
  const auto place = [](double speed) {
    scene::Scene scene = rolling_east();
    scene.initial_state = {{-1, 0.5}, Quaterniond::Identity(), {speed, 0}, {0, 0, 0}};
    scene.surface.base.law = scene::Law::rough;
    scene.surface.base.rolling_resistance = 0.01;
    scene.forces.spring.stiffness = 1;
    Simulation simulation(scene);
    simulation.advance_to(1, ignore);
    EXPECT_LE(simulation.evaluations(), 100000U) << speed;
    return simulation.state().position;
  };
  const Vector2d from_rest = place(0);
  for (const double speed : {1e-50, 1e-130, 1e-160, 1e-300, 1e-310}) {
    Vector2d found = Vector2d::Zero();
    ASSERT_NO_THROW(found = place(speed)) << speed;
    EXPECT_LE((found - from_rest).norm(), 1e-9) << speed;  // the accuracy of each
  }
}

TEST(ExtremesOfRest, ASlideAtATinySpeedIsOneAtAnySpeed) {
  for (const double speed : {1e-50, 1e-100, 1e-160, 1e-250, 1e-300}) {
    scene::Scene scene = rolling_east();
    scene.initial_state.velocity = {speed, 0};
    scene.surface.base.law = scene::Law::coulomb;
    scene.surface.base.friction = 0.2;
    scene.forces.drag.translational = 1;
    Simulation simulation(scene);
    ASSERT_NO_THROW(simulation.advance_to(1, ignore)) << speed;
    // Without slip p_c = v/(1 + (k/R)^2) is left, which drag slows down at the rate (1 - kappa) c/m.
    const double kappa = simulation.sphere().kappa();
    const double expected = (1 - kappa) * speed * std::exp(-(1 - kappa));
    EXPECT_NEAR(simulation.state().twist.velocity.x() / expected, 1, 1e-9) << speed;
  }
}

// A margin of grip of five percent, in a roll that has become steady.
TEST(ExtremesOfRest, ASteadyRollAgainstAResistanceIsNotLookedAtWithoutEnd) {
  scene::Scene scene = rolling_east();
  scene.initial_state.velocity = {1, 1};
  scene.forces.drag.quadratic = 70;
  scene::Material& ground = scene.surface.base;
  ground.law = scene::Law::coulomb;
  ground.friction = 9.9;
  ground.rolling_resistance = 9.45;
  ground.belt = {-2.7, 0};
  Simulation simulation(scene);
  simulation.advance_to(0.2, ignore);
  EXPECT_LT(simulation.evaluations(), 100000U);
}

TEST(ExtremesOfRest, WhatHasStoppedInEveryWayRests) {
  scene::Scene scene{};
  scene.sphere = {1, 0.5, 0.25};
  scene.surface.base = scene::Law::rough;
  scene.surface.base.spin_friction = 0.0625;
  scene.surface.base.rolling_resistance = 0.0625;
  scene.initial_state.velocity = {0.5, 0};
  scene.initial_state.angular_velocity = {0, 1, 1};
  Simulation simulation(scene);
  simulation.advance_to(0.125, {});
  EXPECT_EQ(simulation.state().mode, Mode::rolling);
  simulation.advance_to(10, {});
  EXPECT_TRUE(simulation.state().twist.angular_velocity.isZero(0));
  EXPECT_EQ(simulation.state().mode, Mode::resting);
  scene.forces.wrench.torque.z() = 1;  // turns it at once
  Simulation turned(scene);
  turned.advance_to(10, {});
  EXPECT_EQ(turned.state().mode, Mode::rolling);
}

}  // namespace
}  // namespace hybrid_sphere::testing::extremes_of_rest_test

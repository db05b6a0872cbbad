// Friction and rolling resistance as one dissipation: there is a motion from every state, it is the limit of
// smooth friction, it is the same in all units, and ground at rest gives no energy.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <sstream>
#include <string>

#include "hybrid_sphere/simulation/simulation.hpp"
#include "scene/read_tree.hpp"
#include "scene/yaml.hpp"
#include "sphere/dynamics.hpp"
#include "support/case_count.hpp"
#include "support/print_scene.hpp"
#include "support/recorded.hpp"

namespace hybrid_sphere::testing::dissipation_test {
namespace {

using scene::Law;

scene::Scene read(const std::string& name) {
  return scene::read_scene(scene::tree_from_yaml_file(std::string(TEST_DATA_DIR) + "/dissipation/" + name));
}

class Random {
 public:
  explicit Random(unsigned seed) : generator_(seed) {}
  int integer(int low, int high) { return std::uniform_int_distribution<int>(low, high)(generator_); }
  bool chance(int n) { return integer(1, n) == 1; }
  Vector2d vector(double size) { return Vector2d(integer(-8, 8), integer(-8, 8)) * (size / 8); }

 private:
  std::mt19937 generator_;
};

std::string described(const scene::Scene& scene) {
  std::ostringstream text;
  text << scene;
  return text.str();
}

/// Any state on coulomb ground with a rolling resistance of any size.
scene::Scene random_state(Random& random) {
  constexpr double frictions[] = {0, 0.05, 0.1, 0.2, 0.3, 0.5};
  constexpr double resistances[] = {0.01, 0.06, 0.11, 0.3, 0.6, 1};
  scene::Scene scene{};
  scene.sphere = {random.integer(1, 4) / 2.0, random.integer(1, 4) / 4.0, 0};
  scene.sphere.gyration_radius = scene.sphere.radius * random.integer(3, 12) / 16;
  scene.initial_state.position = random.vector(1);
  if (!random.chance(3)) scene.initial_state.velocity = random.vector(2);
  if (!random.chance(3)) {
    scene.initial_state.angular_velocity.head<2>() = random.vector(2 / scene.sphere.radius);
  }
  scene::Material& ground = scene.surface.base;
  ground.law = Law::coulomb;
  ground.friction = frictions[random.integer(0, 5)];
  ground.rolling_resistance = resistances[random.integer(0, 5)];
  scene.forces.gravity = {0, 0, -8};
  return scene;
}

/// The same with some of slope, belt, turntable, wrench, drag and spring.
scene::Scene random_forced(Random& random) {
  scene::Scene scene = random_state(random);
  scene::Material& ground = scene.surface.base;
  const double inertia = scene.sphere.mass * std::pow(scene.sphere.gyration_radius, 2);
  if (random.chance(2)) scene.forces.gravity.head<2>() = random.vector(4);
  if (random.chance(4)) {
    ground.belt = random.vector(1);
  } else if (random.chance(3)) {
    ground.turntable_rate = random.integer(-8, 8) / 4.0;
    ground.turntable_center = random.vector(1);
  }
  if (random.chance(4)) scene.forces.wrench.force = random.vector(4);
  if (random.chance(4))
    scene.forces.wrench.torque.head<2>() = random.vector(8 * inertia / scene.sphere.radius);
  if (random.chance(5)) scene.forces.drag.translational = 0.5;
  if (random.chance(5)) scene.forces.drag.rotational = inertia;
  if (random.chance(5)) scene.forces.drag.quadratic = 0.25;
  if (random.chance(3)) scene.forces.spring = {random.vector(1), random.integer(1, 8) * 1.0};
  return scene;
}

/// r, v and nu with friction that is smooth: s/sqrt(s^2 + eps^2) in place of s/abs(s), and so for nu.
struct Smooth {
  Vector2d r, v, nu;
  Smooth plus(double h, const Smooth& rate) const {
    return {r + h * rate.r, v + h * rate.v, nu + h * rate.nu};
  }
};

Smooth rate_of(const Dynamics& dynamics, const scene::Material& ground, double eps, const Smooth& y) {
  const double limit = dynamics.normal_force / dynamics.mass;
  const auto direction = [eps](const Vector2d& w) { return Vector2d(w / std::hypot(w.norm(), eps)); };
  const Vector2d reaction = -ground.friction * limit * direction(y.v - y.nu - ground_velocity(ground, y.r));
  const Vector2d couple = ground.rolling_resistance * limit * direction(y.nu);
  return {y.v, dynamics.acceleration(y.r, y.v) + reaction,
          dynamics.spin_acceleration(y.nu) - (1 - dynamics.kappa) / dynamics.kappa * (reaction + couple)};
}

/// By the classical Runge-Kutta method, in steps within its stability.
Smooth smooth_motion(const scene::Scene& scene, double duration, double eps) {
  const Dynamics dynamics(Sphere(scene.sphere), scene.forces);
  const scene::Material& ground = scene.surface.base;
  const Vector3d& omega = scene.initial_state.angular_velocity;
  Smooth y{scene.initial_state.position, scene.initial_state.velocity,
           scene.sphere.radius * Vector2d(omega.y(), -omega.x())};
  const double stiffness =
      (dynamics.slip_decay(ground.friction) + 2 * dynamics.spinning_decay(ground.rolling_resistance)) / eps;
  const int steps = static_cast<int>(std::ceil(duration * stiffness)) + 1000;
  const double h = duration / steps;
  for (int i = 0; i < steps; ++i) {
    const Smooth a = rate_of(dynamics, ground, eps, y);
    const Smooth b = rate_of(dynamics, ground, eps, y.plus(h / 2, a));
    const Smooth c = rate_of(dynamics, ground, eps, y.plus(h / 2, b));
    const Smooth d = rate_of(dynamics, ground, eps, y.plus(h, c));
    y = y.plus(h / 6, a.plus(2, b).plus(2, c).plus(1, d));
  }
  return y;
}

// While friction holds, smooth friction lets creep by eps or so; where a velocity passes through 0 it errs by
// eps for a time eps/A. Over a time of 1 s and accelerations of a few m/s^2, some ten times eps.
TEST(SlidingAgainstAResistance, IsTheLimitOfSmoothFriction) {
  constexpr double eps = 4e-4;
  Random random(7);
  for (int i = 0; i < case_count(16); ++i) {
    const scene::Scene scene = random_forced(random);
    const double duration = 0.25 * random.integer(1, 4);
    Simulation simulation(scene);
    simulation.advance_to(duration, {});
    const Smooth limit = smooth_motion(scene, duration, eps);
    const State& state = simulation.state();
    const Vector3d& omega = state.twist.angular_velocity;
    const Vector2d nu = scene.sphere.radius * Vector2d(omega.y(), -omega.x());
    EXPECT_LE((state.position - limit.r).norm(), 20 * eps) << described(scene);
    EXPECT_LE((state.twist.velocity - limit.v).norm(), 40 * eps) << described(scene);
    EXPECT_LE((nu - limit.nu).norm(), 80 * eps) << described(scene);
  }
}

TEST(SlidingAgainstAResistance, NeverHaltsUnderAnyForce) {
  Random random(11);
  for (int i = 0; i < 400; ++i) {
    const scene::Scene scene = random_forced(random);
    const Record run = record(scene, 4, 8);
    ASSERT_EQ(run.halt, "") << described(scene);
    for (const RecordedState& state : run.states) {
      ASSERT_TRUE(state.position.allFinite() && state.twist.angular_velocity.allFinite()) << described(scene);
    }
  }
}

TEST(SlidingAgainstAResistance, NeverGivesEnergyOnGroundAtRest) {
  Random random(13);
  for (int i = 0; i < 200; ++i) {
    const scene::Scene scene = random_state(random);
    const Sphere sphere(scene.sphere);
    const Record run = record(scene, 2, 64);
    ASSERT_EQ(run.halt, "");
    for (std::size_t k = 1; k < run.states.size(); ++k) {
      const double before = sphere.kinetic_energy(run.states[k - 1].twist);
      // 2e-11 of the speed is the tolerance of a step.
      ASSERT_LE(sphere.kinetic_energy(run.states[k].twist), before * (1 + 1e-9)) << described(scene);
    }
  }
}

// The ground's force is at most mu N, and opposite to the slip where there is one.
TEST(SlidingAgainstAResistance, StaysWithinTheLimitOfFriction) {
  Random random(17);
  for (int i = 0; i < 200; ++i) {
    const scene::Scene scene = random_forced(random);
    const double limit = -scene.surface.base.friction * scene.sphere.mass * scene.forces.gravity.z();
    const Record run = record(scene, 2, 32);
    for (const RecordedState& state : run.states) {
      // The search for a loss of grip is good to rounding; the integration to 1e-9 of the scale.
      EXPECT_LE(state.reaction.head<2>().norm(), limit + 1e-7) << described(scene) << state.time;
    }
  }
}

/// A unit of length 2^n times as long, and of time 2^m times.
scene::Scene in_other_units(scene::Scene scene, int length, int time) {
  const double l = std::ldexp(1, -length), t = std::ldexp(1, -time);
  scene.sphere.radius *= l;
  scene.sphere.gyration_radius *= l;
  scene.initial_state.position *= l;
  scene.initial_state.velocity *= l / t;
  scene.initial_state.angular_velocity /= t;
  scene.forces.gravity *= l / t / t;
  scene.forces.wrench.force *= l / t / t;
  scene.forces.wrench.torque *= l * l / t / t;
  scene.forces.drag.translational /= t;
  scene.forces.drag.rotational *= l * l / t;
  scene.forces.drag.quadratic /= l;
  scene.forces.spring.center *= l;
  scene.forces.spring.stiffness /= t * t;
  for (scene::Material* ground : {&scene.surface.base}) {
    ground->belt *= l / t;
    ground->turntable_rate /= t;
    ground->turntable_center *= l;
  }
  return scene;
}

void expect_the_same_in_other_units(const scene::Scene& scene, int length) {
  const double l = std::ldexp(1, -length);
  const Record run = record(scene, 4, 16);
  const Record other = record(in_other_units(scene, length, 0), 4, 16);
  ASSERT_EQ(run.halt, "");
  ASSERT_EQ(other.switches.size(), run.switches.size());
  for (std::size_t k = 0; k < run.switches.size(); ++k) {
    EXPECT_EQ(other.switches[k].time, run.switches[k].time);
    EXPECT_EQ(other.switches[k].kind, run.switches[k].kind);
  }
  for (std::size_t k = 0; k < run.states.size(); ++k) {
    EXPECT_EQ(other.states[k].position, l * run.states[k].position);
    EXPECT_EQ(other.states[k].twist.velocity, l * run.states[k].twist.velocity);
    EXPECT_EQ(other.states[k].mode, run.states[k].mode);
  }
}

TEST(SlidingAgainstAResistance, IsTheSameToTheBitInOtherUnits) {
  Random random(19);
  for (int i = 0; i < 100; ++i) {
    const scene::Scene scene = random_forced(random);
    SCOPED_TRACE("scene " + std::to_string(i));
    expect_the_same_in_other_units(scene, 12);
  }
}

TEST(Dissipation, AGripThatTheCoupleTakesIsLostAndTheMotionGoesOnTheSameInAllUnits) {
  const scene::Scene scene = read("grip_lost_by_couple.yaml");
  for (const int length : {-20, -3, 5, 20}) expect_the_same_in_other_units(scene, length);
  EXPECT_GE(record(scene, 4, 16).switches.size(), 3U);
}

TEST(Dissipation, AnEdgeBetweenIdenticalGroundsChangesNothing) {
  const Record with = record(read("edge_between_identical_grounds.yaml"), 20, 200);
  const Record without = record(read("without_edge.yaml"), 20, 200);
  ASSERT_EQ(with.halt, "");
  ASSERT_EQ(with.switches.size(), without.switches.size());
  for (std::size_t k = 0; k < with.switches.size(); ++k) {
    EXPECT_EQ(with.switches[k].time, without.switches[k].time);
    EXPECT_EQ(with.switches[k].position, without.switches[k].position);
  }
  for (std::size_t k = 0; k < with.states.size(); ++k) {
    EXPECT_EQ(with.states[k].position, without.states[k].position);
    EXPECT_EQ(with.states[k].twist.angular_velocity, without.states[k].twist.angular_velocity);
  }
}

scene::Scene level(double friction, double resistance, double velocity, double spin) {
  scene::Scene scene{};
  scene.sphere = {2, 0.5, 0.25};  // kappa = 1/5
  scene.forces.gravity = {0, 0, -8};
  scene.surface.base.law = Law::coulomb;
  scene.surface.base.friction = friction;
  scene.surface.base.rolling_resistance = resistance;
  scene.initial_state.velocity = {velocity, 0};
  scene.initial_state.angular_velocity = {0, spin, 0};
  return scene;
}

// v = 1, no spin: friction 1/8 turns the sphere only against a smaller resistance.
// mu = rho = 1/8: s' = v' = -1, at rest after 1 s and 1/2 m.
TEST(Dissipation, ASphereThatDoesNotTurnSkidsToRestWhereTheResistanceIsNoLessThanFriction) {
  for (const double resistance : {0.125, 0.25, 2.0}) {
    Simulation simulation(level(0.125, resistance, 1, 0));
    simulation.advance_to(0.5, {});
    EXPECT_EQ(simulation.state().mode, Mode::sliding);
    EXPECT_EQ(simulation.state().twist.velocity, Vector2d(0.5, 0));
    EXPECT_EQ(simulation.state().twist.angular_velocity, Vector3d(0, 0, 0));
    simulation.advance_to(2, {});
    EXPECT_EQ(simulation.state().mode, Mode::resting);
    EXPECT_EQ(simulation.state().position, Vector2d(0.5, 0));
    EXPECT_EQ(simulation.evaluations(), 0U);
  }
}

// mu = 1/8, rho = 1/16: v' = -1, nu' = (1 - kappa)/kappa (1 - 1/2) = 2, s' = -3: rolls after 1/3 s with 2/3
// m/s, and then v' = -rho (1 - kappa) 8 = -0.4.
TEST(Dissipation, ASphereThatDoesNotTurnIsTurnedByMoreFrictionThanItResists) {
  Simulation simulation(level(0.125, 0.0625, 1, 0));
  Switches switches;
  simulation.advance_to(1, recorder(switches));
  ASSERT_EQ(switches.size(), 1U);
  EXPECT_NEAR(switches[0].time, 1.0 / 3, 1e-15);
  EXPECT_NEAR(simulation.state().twist.velocity.x(), 2.0 / 3 - 0.4 * (2.0 / 3), 1e-15);
  EXPECT_EQ(simulation.evaluations(), 0U);
}

// Rolling takes (1 - kappa) rho N of friction: 0.8 x 0.25 x 8 = 1.6 m > mu N = 1 m. So s' = -A + a along nu,
// with A = 5 and a = 8: the sphere slips forwards, v' = -1 and nu' = 4 - 8 = -4 m/s^2; nu = 2 dies after 0.5
// s, and with v = s = 1.5 the sphere skids on for 1.5 s.
TEST(Dissipation, ASphereThatRollsSlidesWhereFrictionIsTooWeakForTheCouple) {
  Simulation simulation(level(0.125, 0.25, 2, 4));
  Switches switches;
  simulation.advance_to(0.25, recorder(switches));
  EXPECT_TRUE(switches.empty());
  EXPECT_EQ(simulation.state().mode, Mode::sliding);
  EXPECT_NEAR(simulation.state().twist.velocity.x(), 1.75, 1e-15);
  EXPECT_NEAR(simulation.state().twist.angular_velocity.y(), 2, 1e-14);
  simulation.advance_to(1.5, recorder(switches));
  EXPECT_NEAR(simulation.state().twist.velocity.x(), 0.5, 1e-14);
  EXPECT_EQ(simulation.state().twist.angular_velocity, Vector3d(0, 0, 0));
  simulation.advance_to(3, recorder(switches));
  EXPECT_EQ(simulation.state().mode, Mode::resting);
  EXPECT_EQ(simulation.evaluations(), 0U);
}

// Without friction: nu' = -a = -(1 - kappa)/kappa rho 8 = -2, v constant.
TEST(Dissipation, AFrictionlessGroundWithResistanceStopsTheTurningAlone) {
  Simulation simulation(level(0, 0.0625, 1, -4));
  simulation.advance_to(0.5, {});
  EXPECT_EQ(simulation.state().mode, Mode::sliding);
  EXPECT_NEAR(simulation.state().twist.angular_velocity.y(), -2, 1e-14);
  simulation.advance_to(4, {});
  EXPECT_EQ(simulation.state().twist.velocity, Vector2d(1, 0));
  EXPECT_EQ(simulation.state().twist.angular_velocity, Vector3d(0, 0, 0));
  EXPECT_EQ(simulation.state().position, Vector2d(4, 0));
  EXPECT_EQ(simulation.evaluations(), 0U);
}

// Every step by a method: the same, within what it is asked for.
TEST(Dissipation, TheClosedFormsOfSlidingAreWhatIsIntegrated) {
  Random random(23);
  for (int i = 0; i < 60; ++i) {
    scene::Scene scene = random_state(random);
    const Record closed = record(scene, 2, 16);
    scene.solver.method = scene::Solver::Method::dopri87;
    const Record integrated = record(scene, 2, 16);
    ASSERT_EQ(integrated.halt, "");
    ASSERT_EQ(integrated.switches.size(), closed.switches.size()) << described(scene);
    for (std::size_t k = 0; k < closed.states.size(); ++k) {
      const double scale = 4;  // m/s
      EXPECT_LE((integrated.states[k].position - closed.states[k].position).norm(), 2e-9 * scale);
      EXPECT_LE((integrated.states[k].twist.velocity - closed.states[k].twist.velocity).norm(), 1e-9 * scale);
    }
  }
}

}  // namespace
}  // namespace hybrid_sphere::testing::dissipation_test

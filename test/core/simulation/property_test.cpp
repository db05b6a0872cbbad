// What holds for every scene: conservation, energy, symmetry, independence of the output rate.

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>

#include "ground/ground.hpp"
#include "hybrid_sphere/simulation/simulation.hpp"
#include "support/place.hpp"
#include "support/random_scenes.hpp"
#include "support/recorded.hpp"
#include "support/transformed.hpp"

namespace hybrid_sphere::testing::property_test {
namespace {

constexpr double unit = 0x1p-53;
constexpr double horizon = 16;

double size_of(const Twist& twist, double radius) {
  return twist.velocity.norm() + radius * twist.angular_velocity.norm();
}

struct Run {
  std::vector<State> states;
  Switches switches;
};

Run run(const scene::Scene& scene, int outputs = 64, double until = horizon) {
  RC_LOG() << scene;
  Simulation simulation(scene);
  Run result;
  for (int i = 0; i <= outputs; ++i) {
    simulation.advance_to(until * i / outputs, recorder(result.switches));
    result.states.push_back(simulation.state());
    result.states.back().region = {};  // it goes with the simulation
  }
  return result;
}

bool equal(const Twist& a, const Twist& b) {
  return a.velocity == b.velocity && a.angular_velocity == b.angular_velocity;
}

bool equal(const State& a, const State& b) {
  return a.time == b.time && a.position == b.position && a.orientation.coeffs() == b.orientation.coeffs() &&
         equal(a.twist, b.twist) && a.slip == b.slip && a.stage == b.stage && a.mode == b.mode;
}

bool equal(const RecordedSwitch& a, const RecordedSwitch& b) {
  return a.index == b.index && a.time == b.time && a.kind == b.kind && a.from == b.from && a.to == b.to &&
         a.position == b.position && a.impulse == b.impulse && equal(a.before, b.before) &&
         equal(a.after, b.after);
}

RC_GTEST_PROP(Simulation, KeepsTheAngularMomentumAboutTheContactPoint, ()) {
  const scene::Scene scene = random_scene();
  const Sphere sphere(scene.sphere);
  const Run result = run(scene);
  const Twist start{scene.initial_state.velocity, scene.initial_state.angular_velocity};
  const double tolerance = 8 * unit * size_of(start, sphere.radius());  // a handful of roundings
  for (const State& state : result.states) {
    const Vector2d drift = sphere.conserved_velocity(state.twist) - sphere.conserved_velocity(start);
    RC_ASSERT(drift.norm() <= tolerance);
    RC_ASSERT(state.twist.angular_velocity.z() == start.angular_velocity.z());
  }
}

RC_GTEST_PROP(Simulation, NeverGainsEnergy, ()) {
  const scene::Scene scene = random_scene();
  const Sphere sphere(scene.sphere);
  const Run result = run(scene);
  double energy = sphere.kinetic_energy({scene.initial_state.velocity, scene.initial_state.angular_velocity});
  for (const State& state : result.states) {
    RC_ASSERT(sphere.kinetic_energy(state.twist) <= energy * (1 + 16 * unit));
    energy = sphere.kinetic_energy(state.twist);
  }
}

RC_GTEST_PROP(Simulation, IsFiniteAndOfUnitOrientation, ()) {
  for (const State& state : run(random_scene()).states) {
    RC_ASSERT(state.position.allFinite());
    RC_ASSERT(state.twist.velocity.allFinite());
    RC_ASSERT(state.twist.angular_velocity.allFinite());
    RC_ASSERT(std::abs(state.orientation.norm() - 1) < 32 * unit);
  }
}

RC_GTEST_PROP(Simulation, IsTheSameAtAnyOutputRate, ()) {
  const scene::Scene scene = random_scene();
  const Run coarse = run(scene, 4);
  const Run fine = run(scene, 4 * integer(2, 40));
  const std::size_t stride = (fine.states.size() - 1) / 4;
  for (std::size_t i = 0; i < coarse.states.size(); ++i)
    RC_ASSERT(equal(coarse.states[i], fine.states[i * stride]));
  RC_ASSERT(coarse.switches.size() == fine.switches.size());
  for (std::size_t i = 0; i < coarse.switches.size(); ++i)
    RC_ASSERT(equal(coarse.switches[i], fine.switches[i]));
}

RC_GTEST_PROP(Simulation, DoesNotSlipOnRoughGround, ()) {
  const scene::Scene scene = random_scene();
  const double radius = scene.sphere.radius;
  for (const State& state : run(scene).states) {
    const Vector2d slip = Sphere(scene.sphere).contact_velocity(state.twist);
    if (state.stage == Stage::nonholonomic) {
      RC_ASSERT(state.slip == Vector2d::Zero());
      RC_ASSERT(slip.norm() <= 2 * unit * size_of(state.twist, radius));
    } else {
      RC_ASSERT((state.slip - slip).norm() <= 2 * unit * size_of(state.twist, radius));
    }
  }
}

RC_GTEST_PROP(Simulation, KnowsTheGroundUnderTheSphere, ()) {
  const scene::Scene scene = random_scene();
  RC_LOG() << scene;
  const Ground ground(scene.surface);
  Simulation simulation(scene);
  for (int i = 0; i <= 400; ++i) {
    simulation.advance_to(horizon * i / 400, {});
    const State& state = simulation.state();
    if (distance_to_edge(scene.surface, state.position) <= 1e-9) continue;
    RC_LOG() << "at t = " << state.time << " over " << std::string(state.region) << "\n";
    const RegionId region = ground.top_region(state.position);
    RC_ASSERT(std::string(state.region) == std::string(ground.name(region)));
    RC_ASSERT((ground.law(region) == scene::Law::rough) == (state.stage == Stage::nonholonomic));
  }
}

RC_GTEST_PROP(Switch, FollowsFromTheOneBefore, ()) {
  const scene::Scene scene = random_scene();
  const Run result = run(scene);
  Stage stage = Stage::holonomic;
  Twist twist{scene.initial_state.velocity, scene.initial_state.angular_velocity};
  double time = 0;
  for (std::size_t i = 0; i < result.switches.size(); ++i) {
    const RecordedSwitch& event = result.switches[i];
    RC_ASSERT(event.index == i);
    RC_ASSERT(event.time >= time);
    RC_ASSERT(event.from_stage == stage);
    RC_ASSERT(event.to_stage != stage);
    RC_ASSERT((event.kind == SwitchKind::applied) == (event.to_stage == Stage::nonholonomic));
    RC_ASSERT(equal(event.before, twist));
    if (i > 0) RC_ASSERT(!event.from.empty());
    stage = event.to_stage;
    twist = event.after;
    time = event.time;
  }
  RC_ASSERT(result.states.back().stage == stage);
}

RC_GTEST_PROP(Switch, LosesTheEnergyThatCarnotSays, ()) {
  const scene::Scene scene = random_scene();
  const Sphere sphere(scene.sphere);
  for (const RecordedSwitch& event : run(scene).switches) {
    const double loss = event.energy_before - event.energy_after;
    const double carnot = event.impulse.squaredNorm() / (2 * sphere.mass() * sphere.kappa());
    RC_ASSERT(std::abs(loss - carnot) <= 32 * unit * event.energy_before);
    RC_ASSERT((event.impulse + sphere.mass() * sphere.kappa() * event.slip_before).norm() <=
              4 * unit * event.impulse.norm());
  }
}

RC_GTEST_PROP(Switch, ChangesTheVelocitiesByItsImpulse, ()) {
  const scene::Scene scene = random_scene();
  const double m = scene.sphere.mass;
  const double inertia = m * scene.sphere.gyration_radius * scene.sphere.gyration_radius;
  for (const RecordedSwitch& event : run(scene).switches) {
    const double tolerance = 16 * unit * size_of(event.before, scene.sphere.radius);
    const Vector2d momentum = m * (event.after.velocity - event.before.velocity);
    RC_ASSERT((momentum - event.impulse).norm() <= m * tolerance);
    const Vector3d spin = inertia * (event.after.angular_velocity - event.before.angular_velocity);
    RC_ASSERT((spin - event.angular_impulse).norm() <=
              inertia * tolerance / scene.sphere.radius + m * scene.sphere.radius * tolerance);
  }
}

// Powers of two scale without rounding: the scaled scene has the scaled trajectory, to the bit.
RC_GTEST_PROP(Simulation, ScalesWithItsUnits, ()) {
  const scene::Scene scene = random_scene();
  const Units units{std::ldexp(1.0, integer(-20, 20)), std::ldexp(1.0, integer(-20, 20)),
                    std::ldexp(1.0, integer(-20, 20))};
  const Run plain = run(scene);
  const Run scaled = run(in_units(scene, units), 64, horizon * units.time);
  for (std::size_t i = 0; i < plain.states.size(); ++i) {
    RC_ASSERT(scaled.states[i].position == units.length * plain.states[i].position);
    RC_ASSERT(scaled.states[i].twist.velocity == units.length / units.time * plain.states[i].twist.velocity);
    RC_ASSERT(scaled.states[i].twist.angular_velocity == plain.states[i].twist.angular_velocity / units.time);
    RC_ASSERT(scaled.states[i].orientation.coeffs() == plain.states[i].orientation.coeffs());
  }
  RC_ASSERT(scaled.switches.size() == plain.switches.size());
  for (std::size_t i = 0; i < plain.switches.size(); ++i) {
    RC_ASSERT(scaled.switches[i].time == units.time * plain.switches[i].time);
    RC_ASSERT(scaled.switches[i].to == plain.switches[i].to);
    RC_ASSERT(scaled.switches[i].impulse ==
              units.mass * units.length / units.time * plain.switches[i].impulse);
  }
}

// The data are turned without rounding; the places of the switches are not.
void check_symmetry(const scene::Scene& scene, const Symmetry& symmetry) {
  const Run plain = run(scene);
  const Run moved = run(symmetry.of(scene));
  RC_ASSERT(moved.switches.size() == plain.switches.size());
  for (std::size_t i = 0; i < plain.switches.size(); ++i) {
    RC_ASSERT(moved.switches[i].to == plain.switches[i].to);
    RC_ASSERT(std::abs(moved.switches[i].time - plain.switches[i].time) < 1e-6);
    RC_ASSERT((moved.switches[i].impulse - symmetry.of(plain.switches[i].impulse)).norm() == 0);
  }
  for (std::size_t i = 0; i < plain.states.size(); ++i) {
    if (moved.states[i].stage != plain.states[i].stage) continue;  // an output within rounding of a switch
    RC_ASSERT((moved.states[i].position - symmetry.of(plain.states[i].position)).norm() < 1e-6);
    RC_ASSERT((moved.states[i].twist.velocity - symmetry.of(plain.states[i].twist.velocity)).norm() == 0);
    const Quaterniond expected = symmetry.of(plain.states[i].orientation);
    RC_ASSERT((moved.states[i].orientation.coeffs() - expected.coeffs()).norm() < 1e-6);
  }
}

RC_GTEST_PROP(Simulation, LooksTheSameInAMirror, ()) { check_symmetry(off_grid(random_scene()), mirror()); }

RC_GTEST_PROP(Simulation, LooksTheSameTurnedByARightAngle, ()) {
  check_symmetry(off_grid(random_scene()), quarter_turn());
}

RC_GTEST_PROP(SmoothMotion, RunsBackwards, ()) {
  scene::Scene scene = off_grid(random_scene());
  scene.surface.base = scene::Law::smooth;
  for (scene::Region& region : scene.surface.regions) region.material.law = scene::Law::smooth;
  Simulation simulation(scene);
  simulation.advance_to(horizon, {});
  const State there = simulation.state();
  simulation.set_initial_state(
      {there.position, there.orientation, -there.twist.velocity, -there.twist.angular_velocity});
  simulation.advance_to(horizon, {});
  const State& back = simulation.state();
  const double way = horizon * scene.initial_state.velocity.norm() + scene.initial_state.position.norm();
  const double angle = horizon * scene.initial_state.angular_velocity.norm();
  RC_ASSERT((back.position - scene.initial_state.position).norm() <= 8 * unit * way);
  RC_ASSERT((back.orientation.coeffs() - scene.initial_state.orientation.coeffs()).norm() <=
            8 * unit * (1 + angle));
  RC_ASSERT(simulation.switches() == 0U);
}

}  // namespace
}  // namespace hybrid_sphere::testing::property_test

// What holds for every scene of every law, on ground that moves, under any forces.

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>

#include "sphere/dynamics.hpp"
#include "support/place.hpp"
#include "support/random_scenes.hpp"
#include "support/recorded.hpp"

namespace hybrid_sphere::testing::any_ground_property_test {
namespace {

using scene::Law;

constexpr double unit = 0x1p-53;
constexpr double horizon = 8;

Record run(const scene::Scene& scene, int outputs = 64) {
  RC_LOG() << scene;
  return record(scene, horizon, outputs);
}

const scene::Material& ground_of(const scene::Scene& scene, const std::string& name) {
  for (const scene::Region& region : scene.surface.regions) {
    if (region.name == name) return region.material;
  }
  return scene.surface.base;
}

template <class Predicate>
bool any_ground(const scene::Surface& surface, const Predicate& predicate) {
  return predicate(surface.base) ||
         std::any_of(surface.regions.begin(), surface.regions.end(),
                     [&](const scene::Region& region) { return predicate(region.material); });
}

bool has_circle(const scene::Surface& surface) {
  return std::any_of(surface.regions.begin(), surface.regions.end(), [](const scene::Region& region) {
    return std::holds_alternative<scene::Circle>(region.shape);
  });
}

bool drifts(const scene::Forces& forces) {
  return forces.drag.translational != 0 || forces.drag.rotational != 0 || forces.drag.quadratic != 0 ||
         forces.spring.stiffness != 0;
}

Vector2d contact_velocity(const scene::Scene& scene, const Twist& twist) {
  const Vector3d& omega = twist.angular_velocity;
  return twist.velocity - scene.sphere.radius * Vector2d(omega.y(), -omega.x());
}

/// All speeds that rounding is relative to.
double speed_scale(const scene::Scene& scene, const Vector2d& position, const Twist& twist) {
  double scale = twist.velocity.norm() + scene.sphere.radius * twist.angular_velocity.norm();
  any_ground(scene.surface, [&](const scene::Material& material) {
    scale = std::max(scale, material.belt.norm() + std::abs(material.turntable_rate) *
                                                       (position.norm() + material.turntable_center.norm()));
    return false;
  });
  return scale;
}

RC_GTEST_PROP(Simulation, GoesOnToTheEndOrHaltsInALivelock, ()) {
  const scene::Scene scene = random_any_scene();
  const Record result = run(scene);
  RC_CLASSIFY(!result.halt.empty(), "halts");
  RC_ASSERT(result.halt.empty() || result.halt.find("livelock") == 0 ||
            result.halt.find("switches accumulate") == 0);
  for (const RecordedState& state : result.states) {
    RC_ASSERT(state.position.allFinite());
    RC_ASSERT(state.twist.velocity.allFinite());
    RC_ASSERT(state.twist.angular_velocity.allFinite());
    RC_ASSERT(state.slip.allFinite());
    RC_ASSERT(state.reaction.allFinite());
    RC_ASSERT(std::abs(state.orientation.norm() - 1) < 64 * unit);
  }
}

bool equal(const RecordedState& a, const RecordedState& b) {
  return a.time == b.time && a.position == b.position && a.orientation.coeffs() == b.orientation.coeffs() &&
         a.twist.velocity == b.twist.velocity && a.twist.angular_velocity == b.twist.angular_velocity &&
         a.slip == b.slip && a.stage == b.stage && a.mode == b.mode && a.name == b.name &&
         a.reaction == b.reaction;
}

bool equal(const RecordedSwitch& a, const RecordedSwitch& b) {
  return a.index == b.index && a.time == b.time && a.kind == b.kind && a.cause == b.cause &&
         a.from == b.from && a.to == b.to && a.position == b.position && a.impulse == b.impulse &&
         a.angular_impulse == b.angular_impulse && a.after.velocity == b.after.velocity &&
         a.after.angular_velocity == b.after.angular_velocity;
}

RC_GTEST_PROP(Simulation, IsTheSameAtAnyOutputRate, ()) {
  const scene::Scene scene = random_any_scene();
  const Record coarse = run(scene, 4);
  const int more = integer(2, 40);
  const Record fine = record(scene, horizon, 4 * more);
  RC_ASSERT(coarse.halt == fine.halt);
  RC_ASSERT(coarse.switches.size() == fine.switches.size());
  for (std::size_t i = 0; i < coarse.switches.size(); ++i)
    RC_ASSERT(equal(coarse.switches[i], fine.switches[i]));
  const std::size_t common = coarse.states.size() - (coarse.halt.empty() ? 0 : 1);
  for (std::size_t i = 0; i < common; ++i)
    RC_ASSERT(equal(coarse.states[i], fine.states[i * static_cast<std::size_t>(more)]));
  RC_ASSERT(equal(coarse.states.back(), fine.states.back()));
}

RC_GTEST_PROP(SimulationOnStillGround, NeverGainsEnergy, ()) {
  scene::Scene scene = random_any_scene();
  scene.forces.gravity.head<2>().setZero();
  scene.forces.wrench = {};
  scene.forces.spring = {};
  const auto stop = [](scene::Material& material) {
    material.belt.setZero();
    material.turntable_rate = 0;
  };
  stop(scene.surface.base);
  for (scene::Region& region : scene.surface.regions) stop(region.material);
  const Record result = run(scene);
  // Friction may drive the sphere into a smooth circle that it touches; the tangent leads out of it again.
  RC_ASSERT(result.halt.empty() || (has_circle(scene.surface) && result.halt.find("livelock") == 0));
  const Sphere sphere(scene.sphere);
  double energy = sphere.kinetic_energy({scene.initial_state.velocity, scene.initial_state.angular_velocity});
  // Roundings; of an integrated motion two errors of the accuracy asked for.
  const double growth = drifts(scene.forces) ? 2 * scene.solver.accuracy : 32 * unit;
  for (const RecordedState& state : result.states) {
    const double now = sphere.kinetic_energy(state.twist);
    RC_ASSERT(now <= energy * (1 + growth));
    energy = now;
  }
}

RC_GTEST_PROP(Simulation, KnowsTheGroundUnderTheSphere, ()) {
  const scene::Scene scene = random_any_scene();
  const Record result = run(scene, 4000);
  for (const RecordedState& state : result.states) {
    if (state.mode == Mode::edge_sliding) continue;
    if (distance_to_edge(scene.surface, state.position) <= 1e-9 * (8 + state.position.norm())) continue;
    const int region = region_at(scene.surface, state.position);
    const std::string expected =
        region < 0 ? scene::base_name : scene.surface.regions[static_cast<std::size_t>(region)].name;
    if (state.name != expected) {
      RC_LOG() << "at t = " << state.time << ", position " << state.position.transpose() << " over "
               << state.name << "\n";
      for (const RecordedSwitch& event : result.switches)
        RC_LOG() << "switch " << event.time << " " << event.from << " -> " << event.to << "\n";
    }
    RC_ASSERT(state.name == expected);
  }
}

void check_sliding(const scene::Scene& scene, const RecordedState& state, const scene::Material& ground) {
  const double friction = ground.friction * Dynamics(Sphere(scene.sphere), scene.forces).normal_force;
  RC_ASSERT(!state.slip.isZero(0));
  const Vector2d against = -friction * state.slip.normalized();
  // The reaction is the difference of two accelerations.
  const double scale =
      friction + scene.sphere.mass * scene.forces.gravity.norm() + scene.forces.wrench.force.norm() +
      scene.forces.spring.stiffness * (state.position - scene.forces.spring.center).norm() +
      (scene.forces.drag.translational + scene.forces.drag.quadratic * state.twist.velocity.norm()) *
          state.twist.velocity.norm();
  // What the slip's own rounding turns the direction by, where there is little slip left.
  const double speeds = speed_scale(scene, state.position, state.twist);
  const double turned = friction * std::min(2.0, 1e-13 * speeds / state.slip.norm());
  RC_ASSERT((Vector2d(state.reaction.head<2>()) - against).norm() <= 64 * unit * scale + turned);
}

RC_GTEST_PROP(Simulation, ObeysTheLawOfTheGround, ()) {
  const scene::Scene scene = random_any_scene();
  const double normal_force = Dynamics(Sphere(scene.sphere), scene.forces).normal_force;
  for (const RecordedState& state : run(scene, 200).states) {
    RC_LOG() << "t = " << state.time << " on " << state.name << ", " << to_string(state.mode) << "\n";
    const scene::Material& ground = ground_of(scene, state.name);
    const double scale = speed_scale(scene, state.position, state.twist);
    RC_ASSERT(state.reaction.z() == normal_force);
    RC_ASSERT((state.stage == Stage::holonomic) == (state.mode == Mode::free || state.mode == Mode::sliding));
    if (state.mode == Mode::edge_sliding) {
      RC_ASSERT(ground.law == Law::rough);
      continue;
    }
    const Vector2d sigma = contact_velocity(scene, state.twist);
    const bool grips = ground.law != Law::smooth && !(ground.law == Law::coulomb && ground.friction == 0);
    if (!grips) {
      RC_ASSERT(state.mode == Mode::free);
      RC_ASSERT(state.reaction.head<2>().isZero(0));
      continue;
    }
    const Vector2d slip = sigma - ground_velocity(ground, state.position);
    if (state.mode == Mode::sliding) {
      RC_ASSERT(ground.law == Law::coulomb);
      RC_ASSERT((state.slip - slip).norm() <= 64 * unit * scale);
      check_sliding(scene, state, ground);
      continue;
    }
    RC_ASSERT(state.mode == Mode::rolling || state.mode == Mode::resting);
    RC_ASSERT(state.slip.isZero(0));
    RC_ASSERT(slip.norm() <= 64 * unit * scale);
    if (ground.law == Law::rubber) RC_ASSERT(state.twist.angular_velocity.z() == ground.turntable_rate);
    if (ground.law == Law::coulomb)
      RC_ASSERT(state.reaction.head<2>().norm() <= ground.friction * normal_force * (1 + 1e-9));
    if (state.mode == Mode::resting) RC_ASSERT(state.twist.velocity.isZero(0));
  }
}

// p_c' = a_0 whatever the ground does: docs/theory.md 3.1.
RC_GTEST_PROP(SimulationWithoutDrag, KeepsTheAngularMomentumAboutTheContactPoint, ()) {
  scene::Scene scene = random_any_scene();
  scene.forces.drag = {};
  scene.forces.spring = {};
  scene.surface.base.rolling_resistance = 0;
  for (scene::Region& region : scene.surface.regions) region.material.rolling_resistance = 0;
  const Sphere sphere(scene.sphere);
  const Vector2d push = Dynamics(sphere, scene.forces).rolling();
  const Vector2d start =
      sphere.conserved_velocity({scene.initial_state.velocity, scene.initial_state.angular_velocity});
  const Record result = run(scene);
  double scale = 0;
  std::size_t switches = 0;
  std::size_t accumulations = 0;
  for (const RecordedState& state : result.states) {
    scale = std::max(scale, speed_scale(scene, state.position, state.twist) + push.norm() * state.time);
    while (switches < result.switches.size() && result.switches[switches].time <= state.time) {
      const RecordedSwitch& event = result.switches[switches++];
      scale = std::max(scale, speed_scale(scene, event.position, event.before));
      if (event.cause == Cause::accumulation) ++accumulations;
    }
    const Vector2d drift = sphere.conserved_velocity(state.twist) - (start + state.time * push);
    // A handful of roundings in every segment. Where throws accumulate, what is left of the speed across the
    // edge once the clock does not resolve them any more is taken away, docs/theory.md 5.5.
    const double roundings = 64 + 16 * static_cast<double>(switches);
    RC_ASSERT(drift.norm() <= roundings * unit * scale + 1e-11 * static_cast<double>(accumulations) * scale);
  }
}

}  // namespace
}  // namespace hybrid_sphere::testing::any_ground_property_test

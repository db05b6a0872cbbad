// What every switch between grounds of any law says, and the symmetries of the plane and of the units.

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "ground/crossing.hpp"
#include "sphere/dynamics.hpp"
#include "support/agreement.hpp"
#include "support/random_scenes.hpp"
#include "support/recorded.hpp"
#include "support/transformed.hpp"

namespace hybrid_sphere::testing::any_switch_property_test {
namespace {

using scene::Law;

constexpr double unit = 0x1p-53;
constexpr double horizon = 8;

Record run(const scene::Scene& scene, int outputs = 64, double until = horizon) {
  RC_LOG() << scene;
  return record(scene, until, outputs);
}

const scene::Material& ground_of(const scene::Scene& scene, const std::string& name) {
  for (const scene::Region& region : scene.surface.regions) {
    if (region.name == name) return region.material;
  }
  return scene.surface.base;
}

Vector2d nu_of(const scene::Scene& scene, const Twist& twist) {
  return scene.sphere.radius * Vector2d(twist.angular_velocity.y(), -twist.angular_velocity.x());
}

double speed_scale(const scene::Scene& scene, const RecordedSwitch& event) {
  const scene::Material& ground = ground_of(scene, event.to);
  const auto size = [&](const Twist& twist) {
    return twist.velocity.norm() + scene.sphere.radius * twist.angular_velocity.norm();
  };
  return size(event.before) + size(event.after) + ground.belt.norm() +
         std::abs(ground.turntable_rate) * (event.position.norm() + ground.turntable_center.norm());
}

RC_GTEST_PROP(Switch, FollowsFromTheOneBefore, ()) {
  const Record result = run(random_any_scene());
  Stage stage = Stage::holonomic;
  double time = 0;
  for (std::size_t i = 0; i < result.switches.size(); ++i) {
    const RecordedSwitch& event = result.switches[i];
    RC_ASSERT(event.index == i);
    RC_ASSERT(event.time >= time);
    RC_ASSERT(event.from_stage == stage);
    const bool held = event.from_stage == Stage::nonholonomic;
    const bool holds = event.to_stage == Stage::nonholonomic;
    RC_ASSERT(held || holds);
    const SwitchKind expected = !held   ? SwitchKind::applied
                                : holds ? SwitchKind::exchanged
                                        : SwitchKind::released;
    RC_ASSERT(event.kind == expected);
    if (event.from.empty()) RC_ASSERT(i == 0 && event.cause == Cause::placed);
    RC_ASSERT(!event.to.empty());
    stage = event.to_stage;
    time = event.time;
  }
  RC_ASSERT(result.states.back().stage == stage);
}

RC_GTEST_PROP(Switch, ChangesTheVelocitiesByItsImpulses, ()) {
  const scene::Scene scene = random_any_scene();
  const double m = scene.sphere.mass;
  const double radius = scene.sphere.radius;
  const double inertia = m * scene.sphere.gyration_radius * scene.sphere.gyration_radius;
  for (const RecordedSwitch& event : run(scene).switches) {
    const double tolerance = 64 * unit * speed_scale(scene, event);
    const Vector2d momentum = m * (event.after.velocity - event.before.velocity);
    RC_ASSERT((momentum - event.impulse).norm() <= m * tolerance);
    const Vector3d spin = inertia * (event.after.angular_velocity - event.before.angular_velocity);
    RC_ASSERT((spin - event.angular_impulse).norm() <= (inertia / radius + m * radius) * tolerance);
    const Vector2d& P = event.impulse;
    const Vector2d couple(radius * P.y(), -radius * P.x());
    RC_ASSERT((event.angular_impulse.head<2>() - couple).norm() <= 4 * unit * couple.norm());
    const bool spins_on = ground_of(scene, event.to).law != Law::rubber;
    RC_ASSERT(event.angular_impulse.z() == 0 || !spins_on);
  }
}

// The loss is |P|^2/(2 m kappa) - P.sigma', and on rubber that of the spin: docs/theory.md 3.
RC_GTEST_PROP(Switch, BalancesTheEnergyWithTheWorkOfTheGround, ()) {
  const scene::Scene scene = random_any_scene();
  const Sphere sphere(scene.sphere);
  const double inertia = scene.sphere.mass * std::pow(scene.sphere.gyration_radius, 2);
  for (const RecordedSwitch& event : run(scene).switches) {
    const Vector2d& P = event.impulse;
    const Vector2d sigma = event.after.velocity - nu_of(scene, event.after);
    const double before = event.before.angular_velocity.z();
    const double after = event.after.angular_velocity.z();
    const double expected = P.squaredNorm() / (2 * sphere.mass() * sphere.kappa()) - P.dot(sigma) +
                            inertia * (before - after) * (before + after) / 2;
    const double scale = event.energy_before + event.energy_after + P.squaredNorm() / sphere.mass() +
                         P.norm() * speed_scale(scene, event);
    RC_ASSERT(std::abs(event.energy_before - event.energy_after - expected) <= 256 * unit * scale);
  }
}

const scene::Shape* shape_of(const scene::Scene& scene, const std::string& name) {
  for (const scene::Region& region : scene.surface.regions) {
    if (region.name == name) return &region.shape;
  }
  return nullptr;
}

/// How far a point lies outside of a closed region, 0 in it [m].
double distance_outside(const scene::Shape& shape, const Vector2d& point) {
  if (locate(shape, point) != Side::outside) return 0;
  if (const auto* half_plane = std::get_if<scene::HalfPlane>(&shape)) {
    return -half_plane->normal.normalized().dot(point - half_plane->point);
  }
  if (const auto* circle = std::get_if<scene::Circle>(&shape)) {
    return std::abs((point - circle->center).norm() - circle->radius);
  }
  double distance = std::numeric_limits<double>::infinity();
  const auto& vertices = std::get<scene::Polygon>(shape).vertices;
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const Vector2d& a = vertices[i];
    const Vector2d side = vertices[(i + 1) % vertices.size()] - a;
    const double share = std::clamp(side.dot(point - a) / side.squaredNorm(), 0.0, 1.0);
    distance = std::min(distance, (point - a - share * side).norm());
  }
  return distance;
}

scene::Solver any_solver() {
  using Method = scene::Solver::Method;
  const Method methods[] = {Method::automatic,    Method::euler,       Method::rk4,
                            Method::lie_midpoint, Method::rkmk4,       Method::cvode_bdf,
                            Method::arkode_erk,   Method::cvode_adams, Method::arkode_erk3,
                            Method::arkode_erk5,  Method::dopri5,      Method::dopri87};
  scene::Solver solver;
  solver.method = methods[integer(0, 11)];
  solver.accuracy = std::pow(10.0, -integer(3, 9));
  solver.step = std::pow(10.0, integer(-2, 6));
  return solver;
}

// A place is rounded, and a curved path's instant is known to a bound on its error: 1e-9 of the way is far
// above both, and far below what a wrong region would be off.
RC_GTEST_PROP(Switch, LiesInTheClosedRegionThatItNamesByEveryMethod, ()) {
  scene::Scene scene = random_any_scene();
  scene.solver = any_solver();
  const Record result = run(scene, 16, 4);
  double time = 0;
  for (std::size_t i = 0; i < result.switches.size(); ++i) {
    const RecordedSwitch& event = result.switches[i];
    RC_ASSERT(event.index == i);
    RC_ASSERT(event.time >= time);
    time = event.time;
    RC_ASSERT(event.position.allFinite() && event.impulse.allFinite() && event.slip_before.allFinite());
    RC_ASSERT(event.after.velocity.allFinite() && event.after.angular_velocity.allFinite());
    const scene::Shape* shape = shape_of(scene, event.to);
    const double size = 16 + event.position.norm();
    if (shape) RC_ASSERT(distance_outside(*shape, event.position) <= 1e-9 * size);
  }
  for (const RecordedState& state : result.states) {
    Switches before = result.switches;
    while (!before.empty() && before.back().time > state.time) before.pop_back();
    const std::string found = contradiction(state, state.reaction, before);
    RC_LOG() << found << " at " << state.time << "\n";
    RC_ASSERT(found.empty());
  }
}

RC_GTEST_PROP(Switch, HasTheImpulseThatItsCauseAllows, ()) {
  const scene::Scene scene = random_any_scene();
  for (const RecordedSwitch& event : run(scene).switches) {
    const scene::Material& ground = ground_of(scene, event.to);
    const bool jumps = !event.impulse.isZero(0) || !event.angular_impulse.isZero(0);
    if (event.cause == Cause::slip_ended) RC_ASSERT(event.kind == SwitchKind::applied && !jumps);
    if (event.cause == Cause::grip_lost) RC_ASSERT(event.kind == SwitchKind::released && !jumps);
    if (event.cause == Cause::slip_ended || event.cause == Cause::grip_lost)
      RC_ASSERT(ground.law == Law::coulomb && event.from == event.to);
    if (event.cause == Cause::livelock) RC_ASSERT(event.to_stage == Stage::nonholonomic);
    if (event.kind == SwitchKind::released || ground.law == Law::coulomb) RC_ASSERT(!jumps);
  }
}

// Ground on which friction turns the slip, and with it the sphere: powers of numbers, and no closed form to
// the bit.
void take_away_friction(scene::Material& material) {
  if (material.law == Law::coulomb) material.law = Law::rough;
  material.rolling_resistance = material.friction = 0;
}

bool is_integrated(const scene::Scene& scene) {
  Simulation simulation(scene);
  try {
    simulation.advance_to(horizon, {});
  } catch (const HaltedError&) {
  }
  return simulation.evaluations() > 0;
}

// Powers of two scale without rounding.
RC_GTEST_PROP(Simulation, ScalesWithItsUnitsToTheBitWithoutTurntables, ()) {
  scene::Scene scene = random_any_scene();
  const bool forced = Dynamics(Sphere(scene.sphere), scene.forces).forced();
  const auto straighten = [&](scene::Material& material) {
    material.turntable_rate = 0;  // angles round
    if (forced) take_away_friction(material);
  };
  straighten(scene.surface.base);
  for (scene::Region& region : scene.surface.regions) straighten(region.material);
  RC_PRE(!is_integrated(scene));
  const Units units{std::ldexp(1.0, integer(-20, 20)), std::ldexp(1.0, integer(-20, 20)),
                    std::ldexp(1.0, integer(-20, 20))};
  const Record plain = run(scene);
  const Record scaled = run(in_units(scene, units), 64, horizon * units.time);
  const double speed = units.length / units.time;
  RC_LOG() << "plain: " << plain.halt << "\nscaled: " << scaled.halt << "\n";
  RC_ASSERT(scaled.states.size() == plain.states.size());
  for (std::size_t i = 0; i < plain.states.size(); ++i) {
    RC_LOG() << "at t = " << plain.states[i].time << " on " << plain.states[i].name << "\n";
    RC_ASSERT(scaled.states[i].name == plain.states[i].name);
    RC_ASSERT(scaled.states[i].mode == plain.states[i].mode);
    RC_ASSERT(scaled.states[i].position == units.length * plain.states[i].position);
    RC_ASSERT(scaled.states[i].twist.velocity == speed * plain.states[i].twist.velocity);
    RC_ASSERT(scaled.states[i].twist.angular_velocity == plain.states[i].twist.angular_velocity / units.time);
  }
  RC_ASSERT(scaled.switches.size() == plain.switches.size());
  for (std::size_t i = 0; i < plain.switches.size(); ++i) {
    RC_ASSERT(scaled.switches[i].time == units.time * plain.switches[i].time);
    RC_ASSERT(scaled.switches[i].to == plain.switches[i].to);
    RC_ASSERT(scaled.switches[i].impulse == units.mass * speed * plain.switches[i].impulse);
  }
}

/// Whether throws come to a last instant: then rounding decides how many there are, and on which side of the
/// edge the sphere is after them where both go on along it.
bool accumulates(const Record& record) {
  return std::any_of(record.switches.begin(), record.switches.end(),
                     [](const RecordedSwitch& event) { return event.cause == Cause::accumulation; });
}

// How far two neighbouring states come apart is a property of the scene: switches in the vicinity of a
// corner, grip that is just lost. The moved scene may be as far from the plain one as a scene whose start is
// shifted by 1e-9 is; a case in which that is more than 1e-5 says nothing.
void check_symmetry(const scene::Scene& scene, const Symmetry& symmetry) {
  const Record plain = run(scene);
  scene::Scene shifted = scene;
  shifted.initial_state.position += Vector2d(1e-9, -1e-9);
  shifted.initial_state.velocity += Vector2d(-1e-9, 1e-9);
  const Record beside = record(shifted, horizon, 64);
  RC_PRE(plain.halt.empty() && beside.halt.empty() && plain.switches.size() == beside.switches.size());
  RC_PRE(!accumulates(plain) && !accumulates(beside));
  const Record moved = run(symmetry.of(scene));
  RC_ASSERT(moved.halt.empty());
  RC_ASSERT(moved.switches.size() == plain.switches.size());
  for (std::size_t i = 0; i < plain.states.size(); ++i) {
    const RecordedState& a = plain.states[i];
    const RecordedState& b = moved.states[i];
    const double spread = (beside.states[i].position - a.position).norm();
    if (spread > 1e-5 || beside.states[i].mode != a.mode) return;
    const double tolerance = 1e-6 * (1 + a.position.norm()) + 100 * spread;
    RC_ASSERT((b.position - symmetry.of(a.position)).norm() <= tolerance);
    if (beside.states[i].name == a.name) RC_ASSERT(b.name == a.name);
    if (b.mode != a.mode) continue;  // an output within rounding of a switch
    const double fast = (beside.states[i].twist.velocity - a.twist.velocity).norm();
    RC_ASSERT((b.twist.velocity - symmetry.of(a.twist.velocity)).norm() <=
              1e-6 * (1 + a.twist.velocity.norm()) + 100 * (fast + spread));
  }
}

RC_GTEST_PROP(Simulation, LooksTheSameInAMirror, ()) {
  check_symmetry(off_grid(random_any_scene()), mirror());
}

RC_GTEST_PROP(Simulation, LooksTheSameTurnedByARightAngle, ()) {
  check_symmetry(off_grid(random_any_scene()), quarter_turn());
}

}  // namespace
}  // namespace hybrid_sphere::testing::any_switch_property_test

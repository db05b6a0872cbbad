// Characters in which dry friction and resistances decide.

#include <cmath>

#include "chance.hpp"
#include "character_parts.hpp"
#include "support/random_scenes.hpp"

namespace hybrid_sphere::fuzz {

using scene::Law;
using scene::Material;
using testing::integer;

// Dry friction with resistances under everything that turns the reaction.
Case friction_case() {
  scene::Surface surface;
  const auto material = [] {
    Material result(chance(4) ? Law::rough : Law::coulomb);
    if (result.law == Law::coulomb) result.friction = integer(1, 16) / 32.0;
    if (chance(2)) result.rolling_resistance = integer(1, 16) / 64.0;
    if (chance(2)) result.spin_friction = integer(1, 16) / 64.0;
    if (chance(3)) result.belt = vector(8, 4);
    if (chance(3)) {
      result.turntable_rate = integer(-8, 8) / 4.0;
      result.turntable_center = vector(8, 1);
    }
    return result;
  };
  surface.base = material();
  for (int i = integer(0, 3); i > 0; --i)
    add(surface, testing::random_shape(), chance(3) ? surface.base : material());
  Case result{sphere_on(surface)};
  scene::Forces& forces = result.scene.forces;
  if (chance(2)) forces.gravity.head<2>() = vector(8, 2);
  if (chance(3)) forces.spring = {vector(8, 2), integer(1, 16) / 4.0};
  if (chance(3)) forces.drag.rotational = integer(1, 8) / 64.0;
  return result;
}

// A slope that pulls just as much as friction or the resistance holds, across an edge on which the sphere is.
Case balance_case() {
  scene::Surface surface;
  const Vector2d place = chance(3) ? vector(8, 1) : Vector2d(0, 0);
  const Vector2d across = chance(2) ? Vector2d(1, 0) : testing::random_direction();
  const Vector2d along(-across.y(), across.x());
  surface.base = Material(Law::coulomb);
  const double friction = surface.base.friction = integer(1, 16) / 32.0;
  const double resistance = surface.base.rolling_resistance =
      chance(2) ? 0 : friction * integer(1, 16) / 16.0;
  Material other = chance(2) ? surface.base : any_material();
  if (chance(4)) other.belt = across / 2;
  switch (integer(0, 3)) {
    case 0: add(surface, scene::HalfPlane{place, across}, other); break;
    case 1: add(surface, scene::Polygon{{place, place + along, place + across}, false}, other); break;
    case 2: add(surface, scene::Polygon{{place - along, place + across, place + along}, false}, other); break;
    default: break;
  }
  Case result{sphere_on(surface)};
  scene::Scene& scene = result.scene;
  const double k = scene.sphere.gyration_radius / scene.sphere.radius;
  const double kappa = k * k / (1 + k * k);
  const double pulls[] = {friction, resistance, friction / kappa,
                          (friction - (1 - kappa) * resistance) / kappa};
  const Vector2d down = across.normalized();
  const double weight = 8;
  scene.forces.gravity << pulls[integer(0, 3)] * weight * (chance(2) ? down : Vector2d(-down)), -weight;
  scene.forces.wrench = {};
  scene.initial_state.position = place;
  scene.initial_state.velocity = chance(3) ? Vector2d(integer(-4, 4) / 2.0 * down) : Vector2d(0, 0);
  const Vector2d nu = integer(-4, 4) / 2.0 * down;
  scene.initial_state.angular_velocity.head<2>() = Vector2d(-nu.y(), nu.x()) / scene.sphere.radius;
  if (chance(2)) scene.forces.spring = {place, integer(1, 8) / 4.0};
  return result;
}

namespace {

/// As people write numbers.
double tenths(int size) { return integer(-size, size) / 10.0; }

Material any_friction() {
  Material result(chance(3) ? Law::rough : Law::coulomb);
  if (result.law == Law::coulomb) result.friction = integer(1, 20) / 50.0;
  return result;
}

}  // namespace

// A slope that drives the sphere, along one line, to a belt that throws it back ever less.
Case throws_case() {
  const Vector2d directions[] = {{1, 0}, {0, 1}, {1, 1}, {0.6, 0.8}, {1, -1}};
  const Vector2d down = directions[integer(0, 4)];
  const Vector2d normals[] = {down, {1, 0}, {2, -1}, {1, 0.2}};
  Vector2d normal = normals[integer(0, 3)];
  if (!(normal.dot(down) > 0)) normal = down;
  const Vector2d place = chance(3) ? Vector2d(0, 0) : Vector2d(tenths(10), tenths(10));
  Material belt = any_friction();
  belt.belt = -integer(1, 20) / 10.0 * down;
  scene::Surface surface;
  surface.base = chance(4) ? Material(Law::smooth) : any_friction();
  add(surface, scene::HalfPlane{place, normal}, belt);
  Case result{sphere_on(surface)};
  scene::Scene& scene = result.scene;
  scene.initial_state.position = place - integer(1, 5) / 10.0 * down;
  scene.initial_state.velocity = chance(2) ? Vector2d(0, 0) : Vector2d(0.5 * down);
  scene.initial_state.angular_velocity.setZero();
  scene.forces = {};
  scene.forces.gravity << integer(1, 5) / 10.0 * down, -9.81;
  return result;
}

// A path that is, or becomes, one along an edge, by numbers as people write them.
Case along_case() {
  const Vector2d directions[] = {{1, 0}, {0, -1}, {1, 1}, {-1, 1}};
  const Vector2d along = directions[integer(0, 3)];
  const Vector2d normal(-along.y(), along.x());
  const Vector2d place = chance(3) ? Vector2d(0, 0) : Vector2d(tenths(20), tenths(20));
  scene::Surface surface;
  surface.base = chance(2) ? Material(Law::smooth) : any_friction();
  Material ground = chance(4) ? any_material() : any_friction();
  if (chance(2)) ground.belt = {tenths(12), tenths(12)};
  const Vector2d corner = place + integer(0, 9) / 10.0 * along;
  switch (integer(0, 2)) {
    case 0: add(surface, scene::HalfPlane{corner, normal}, ground); break;
    case 1: add(surface, scene::Polygon{{corner, corner + along, corner + normal}, false}, ground); break;
    default:
      add(surface, scene::Polygon{{corner, corner + along, corner + normal}, false}, ground);
      add(surface, scene::Polygon{{corner, corner - normal, corner + along}, false}, any_friction());
  }
  Case result{sphere_on(surface)};
  scene::Scene& scene = result.scene;
  scene.initial_state.position = place;
  scene.initial_state.velocity = integer(1, 20) / 10.0 * along;
  scene.initial_state.angular_velocity = {tenths(90), tenths(90), 0};
  scene.forces = {};
  scene.forces.gravity.z() = -9.81;
  return result;
}

// Dry friction beside quadratic drag on ground that hardly moves, and a sphere that goes with it.
Case creep_case() {
  Case result = friction_case();
  scene::Scene& scene = result.scene;
  const double small = std::pow(10.0, -integer(1, 50));
  Material& ground = scene.surface.base;
  ground.belt = small * vector(8, 8);
  ground.turntable_rate = chance(3) ? small * integer(-8, 8) / 8.0 : 0;
  if (chance(2)) scene.forces.drag.quadratic = integer(1, 16) / 8.0;
  if (chance(3)) return result;
  scene.initial_state.velocity = ground.belt;
  scene.initial_state.angular_velocity.head<2>().setZero();
  return result;
}

}  // namespace hybrid_sphere::fuzz

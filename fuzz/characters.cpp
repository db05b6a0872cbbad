#include "characters.hpp"

#include <algorithm>
#include <cmath>

#include "chance.hpp"
#include "character_parts.hpp"
#include "support/random_scenes.hpp"
#include "support/transformed.hpp"

namespace hybrid_sphere::fuzz {
namespace {

using scene::Law;
using scene::Material;
using testing::integer;

Material still(Material material) {
  material.belt.setZero();
  material.turntable_rate = 0;
  return material;
}

// Square cells; each axis has a pitch of its own, and not every cell is there.
scene::Surface lattice(double pitch, bool moving) {
  scene::Surface surface;
  std::vector<Material> grounds;
  for (int i = 0; i < 3; ++i) grounds.push_back(moving ? any_material() : still(any_material()));
  surface.base = grounds[0];
  const int size = integer(1, 3);
  for (int y = -size; y <= size; ++y) {
    for (int x = -size; x <= size; ++x) {
      const int kind = integer(0, 3);
      if (kind == 3) continue;
      const Vector2d low = pitch * Vector2d(x, y);
      const Vector2d high = pitch * Vector2d(x + 1, y + 1);
      add(surface, box(low, high), grounds[static_cast<std::size_t>(kind)]);
    }
  }
  if (chance(3)) surface.livelock = scene::Livelock::stop;
  return surface;
}

double random_pitch() { return chance(2) ? std::ldexp(1.0, integer(-2, 2)) : integer(1, 30) / 10.0; }

Case lattice_case() {
  Case result{sphere_on(lattice(random_pitch(), true))};
  scene::Forces& forces = result.scene.forces;
  if (chance(2)) forces.gravity.head<2>() = vector(8, 4);
  if (chance(3)) forces.spring = {vector(8, 2), integer(1, 16) / 4.0};
  if (chance(3)) forces.drag.translational = integer(1, 8) / 8.0;
  return result;
}

// Everything that moves the sphere is along a line of the lattice, or across it.
Case grid_line_case() {
  const double pitch = random_pitch();
  Case result{sphere_on(lattice(pitch, false))};
  scene::Scene& scene = result.scene;
  const double line = pitch * integer(-3, 3);
  scene.initial_state.position = {pitch * integer(-8, 8) / 2, line};
  const auto along = [](int size, double denominator) {
    return Vector2d(integer(-size, size) / denominator, 0);
  };
  scene.initial_state.velocity = along(8, 4);
  const double w2 = integer(-32, 32) / 8.0;
  scene.initial_state.angular_velocity = {0, w2, chance(2) ? 0 : integer(-8, 8) / 4.0};
  scene.forces.gravity.head<2>() = along(8, 4);
  scene.forces.wrench = {};
  if (scene.forces.spring.stiffness != 0) scene.forces.spring.center = {integer(-8, 8) / 2.0, line};
  if (chance(2)) result = {testing::quarter_turn().of(scene), result.duration};
  return result;
}

// Regions that share sides and corners round a point; the sphere aims at it, or along a side.
Case shared_case() {
  scene::Surface surface;
  surface.base = any_material();
  const Vector2d center = vector(4, 1);
  const int count = integer(2, 6);
  std::vector<Vector2d> spokes;
  for (int i = 0; i < 8; ++i) {
    const double x[] = {1, 1, 0, -1, -1, -1, 0, 1};
    const double y[] = {0, 1, 1, 1, 0, -1, -1, -1};
    spokes.push_back(integer(1, 4) * Vector2d(x[i], y[i]));
  }
  for (int i = 0; i < count; ++i) {
    const auto first = static_cast<std::size_t>(integer(0, 7));
    const Vector2d& a = spokes[first];
    const Vector2d& b = spokes[(first + 1 + static_cast<std::size_t>(integer(0, 1))) % 8];
    if (a.x() * b.y() - a.y() * b.x() > 0)
      add(surface, scene::Polygon{{center, center + a, center + b}, chance(6)}, any_material());
  }
  if (chance(2)) add(surface, scene::HalfPlane{center, testing::random_direction()}, any_material());
  if (chance(3)) add(surface, scene::Circle{center + Vector2d(1, 0), 1, false}, any_material());
  Case result{sphere_on(surface)};
  scene::InitialState& start = result.scene.initial_state;
  const Vector2d spoke = spokes[static_cast<std::size_t>(integer(0, 7))];
  start.position = center + spoke * integer(-2, 2);
  start.velocity = chance(4) ? vector(8, 4) : Vector2d(-spoke * integer(-4, 4) / 4.0);
  return result;
}

// Two belts that run against each other along a line, and what lies on or under it.
Case edge_slide_case() {
  scene::Surface surface;
  const Vector2d direction = testing::random_direction();
  const Vector2d normal(-direction.y(), direction.x());
  const Vector2d point = vector(4, 2);
  if (chance(2))
    add(surface, scene::Circle{point + direction, static_cast<double>(integer(1, 3)), false}, any_material());
  Material away(chance(4) ? Law::rubber : Law::rough);
  Material towards(Law::rough);
  away.belt = -normal * integer(1, 4) / 2.0 + direction * integer(-4, 4) / 4.0;
  towards.belt = normal * integer(1, 4) / 2.0 + direction * integer(-4, 4) / 4.0;
  surface.base = towards;
  add(surface, scene::HalfPlane{point, normal}, away);
  for (int i = integer(0, 2); i > 0; --i) {
    const Vector2d corner = point + direction * integer(1, 4);
    const Vector2d size(integer(1, 3), integer(1, 3));
    add(surface, box(corner - size / 2, corner + size / 2), chance(3) ? towards : any_material());
    if (chance(2)) std::swap(surface.regions[0], surface.regions.back());
  }
  Case result{sphere_on(surface)};
  result.scene.forces.drag = {};
  result.scene.forces.spring = {};
  result.scene.initial_state.position = point + normal * integer(-4, 4) / 2.0;
  result.scene.initial_state.velocity = direction * integer(-4, 4) / 2.0 + normal * integer(-2, 2) / 2.0;
  return result;
}

// Straight paths that touch circles, parabolas whose vertex touches a line, discs on a spring's ring.
Case tangent_case() {
  scene::Surface surface;
  surface.base = any_material();
  const double line = integer(-4, 4) / 2.0;
  for (int i = integer(1, 4); i > 0; --i) {
    const double radius = integer(1, 8) / 4.0;
    add(surface,
        scene::Circle{{integer(-8, 8) / 2.0, line + (chance(2) ? radius : -radius)}, radius, chance(6)},
        any_material());
  }
  Case result{sphere_on(surface)};
  scene::Scene& scene = result.scene;
  scene.initial_state.position = {integer(-8, 8) / 2.0, line};
  scene.initial_state.velocity = {integer(-8, 8) / 2.0, 0};
  if (chance(2)) {
    const double climb = integer(1, 4);
    const double fall = integer(1, 4);
    scene.initial_state.velocity.y() = climb;
    scene.forces.gravity.head<2>() = Vector2d(0, -fall);
    add(scene.surface, scene::HalfPlane{{0, line + climb * climb / (2 * fall)}, {0, 1}}, any_material());
  }
  return result;
}

// Strips and triangles down to a rounding of their place.
Case sliver_case() {
  scene::Surface surface;
  surface.base = any_material();
  for (int i = integer(1, 6); i > 0; --i) {
    const Vector2d corner = vector(8, 2);
    const Vector2d side = testing::random_direction();
    const double width = std::ldexp(1.0, -integer(1, 44));
    const Vector2d off = width * Vector2d(-side.y(), side.x());
    if (chance(2)) {
      add(surface, scene::Polygon{{corner, corner + side, corner + side / 2 + off}, chance(6)},
          any_material());
    } else {
      add(surface, scene::Polygon{{corner, corner + side, corner + side + off, corner + off}, chance(6)},
          any_material());
    }
  }
  return {sphere_on(surface)};
}

// The ordinary numbers in other units of length, time and mass.
Case decades_case() {
  Case result{testing::random_any_scene()};
  const auto decade = [] { return std::pow(10.0, integer(-6, 6)); };
  const testing::Units units{decade(), decade(), decade()};
  result.scene = testing::in_units(result.scene, units);
  result.duration *= units.time;
  return result;
}

// Belts in the tip of a wedge, and a disc in ground that turns: throws that accumulate.
Case wedge_case() {
  scene::Surface surface;
  const auto belt = [](const Vector2d& u) {
    Material material(chance(4) ? Law::coulomb : Law::rough);
    if (material.law == Law::coulomb) material.friction = integer(1, 16) / 16.0;
    material.belt = u;
    return material;
  };
  if (chance(3)) {
    surface.base = Material(Law::rough);
    surface.base.turntable_rate = integer(1, 8) / 2.0 * (chance(2) ? 1 : -1);
    add(surface, scene::Circle{{0, 0}, integer(2, 8) / 2.0, false}, Law::smooth);
  } else {
    const Vector2d up(integer(-4, 4), integer(1, 4));
    const Vector2d down(integer(-4, 4), -integer(1, 4));
    add(surface, scene::HalfPlane{{0, 0}, up}, belt(vector(8, 4) - up / 2));
    add(surface, scene::HalfPlane{{0, 0}, down}, belt(vector(8, 4) - down / 2));
  }
  if (chance(3)) surface.livelock = scene::Livelock::stop;
  return {sphere_on(surface)};
}

/// Teeth along a line, which cuts them once up and once down each.
scene::Polygon comb(int teeth, double width, const Vector2d& place, const Vector2d& along) {
  const Vector2d up(-along.y(), along.x());
  const auto corner = [&](double x, double y) { return Vector2d(place + width * x * along + y * up); };
  scene::Polygon polygon{{corner(0, -1), corner(teeth, -1)}};
  for (int i = teeth; i-- > 0;) {
    polygon.vertices.push_back(corner(i + 0.5, 1));
    polygon.vertices.push_back(corner(i, -0.5));
  }
  return polygon;
}

// A thousand corners, or hundreds of sides exactly on one line, in the way of the sphere.
Case comb_case() {
  scene::Surface surface;
  surface.base = any_material();
  const Vector2d along = testing::random_direction();
  const Vector2d place = vector(4, 1);
  const int teeth = 1 << integer(0, 9);
  const double length = integer(1, 16) / 2.0;
  if (chance(3)) {
    const Vector2d far = length * along;
    const Vector2d side(-along.y(), along.x());
    for (int i = 1 << integer(0, 9); i > 0; --i) {
      const double width = 1 + integer(0, 64) / 64.0;
      add(surface, scene::Polygon{{place - width * side, place + far, place + width * side}, false},
          any_material());
    }
  } else {
    add(surface, comb(teeth, length / teeth, place, along), any_material());
  }
  Case result{sphere_on(surface)};
  scene::InitialState& start = result.scene.initial_state;
  start.position = place - along * integer(-1, 4) / 2.0;
  start.velocity = integer(1, 8) / 2.0 * along;
  if (chance(2)) start.velocity += vector(8, 64);
  result.duration = integer(1, 8);
  return result;
}

}  // namespace

const std::vector<Character>& characters() {
  static const std::vector<Character> all = {
      {"grid", "shapes on a coarse grid, every law and force",
       [] { return Case{testing::random_any_scene()}; }},
      {"off_grid", "the same, the start moved off the grid",
       [] { return Case{testing::off_grid(testing::random_any_scene())}; }},
      {"lattice", "square cells with slopes, springs and drag", lattice_case},
      {"grid_line", "paths on the lines of a lattice", grid_line_case},
      {"shared", "sides and corners that regions share", shared_case},
      {"edge_slide", "belts against each other, with hidden edges", edge_slide_case},
      {"tangent", "paths that touch edges", tangent_case},
      {"sliver", "strips and triangles down to a rounding", sliver_case},
      {"decades", "ordinary scenes in other units", decades_case},
      {"wedge", "throws that accumulate", wedge_case},
      {"friction", "dry friction and resistances on ground that moves", friction_case},
      {"balance", "slopes that pull as much as friction holds, on edges", balance_case},
      {"comb", "a thousand corners, or hundreds of sides on one line", comb_case},
      {"throws", "one-dimensional throws that end, by decimals", throws_case},
      {"along", "paths along edges, by decimals", along_case},
      {"creep", "dry friction beside drag on ground that hardly moves", creep_case}};
  return all;
}

Case make_case(const Character& character) {
  Case result = character.make();
  // Where forces just balance, their rounding decides what becomes of a velocity of 1e-15 m/s.
  if (character.make != balance_case && chance(16)) {
    const double small = std::pow(10.0, -integer(1, 50));
    result.scene.initial_state.velocity *= small;
    if (chance(2)) result.scene.initial_state.angular_velocity.head<2>() *= small;
  }
  // A scene file has one of the two.
  const auto with_one_velocity = [](Material& material) {
    if (material.turntable_rate != 0) material.belt.setZero();
  };
  with_one_velocity(result.scene.surface.base);
  for (scene::Region& region : result.scene.surface.regions) with_one_velocity(region.material);
  scene::Solver& solver = result.scene.solver;
  if (chance(3)) {
    solver.method = scene::method_names[static_cast<std::size_t>(integer(0, 12))].method;
    const double scale = result.duration / 8;
    solver.step = scale / (chance(2) ? 64 : 8);
  }
  if (chance(3)) solver.accuracy = std::pow(10.0, -integer(2, 13));
  return result;
}

}  // namespace hybrid_sphere::fuzz

#pragma once

#include <string>
#include <vector>

#include "hybrid_sphere/scene/scene.hpp"
#include "hybrid_sphere/simulation/records.hpp"

/// A sphere that stays on one straight line, on a map of tiles whose edges lie along the line and across it:
/// the reference for paths along edges. The rules of docs/theory.md 5.2 on intervals of the line, whose ends
/// are exact, and the motion between them in extended precision; without any code of the library.
namespace hybrid_sphere::testing {

/// All that lies at a <= s <= b and low <= q <= high, q across the line, which is q = 0.
struct Tile {
  double a;
  double b;
  double low;
  double high;
  scene::Law law = scene::Law::smooth;
  double friction = 0;
  double belt = 0;         ///< along the line
  double belt_across = 0;  ///< takes the sphere off the line: nothing is told from there on
};

struct LineScene {
  scene::SphereBody sphere{1, 0.25, 0.125};
  double place = 0;     ///< s at the start
  double velocity = 0;  ///< along the line
  double rolling = 0;   ///< R omega, so that the slip is velocity - rolling
  double spin = 0;      ///< about the normal
  double pull = 0;      ///< force over mass, along the line
  double drag = 0;      ///< c/m
  double spring = 0;    ///< K/m
  double spring_center = 0;
  double gravity = 8;
  double resolution = 0;  ///< slips on coulomb ground that are less than this may be told from 0 or not
  Tile base{0, 0, 0, 0};
  std::vector<Tile> tiles;  ///< later ones on top; named "0", "1" ...

  /// The same in a plane. Lengths along the line and across it are counted in abs(direction) metres.
  scene::Scene in_plane(const Vector2d& direction) const;
};

struct LineSwitch {
  double time;
  double place;
  SwitchKind kind;
  std::string from;
  std::string to;
};

struct LineCourse {
  std::vector<LineSwitch> switches;
  double told_until;     ///< later on nothing is told: a livelock, a tie that only rounding decides ...
  std::string end = {};  ///< and why
};

/// @param unit   length of one unit of s [m]: abs(direction)
/// @param until  [s]
LineCourse course_of(const LineScene& scene, double unit, double until);

}  // namespace hybrid_sphere::testing

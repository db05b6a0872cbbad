#pragma once

#include <array>
#include <cfloat>
#include <functional>
#include <optional>
#include <string>

#include "support/recorded.hpp"
#include "verdict.hpp"

/// Runs that ought to be the same, and what of them hangs on rounding.
namespace hybrid_sphere::fuzz {

constexpr int compared_outputs = 16;
constexpr double shift = 1e-9;                 ///< relative, of a neighbouring scene
constexpr double rounding = 64 * DBL_EPSILON;  ///< relative, of a place

/// A claim that does not hold.
struct Broken {
  const char* claim;
  std::string words;
};
using Found = std::optional<Broken>;
/// When, by how much and how much is allowed [s, m, m].
std::string off_at(double time, double error, double allowed);

/// The run, and how far neighbouring scenes come off it: what hangs on less says nothing.
struct Plain {
  const Case& a_case;
  testing::Record record;
  std::array<testing::Record, 2> beside;
};

/// What is related to a run takes as long as that, or a little longer [s of processor time].
constexpr double patience = 2;
/// Interrupted after so long [s of processor time].
testing::Record run_for(double seconds, const scene::Scene& scene, double duration);
inline testing::Record run(const scene::Scene& scene, double duration) {
  return run_for(4 * patience, scene, duration);
}
Plain plain_run(const Case& a_case, double seconds);

/// The scene with its velocities and forces in the plane a little larger or smaller: what is on a line of the
/// axes stays there, and what just balances friction does so no longer.
scene::Scene neighbour(scene::Scene scene, double part);

bool same_switches(const testing::Record& a, const testing::Record& b);
/// Whether a run throws the sphere to and fro ever sooner up to an instant, and goes on.
bool accumulates_before(double instant, const testing::Record& record, double span);
/// Length of the path [m].
double way_of(const testing::Record& record);

using Place = std::function<Vector2d(const testing::RecordedState&)>;
/// Compares places with those that follow from the plain run.
/// @param extra  allowed beside the accuracy and what the neighbours come off [m]
Found compare(const Plain& plain, const testing::Record& other, const char* claim, const Place& place,
              double extra = 0);

/// From the edge of a region and from the lines of its sides [m].
double distance_to_lines(const scene::Shape& shape, const Vector2d& point);
/// What the rounding of a place hides where the sphere starts beside an edge, or slowly, or a region is
/// hardly wider than that [m]: a way r is left a time sqrt(2 r/a) later, at a speed of sqrt(2 r a). 0
/// otherwise.
double way_hidden_by_rounding(const Plain& plain);
/// Whether a scene begins on an edge, so slowly that the first way that forces leave it is within the
/// rounding of the place: on which side it goes on is told in some units, places and orders of corners, and
/// not in others.
bool is_lost_on_an_edge(const scene::Scene& scene);
/// Whether a switch finds the sphere in its place on an edge, without a velocity, as where friction just
/// balances a slope until the slip is used up: on which side it goes on is told by rounding.
bool stands_on_an_edge(const Plain& plain);
/// The largest distance from the origin, of the start and of what has a place on the map [m].
double size_of_places(const scene::Scene& scene);
/// Whether a velocity with which a scene begins makes less than the rounding of a place, and is thus none
/// there.
/// @param size  of the place [m]
bool is_less_than_rounding(const Case& a_case, double size);

}  // namespace hybrid_sphere::fuzz

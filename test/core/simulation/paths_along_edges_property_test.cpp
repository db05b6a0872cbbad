// Accelerated paths on the grid lines of tiled maps, against a reference on the line alone.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <random>
#include <sstream>
#include <utility>

#include "support/line_reference.hpp"
#include "support/print_scene.hpp"
#include "support/recorded.hpp"
#include "support/transformed.hpp"

namespace hybrid_sphere::testing::paths_along_edges_property_test {
namespace {

using scene::Law;

class Generator {
 public:
  explicit Generator(unsigned seed) : random_(seed) {}

  int integer(int low, int high) { return std::uniform_int_distribution<int>(low, high)(random_); }
  bool chance(int percent) { return integer(1, 100) <= percent; }
  template <class T, std::size_t n>
  T one_of(const T (&values)[n]) {
    return values[integer(0, static_cast<int>(n) - 1)];
  }

  Tile tile() {
    const double a = 0.5 * integer(-6, 8);
    const double ranges[][2] = {{0, 1}, {-1, 0}, {-1, 1}, {0, 2}, {-2, 0}};
    const auto& [low, high] = ranges[integer(0, 4)];
    Tile result{a, a + 0.5 * integer(1, 5), low, high};
    give_law(result);
    return result;
  }

  void give_law(Tile& tile) {
    tile.law = one_of({Law::smooth, Law::smooth, Law::rough, Law::rough, Law::rubber, Law::coulomb});
    if (tile.law == Law::coulomb) tile.friction = one_of({0.0, 0.03125, 0.125, 0.5});
    if (tile.law != Law::smooth && chance(25)) tile.belt = 0.25 * integer(-4, 4);
    if (tile.law != Law::smooth && chance(5)) tile.belt_across = 0.5;
  }

  LineScene scene() {
    LineScene result;
    result.sphere.mass = one_of({1.0, 2.0});
    result.sphere.gyration_radius = one_of({0.125, 0.15625, 0.1875});
    for (int i = integer(2, 9); i > 0; --i) result.tiles.push_back(tile());
    if (chance(30)) give_law(result.base);
    result.place = chance(50) ? 0.5 * integer(-6, 8) : 0.0625 * integer(-48, 64);
    result.velocity = chance(20) ? 0 : 0.25 * integer(-8, 8);
    result.rolling = chance(40) ? result.velocity : 0.25 * integer(-8, 8);
    result.spin = integer(-1, 1);
    result.pull = chance(80) ? 0.125 * integer(-8, 8) : 0;
    const bool coulomb = std::any_of(result.tiles.begin(), result.tiles.end(),
                                     [](const Tile& tile) { return tile.law == Law::coulomb; }) ||
                         result.base.law == Law::coulomb;
    if (!coulomb && chance(40)) result.drag = 0.125 * integer(1, 6);
    if (!coulomb && chance(40)) {
      result.spring = 0.125 * integer(2, 20);
      result.spring_center = 0.5 * integer(-4, 6);
    }
    return result;
  }

 private:
  std::mt19937 random_;
};

std::string told(const std::string& name, const std::string& from, const std::string& to, double time,
                 double place) {
  return name + " " + from + " -> " + to + " at t = " + std::to_string(time) +
         ", s = " + std::to_string(place);
}

/// What differs, or nothing.
std::string difference(const LineScene& line, const Vector2d& direction, scene::Solver::Method method) {
  const double until = 12;
  const double unit = direction.norm();
  const LineCourse expected = course_of(line, unit, until);
  scene::Scene scene = line.in_plane(direction);
  scene.solver.method = method;
  const double horizon = std::min(until, expected.told_until);
  const Record found = record(scene, horizon, 1);
  // An integration in steps of the accuracy 1e-9; closed forms and the reference are rounded.
  const double tolerance = method == scene::Solver::Method::automatic ? 1e-8 : 1e-5;
  const auto is_told = [&](double time) { return time < horizon - 100 * tolerance; };
  std::string text;
  std::size_t count = 0;
  for (; count < expected.switches.size() && is_told(expected.switches[count].time); ++count) {
    const LineSwitch& e = expected.switches[count];
    text = "expected " + told(to_string(e.kind), e.from, e.to, e.time, e.place) + "; ";
    if (count >= found.switches.size())
      return text + "found no more" + (found.halt.empty() ? "" : ": " + found.halt);
    const RecordedSwitch& f = found.switches[count];
    const double place = f.position.dot(direction) / direction.squaredNorm();
    const bool same = f.kind == e.kind && f.from == e.from && f.to == e.to &&
                      std::abs(f.time - e.time) <= tolerance * (1 + e.time) &&
                      std::abs(place - e.place) <= tolerance * 10;
    if (!same) return text + "found " + told(to_string(f.kind), f.from, f.to, f.time, place);
  }
  if (found.switches.size() > count && is_told(found.switches[count].time)) {
    const RecordedSwitch& f = found.switches[count];
    const bool next_told =
        count < expected.switches.size() && expected.switches[count].time <= f.time + 200 * tolerance;
    if (!next_told) {
      return "found more: " + told(to_string(f.kind), f.from, f.to, f.time,
                                   f.position.dot(direction) / direction.squaredNorm());
    }
  }
  return "";
}

int number_of_cases(int usual) {
  const char* asked = std::getenv("PATHS_ALONG_EDGES");
  return asked ? std::atoi(asked) : usual;
}

LineScene scene_of(unsigned seed, const Vector2d& direction, scene::Solver::Method method) {
  LineScene line = Generator(seed).scene();
  // A velocity along which nothing pulls is taken for what it is, rounded: no force keeps it on an oblique
  // line.
  const bool oblique = direction.x() != 0 && direction.y() != 0;
  if (oblique && line.spring == 0 && (line.drag == 0 || line.pull == 0)) line.pull = 0.5;
  if (method != scene::Solver::Method::automatic) line.resolution = 1e-6;
  return line;
}

void check(const Vector2d& direction, scene::Solver::Method method, unsigned seed, int usual) {
  const int cases = number_of_cases(usual);
  int wrong = 0;
  std::size_t switches = 0;
  for (int i = 0; i < cases; ++i) {
    const LineScene line = scene_of(seed + static_cast<unsigned>(i), direction, method);
    switches += course_of(line, direction.norm(), 12).switches.size();
    const std::string fault = difference(line, direction, method);
    if (fault.empty()) continue;
    ++wrong;
    if (wrong > 5) continue;
    std::ostringstream text;
    text << line.in_plane(direction);
    ADD_FAILURE() << "case " << seed + static_cast<unsigned>(i) << ": " << fault << "\n"
                  << text.str() << "\n"
                  << course_of(line, direction.norm(), 12).end;
  }
  EXPECT_EQ(wrong, 0) << "of " << cases;
  EXPECT_GT(switches, static_cast<std::size_t>(cases));
}

constexpr auto closed_forms = scene::Solver::Method::automatic;

TEST(AcceleratedPathsAlongEdges, MeetWhatTheRulesSayOnLinesAlongX) { check({1, 0}, closed_forms, 1, 150); }
TEST(AcceleratedPathsAlongEdges, MeetWhatTheRulesSayOnLinesAgainstY) {
  check({0, -1}, closed_forms, 100001, 100);
}
TEST(AcceleratedPathsAlongEdges, MeetWhatTheRulesSayOnObliqueLines) {
  check({3, 4}, closed_forms, 200001, 100);
}
// What is slow has the rounding of what was fast; what is near the origin that of places far from it.
TEST(AcceleratedPathsAlongEdges, StayOnAnObliqueLineAfterFasterOrFartherMotion) {
  const Vector2d direction(3, 4);
  for (const unsigned seed : {200660U, 200782U, 200875U, 200994U, 201066U, 201786U}) {
    EXPECT_EQ(difference(scene_of(seed, direction, closed_forms), direction, closed_forms), "") << seed;
  }
}
// A spring pulls it off the rounding of the place where it has come to rest, and over the corner to the side.
TEST(AcceleratedPathsAlongEdges, StayOnAnObliqueLineFromARestFarFromTheOrigin) {
  scene::Scene scene{};
  scene.sphere = {0.25, 0.125, 0.0859375};
  scene.initial_state.velocity = {-1.2480754415067656, 0.83205029433784372};
  scene.initial_state.angular_velocity = {8.8752031396036664, 13.3128047094055, 2};
  scene.forces.gravity = {1.6641005886756874, -1.1094003924504583, -8};
  scene.forces.spring.stiffness = 2;
  scene.surface.base = Law::coulomb;
  scene.surface.base.friction = 0.25;
  scene.surface.base.rolling_resistance = 0.03125;
  scene.surface.regions = {{"triangle", scene::Polygon{{{0, 0}, {2, 3}, {3, -2}}, false}, Law::smooth}};
  const double until = 8;
  const Record here = record(scene, until, 1);
  ASSERT_GT(here.switches.size(), 6U);
  for (const Vector2d& way : {Vector2d(-4, 8), Vector2d(16, 8), Vector2d(64, -32), Vector2d(512, 256)}) {
    const Record there = record(shifted(scene, way), until, 1);
    ASSERT_EQ(there.switches.size(), here.switches.size()) << way.transpose();
    for (std::size_t i = 0; i < here.switches.size(); ++i)
      EXPECT_NEAR((there.switches[i].position - way - here.switches[i].position).norm(), 0, 1e-9) << i;
  }
}
// Friction against the slip of a sphere that stands in a corner drives it along the side, to its rounding.
TEST(AcceleratedPathsAlongEdges, RunOnTheTopmostGroundFromARestThatFrictionEnds) {
  for (const Vector2d& along : {Vector2d(-3, 2), Vector2d(3, 4), Vector2d(5, -7), Vector2d(-1, -9)}) {
    for (const double turn : {-1.0, 1.0}) {
      scene::Scene scene{};
      scene.sphere = {0.25, 1, 0.5};
      scene.initial_state.position = {-1, -2};
      const Vector2d spin = 2 / along.norm() * Vector2d(-along.y(), along.x());
      scene.initial_state.angular_velocity = {spin.x(), spin.y(), -7};
      scene.forces.gravity.z() = -8;
      scene.surface.base = Law::coulomb;
      scene.surface.base.friction = 0.375;
      scene.surface.regions = {{"top", {}, Law::coulomb}};
      scene.surface.regions[0].material.friction = 0.21875;
      const Vector2d from = scene.initial_state.position;
      const Vector2d beside = from + turn * Vector2d(-along.y(), along.x());
      scene.surface.regions[0].shape = scene::Polygon{{from, from + along, beside}, false};
      for (const auto method : {closed_forms, scene::Solver::Method::dopri87}) {
        scene.solver.method = method;
        Simulation simulation(scene);
        simulation.advance_to(0.2, {});
        EXPECT_EQ(simulation.state().mode, Mode::sliding);
        EXPECT_EQ(simulation.state().region, "top") << along.transpose() << ", " << turn;
      }
    }
  }
}
// Sides by decimals are parallel to rounding: to the pull as well as to that of a region on top, which it is
// exactly parallel to.
TEST(AcceleratedPathsAlongEdges, RunOnTheTopmostGroundThatTheyAreExactlyAlong) {
  for (const bool is_under : {false, true}) {
    scene::Scene scene{};
    scene.sphere = {1, 1, std::sqrt(0.4)};
    scene.forces.gravity = {0.1, 0.3, -10};
    scene.surface.base = Law::coulomb;
    scene.surface.base.friction = 0.02;
    scene.surface.regions = {{"left", scene::Polygon{{{0, 0}, {0.3, 0.9}, {-1, 1}}, false}, Law::rough},
                             {"right", scene::Polygon{{{0, 0}, {0.1, 0.3}, {1, -1}}, false}, Law::smooth}};
    if (is_under) std::swap(scene.surface.regions[0], scene.surface.regions[1]);
    Simulation simulation(scene);
    simulation.advance_to(1, {});
    EXPECT_EQ(simulation.state().region, "right") << is_under;
    EXPECT_LT((simulation.state().position - Vector2d(0.05, 0.15)).norm(), 1e-15);
  }
}
// What is left of forces that cancel has a direction of its own.
TEST(AcceleratedPathsAlongEdges, AreNoneWhereForcesCancelButForAPullAcrossTheEdge) {
  scene::Scene scene{};
  scene.sphere = {1, 1, std::sqrt(0.4)};
  scene.forces.gravity = {-3145728 + 0x1p-28, -4194304 - 3 * 0x1p-30, -10};
  scene.forces.spring = {{0x1p20 * 3145728, 0x1p20 * 4194304}, 0x1p-20};
  scene.surface.regions = {
      {"along", scene::Polygon{{{-6, -8}, {6, 8}, {2, 11}, {-10, -5}}, false}, Law::smooth},
      {"across", scene::HalfPlane{{0.0016, -0.0012}, {4, -3}}, Law::rough}};
  const Record run = record(scene, 1500, 1);
  ASSERT_FALSE(run.switches.empty());
  EXPECT_EQ(run.switches[0].to, "across");
}
TEST(AcceleratedPathsAlongEdges, MeetWhatTheRulesSayWhereTheyAreIntegrated) {
  check({1, 0}, scene::Solver::Method::dopri87, 300001, 30);
}

}  // namespace
}  // namespace hybrid_sphere::testing::paths_along_edges_property_test

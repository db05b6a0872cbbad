// Where only rounding leads a sphere out of a ground, along its edge or in the limit of its throws, it stays
// there: docs/theory.md 5.2.

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "support/materials.hpp"
#include "support/recorded.hpp"
#include "support/transformed.hpp"

namespace hybrid_sphere::testing::rounded_exit_test {
namespace {

using scene::Law;
using Method = scene::Solver::Method;

constexpr Method methods[] = {Method::automatic, Method::dopri87, Method::cvode_bdf};

scene::SphereBody body(double radius, double gyration_squared) {
  return {1, radius, radius * std::sqrt(gyration_squared)};
}
const scene::SphereBody solid = body(0.1, 0.4);
const scene::SphereBody shell = body(0.1, 2. / 3);

scene::Material coulomb(double friction, const Vector2d& belt = {0, 0}) {
  scene::Material material(Law::coulomb);
  material.friction = friction;
  material.belt = belt;
  return material;
}

scene::Material rough(const Vector2d& belt) {
  scene::Material material(Law::rough);
  material.belt = belt;
  return material;
}

State end_of(const scene::Scene& scene, double duration) {
  Simulation simulation(scene);
  simulation.advance_to(duration, {});
  State state = simulation.state();
  state.region = {};
  return state;
}

// The velocity that is given lies along the edge; what is computed from slip and momentum need not. The
// friction of the belt draws the sphere into it, wherever the edge is.
TEST(RoundedExit, IsNoneAtAStartAlongTheEdgeOfABelt) {
  struct Start {
    Vector2d velocity;
    Vector3d omega;
    scene::Material base;
    scene::Material belt;
  };
  const std::vector<Start> starts = {{{1, 0}, {10, 0, 0}, Law::smooth, coulomb(0.1, {0, 1.2})},
                                     {{-0.5, 0}, {-8.2, 2.5, 0}, Law::rough, coulomb(0.05, {0.7, -0.4})},
                                     {{1, 0}, {-9, 7.4, 0}, coulomb(0.1), coulomb(0.1, {-0.7, 0.7})}};
  for (const Start& start : starts) {
    scene::Scene scene{};
    scene.sphere = shell;
    scene.initial_state.velocity = start.velocity;
    scene.initial_state.angular_velocity = start.omega;
    scene.surface.base = start.base;
    scene.surface.regions = {{"belt", scene::HalfPlane{{0, 0}, {0, 1}}, start.belt}};
    const State state = end_of(scene, 10);
    const State there = end_of(shifted(scene, {0, 0.5}), 10);
    EXPECT_LT((there.position - Vector2d(0, 0.5) - state.position).norm(), 1e-12);
    scene.solver.method = Method::dopri87;
    EXPECT_LT((end_of(scene, 10).position - state.position).norm(), 1e-8)
        << "ten times the accuracy asked for";
  }
}

/// A slope drives the sphere to a belt against it, which throws it back ever less, until t; from there on it
/// rolls down the slope on the belt, from rest.
struct Throws {
  const char* what;
  scene::Scene scene;
  double last;  // [s]
  Vector2d place;
};

std::vector<Throws> throws_that_end() {
  std::vector<Throws> list;
  const auto add = [&](const char* what, const scene::SphereBody& sphere, const Vector2d& start,
                       const Vector2d& velocity, const scene::Material& base, const scene::HalfPlane& edge,
                       const scene::Material& belt, const Vector2d& slope, double last,
                       const Vector2d& place) {
    scene::Scene scene{};
    scene.sphere = sphere;
    scene.initial_state.position = start;
    scene.initial_state.velocity = velocity;
    scene.surface.base = base;
    scene.surface.regions = {{"belt", edge, belt}};
    scene.forces.gravity = {slope.x(), slope.y(), -9.81};
    list.push_back({what, scene, last, place});
  };
  add("rough belt at the origin", shell, {-0.2, 0}, {0, 0}, coulomb(0.02), {{0, 0}, {1, 0}}, rough({-1.8, 0}),
      {0.2, 0}, 6, {0, 0});
  add("coulomb belt", shell, {0.2, 0}, {0, 0}, coulomb(0.05), {{0.3, 0}, {1, 0}}, coulomb(0.1, {-0.4, 0}),
      {0.1, 0}, 8. / 3, {0.3, 0});
  add("oblique belt", solid, {0, 1.2}, {0, 0}, coulomb(0.5), {{0.6, 0.8}, {1, 1}}, rough({-1.4, -1.4}),
      {0.5, 0.5}, 1.12, {0.1, 1.3});
  add("oblique throws", solid, {0.2, 0.6}, {0.5, 0.5}, coulomb(0.05), {{0.5, 0}, {1, 0}}, rough({-1.6, -1.6}),
      {0.2, 0.2}, 0.7, {0.5, 0.9});
  const scene::SphereBody other = body(0.25, 0.47265625);
  add("a belt that just stops the sphere", other, {-0.3, -0.4}, {0.3, 0.4}, Law::rough, {{0, 0}, {1, 0.2}},
      rough({-0.96, -1.28}), {0.12, 0.16}, 1.28125, {0, 0});
  add("coulomb on both sides", other, {-0.18, -0.24}, {0, 0}, coulomb(0.34), {{0, 0}, {0.6, 0.8}},
      coulomb(0.32, {-0.72, -0.96}), {0.12, 0.16}, 2.8359375, {0, 0});
  add("coulomb on both sides, along a seam", body(0.875, 0.5625), {-0.18, -0.24}, {0, 0}, coulomb(0.28),
      {{0, 0}, {2, -1}}, coulomb(0.2, {-0.72, -0.96}), {0.12, 0.16}, 3.375, {0, 0});
  return list;
}

void expect_no_exit(Throws throws, Method method, const Vector2d& shift) {
  const scene::SphereBody& sphere = throws.scene.sphere;
  const double inertia = 1 + std::pow(sphere.gyration_radius / sphere.radius, 2);
  const double rolled = 10 - throws.last;
  const Vector2d acceleration = throws.scene.forces.gravity.head<2>() / inertia;
  throws.scene.solver.method = method;
  const State state = end_of(shifted(throws.scene, shift), 10);
  const Vector2d place = throws.place + shift + 0.5 * rolled * rolled * acceleration;
  EXPECT_LT((state.twist.velocity - rolled * acceleration).norm(), 1e-7) << throws.what;
  EXPECT_LT((state.position - place).norm(), 1e-6)
      << throws.what << ": a throw that is left out lasts 1e-7 s";
}

TEST(RoundedExit, IsNoneInTheLimitOfThrows) {
  for (const Throws& throws : throws_that_end()) {
    for (const Method method : {Method::automatic, Method::dopri87}) {
      for (const Vector2d& shift : {Vector2d(0, 0), Vector2d(-4, 8), Vector2d(64, 32)}) {
        expect_no_exit(throws, method, shift);
      }
    }
  }
}

// Takes 1500 evaluations a throw, and starts with the first order again after each. Far from the origin,
// where the throws are lost in rounding soonest.
TEST(RoundedExit, IsNoneInTheLimitOfThrowsByAnImplicitMethod) {
  for (const Throws& throws : throws_that_end()) expect_no_exit(throws, Method::cvode_bdf, {64, 32});
}

// A slope against a belt, both so slow that their speeds are less than what a fall through the rounding of a
// place gives: a livelock as at any speed.
TEST(RoundedExit, IsNoWayOutOfALivelock) {
  for (const double speed : {1.0, 1e-6, 1e-8}) {
    for (const Law law : {Law::rough, Law::rubber}) {
      scene::Scene scene{};
      scene.sphere = body(0.25, 0.4);
      scene.initial_state.position = {7, 0};
      scene.initial_state.velocity = {0.25 * speed, 0};
      scene.initial_state.angular_velocity = {0, speed, 0};
      scene.forces.gravity = {0.1 * speed * speed, 0, -9.81};
      scene.surface.base = Law::rough;
      scene.surface.livelock = scene::Livelock::stop;
      scene::Material belt(law);
      belt.belt = {-2 * speed, 0};
      scene.surface.regions = {{"belt", scene::HalfPlane{{8, 0}, {1, 0}}, belt}};
      Simulation simulation(scene);
      EXPECT_THROW(simulation.advance_to(10 / speed, {}), HaltedError) << speed;
      EXPECT_NEAR(simulation.time() * speed, 2.84429, 1e-4);
    }
  }
}

// A resistance of the other ground slows down what the throws use up, eight times as long as without it, and
// turns with the sphere. How many throws rounding tells apart differs from place to place.
TEST(RoundedExit, OfThrowsIsFarAwayWhatItIsAtTheOrigin) {
  scene::Scene scene{};
  scene.sphere = body(0.75, 0.390625);
  scene.initial_state.angular_velocity = {-1.25, -0.5, 2.625};
  scene.forces.gravity = {-0.0625, 0.1875, -8};
  scene.surface.base = coulomb(0.09375);
  scene.surface.base.rolling_resistance = 0.0234375;
  scene::Material belt(Law::rubber);
  belt.belt = {-0.75, -1.5};
  scene.surface.regions = {{"belt", scene::HalfPlane{{0, 0}, {-1, 3}}, belt}};
  const Vector2d velocity = end_of(scene, 8).twist.velocity;
  for (const Method method : methods) {
    scene.solver.method = method;
    for (const Vector2d& shift : {Vector2d(-4, 8), Vector2d(64, -32)})
      EXPECT_LT((end_of(shifted(scene, shift), 8).twist.velocity - velocity).norm(), 2e-8);
  }
}

// The friction of the disc pushes the sphere out, on the turntable it rolls away once its throws have used up
// the slip: they come off the edge by less and less.
TEST(RoundedExit, OfThrowsByFrictionIsTakenOffACircle) {
  scene::Scene scene{};
  scene.sphere = {0.5, 0.5, 0.3125};
  scene.initial_state.position = {-0.626902, 2.336717};
  scene.initial_state.velocity = {-0.10427, 0.143387};
  scene.initial_state.angular_velocity = {10.425297, -3.515988, -3.5};
  scene.forces.gravity = {-0.75, -0.75, -8};
  scene.forces.wrench.force = {0.3125, 0.1875};
  scene.forces.drag.translational = 0.25;
  scene.surface.base = coulomb(0.25);
  scene.surface.base.turntable_rate = 1;
  scene.surface.base.turntable_center = {-6, 4};
  scene.surface.regions = {{"disc", scene::Circle{{1, 3.5}, 2, false}, coulomb(0.34375, {-0.75, 1.5})}};
  const Vector2d place(-0.7567745425, 2.3256650952);
  for (const Method method : methods) {
    scene.solver.method = method;
    for (const Vector2d& way : {Vector2d(0, 0), Vector2d(-4, 8), Vector2d(3, -7), Vector2d(512, 256)}) {
      scene::Scene there = shifted(scene, way);
      EXPECT_LT((end_of(there, 1).position - way - place).norm(), 2e-6) << way.transpose();
    }
  }
}

// The momentum that the table conserves leads along its edge: on the ground outside the sphere rolls along
// it.
TEST(RoundedExit, IsNoneAlongTheEdgeOfATurntable) {
  scene::Scene scene{};
  scene.sphere = solid;
  scene.initial_state.position = {-0.6, 1.2};
  scene.initial_state.velocity = {2.5, 0};
  scene::Material table(Law::rough);
  table.turntable_rate = 3.8;
  table.turntable_center = {0.4, 0.2};
  scene.surface.base = Law::rough;
  scene.surface.regions = {{"table", scene::HalfPlane{{0, 1}, {0, 1}}, table}};
  for (const Method method : methods) {
    scene.solver.method = method;
    const State state = end_of(scene, 10);
    EXPECT_LT((state.twist.velocity - Vector2d(2.5 / 1.4, 0)).norm(), 1e-8);
    EXPECT_NEAR(state.position.y(), 1, 1e-8);
  }
}

// The friction of the region pushes out of it: the sphere goes on along its side, on the ice.
TEST(RoundedExit, IsNoneAlongAnObliqueSide) {
  scene::Scene scene{};
  scene.sphere = solid;
  scene.initial_state.position = {1.8, 0.4};
  scene.initial_state.velocity = {1.6, 1.6};
  scene.initial_state.angular_velocity = {3.2, 1.7, 0};
  scene.surface.regions = {
      {"felt", scene::Polygon{{{2.7, 1.3}, {3.7, 2.3}, {2.7, 2.3}}, false}, coulomb(0.3)}};
  for (const Method method : methods) {
    scene.solver.method = method;
    const State state = end_of(scene, 10);
    EXPECT_LT((state.twist.velocity - Vector2d(1.6, 1.6)).norm(), 1e-14);
  }
}

// Along the diagonal between two triangles, one of which pushes the sphere out and the other does not.
TEST(RoundedExit, IsNoneFromTheGroundThatDoesNotPushOut) {
  scene::Scene scene{};
  scene.sphere = body(0.11, 0.4);
  scene.initial_state.position = {1.8, 1.0};
  scene.initial_state.velocity = {-2, -2};
  const auto polygon = [](const std::vector<Vector2d>& corners) { return scene::Polygon{corners, false}; };
  scene.surface.regions = {{"still", polygon({{0.6, -0.2}, {1.2, -0.2}, {1.2, 0.4}}), coulomb(0.3)},
                           {"moving", polygon({{1.2, 0.4}, {0.6, 0.4}, {0.6, -0.2}}), coulomb(0.2, {0.8, 0})},
                           {"ice", polygon({{1.2, -0.2}, {1.8, -0.2}, {1.8, 0.4}, {1.2, 0.4}}), Law::smooth},
                           {"polished", polygon({{1.2, 0.4}, {1.8, 0.4}, {1.8, 1.0}}), coulomb(0.02)}};
  for (const Method method : methods) {
    scene.solver.method = method;
    const State state = end_of(scene, 10);
    EXPECT_LT((state.twist.velocity - Vector2d(-2 / 1.4, -2 / 1.4)).norm(), 1e-9) << "rolling, as everywhere";
  }
}

// A belt throws the sphere back along the seam between ice and a belt that draws it away: it is on the ice.
TEST(RoundedExit, IsToldFromOneOverAnotherSide) {
  scene::Scene scene{};
  scene.sphere = solid;
  scene.initial_state.position = {0, -1};
  scene.initial_state.velocity = {0, 1};
  scene.surface.regions = {{"seam", scene::HalfPlane{{0, 0}, {1, 0}}, coulomb(0.1, {-3, 0})},
                           {"belt", scene::HalfPlane{{0, 0}, {0, 1}}, rough({0, -5})}};
  for (const Method method : methods) {
    scene.solver.method = method;
    const State state = end_of(scene, 3);
    EXPECT_EQ(state.position.x(), 0);
    EXPECT_LT((state.twist.velocity - Vector2d(0, (5. - 2 * 5) / 7)).norm(), 1e-14) << "p_c + kappa u";
  }
}

// As the felt above, but it turns: what pushes the sphere along the side at first pushes it out then.
TEST(RoundedExit, IsOneWhereTheMotionLeavesTheSideLater) {
  scene::Scene scene{};
  scene.sphere = solid;
  scene.initial_state.position = {1.8, 0.4};
  scene.initial_state.velocity = {1.6, 1.6};
  scene::Material felt = coulomb(0.3);
  felt.turntable_rate = -3;
  felt.turntable_center = {1.7, 2.3};
  scene.surface.regions = {{"felt", scene::Polygon{{{2.7, 1.3}, {3.7, 2.3}, {2.7, 2.3}}, false}, felt}};
  for (const Method method : methods) {
    scene.solver.method = method;
    EXPECT_LT((end_of(scene, 3).twist.velocity - Vector2d(1.6, 1.6)).norm(), 1e-14);
  }
}

// From cell to cell over ice: the sphere has the slip of the next cell to rounding, and rolls on at once.
TEST(RoundedExit, IsNoneFromACellWhereAMotionEndsBeforeItHasLeftTheSide) {
  scene::Scene scene{};
  scene.sphere = solid;
  scene.initial_state.position = {1.2, 1.0};
  scene.initial_state.velocity = {-1, -0.6};
  const scene::Material belt = coulomb(0.5, {-0.3, -1});
  scene.surface.regions = {
      {"image_0", scene::Polygon{{{0, 0}, {0.5, 0}, {0.5, 0.5}, {0, 0.5}}, false}, belt},
      {"image_1", scene::Polygon{{{0.5, 0.5}, {1, 0.5}, {1, 1}, {0.5, 1}}, false}, belt}};
  scene.surface.image_regions = 2;
  const State expected = end_of(scene, 10);
  for (const Method method : {Method::dopri5, Method::dopri87, Method::cvode_bdf}) {
    scene.solver.method = method;
    EXPECT_LT((end_of(scene, 10).position - expected.position).norm(), 1e-8);
  }
}

// At rest on an edge the sphere is pushed out of the region, into the base: that acts alone, wherever the
// edge is.
TEST(RoundedExit, IsAtOnceWhereTheSphereIsPushedOffAnEdge) {
  scene::Scene scene{};
  scene.sphere = body(0.875, 0.4726562);
  scene.initial_state.position = {-2, 1};
  scene.initial_state.angular_velocity = {-1.6, 1.6, 3.875};
  scene.forces.gravity = {0, 0, -8};
  scene.surface.base = coulomb(0.25);
  scene::Material table = coulomb(0.5);
  table.spin_friction = 0.0625;
  table.turntable_rate = 1.75;
  scene.surface.regions = {{"table", scene::HalfPlane{{-2, 1}, {-4, -4}}, table}};
  const double t = 0.25;
  const Vector2d way = Vector2d(1, 1).normalized() * 0.5 * 0.25 * 8 * t * t;
  for (const Method method : methods) {
    for (const Vector2d& shift : {Vector2d(0, 0), Vector2d(-4, 8), Vector2d(2, -1)}) {
      scene::Scene moved = shifted(scene, shift);
      moved.surface.regions[0].material.turntable_center = Vector2d(-1, 6) + shift;
      moved.solver.method = method;
      const State state = end_of(moved, t);
      EXPECT_LT((state.position - moved.initial_state.position - way).norm(), 1e-9 * way.norm() + 1e-15);
      EXPECT_EQ(state.twist.angular_velocity.z(), 3.875) << "the spin friction of the table";
    }
  }
}

// The same along the edge, so slowly that all that lies ahead of the first look is within rounding.
TEST(RoundedExit, IsAtOnceHoweverSlowlyTheSphereMovesAlongTheEdge) {
  for (const double speed : {1.0, 4e-7, 3e-12}) {
    scene::Scene scene{};
    scene.sphere = body(0.375, 0.31640625);
    scene.initial_state.velocity = {speed, 0};
    scene.initial_state.angular_velocity = {2.1, 7.5, 0};
    scene.surface.regions = {{"felt", scene::HalfPlane{{0, 0}, {0, 1}}, coulomb(0.22)}};
    for (const Method method : methods) {
      scene.solver.method = method;
      const State state = end_of(shifted(scene, {-4, 8}), 8);
      EXPECT_EQ(state.twist.velocity, Vector2d(speed, 0)) << speed << ", " << static_cast<int>(method);
    }
  }
}

}  // namespace
}  // namespace hybrid_sphere::testing::rounded_exit_test

// The mechanical lens of Ivanov and Erdakova (arXiv:1509.01413): balls that slide with equal velocities and
// spins over an edge between two frictions meet in one point. The slip s = v - R (omega_2, -omega_1) = (0,
// 15) keeps its direction, so that y'' = -mu g is known on both sides.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "hybrid_sphere/simulation/simulation.hpp"

namespace hybrid_sphere::testing::mechanical_lens_test {
namespace {

constexpr double gravity = 9.81;
constexpr double speed = 2;
constexpr double focal_time = 1.2;
constexpr double below = 0.1;  // friction
constexpr double above = 0.3;
constexpr double first = 0.7064;  // starts of the balls that are focused
constexpr double last = 2.1189;

double edge(double x) { return 2.11896 - 1.1772 * x + 0.122625 * x * x; }

/// Where the ball starts that comes to the edge at a time.
double start_of_crossing(double t) { return edge(speed * t) + 0.5 * below * gravity * t * t; }

scene::Material coulomb(double friction) {
  scene::Material material(scene::Law::coulomb);
  material.friction = friction;
  return material;
}

std::vector<double> equal_steps(int chords) {
  std::vector<double> times;
  for (int i = 0; i <= chords; ++i) times.push_back(focal_time * i / chords);
  return times;
}

/// The edge as chords between its points at speed t.
scene::Scene lens(double s, const std::vector<double>& times) {
  scene::Scene scene{};
  scene.sphere = {1, 0.5, 0.5 * std::sqrt(0.4)};
  scene.forces.gravity = {0, 0, -gravity};
  scene.initial_state.position = {0, s};
  scene.initial_state.velocity = {speed, 0};
  scene.initial_state.angular_velocity = Vector3d(15, 2, 0) / 0.5;
  scene.surface.base = coulomb(below);
  scene::Polygon region;
  for (const double t : times) region.vertices.emplace_back(speed * t, edge(speed * t));
  region.vertices.insert(region.vertices.end(), {{3, -1}, {3, 5}, {0, 5}});
  scene.surface.regions = {{"above", region, coulomb(above)}};
  return scene;
}

State at_the_focus(double s, const std::vector<double>& times) {
  Simulation simulation(lens(s, times));
  simulation.advance_to(focal_time);
  State there = simulation.state();
  there.region = {};  // named by the simulation
  return there;
}

double miss(double s, int chords) {
  return (at_the_focus(s, equal_steps(chords)).position - Vector2d(speed * focal_time, 0)).norm();
}

TEST(MechanicalLens, FocusesToRoundingWhereTheChordsMeetTheEdge) {
  constexpr int chords = 64;
  for (int i = 1; i < chords; ++i) {
    const double t = focal_time * i / chords;
    EXPECT_LE(miss(start_of_crossing(t), chords), 1e-12) << t;
  }
}

TEST(MechanicalLens, ConvergesLikeTheChords) {
  constexpr int balls = 400;
  const auto worst = [&](int chords) {
    double most = 0;
    for (int i = 0; i <= balls; ++i) most = std::max(most, miss(first + (last - first) * i / balls, chords));
    return most;
  };
  double before = worst(8);
  EXPECT_LE(before, 0.02);
  for (const int chords : {16, 32, 64}) {
    const double now = worst(chords);
    EXPECT_NEAR(std::log2(before / now), 2, 0.05) << chords;
    before = now;
  }
}

// The velocity at the end tells for how long each friction has acted.
TEST(MechanicalLens, IsCrossedWhenTheEdgeIs) {
  constexpr double known = 0.30052682765544;  // [s], for the ball from 1.5 m
  const State there = at_the_focus(1.5, {0, known, focal_time});
  const double slowed = -there.twist.velocity.y() / gravity;  // mu_1 t + mu_2 (1.2 s - t)
  EXPECT_NEAR((above * focal_time - slowed) / (above - below), known, 1e-13);
}

}  // namespace
}  // namespace hybrid_sphere::testing::mechanical_lens_test

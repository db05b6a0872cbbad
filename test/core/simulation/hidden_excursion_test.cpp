// A belt takes the sphere back over the edge that it has come over so slowly that no place between them is
// told apart from the edge: docs/theory.md 5.5.

#include <gtest/gtest.h>

#include <stdexcept>
#include <vector>

#include "support/recorded.hpp"

namespace hybrid_sphere::testing::hidden_excursion_test {
namespace {

using scene::Law;
using Method = scene::Solver::Method;

constexpr double gravity = 9.81;
const Vector2d place{4, 4};
const double speeds[] = {1e-100, 5e-37, 1e-12, 1e-9, 5e-8};

scene::Material belt_with(const Vector2d& velocity) {
  scene::Material material(Law::coulomb);
  material.friction = 0.5;
  material.belt = velocity;
  return material;
}

Vector2d acceleration_on(const scene::Material& belt) {
  return belt.friction * gravity * belt.belt.normalized();
}

scene::Scene at_rest(const scene::Material& base, const scene::Shape& shape,
                     const scene::Material& material) {
  scene::Scene scene{};
  scene.sphere = {1, 0.5, 0.3};
  scene.initial_state.position = place;
  scene.forces.gravity = {0, 0, -gravity};
  scene.surface.base = base;
  scene.surface.regions = {{"ground", shape, material}};
  return scene;
}

/// At all speeds: the belt takes the sphere back over the edge across that axis.
/// @param direction  of the velocity, with a component of size 1 along the axis
void expect_thrown_back(scene::Scene scene, const Vector2d& direction, const scene::Material& belt, int axis,
                        const char* into) {
  const Vector2d acceleration = acceleration_on(belt);
  for (const double speed : speeds) {
    scene.initial_state.velocity = speed * direction;
    const Vector2d expected = speed * direction + 2 * speed / acceleration[axis] * acceleration;
    for (const Method method : {Method::automatic, Method::dopri87, Method::cvode_bdf}) {
      scene.solver.method = method;
      Simulation simulation(scene);
      simulation.advance_to(2, {});
      const State& state = simulation.state();
      EXPECT_EQ(state.region, into);
      // The friction turns with the slip, by as much as the speed is of that of the belt.
      EXPECT_LT((state.twist.velocity - expected).norm(), 1e-6 * expected.norm()) << speed;
      EXPECT_LT((state.position - place).norm(), 3 * expected.norm() + 1e-14);
    }
  }
}

TEST(HiddenExcursion, OverAnEdgeEndsWithTheVelocityThatTheBeltGives) {
  const scene::Material belt = belt_with({-0.75, 0.25});
  const scene::Scene scene = at_rest(Law::smooth, scene::HalfPlane{{1, 4}, {0, -1}}, belt);
  expect_thrown_back(scene, {0.5, -1}, belt, 1, "base");
}

TEST(HiddenExcursion, IntoACornerEndsOverTheSideThatComesFirst) {
  const scene::Material belt = belt_with({0.75, 0.25});
  const scene::Polygon corner{{{4, 4}, {2, 4}, {2, 2}, {4, 2}}};
  expect_thrown_back(at_rest(Law::smooth, corner, belt), {-1, -1}, belt, 0, "base");
}

TEST(HiddenExcursion, AroundACornerEndsOverTheSideThatComesLast) {
  const scene::Material belt = belt_with({0.75, 0.25});
  const scene::Polygon corner{{{4, 4}, {6, 4}, {6, 6}, {4, 6}}};
  expect_thrown_back(at_rest(belt, corner, Law::smooth), {-1, -1}, belt, 1, "ground");
}

TEST(HiddenExcursion, IntoAReflexCornerEndsOverTheSideThatComesLast) {
  const scene::Material belt = belt_with({0.75, 0.25});
  const scene::Polygon l_shape{{{2, 2}, {6, 2}, {6, 4}, {4, 4}, {4, 6}, {2, 6}}};
  expect_thrown_back(at_rest(Law::smooth, l_shape, belt), {-1, -1}, belt, 1, "base");
}

// Two triangles share the diagonal along which the sphere comes; the belt of one takes it out over another
// side, and it is on none of the two then.
TEST(HiddenExcursion, FromACornerOfTwoRegionsLeadsOutOfBoth) {
  const scene::Material belt = belt_with({-0.75, 0.25});
  scene::Scene scene = at_rest(Law::smooth, scene::Polygon{{{4, 4}, {2, 2}, {4, 2}}}, Law::rough);
  scene.surface.regions.push_back({"belt", scene::Polygon{{{4, 4}, {2, 4}, {2, 2}}}, belt});
  expect_thrown_back(scene, {-1, -1}, belt, 1, "base");
}

// A part of the map that lies on that of the belt comes first, though the acceleration leads out of both.
TEST(HiddenExcursion, EndsOnTheGroundThatComesFirst) {
  scene::Scene scene = at_rest(Law::smooth, scene::HalfPlane{{1, 4}, {0, -1}}, belt_with({-1, 0.1}));
  const scene::Material belt = belt_with({-1, -1});
  scene.surface.regions.push_back({"corner", scene::Polygon{{{4, 4}, {2, 4}, {2, 2}, {4, 2}}}, belt});
  scene.initial_state.velocity = {1e-9, -1e-9};
  Simulation simulation(scene);
  simulation.advance_to(0.05, {});
  EXPECT_EQ(simulation.state().region, "corner");
  const Vector2d expected = place + 0.00125 * acceleration_on(belt);
  EXPECT_LT((simulation.state().position - expected).norm(), 1e-8);
}

// The acceleration leads out of both, but over the side that is crossed lies the other.
TEST(HiddenExcursion, EndsOnTheGroundBeyondTheSideThatIsCrossed) {
  const scene::Material belt = belt_with({-1, 0.2});
  const scene::Region beyond{"beyond", scene::Polygon{{{4, 4}, {4, 8}, {0, 8}, {0, 4}}}, belt};
  const scene::Region left{"left", scene::Polygon{{{4, 4}, {0, 4}, {0, 0}, {4, 0}}}, belt_with({1, 3})};
  scene::Scene scene = at_rest(Law::smooth, scene::HalfPlane{{0, 0}, {0, 1}}, Law::smooth);
  scene.initial_state.velocity = {-1e-9, -2e-9};
  for (const auto& regions : {std::vector{beyond, left}, std::vector{left, beyond}}) {
    scene.surface.regions = regions;
    Simulation simulation(scene);
    simulation.advance_to(0.05, {});
    EXPECT_EQ(simulation.state().region, "beyond");
    const Vector2d expected = place + 0.00125 * acceleration_on(belt);
    EXPECT_LT((simulation.state().position - expected).norm(), 1e-8);
  }
}

// The belt's friction lets the contact go faster than the sphere, so that the friction beyond pulls it back:
// throws to and fro, of which there may be millions in each second.
TEST(HiddenExcursion, IsNoneWhereTheNextGroundTakesTheSphereBack) {
  scene::Material base(Law::coulomb);
  base.friction = 0.24;
  scene::Scene scene = at_rest(base, scene::HalfPlane{{0.4, -1.2}, {-1, -1}}, belt_with({0, 0.4}));
  scene.initial_state.position = {1.2, -2};
  scene.initial_state.velocity = {-1.5e-8, 1.5e-8};
  scene.initial_state.angular_velocity = {8.8e-8, -4.1e-8, 0};
  Simulation simulation(scene);
  try {
    simulation.advance_to(1, {});
  } catch (const HaltedError& error) {
    EXPECT_EQ(error.stop(), Stop::livelock);
  }
  EXPECT_LT(simulation.switches(), 100U);
}

/// What is no longer than the rounding of a place may be long in time.
scene::Scene with_long_excursion() {
  constexpr double far = 1e6;
  scene::Scene scene = at_rest(Law::smooth, scene::HalfPlane{{0, far}, {0, -1}}, Law::rough);
  scene.initial_state.position = {far, far};
  scene.initial_state.velocity = {5e-7, -1e-6};
  scene.forces.gravity = {0, 1e-4, -10};
  return scene;
}

TEST(HiddenExcursion, LastsAsLongAsItsGroundActs) {
  const scene::Scene scene = with_long_excursion();
  const double kappa = 0.3 * 0.3 / (0.5 * 0.5 + 0.3 * 0.3);
  const double inertia = 1 / (1 - kappa);
  const double rolling = -1e-6 / inertia;  // where the sphere has rolled on
  const double duration = -2 * rolling / (1e-4 / inertia);
  std::vector<double> times;
  const auto note = [&](const Switch& event) { times.push_back(event.time); };
  Simulation simulation(scene);
  simulation.advance_to(duration / 4, note);
  ASSERT_EQ(times, std::vector<double>{0});
  EXPECT_NEAR(simulation.state().twist.velocity.y(), rolling / 2, 1e-6 * -rolling);
  simulation.kick({0, 0.5 * rolling});  // now the excursion ends at another time
  simulation.advance_to(duration / 2, note);
  EXPECT_EQ(simulation.state().region, "ground");
  EXPECT_EQ(times.size(), 1U);
  simulation.advance_to(2 * duration, note);
  EXPECT_EQ(simulation.state().region, "base");
  ASSERT_EQ(times.size(), 2U);
  EXPECT_GT(times.back(), duration);
}

// The ground has been entered, but its path is not known yet.
TEST(HiddenExcursion, BeginsAfterAKickThatComesBeforeThePathIsKnown) {
  Simulation simulation(with_long_excursion());
  EXPECT_THROW(simulation.advance_to(0, [](const Switch&) { throw std::runtime_error("full"); }),
               std::runtime_error);
  simulation.kick({0, -1e-9});
  std::vector<double> times;
  simulation.advance_to(0, [&](const Switch& event) { times.push_back(event.time); });
  EXPECT_TRUE(times.empty());
  EXPECT_EQ(simulation.state().region, "ground");
  EXPECT_LT(simulation.state().twist.velocity.y(), 0);
}

}  // namespace
}  // namespace hybrid_sphere::testing::hidden_excursion_test

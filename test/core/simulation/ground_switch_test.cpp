// Switches between grounds of every law, one claim a case.

#include <gtest/gtest.h>

#include <cmath>

#include "hybrid_sphere/simulation/simulation.hpp"
#include "support/materials.hpp"
#include "support/recorded.hpp"

namespace hybrid_sphere::testing::ground_switch_test {
namespace {

using scene::Law;

// k = R/2, so that kappa = 1/5; gravity 8 m/s^2.
scene::Scene base_scene() {
  scene::Scene scene{};
  scene.sphere = {2, 0.5, 0.25};
  scene.forces.gravity = {0, 0, -8};
  return scene;
}

// Left of x = 0 the base, right of it the other.
scene::Scene two_grounds(const scene::Material& left, const scene::Material& right) {
  scene::Scene scene = base_scene();
  scene.surface.base = left;
  scene.surface.regions = {{"right", scene::HalfPlane{{0, 0}, {1, 0}}, right}};
  scene.initial_state.position = {-1, 0};
  scene.initial_state.velocity = {1, 0};
  return scene;
}

Switches switches_of(Simulation& simulation, double until) {
  Switches switches;
  simulation.advance_to(until, recorder(switches));
  return switches;
}

// p_c = (1 - kappa) v + kappa nu = 0: what rounding leaves of the velocities would decide where the sphere
// goes.
TEST(RoughGround, OnWhichTheImpulseTakesAllVelocityBringsTheSphereToRest) {
  scene::Scene scene{};
  scene.sphere = {1.75, 0.875, 0.4921875};
  scene.surface.base = Law::rough;
  const double kappa = Sphere(scene.sphere).kappa();
  for (int i = 1; i <= 20; ++i) {
    const Vector2d v(0.1 * i, 0.3 - 0.07 * i);
    const Vector2d nu = -(1 - kappa) / kappa * v;
    scene.initial_state.velocity = v;
    scene.initial_state.angular_velocity = {-nu.y() / 0.875, nu.x() / 0.875, 0};
    Simulation simulation(scene);
    simulation.advance_to(1, {});
    EXPECT_EQ(simulation.state().mode, Mode::resting) << i;
    EXPECT_EQ(simulation.state().position, Vector2d(0, 0)) << i;
  }
}

TEST(Rubber, StopsTheSpinWithAThirdComponentOfItsImpulse) {
  scene::Scene scene = base_scene();
  scene.surface.base = Law::rubber;
  scene.initial_state.velocity = {1, 0.5};
  scene.initial_state.angular_velocity = {0, 0, 3};
  Simulation simulation(scene);
  const auto switches = switches_of(simulation, 1);
  ASSERT_EQ(switches.size(), 1U);
  // P = -m kappa s, (R P_y, -R P_x), L_z = -m k^2 omega_3
  EXPECT_NEAR(switches[0].impulse.x(), -0.4, 1e-15);
  EXPECT_NEAR(switches[0].impulse.y(), -0.2, 1e-15);
  EXPECT_NEAR(switches[0].angular_impulse.x(), -0.1, 1e-15);
  EXPECT_NEAR(switches[0].angular_impulse.y(), 0.2, 1e-15);
  EXPECT_EQ(switches[0].angular_impulse.z(), -2 * 0.0625 * 3);
  EXPECT_EQ(simulation.state().twist.angular_velocity.z(), 0);
}

TEST(Rubber, SpinsWithItsTurntable) {
  scene::Scene scene = base_scene();
  scene.surface.base = Law::rubber;
  scene.surface.base.turntable_rate = 0.75;
  scene.initial_state.position = {1, 2};
  Simulation simulation(scene);
  simulation.advance_to(3, {});
  EXPECT_EQ(simulation.state().twist.angular_velocity.z(), 0.75);
}

TEST(GroundSwitch, ABeltExchangesTheConstraintOfAnother) {
  Simulation simulation(two_grounds(belt({1, 0}), belt({2, 1})));
  const auto switches = switches_of(simulation, 3);
  ASSERT_EQ(switches.size(), 2U);
  EXPECT_EQ(switches[0].kind, SwitchKind::applied);
  EXPECT_EQ(switches[1].kind, SwitchKind::exchanged);
  EXPECT_EQ(switches[1].from, "base");
  EXPECT_EQ(switches[1].to, "right");
  // P = m kappa (u_new - u_old): docs/theory.md 3.
  EXPECT_NEAR(switches[1].impulse.x(), 0.4, 1e-15);
  EXPECT_NEAR(switches[1].impulse.y(), 0.4, 1e-15);
}

TEST(GroundSwitch, ABeltOfTheSameVelocityIsTheSameConstraint) {
  Simulation simulation(two_grounds(belt({1, 0.5}), belt({1, 0.5})));
  EXPECT_EQ(switches_of(simulation, 3).size(), 1U);
  EXPECT_EQ(simulation.state().region, "right");
}

TEST(CoulombGround, OnWhichTheSphereGoesOnRollingIsNoSwitch) {
  Simulation simulation(two_grounds(Law::rough, coulomb(0.25)));
  EXPECT_EQ(switches_of(simulation, 3).size(), 1U);
  EXPECT_EQ(simulation.state().region, "right");
  EXPECT_EQ(simulation.state().mode, Mode::rolling);
}

TEST(CoulombGround, AppliesItsConstraintWithoutAnImpulseWhenTheSlipHasEnded) {
  Simulation simulation(two_grounds(Law::smooth, coulomb(0.25)));
  Switches switches = switches_of(simulation, 1.0625);
  EXPECT_TRUE(switches.empty());
  EXPECT_EQ(simulation.state().mode, Mode::sliding);
  EXPECT_EQ(simulation.state().stage, Stage::holonomic);
  switches = switches_of(simulation, 2);
  ASSERT_EQ(switches.size(), 1U);
  EXPECT_EQ(switches[0].kind, SwitchKind::applied);
  EXPECT_EQ(switches[0].cause, Cause::slip_ended);
  EXPECT_NEAR(switches[0].time, 1 + 0.2 / (0.25 * 8), 1e-15);  // kappa |s|/(mu g)
  EXPECT_EQ(switches[0].impulse, Vector2d::Zero());
  EXPECT_EQ(switches[0].angular_impulse, Vector3d::Zero());
  EXPECT_NEAR(simulation.state().twist.velocity.x(), 0.8, 1e-15);
}

// A force F takes the reaction kappa F while the sphere rolls: it may be 20 N with mu N = 4 N.
TEST(GroundSwitch, ACommandThatAsksForMoreGripThanThereIsReleasesTheConstraint) {
  scene::Scene scene = base_scene();
  scene.surface.base = coulomb(0.25);
  Simulation simulation(scene);
  switches_of(simulation, 1);
  simulation.set_command({{19, 0}, Vector3d::Zero()});
  EXPECT_TRUE(switches_of(simulation, 1.5).empty());
  EXPECT_EQ(simulation.state().mode, Mode::rolling);
  simulation.set_command({{21, 0}, Vector3d::Zero()});
  const auto switches = switches_of(simulation, 2);
  ASSERT_EQ(switches.size(), 1U);
  EXPECT_EQ(switches[0].kind, SwitchKind::released);
  EXPECT_EQ(switches[0].cause, Cause::grip_lost);
  EXPECT_EQ(switches[0].time, 1.5);
  EXPECT_EQ(simulation.state().mode, Mode::sliding);
  EXPECT_NEAR(simulation.reaction().x(), -4, 1e-13);
}

TEST(GroundSwitch, ACommandActsLikeAForceOfTheScene) {
  scene::Scene pushed = base_scene();
  pushed.surface.base = Law::rough;
  const scene::Wrench wrench{{0.5, -0.25}, {0.125, 0.25, 0.5}};
  scene::Scene free = pushed;
  pushed.forces.wrench = wrench;
  Simulation commanded(free);
  commanded.set_command(wrench);
  Simulation expected(pushed);
  commanded.advance_to(2, {});
  expected.advance_to(2, {});
  EXPECT_EQ(commanded.state().position, expected.state().position);
  EXPECT_EQ(commanded.state().twist.angular_velocity, expected.state().twist.angular_velocity);
}

TEST(GroundSwitch, ACommandEqualToTheOneInForceChangesNothing) {
  scene::Scene scene = two_grounds(Law::smooth, Law::rough);
  scene.initial_state.angular_velocity = {0.1, 0.2, 0.3};
  const scene::Wrench wrench{{0.3, -0.1}, {0.1, 0.2, 0.3}};
  Simulation once(scene);
  Simulation often(scene);
  once.set_command(wrench);
  for (int i = 0; i < 100; ++i) {
    often.set_command(wrench);
    often.advance_to(0.02 * i, {});
  }
  once.advance_to(2, {});
  often.advance_to(2, {});
  EXPECT_EQ(once.state().position, often.state().position);
  EXPECT_EQ(once.state().orientation.coeffs(), often.state().orientation.coeffs());
}

scene::Scene opposing_belts(scene::Livelock livelock) {
  scene::Scene scene = two_grounds(belt({1, 0.25}), belt({-1, 0.5}));
  scene.surface.livelock = livelock;
  scene.initial_state.velocity = {0.125, 0};  // p_c = 0.1, between the 0.2 of both belts
  return scene;
}

TEST(OpposingBelts, LetTheSphereSlideAlongTheirEdge) {
  Simulation simulation(opposing_belts(scene::Livelock::slide));
  const auto switches = switches_of(simulation, 100);
  ASSERT_FALSE(switches.empty());
  EXPECT_EQ(switches.back().cause, Cause::livelock);
  EXPECT_EQ(simulation.state().mode, Mode::edge_sliding);
  EXPECT_EQ(simulation.state().stage, Stage::nonholonomic);
  EXPECT_EQ(simulation.state().position.x(), 0);
  EXPECT_EQ(simulation.state().twist.velocity.x(), 0);
  EXPECT_GT(simulation.state().position.y(), 1);
}

// The base and the belt throw the sphere at each other where it is put, in the tip of a triangle: along the
// edge ahead the triangle lies beside the belt.
TEST(OpposingBelts, PutInTheTipOfAThirdGroundSlideAlongTheEdgeThatLeadsAway) {
  scene::Scene scene = base_scene();
  scene.surface.livelock = scene::Livelock::slide;
  scene.surface.base = Law::rough;
  scene.surface.regions = {{"triangle", scene::Polygon{{{2, 4}, {6, 0}, {4, 6}}, false}, Law::rough},
                           {"belt", scene::HalfPlane{{2, 4}, {3, -4}}, belt({-0.25, 1.5})}};
  scene.initial_state.position = {2, 4};
  scene.initial_state.velocity = {0, 0.25};
  scene.initial_state.angular_velocity = {1, 2, 0};  // p_c = (0.2, 0.1)
  Simulation simulation(scene);
  simulation.advance_to(1, {});
  EXPECT_EQ(simulation.state().mode, Mode::edge_sliding);
  EXPECT_EQ(simulation.state().region, "triangle");
  EXPECT_GT(simulation.state().position.y(), 4);
}

TEST(OpposingBelts, EndTheComputationWhereTheSceneAsksForThat) {
  Simulation simulation(opposing_belts(scene::Livelock::stop));
  Switches switches;
  try {
    simulation.advance_to(5, recorder(switches));
    FAIL() << "did not halt";
  } catch (const HaltedError& error) {
    EXPECT_EQ(error.time(), simulation.time());
    EXPECT_NE(std::string(error.what()).find("\"right\""), std::string::npos) << error.what();
  }
  EXPECT_EQ(simulation.state().position.x(), 0);
  EXPECT_TRUE(simulation.state().twist.velocity.allFinite());
  EXPECT_THROW(simulation.advance_to(5, {}), HaltedError);
  simulation.reset();
  EXPECT_NO_THROW(simulation.advance_to(0.25, {}));
  EXPECT_EQ(simulation.time(), 0.25);
}

// Each of three belts sends the sphere from their common corner onto the next one.
TEST(ThreeBelts, ThatChaseTheSphereRoundACornerHaltIt) {
  scene::Scene scene = base_scene();
  const auto sector = [](double from) {
    const auto at = [](double angle) { return Vector2d(8 * std::cos(angle), 8 * std::sin(angle)); };
    const double step = 2 * M_PI / 3;
    return scene::Polygon{{{0, 0}, at(from), at(from + step / 2), at(from + step)}, false};
  };
  for (int i = 0; i < 3; ++i) {
    const double from = 2 * M_PI / 3 * i;
    const double towards = from + M_PI;  // the middle of the next one
    scene.surface.regions.push_back(
        {"sector_" + std::to_string(i), sector(from), belt({std::cos(towards), std::sin(towards)})});
  }
  Simulation simulation(scene);
  EXPECT_THROW(simulation.advance_to(1, {}), HaltedError);
  EXPECT_EQ(simulation.state().position, Vector2d(0, 0));
}

// A torque sends the resting sphere from still rough ground to the right, a force from smooth ground to the
// left: docs/theory.md 5.4.
TEST(GroundSwitch, ATorqueAndAForceThatPushASphereAtRestOntoAnEdgeFromBothSidesHaltIt) {
  scene::Scene scene = two_grounds(Law::rough, Law::smooth);
  scene.initial_state.position = {0, 0};
  scene.initial_state.velocity = {0, 0};
  scene.forces.wrench = {{-0.5, 0}, {0, 2, 0}};
  Simulation simulation(scene);
  EXPECT_THROW(simulation.advance_to(1, {}), HaltedError);
  EXPECT_EQ(simulation.state().position, Vector2d(0, 0));
}

// Between two belts in the tip of a wedge the throws take shorter and shorter times, down to the resolution
// of the clock and of the place.
TEST(TwoBelts, ThatThrowTheSphereIntoTheTipOfAWedgeDoNotHangTheComputation) {
  scene::Scene scene = base_scene();
  const Vector2d tip(0.1, 0.3);
  scene.surface.regions = {{"below", scene::HalfPlane{tip, {-1, -4}}, belt({-4, 2})},
                           {"above", scene::HalfPlane{tip, {-1, 4}}, belt({-4, -2})}};
  scene.initial_state.position = {4.1, 0.3};
  scene.initial_state.velocity = {-0.25, -1};
  scene.initial_state.angular_velocity = {-8, 0, 0};  // p_c = (-0.2, 0)
  Simulation simulation(scene);
  try {
    simulation.advance_to(100, {});
    EXPECT_LT(simulation.state().position.x(), -50);  // through the tip, with a velocity of (-1, +-0.4)
  } catch (const HaltedError&) {
    EXPECT_LE((simulation.state().position - tip).norm(), 1e-12);
  }
  EXPECT_GT(simulation.switches(), 20U);
}

TEST(RollingResistance, BringsTheSphereToRestForGood) {
  scene::Scene scene = base_scene();
  scene.surface.base = Law::rough;
  scene.surface.base.rolling_resistance = 0.125;
  scene.initial_state.velocity = {1, 0};
  scene.initial_state.angular_velocity = {0, 2, 0};
  Simulation simulation(scene);
  // nu' = -rho (1 - kappa) g = -0.8: 0.625 m in 1.25 s
  simulation.advance_to(1000, {});
  EXPECT_NEAR(simulation.state().position.x(), 0.625, 1e-15);
  EXPECT_EQ(simulation.state().mode, Mode::resting);
  EXPECT_EQ(simulation.state().twist.velocity, Vector2d::Zero());
}

TEST(RollingResistance, CarriesTheRestingSphereAlongWithItsBelt) {
  scene::Scene scene = base_scene();
  scene.surface.base = belt({1, 0});
  scene.surface.base.rolling_resistance = 0.125;
  Simulation simulation(scene);
  simulation.advance_to(100, {});
  EXPECT_EQ(simulation.state().twist.velocity, Vector2d(1, 0));
  EXPECT_TRUE(simulation.state().twist.angular_velocity.head<2>().isZero(0));
}

TEST(SpinFriction, UsesUpTheSpinAndNothingElse) {
  scene::Scene scene = base_scene();
  scene.surface.base = Law::rough;
  scene.surface.base.spin_friction = 0.125;
  scene.initial_state.velocity = {1, 0};
  scene.initial_state.angular_velocity = {0, 2, 8};
  Simulation simulation(scene);
  simulation.advance_to(0.5, {});
  // omega_3' = -rho R N/(m k^2) = -8
  EXPECT_NEAR(simulation.state().twist.angular_velocity.z(), 4, 1e-14);
  simulation.advance_to(4, {});
  EXPECT_EQ(simulation.state().twist.angular_velocity.z(), 0);
  EXPECT_EQ(simulation.state().twist.velocity, Vector2d(1, 0));
}

// An incline holds up to tan(alpha) = mu/kappa.
TEST(GroundSwitch, AnInclineKeepsTheSphereRollingUpToTheLimitOfGrip) {
  for (const double slope : {9.9, 10.0, 10.1}) {
    scene::Scene scene = base_scene();
    scene.forces.gravity.x() = slope;
    scene.surface.base = coulomb(0.25);
    Simulation simulation(scene);
    simulation.advance_to(1, {});
    EXPECT_EQ(simulation.state().mode, slope > 10 ? Mode::sliding : Mode::rolling) << slope;
  }
}

TEST(GroundSwitch, ASphereOnAnEdgeRidesAlongItUnderAForceAlongIt) {
  const Vector2d directions[] = {{0, 1}, {1, 0}, {3, 4}, {1, 3}};
  for (const Vector2d& along : directions) {
    const Vector2d inwards(along.y(), -along.x());
    const Vector2d far = 64 * along;
    const Vector2d deep = 64 * inwards;
    const scene::Shape shapes[] = {
        scene::HalfPlane{{0, 0}, inwards},
        scene::Polygon{{-far, Vector2d(deep - far), Vector2d(deep + far), far}, false}};
    for (const scene::Shape& shape : shapes) {
      scene::Scene scene = base_scene();
      scene.surface.base = Law::smooth;
      scene.surface.regions = {{"region", shape, Law::smooth}};
      scene.initial_state.velocity = along;
      scene.forces.wrench.force = along / 4;
      Simulation simulation(scene);
      simulation.advance_to(0, {});
      const std::string first(simulation.state().region);
      for (int i = 1; i <= 100; ++i) {
        simulation.advance_to(0.01 * i, {});
        EXPECT_EQ(simulation.state().region, first) << "along " << along.transpose();
      }
      EXPECT_EQ(simulation.switches(), 0U);
    }
  }
}

TEST(GroundSwitch, ASphereOnAnEdgeEntersTheGroundThatTheForcePushesItInto) {
  for (const double force : {1.0, -1.0}) {
    scene::Scene scene = two_grounds(Law::smooth, Law::rough);
    scene.initial_state.position = {0, 0};
    scene.initial_state.velocity = {0, 0};
    scene.forces.wrench.force = {force, 0};
    Simulation simulation(scene);
    simulation.advance_to(1, {});
    EXPECT_EQ(simulation.state().region, force > 0 ? "right" : "base");
    EXPECT_EQ(simulation.switches(), force > 0 ? 1U : 0U);
  }
}

}  // namespace
}  // namespace hybrid_sphere::testing::ground_switch_test

// Throws to and fro that accumulate geometrically: their last instant, and the motion after it.

#include <gtest/gtest.h>

#include <cfloat>
#include <cmath>

#include "hybrid_sphere/scene/read_scene.hpp"
#include "sphere/constants.hpp"
#include "support/materials.hpp"
#include "support/recorded.hpp"

namespace hybrid_sphere::testing::limit_test {
namespace {

using scene::Law;

scene::Scene read(const std::string& name) {
  return scene::read_scene_file(std::string(TEST_DATA_DIR) + "/accumulation/" + name + ".yaml");
}

const RecordedSwitch* limit_in(const Switches& switches) {
  for (const RecordedSwitch& event : switches) {
    if (event.cause == Cause::accumulation) return &event;
  }
  return nullptr;
}

// A force F = m f drives the sphere over smooth ground to a rough half-plane at rest, which throws it back
// with p_c.x; a torque makes p_c' = a0 = (1 - kappa) f + kappa g, 0 < a0 < f/2. Each flight takes 2 |p_c|/f,
// so that p_c goes to q = 1 - 2 a0/f of itself: 0 at a0 (t* - t) = |p_c|.
struct ThrownByAForce {
  double length = 1;  // units
  double time = 1;
  double turn = 0;    // of the edge's normal [rad]
  double push = 0.4;  // a0/f, so that q = 1 - 2 push

  scene::Scene scene() const {
    scene::Scene scene{};
    const double speed = length / time;
    const double acceleration = length / (time * time);
    const Eigen::Rotation2Dd rotation(turn);
    scene.sphere = {1, length, 0.5 * length};  // kappa = 1/5
    const Vector2d normal = turn == 0 ? Vector2d(1, 0) : Vector2d(rotation * Vector2d(1, 0));
    const Vector2d tangent(-normal.y(), normal.x());
    scene.surface.regions = {{"rough", scene::HalfPlane{{0, 0}, normal}, Law::rough}};
    scene.initial_state.position = length * (-0.5 * normal);
    scene.initial_state.velocity = speed * (normal + 0.5 * tangent);
    // p_c.n = 0.8 - 0.2 12 = -1.6
    scene.initial_state.angular_velocity = 12 / time * Vector3d(normal.y(), -normal.x(), 0);
    scene.forces.wrench.force = acceleration * normal;
    // a0 = 0.8 f + 0.2 g, with the torque m k^2 g/R = g/4
    const double torque = length * acceleration * (push - 0.8) * 5 / 4;
    scene.forces.wrench.torque = torque * Vector3d(-normal.y(), normal.x(), 0);
    return scene;
  }
};

struct Passed {
  Record record;
  const RecordedSwitch* limit = nullptr;
};

Passed pass(const scene::Scene& scene, double until, int outputs = 1) {
  Passed passed{record(scene, until, outputs), nullptr};
  passed.limit = limit_in(passed.record.switches);
  return passed;
}

TEST(Limit, AnAccumulationOfThrowsUnderAForceEndsAtTheLimitOfItsGeometricSeries) {
  const ThrownByAForce thrown;
  const Passed passed = pass(thrown.scene(), 6);
  EXPECT_EQ(passed.record.halt, "");
  ASSERT_NE(passed.limit, nullptr);
  const RecordedSwitch& limit = *passed.limit;
  EXPECT_NEAR(limit.time, 4, 1e-14);
  EXPECT_EQ(limit.kind, SwitchKind::applied);
  EXPECT_EQ(limit.from, "base");
  EXPECT_EQ(limit.to, "rough");
  EXPECT_EQ(limit.position.x(), 0);
  EXPECT_EQ(limit.after.velocity.x(), 0);
  // Smooth until the first throw at t1 = -1 + sqrt(2), then p_c.y = 0.8 0.5.
  EXPECT_NEAR(limit.position.y(), 0.5 * (std::sqrt(2) - 1) + 0.4 * (4 - (std::sqrt(2) - 1)), 1e-14);
  EXPECT_NEAR(limit.after.velocity.y(), 0.4, 1e-15);
  EXPECT_EQ(passed.record.switches.size(), limit.index + 1) << "it rolls on";
  EXPECT_LT(limit.index, 40U);
  const RecordedState& end = passed.record.states.back();
  EXPECT_EQ(end.mode, Mode::rolling);
  EXPECT_NEAR(end.position.x(), 0.5 * 0.4 * 4, 1e-13);
  EXPECT_NEAR(end.twist.velocity.x(), 0.4 * 2, 1e-13);
}

// Within few throws, and in thousands of them.
TEST(Limit, AnAccumulationOfAnyRatioEndsAtItsLimit) {
  for (const double push : {0.49995, 0.495, 0.45, 0.3, 0.1, 0.02, 0.005}) {
    ThrownByAForce thrown;
    thrown.push = push;
    for (const double turn : {0.0, 0.7}) {
      thrown.turn = turn;
      const double last = 1.6 / push;
      const Passed passed = pass(thrown.scene(), last + 2);
      EXPECT_EQ(passed.record.halt, "") << push << " " << turn;
      // With q = 1e-4 the third throw may be less than rounding: then it is none.
      ASSERT_TRUE(passed.limit || push > 0.499) << push << " " << turn;
      if (passed.limit) {
        EXPECT_NEAR(passed.limit->time, last, 1e-12 * last) << push << " " << turn;
      }
      const Vector2d normal(std::cos(turn), std::sin(turn));
      EXPECT_NEAR(passed.record.states.back().position.dot(normal), 2 * push, 1e-11) << push << " " << turn;
    }
  }
}

TEST(Limit, AnAccumulationDoesNotDependOnOutputs) {
  const scene::Scene scene = ThrownByAForce().scene();
  const Record once = record(scene, 6, 1);
  const Record often = record(scene, 6, 6000);
  ASSERT_EQ(once.switches.size(), often.switches.size());
  EXPECT_EQ(once.states.back().position, often.states.back().position);
  EXPECT_EQ(once.states.back().orientation.coeffs(), often.states.back().orientation.coeffs());
  for (std::size_t i = 0; i < once.switches.size(); ++i) {
    EXPECT_EQ(once.switches[i].time, often.switches[i].time) << i;
    EXPECT_EQ(once.switches[i].after.velocity, often.switches[i].after.velocity) << i;
  }
}

TEST(Limit, AnAccumulationIsTheSameInAllUnits) {
  const Passed plain = pass(ThrownByAForce().scene(), 6);
  for (const int length : {-40, -7, 30}) {
    for (const int time : {-16, 3, 25}) {
      ThrownByAForce thrown;
      thrown.length = std::ldexp(1, length);
      thrown.time = std::ldexp(1, time);
      const Passed scaled = pass(thrown.scene(), 6 * thrown.time);
      ASSERT_EQ(scaled.record.switches.size(), plain.record.switches.size()) << length << " " << time;
      ASSERT_NE(scaled.limit, nullptr);
      EXPECT_EQ(scaled.limit->time, thrown.time * plain.limit->time);
      EXPECT_EQ(scaled.limit->position, thrown.length * plain.limit->position);
      EXPECT_EQ(scaled.record.states.back().position, thrown.length * plain.record.states.back().position);
    }
  }
}

TEST(Limit, AnAccumulationOnAnEdgeInAnyDirectionEndsOnTheEdge) {
  for (const double turn : {0.3, 1.1, 2.5, -2.0}) {
    ThrownByAForce thrown;
    thrown.turn = turn;
    const Passed passed = pass(thrown.scene(), 6);
    EXPECT_EQ(passed.record.halt, "") << turn;
    ASSERT_NE(passed.limit, nullptr) << turn;
    const Vector2d normal(std::cos(turn), std::sin(turn));
    EXPECT_NEAR(passed.limit->time, 4, 1e-13);
    EXPECT_LE(std::abs(passed.limit->position.dot(normal)), 0x1p-51);
    const double across = passed.limit->after.velocity.dot(normal);
    EXPECT_GE(across, 0) << "into the ground";
    EXPECT_LE(across, 3 * DBL_EPSILON * passed.limit->after.velocity.norm());
    EXPECT_NEAR(passed.record.states.back().position.dot(normal), 0.8, 1e-12);
  }
}

TEST(Limit, AnAccumulationIsTheSameByEveryMethodWithinItsAccuracy) {
  using Method = scene::Solver::Method;
  for (const Method method : {Method::dopri5, Method::dopri87, Method::arkode_erk, Method::cvode_adams}) {
    for (const double accuracy : {1e-6, 1e-9, 1e-12}) {
      scene::Scene scene = ThrownByAForce().scene();
      scene.solver.method = method;
      scene.solver.accuracy = accuracy;
      const Passed passed = pass(scene, 6);
      EXPECT_EQ(passed.record.halt, "") << static_cast<int>(method) << " " << accuracy;
      ASSERT_NE(passed.limit, nullptr) << static_cast<int>(method) << " " << accuracy;
      EXPECT_NEAR(passed.limit->time, 4, 10 * accuracy);
      EXPECT_NEAR(passed.record.states.back().position.x(), 0.8, 10 * accuracy);
    }
  }
}

// Where it goes on by itself, livelock: stop has nothing to stop.
TEST(Limit, AnAccumulationWithAMotionAfterItGoesOnWhereLivelocksStop) {
  scene::Scene scene = ThrownByAForce().scene();
  scene.surface.livelock = scene::Livelock::stop;
  EXPECT_EQ(pass(scene, 6).record.halt, "");
}

// On a belt v = p_c + kappa u is constant. The disc on it has coulomb friction that accelerates the sphere
// out of it: it is thrown in again until that velocity is along the circle, at the place with n.v = 0.
TEST(Limit, AnAccumulationOnACircleEndsWhereTheGroundLetsTheSphereRunAlongIt) {
  const scene::Scene scene = read("thrown_into_a_disc_on_a_belt");
  const Passed passed = pass(scene, 20);
  EXPECT_EQ(passed.record.halt, "");
  ASSERT_NE(passed.limit, nullptr);
  const Vector2d v = passed.limit->after.velocity;
  const Vector2d center(0.27, -1.14);
  const Vector2d tangent_point = center + 1.51 * Vector2d(-v.y(), v.x()).normalized();
  EXPECT_LT((passed.limit->position - tangent_point).norm(), 1e-9);
  EXPECT_EQ(passed.limit->to, "r0");
  // p_c is constant from the first touch on: so is the velocity on the belt, but for what the limit's time is
  // off by, to first order in the last 3e-6 s of it.
  EXPECT_LT((v - passed.record.switches[0].after.velocity).norm(), 3e-6 * 3e-6);
  EXPECT_EQ(passed.record.switches.size(), passed.limit->index + 1);
}

TEST(Limit, AnAccumulationOfAnyForcesGoesOnOnTheGroundThatThrew) {
  for (const char* name : {"thrown_from_a_turntable_round_a_disc", "thrown_by_a_spring_onto_a_turntable",
                           "thrown_into_a_disc_on_a_belt"}) {
    scene::Scene scene = read(name);
    const Passed coarse = pass(scene, 6);
    scene.solver.accuracy = 1e-13;
    const Passed fine = pass(scene, 6);
    EXPECT_EQ(coarse.record.halt, "") << name;
    ASSERT_NE(coarse.limit, nullptr) << name;
    ASSERT_NE(fine.limit, nullptr) << name;
    EXPECT_NEAR(coarse.limit->time, fine.limit->time, 1e-8) << name;
    EXPECT_LT((coarse.limit->position - fine.limit->position).norm(), 1e-8) << name;
    EXPECT_LT((coarse.record.states.back().position - fine.record.states.back().position).norm(), 1e-7)
        << name;
    // Continuous but for the slip that has been gained since the last throw.
    EXPECT_LT((coarse.limit->after.velocity - coarse.limit->before.velocity).norm(), 1e-4) << name;
  }
}

// A resistance acts along the edge in the limit, as all else does: what rounding leaves of the velocity
// across it decides.
TEST(Limit, AnAccumulationStaysOnTheGroundThatThrewWhereNothingLeadsAcrossTheEdge) {
  for (int i = 0; i < 16; ++i) {
    const Vector2d direction = Vector2d(7 - i, i - 4.5).normalized();
    const Vector2d normal = -turned(direction);
    scene::Scene scene;
    scene.sphere = {0.25, 0.375, 0.09375};
    scene.surface.base = Law::coulomb;
    scene.surface.base.friction = 0.25;
    scene.surface.base.rolling_resistance = 0.03125;
    scene.surface.base.belt = 3.375 * direction + 6 * normal;
    scene::Material mat(Law::rough);
    mat.rolling_resistance = 0.171875;
    scene.surface.regions = {{"mat", scene::HalfPlane{{1.25, 6.5}, normal}, mat}};
    scene.initial_state.position = {1.25, 6.5};
    scene.initial_state.velocity = -0.08 * direction - 0.14 * normal;
    scene.initial_state.angular_velocity << 0.5625 * direction - 0.3125 * normal, 0;
    Simulation simulation(scene);
    EXPECT_NO_THROW(simulation.advance_to(8, [](const Switch&) {})) << direction.transpose();
    EXPECT_EQ(simulation.state().region, "mat");
    EXPECT_EQ(simulation.state().twist.velocity.norm(), 0);
  }
}

// Two belts throw the sphere across a smooth wedge with the tip at 0, whose sides are y = +-x/5: by each
// throw it comes nearer to the tip, to (w - v/5)/(w + v/5) of the distance, v along the wedge and w across
// it.
scene::Scene wedge() {
  scene::Scene scene{};
  scene.sphere = {1, 1, 0.5};  // kappa = 1/5
  scene.surface.base = belt({0, 5});
  scene.surface.regions = {{"above", scene::HalfPlane{{0, 0}, {0, 1}}, belt({0, -5})},
                           {"wedge", scene::Polygon{{{-5, -1}, {0, 0}, {-5, 1}}, false}, Law::smooth}};
  scene.initial_state.position = {-2.25, 0};
  scene.initial_state.velocity = {0.5, 1};
  // p_c = (0.4 + 0.2 nu.x, 0): nu = R (w2, -w1)
  scene.initial_state.angular_velocity = {4, 0.5, 0};
  return scene;
}

// The edges of the wedge go on behind its tip, 7 degrees apart, the one under the ground of the other.
TEST(Limit, AnAccumulationInTheTipOfAWedgeGoesOnAlongTheEdgeThatIsSeen) {
  scene::Scene scene{};
  scene.sphere = {0.5, 0.625, 0.4296875};
  scene.surface.livelock = scene::Livelock::slide;
  scene.surface.regions = {{"under", scene::HalfPlane{{0, 0}, {4, 2}}, belt({-1, 0.25})},
                           {"above", scene::HalfPlane{{0, 0}, {-3, -2}}, belt({0.75, 2.75})}};
  scene.initial_state.position = {-2, 3};
  scene.initial_state.velocity = {1, -3};
  scene.initial_state.angular_velocity = {-0.375, 1.125, 7.125};
  Simulation simulation(scene);
  simulation.advance_to(4, {});
  const State& state = simulation.state();
  EXPECT_EQ(state.mode, Mode::edge_sliding);
  EXPECT_NEAR(state.position.dot(Vector2d(3, 2)), 0, 1e-13) << "on the edge of what lies on top";
  EXPECT_GT(state.position.x(), 1);
}

TEST(Limit, AnAccumulationInTheTipOfAWedgeGoesOnAlongTheEdgeBehindIt) {
  const scene::Scene scene = wedge();
  const Passed passed = pass(scene, 6);
  EXPECT_EQ(passed.record.halt, "");
  ASSERT_NE(passed.limit, nullptr);
  // Always 0.5 m/s along the wedge: p_c.n = 0.8 0.5 + 0.2 0.5.
  EXPECT_NEAR(passed.limit->time, 4.5, 1e-13);
  EXPECT_EQ(passed.limit->position, Vector2d(0, 0));
  EXPECT_EQ(passed.limit->after.velocity.y(), 0);
  EXPECT_NEAR(passed.limit->after.velocity.x(), 0.5, 1e-15);
  const RecordedState& end = passed.record.states.back();
  EXPECT_EQ(end.mode, Mode::edge_sliding);
  EXPECT_EQ(end.position.y(), 0);
  EXPECT_NEAR(end.position.x(), 0.75, 1e-13);
}

// The same belts go on behind the tip, beside an edge that is that of neither side.
TEST(Limit, AnAccumulationInTheTipOfAWedgeGoesOnAlongTheEdgeOfAThirdRegion) {
  scene::Scene scene = wedge();
  scene.surface.regions.push_back({"behind", scene::Polygon{{{0, 0}, {6, -6}, {6, 1}}, false}, belt({0, 5})});
  const Passed passed = pass(scene, 6);
  EXPECT_EQ(passed.record.halt, "");
  const RecordedState& end = passed.record.states.back();
  EXPECT_EQ(end.mode, Mode::edge_sliding);
  EXPECT_GT(end.position.x(), 0.5);
  EXPECT_NEAR(end.position.y(), end.position.x() / 6, 1e-13);
}

TEST(Limit, AnAccumulationIsPassedOnceWhereASinkThrowsAtItsLimit) {
  for (const char* name : {"thrown_into_a_disc_on_a_belt", "thrown_from_a_turntable_round_a_disc"}) {
    SCOPED_TRACE(name);
    const Record whole = record(read(name), 8, 8);
    ASSERT_NE(limit_in(whole.switches), nullptr);
    Simulation simulation(read(name));
    std::size_t heard = 0;
    const auto sink = [&](const Switch& event) {
      ++heard;
      if (event.cause == Cause::accumulation) throw std::logic_error("no room");
    };
    std::size_t thrown = 0;
    for (int i = 0; i <= 8; ++i) {
      try {
        simulation.advance_to(i, sink);
      } catch (const std::logic_error&) {
        ++thrown;
        simulation.advance_to(i, sink);
      }
      EXPECT_EQ(simulation.state().position, whole.states[static_cast<std::size_t>(i)].position) << i;
      EXPECT_EQ(simulation.state().twist.velocity, whole.states[static_cast<std::size_t>(i)].twist.velocity);
    }
    EXPECT_GT(thrown, 0U);
    EXPECT_EQ(heard, whole.switches.size());
  }
}

TEST(Limit, AnAccumulationWhoseLimitIsALivelockStopsWhereTheSceneAsksForThat) {
  scene::Scene scene = wedge();
  scene.surface.livelock = scene::Livelock::stop;
  Simulation simulation(scene);
  try {
    simulation.advance_to(6, {});
    FAIL() << "no halt";
  } catch (const HaltedError& error) {
    EXPECT_EQ(std::string(error.what()).find("livelock"), 0U) << error.what();
    EXPECT_NEAR(error.time(), 4.5, 1e-13);
  }
  // The last throws of the cycle, in which |v| q^2 d/4 <= 64 eps 5.1 with q = (0.9/1.1)^2 and v = (0.5, +-1).
  EXPECT_LT(simulation.state().position.norm(), 2e-12);
}

// Behind the tip there is smooth ground again: throws across it could begin in any way.
TEST(Limit, AnAccumulationBehindWhichNoMotionIsKnownEndsTheComputationAndSaysSo) {
  scene::Scene scene = wedge();
  scene.surface.regions.push_back({"behind", scene::Polygon{{{0, 0}, {5, -1}, {5, 1}}, false}, Law::smooth});
  Simulation simulation(scene);
  try {
    simulation.advance_to(6, {});
    FAIL() << "no halt";
  } catch (const HaltedError& error) {
    EXPECT_EQ(std::string(error.what()).find("switches accumulate at t = 4.5 s"), 0U) << error.what();
    EXPECT_NE(std::string(error.what()).find("no motion along the edge is known"), std::string::npos);
  }
}

}  // namespace
}  // namespace hybrid_sphere::testing::limit_test

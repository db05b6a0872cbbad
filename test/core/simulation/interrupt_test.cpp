// A computation that takes long can be interrupted, asked, changed and gone on with.

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "interrupt/interrupt.hpp"
#include "support/agreement.hpp"
#include "support/interrupted.hpp"

namespace hybrid_sphere::testing::interrupt_test {
namespace {

using scene::Law;

scene::Scene base_scene() {
  scene::Scene scene{};
  scene.sphere = {1, 0.1, 0.1 * std::sqrt(0.4)};
  scene.forces.gravity = {0, 0, -9.81};
  scene.initial_state.velocity = {1, 0};
  return scene;
}

/// Rolling on a tilted turntable so that the axis turns as fast as the sphere: many steps.
scene::Scene spinning(double turntable_rate) {
  scene::Scene scene = base_scene();
  scene.surface.base = Law::rough;
  scene.surface.base.turntable_rate = turntable_rate;
  scene.forces.gravity.x() = 1;
  scene.initial_state.position = {0.05, 0};
  return scene;
}

/// Integrated: friction on a turntable beside drag and a spring, with an edge now and then.
scene::Scene integrated() {
  scene::Scene scene = base_scene();
  scene::Material ground(Law::coulomb);
  ground.friction = 0.05;
  ground.turntable_rate = 2;
  scene.surface.base = ground;
  scene.surface.regions = {{"disc", scene::Circle{{0.4, 0.1}, 0.3}, Law::rough}};
  scene.forces.drag = {0.1, 0.01, 0.2};
  scene.forces.spring = {{0.2, 0}, 3};
  return scene;
}

/// Integrated, in and out of polygons with so many sides that each piece of the path is asked about often.
scene::Scene among_many_sides() {
  scene::Scene scene = integrated();
  scene.surface.regions.clear();
  for (const double radius : {0.4, 0.3, 0.2}) {
    scene::Polygon polygon;
    for (int i = 0; i < 300; ++i) {
      const double angle = 2 * M_PI * i / 300;
      polygon.vertices.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
    }
    scene.surface.regions.push_back(
        {"within " + std::to_string(radius), polygon, radius == 0.3 ? Law::rough : Law::smooth});
  }
  return scene;
}

/// A circle on a turntable that turns the sphere by many radians in a revolution.
scene::Scene periodic() {
  scene::Scene scene = base_scene();
  scene::Material ground(Law::rough);
  ground.turntable_rate = 0.01;
  scene.surface.base = ground;
  scene.initial_state.velocity = {3, 0};
  return scene;
}

/// Straight on over regions that all share their edges.
scene::Scene among_coincident_edges() {
  scene::Scene scene = base_scene();
  scene.initial_state.position = {-1, 0.3};
  const scene::Polygon square{{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
  for (int i = 0; i < 3000; ++i) {
    const scene::Material ground(i % 2 == 0 ? Law::rough : Law::smooth);
    scene.surface.regions.push_back({"region_" + std::to_string(i), square, ground});
  }
  return scene;
}

void expect_same(const Record& a, const Record& b) {
  EXPECT_EQ(a.halt, b.halt);
  ASSERT_EQ(a.switches.size(), b.switches.size());
  for (std::size_t i = 0; i < a.switches.size(); ++i) {
    EXPECT_EQ(a.switches[i].time, b.switches[i].time);
    EXPECT_EQ(a.switches[i].impulse, b.switches[i].impulse);
    EXPECT_EQ(a.switches[i].to, b.switches[i].to);
  }
  ASSERT_EQ(a.states.size(), b.states.size());
  for (std::size_t i = 0; i < a.states.size(); ++i) expect_same(a.states[i], b.states[i]);
}

TEST(Interrupt, AnInterruptedComputationGoesOnToTheSameBits) {
  struct Case {
    const char* name;
    scene::Scene scene;
    double until;
    std::uint32_t turns;  // between two questions
  };
  for (const Case& c : {Case{"spinning", spinning(5e4), 2, 256}, Case{"integrated", integrated(), 20, 256},
                        Case{"periodic", periodic(), 3000, 8}}) {
    SCOPED_TRACE(c.name);
    const Record whole = record(c.scene, c.until, 10);
    int stops = 0;
    double last = 0;
    const Record parts =
        record_interrupted(c.scene, c.until, 10, c.turns, 2, stops, [&](Simulation& simulation) {
          EXPECT_GE(simulation.time(), last) << "time never goes back";
          last = simulation.time();
        });
    EXPECT_GT(stops, 3);
    expect_same(parts, whole);
  }
}

TEST(Interrupt, AnInterruptedComputationIsAskedOftenAndKeepsWhatItHas) {
  Simulation simulation(spinning(1e11));
  int asked = 0;
  simulation.set_interrupt([&] { return ++asked % 10 == 0; });
  double last = 0;
  for (int i = 0; i < 20; ++i) {
    EXPECT_THROW(simulation.advance_to(1, {}), Interrupted);
    EXPECT_GT(simulation.time(), last) << "it comes on";
    last = simulation.time();
    EXPECT_EQ(asked, 10 * (i + 1));
  }
  EXPECT_LT(last, 1e-3);
}

// What it says there is what an undisturbed simulation says at that time.
TEST(Interrupt, AnInterruptedComputationStandsAtATimeUpToWhichAllIsKnown) {
  for (const scene::Scene& scene : {spinning(2e4), integrated()}) {
    int stops = 0;
    std::vector<RecordedState> seen;
    record_interrupted(scene, 5, 3, 64, 3, stops,
                       [&](Simulation& simulation) { seen.emplace_back(simulation); });
    ASSERT_GT(stops, 3);
    Simulation undisturbed(scene);
    for (const RecordedState& state : seen) {
      undisturbed.advance_to(state.time, {});
      expect_same(RecordedState(undisturbed), state);
    }
  }
}

// An exception of the question's own is no halt either: the state is told, and the next call goes on.
TEST(Interrupt, ThatThrowsIsHeardAndTheComputationGoesOn) {
  const QuestionsEvery questions(8);
  for (const scene::Scene& scene : {spinning(2e4), integrated(), among_many_sides()}) {
    const Record whole = record(scene, 5, 1);
    Simulation simulation(scene);
    int asked = 0;
    int patience = 7;  // a piece of the path is traced at once or not at all
    int thrown = 0;
    simulation.set_interrupt([&]() -> bool {
      if (++asked < patience) return false;
      asked = 0;
      patience += patience / 4;
      throw std::out_of_range("mine");
    });
    Switches switches;
    while (simulation.time() < 5) {
      try {
        simulation.advance_to(5, recorder(switches));
      } catch (const std::out_of_range& error) {
        ASSERT_STREQ(error.what(), "mine");
        ++thrown;
        EXPECT_EQ(contradiction(simulation.state(), simulation.reaction(), switches), "");
      }
    }
    EXPECT_GT(thrown, 3);
    ASSERT_EQ(switches.size(), whole.switches.size());
    for (std::size_t i = 0; i < switches.size(); ++i) {
      EXPECT_EQ(switches[i].time, whole.switches[i].time);
      EXPECT_EQ(switches[i].to, whole.switches[i].to);
    }
    expect_same(RecordedState(simulation), whole.states.back());
  }
}

// It has come to rest, and a torque makes it spin faster and faster about an axis that turns.
TEST(Interrupt, AnInterruptedComputationIsTheOrientationOfASphereThatHasComeToRest) {
  scene::Scene scene = base_scene();
  scene.forces.drag = {1, 0, 0.1};
  scene.forces.wrench.torque = {0, 0, 1};
  scene.initial_state.angular_velocity = {1, 0, 0};
  Simulation simulation(scene);
  simulation.set_interrupt([] { return true; });
  EXPECT_THROW(simulation.advance_to(1e6, {}), Interrupted);
}

// Where it is at rest its place is known for ever, and the orientation has to be followed all the same: no
// panel turns it by more than all those before.
TEST(Interrupt, AnInterruptedComputationIsTheOrientationAtEachNextTime) {
  const QuestionsEvery questions(4);
  scene::Scene scene = base_scene();
  scene.initial_state.velocity.setZero();
  scene.forces.drag = {1, 0, 0.5};
  scene.forces.wrench.torque = {0, 0, 0.1};
  scene.initial_state.angular_velocity = {1, 0, 0};
  Simulation simulation(scene);
  int asked = 0;
  simulation.set_interrupt([&] {
    ++asked;
    return false;
  });
  for (double t = 400; t < 1e6; t *= 3) {
    const int before = asked;
    simulation.advance_to(t, {});
    EXPECT_GT(asked, before) << "t = " << t;
  }
}

// A spring turns it to and fro by a small angle, more often than can be told at once; drag leaves no period.
TEST(Interrupt, AnInterruptedComputationIsTheOrientationOfASphereThatTurnsToAndFro) {
  scene::Scene scene = base_scene();
  scene.surface.base = Law::rough;
  scene.forces.spring = {{0, 0}, 1e6};
  scene.forces.drag.translational = 1e-9;
  scene.initial_state.position = {1e-6, 0};
  scene.initial_state.velocity = {0, 1e-3};
  scene.initial_state.angular_velocity = {-1e-2, 0, 1};
  Simulation simulation(scene);
  simulation.set_interrupt([] { return true; });
  EXPECT_THROW(simulation.advance_to(100, {}), Interrupted);
}

// Asked about as often as there are regions, it stops while the straight path is traced, and traces it anew.
TEST(Interrupt, AnInterruptedComputationIsAStraightPathAmongCoincidentEdges) {
  const scene::Scene scene = among_coincident_edges();
  const Record whole = record(scene, 3, 10);
  ASSERT_EQ(whole.switches.size(), 0U) << "the topmost region is smooth";
  Simulation simulation(scene);
  int asked = 0;
  simulation.set_interrupt([&] { return ++asked == 5; });
  EXPECT_THROW(simulation.advance_to(3, {}), Interrupted);
  EXPECT_EQ(asked, 5);
  EXPECT_EQ(simulation.time(), 0);
  simulation.advance_to(3, {});
  EXPECT_GT(asked, 20);
  expect_same(RecordedState(simulation), whole.states.back());
}

TEST(Interrupt, AnInterruptedComputationIsNoHalt) {
  Simulation simulation(spinning(1e7));
  bool stop = true;
  simulation.set_interrupt([&] { return stop; });
  EXPECT_THROW(simulation.advance_to(2, {}), Interrupted);
  simulation.kick({0.1, 0});
  stop = false;
  EXPECT_NO_THROW(simulation.advance_to(0.005, {}));
  stop = true;
  EXPECT_THROW(simulation.advance_to(2, {}), Interrupted);
  simulation.reset();
  EXPECT_EQ(simulation.time(), 0);
  stop = false;
  EXPECT_NO_THROW(simulation.advance_to(0.005, {}));
}

// A command, a kick, another ground and a reset come where the computation stands.
TEST(Interrupt, AnInterruptedComputationCanBeChangedWhereItStands) {
  const scene::Scene scene = integrated();
  const QuestionsEvery questions(8);
  for (int first = 1; first < 150; first += 7) {
    Simulation simulation(scene);
    int asked = 0;
    simulation.set_interrupt([&] { return ++asked == first; });
    ASSERT_THROW(simulation.advance_to(20, {}), Interrupted) << first;
    const double there = simulation.time();
    Simulation other(scene);
    other.advance_to(there, {});
    for (Simulation* each : {&simulation, &other}) {
      switch (first % 4) {
        case 0: each->kick({0.5, -0.25}); break;
        case 1: each->set_command({{0.5, 0.5}, {0, 0, 0.125}}); break;
        case 2: each->set_surface(spinning(0).surface); break;
        default: each->set_accuracy(1e-6); break;
      }
    }
    for (const double time : {there, there + 0.1, there + 5}) {
      simulation.advance_to(time, {});
      other.advance_to(time, {});
      expect_same(RecordedState(simulation), RecordedState(other));
    }
  }
}

// The edge is known on which the path begins that was not traced, also where the rounded place is beside it.
TEST(Interrupt, AnInterruptedComputationIsStillOnTheEdgeWhereItIsKicked) {
  const QuestionsEvery questions(1);
  for (int i = 0; i < 40; ++i) {
    SCOPED_TRACE(i);
    const double angle = 0.03 * i - 0.6;
    const Vector2d normal(std::cos(angle), std::sin(angle));
    scene::Scene scene = base_scene();
    scene.initial_state.position = {0.1, 0.7};
    scene.surface.regions = {{"half", scene::HalfPlane{{1.0 / 3, 2.0 / 3}, normal}, Law::rough}};
    Simulation whole(scene);
    Switches first;
    whole.advance_to(0.5, recorder(first));
    ASSERT_EQ(first.size(), 1U);
    whole.reset();
    whole.advance_to(first[0].time, {});

    Simulation simulation(scene);
    bool stops = true;
    simulation.set_interrupt([&] { return stops && simulation.time() > 0; });
    EXPECT_THROW(simulation.advance_to(1, {}), Interrupted);
    ASSERT_EQ(simulation.time(), first[0].time);
    stops = false;
    Switches switches[2];
    std::size_t which = 0;
    for (Simulation* each : {&whole, &simulation}) {
      each->kick(-3 * normal);
      each->advance_to(1, recorder(switches[which++]));
    }
    expect_same(RecordedState(simulation), RecordedState(whole));
    EXPECT_EQ(switches[0].size(), 1U) << "released, and not on the ground before";
    EXPECT_EQ(switches[1].size(), 1U);
  }
}

TEST(Interrupt, IsNotAskedForWhereThereIsAClosedFormNearBy) {
  scene::Scene scene = base_scene();
  scene.surface.regions = {{"half", scene::HalfPlane{{0.5, 0}, {1, 0}}, Law::rough}};
  Simulation simulation(scene);
  int asked = 0;
  simulation.set_interrupt([&] {
    ++asked;
    return false;
  });
  for (int i = 0; i < 10000; ++i) simulation.advance_to(1e-3 * i, {});
  EXPECT_EQ(asked, 0);
}

}  // namespace
}  // namespace hybrid_sphere::testing::interrupt_test

// Every ground that the sphere comes to is told, also where no switch is, and what the sink throws passes
// through.

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "hybrid_sphere/scene/read_scene.hpp"
#include "hybrid_sphere/simulation/simulation.hpp"
#include "support/files.hpp"

namespace hybrid_sphere::testing::region_sink_test {
namespace {

using scene::Law;

struct Told {
  double time;
  std::string region;
  bool operator==(const Told& other) const { return time == other.time && region == other.region; }
};

std::ostream& operator<<(std::ostream& out, const Told& told) {
  return out << "\"" << told.region << "\" at " << told.time;
}

Simulation::RegionSink recorder(std::vector<Told>& told) {
  return [&told](double time, std::string_view region) { told.push_back({time, std::string(region)}); };
}

/// Rolls at 1 m/s along x, from -1 over strips of the same law that begin at 0, 1, 2 ...
scene::Scene strips(const std::vector<Law>& laws, Law base = Law::rough) {
  scene::Scene scene{};
  scene.sphere = {1, 0.5, 0.25};
  scene.initial_state.position = {-1, 0};
  scene.initial_state.velocity = {1, 0};
  scene.initial_state.angular_velocity = {0, 2, 0};
  scene.surface.base = base;
  for (std::size_t i = 0; i < laws.size(); ++i) {
    const double x = static_cast<double>(i);
    scene.surface.regions.push_back(
        {"strip_" + std::to_string(i), scene::HalfPlane{{x, 0}, {1, 0}}, laws[i]});
  }
  return scene;
}

TEST(RegionSink, IsToldOfGroundsOfEqualLaws) {
  for (const Law law : {Law::smooth, Law::rough, Law::rubber}) {
    Simulation simulation(strips({law, law, law}, law));
    std::vector<Told> told;
    std::size_t switches = 0;
    simulation.set_region_sink(recorder(told));
    simulation.advance_to(10, [&](const Switch&) { ++switches; });
    EXPECT_EQ(told, (std::vector<Told>{{0, "base"}, {1, "strip_0"}, {2, "strip_1"}, {3, "strip_2"}}));
    EXPECT_EQ(switches, law == Law::smooth ? 0U : 1U);
  }
}

TEST(RegionSink, IsToldBeforeTheSwitchOfTheSameInstant) {
  Simulation simulation(strips({Law::rough, Law::smooth}, Law::smooth));
  std::vector<std::string> order;
  simulation.set_region_sink([&](double, std::string_view region) { order.emplace_back(region); });
  simulation.advance_to(10,
                        [&](const Switch& event) { order.push_back("to " + std::string(event.to_region)); });
  EXPECT_EQ(order, (std::vector<std::string>{"base", "strip_0", "to strip_0", "strip_1", "to strip_1"}));
}

scene::Scene scene_of(const std::string& folder, const std::string& name) {
  return scene::read_scene_file(std::string(TEST_DATA_DIR) + "/" + folder + "/" + name + ".yaml");
}

/// The grounds under the sphere and when they change, seen from outside: state().region at each time that the
/// sink has told, and just before it.
void expect_told_when_the_state_changes(const scene::Scene& scene, double duration, const std::string& name) {
  std::vector<Told> told;
  Simulation simulation(scene);
  simulation.set_region_sink(recorder(told));
  try {
    simulation.advance_to(duration);
  } catch (const HaltedError&) {
    duration = simulation.time();
  }
  ASSERT_FALSE(told.empty()) << name;
  EXPECT_EQ(told.front().time, 0) << name;
  EXPECT_EQ(simulation.state().region, told.back().region) << name;
  Simulation follower(scene);
  for (std::size_t i = 0; i < told.size(); ++i) {
    if (i + 1 < told.size()) {
      EXPECT_LE(told[i].time, told[i + 1].time) << name;
      EXPECT_NE(told[i].region, told[i + 1].region) << name << ": the same ground twice";
    }
    const bool is_last_then = i + 1 == told.size() || told[i + 1].time > told[i].time;
    if (!is_last_then || told[i].time >= duration) continue;
    const double before = std::nextafter(told[i].time, 0);
    if (before > follower.time()) {
      follower.advance_to(before);
      std::size_t then = i;
      while (then > 0 && told[then].time > before) --then;
      EXPECT_EQ(follower.state().region, told[then].region) << name << " before t = " << told[i].time;
    }
    follower.advance_to(told[i].time);
    EXPECT_EQ(follower.state().region, told[i].region) << name << " at t = " << told[i].time;
  }
}

TEST(RegionSink, IsToldWhenTheGroundOfTheStateChanges) {
  for (const std::string& name : yaml_files("oracle")) {
    expect_told_when_the_state_changes(scene_of("oracle", name), 3, name);
  }
  for (const char* name : {"chatter_through_a_corner", "thrown_into_a_disc_on_a_belt"}) {
    expect_told_when_the_state_changes(scene_of("accumulation", name), 3, name);
  }
}

TEST(RegionSink, DoesNotChangeTheMotion) {
  for (const std::string& name : yaml_files("oracle")) {
    const scene::Scene scene = scene_of("oracle", name);
    const auto end_of = [&](bool has_sink) {
      Simulation simulation(scene);
      if (has_sink) simulation.set_region_sink([](double, std::string_view) {});
      try {
        simulation.advance_to(2);
      } catch (const HaltedError&) {
      }
      const State& state = simulation.state();
      return std::make_tuple(simulation.time(), simulation.switches(), state.position, state.twist.velocity,
                             state.twist.angular_velocity);
    };
    EXPECT_EQ(end_of(false), end_of(true)) << name;
  }
}

TEST(RegionSink, IsToldAnewAfterAnotherInitialState) {
  Simulation simulation(strips({Law::rough}));
  std::vector<Told> told;
  simulation.set_region_sink(recorder(told));
  simulation.advance_to(0.5);
  scene::InitialState there = strips({}).initial_state;
  there.position = {3, 0};
  simulation.set_initial_state(there);
  EXPECT_EQ(told.size(), 1U) << "the ground acts in the first advance_to";
  simulation.advance_to(1);
  simulation.reset();
  simulation.advance_to(1);
  EXPECT_EQ(told, (std::vector<Told>{{0, "base"}, {0, "strip_0"}, {0, "strip_0"}}));
}

TEST(RegionSink, IsToldTheGroundThatIsPutUnderTheSphere) {
  Simulation simulation(strips({Law::rough}));
  std::vector<Told> told;
  simulation.set_region_sink(recorder(told));
  simulation.advance_to(0.5);
  scene::Surface other = strips({Law::smooth}).surface;
  other.regions[0] = {"mat", scene::HalfPlane{{-2, 0}, {1, 0}}, Law::rough};
  simulation.set_surface(other);
  simulation.advance_to(1);
  EXPECT_EQ(told, (std::vector<Told>{{0, "base"}, {0.5, "mat"}}));
}

TEST(RegionSink, IsNotToldAgainOfTheSameGroundByForcesAndImpulses) {
  Simulation simulation(strips({}));
  std::vector<Told> told;
  simulation.set_region_sink(recorder(told));
  simulation.advance_to(0.25);
  simulation.kick({1, 0});
  simulation.advance_to(0.5);
  simulation.set_command({{0, 1}, {0, 0, 0}});
  simulation.advance_to(0.75);
  EXPECT_EQ(told, (std::vector<Told>{{0, "base"}}));
}

TEST(RegionSink, MayBeTakenAway) {
  Simulation simulation(strips({Law::rough}));
  std::vector<Told> told;
  simulation.set_region_sink(recorder(told));
  simulation.advance_to(0);
  simulation.set_region_sink({});
  simulation.advance_to(5);
  EXPECT_EQ(told.size(), 1U);
}

struct Enough : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Throws each time that it is told.
TEST(RegionSink, MayThrowAndTheRunGoesOn) {
  const scene::Scene scene = strips({Law::rough, Law::rough, Law::smooth, Law::rough}, Law::smooth);
  std::vector<double> expected;
  Simulation undisturbed(scene);
  undisturbed.advance_to(10, [&](const Switch& event) { expected.push_back(event.time); });

  Simulation simulation(scene);
  std::vector<std::string> regions;
  std::vector<double> switches;
  simulation.set_region_sink([&](double, std::string_view region) {
    regions.emplace_back(region);
    throw Enough("enough");
  });
  const auto note = [&](const Switch& event) { switches.push_back(event.time); };
  for (int i = 0; i < 5; ++i) EXPECT_THROW(simulation.advance_to(10, note), Enough) << i;
  EXPECT_NO_THROW(simulation.advance_to(10, note));
  EXPECT_EQ(regions, (std::vector<std::string>{"base", "strip_0", "strip_1", "strip_2", "strip_3"}));
  EXPECT_EQ(switches, expected) << "no switch is lost";
  EXPECT_EQ(simulation.switches(), undisturbed.switches());
  EXPECT_EQ(simulation.state().position, undisturbed.state().position);
  EXPECT_EQ(simulation.state().twist.velocity, undisturbed.state().twist.velocity);
}

TEST(RegionSink, LetsPassWhatTheSwitchSinkThrowsAtTheSameInstant) {
  Simulation simulation(strips({}));
  simulation.set_region_sink([](double, std::string_view) { throw Enough("enough"); });
  EXPECT_THROW(simulation.advance_to(1, [](const Switch&) { throw std::logic_error("of the switch"); }),
               std::logic_error);
  EXPECT_EQ(simulation.switches(), 1U);
  EXPECT_NO_THROW(simulation.advance_to(1));
}

TEST(RegionSink, PassesOnWhatTheSwitchSinkThrows) {
  Simulation simulation(strips({Law::rough}, Law::smooth));
  std::vector<Told> told;
  simulation.set_region_sink(recorder(told));
  EXPECT_THROW(simulation.advance_to(10, [](const Switch&) { throw Enough("enough"); }), Enough);
  EXPECT_EQ(told.size(), 2U);
  simulation.advance_to(10);
  EXPECT_EQ(told.size(), 2U);
}

}  // namespace
}  // namespace hybrid_sphere::testing::region_sink_test

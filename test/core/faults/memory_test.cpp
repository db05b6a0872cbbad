// Every allocation fails in turn, alone and with all that follow it: what comes out is std::bad_alloc or a
// refusal in words, nothing is leaked, and the next try without a fault succeeds.

#include <gtest/gtest.h>

#include <fstream>
#include <functional>
#include <limits>
#include <new>

#include "hybrid_sphere/scene/read_scene.hpp"
#include "hybrid_sphere/simulation/simulation.hpp"
#include "scene/cell_map.hpp"
#include "scene/grey_image.hpp"
#include "scene/read_tree.hpp"
#include "scene/yaml.hpp"
#include "support/command_line.hpp"
#include "support/failing_memory.hpp"
#include "support/temporary_file.hpp"
#include "support/three_stage_line.hpp"

namespace hybrid_sphere::testing::memory_test {
namespace {

constexpr std::size_t all = std::numeric_limits<std::size_t>::max();

/// True: done; false: ended by a fault in a way that is allowed.
bool outcome(const std::function<void()>& action) {
  try {
    action();
    return true;
  } catch (const std::bad_alloc&) {
  } catch (const scene::SceneError& error) {
    EXPECT_STRNE(error.what(), "");
  } catch (const scene::ImageError& error) {
    EXPECT_STRNE(error.what(), "");
  } catch (const HaltedError& error) {
    EXPECT_STRNE(error.what(), "");
  }
  return false;
}

/// @param step  between the allocations that fail: 1 for each of them
void expect_survival(const std::function<void()>& action, std::size_t step = 1) {
  action();  // what is made once is made
  for (const std::size_t count : {std::size_t{1}, all}) {
    bool failed = true;
    for (std::size_t first = 1; failed; first += step) {
      const long before = memory::live();
      memory::fail(first, count);
      const bool done = outcome(action);
      failed = memory::stop();
      EXPECT_TRUE(done || failed) << "allocation " << first;
      ASSERT_EQ(memory::live(), before)
          << "leaked where allocation " << first << " of " << count << " failed";
    }
    EXPECT_TRUE(outcome(action));
  }
}

const char* const scene_text = R"(
sphere: {mass: 1, radius: 0.1, body: solid}
initial_state: {position: [-1, 0.01], velocity: [1, 0.3], angular_velocity: [2, 4, 1], orientation: [0, 0, 0, 1]}
surface:
  base: &rough {law: rough}
  regions:
  - {name: "a name that is longer than a short text", half_plane: {point: [0, 0], normal: [1, 0]}, law: smooth}
  - name: triangle
    polygon: &corners [[0.1, 0.1], [1.5, 0.2], [1, 1]]
    law: coulomb
    friction: 0.3
  - {name: above, polygon: *corners, law: rubber, outside: true}
  - {name: disc, circle: {center: [0.5, 0], radius: 0.25}, law: rough, turntable: {rate: 1, center: [0.5, 0]}}
gravity: [0.1, 0, -9.81]
drag: {translational: 0.1}
solver: {accuracy: 1e-6, method: dopri5}
)";

TEST(Memory, IsMissingWhileAYamlTextIsRead) {
  expect_survival([] { scene::tree_from_yaml(scene_text); });
}

TEST(Memory, IsMissingWhileASceneIsRead) {
  expect_survival([] { scene::read_scene(scene::tree_from_yaml(scene_text)); });
}

TEST(Memory, IsMissingWhileASceneIsRefused) {
  expect_survival([] {
    try {
      scene::read_scene(scene::tree_from_yaml("sphere: {mass: 1, raduis: 1}"));
    } catch (const scene::SceneError&) {
    }
  });
}

TEST(Memory, IsMissingWhileACopyOfATreeIsMade) {
  const scene::Tree tree = scene::tree_from_yaml(scene_text);
  memory::fail(1, all);
  const scene::Tree copy = tree;
  EXPECT_FALSE(memory::stop()) << "a copy takes memory";
  EXPECT_EQ(copy.as_map()->size(), tree.as_map()->size());
}

TEST(Memory, IsMissingWhileImagesAreRead) {
  for (const char* name :
       {"grey_8.png", "rgba.png", "grey_16.png", "palette.png", "office.pgm", "corner.pgm"}) {
    const std::string path = std::string(TEST_DATA_DIR) + "/images/" + name;
    expect_survival([&path] { scene::read_grey_image(path); });
  }
}

TEST(Memory, IsMissingWhileASceneWithAMapIsRead) {
  const TemporaryFile file("with_map.yaml");
  file.fill("sphere: {mass: 1, radius: 0.1, body: solid}\nsurface: {image: {map: " +
            std::string(TEST_DATA_DIR) + "/images/office.yaml}}\n");
  expect_survival([&file] { scene::read_scene_file(file.path()); });
}

TEST(Memory, IsMissingWhileCellsBecomeRegions) {
  scene::CellMap cells{20, 20, 0.1, {0, 0}, std::vector<std::uint8_t>(400)};
  for (std::size_t i = 0; i < 400; ++i) cells.belonging[i] = i * i * 7 % 5 < 2 ? 1 : 0;
  expect_survival([&cells] { scene::regions_of(cells, scene::Law::rough, "cell_", "cells"); });
}

TEST(Memory, IsMissingWhileTheSphereMoves) {
  scene::Scene scene = scene::read_scene(scene::tree_from_yaml(scene_text));
  // Not those of SUNDIALS, whose version 6.4 uses what malloc did not give (SUNLogger_Create).
  for (const scene::Solver::Method method :
       {scene::Solver::Method::dopri87, scene::Solver::Method::dopri5, scene::Solver::Method::rk4}) {
    scene.solver.method = method;
    const auto run = [&scene] {
      Simulation simulation(scene);
      simulation.advance_to(2, [](const Switch&) {});
      static_cast<void>(simulation.state());
    };
    expect_survival(run);
  }
}

TEST(Memory, IsMissingWhileSimulateWritesItsTables) {
  const TemporaryFile scene("scene.yaml");
  const TemporaryFile states("states.csv");
  const TemporaryFile switches("switches.csv");
  scene.fill(scene_text);
  std::size_t refused = 0;
  const auto run = [&] {
    const CommandResult result = simulate({scene.path(), "--duration", "2", "--states", states.path(),
                                           "--switches", switches.path(), "--explain", "--timing"});
    if (result.exit_code == cli::done) return;
    ++refused;
    EXPECT_TRUE(result.exit_code == cli::refused || result.exit_code == cli::could_not_go_on)
        << result.exit_code;
    throw std::bad_alloc();
  };
  expect_survival(run, 7);
  EXPECT_GT(refused, 10U);
}

TEST(Memory, IsMissingWhileTheAccuracyIsSet) {
  Simulation simulation(scene::read_scene(scene::tree_from_yaml(scene_text)));
  simulation.advance_to(0.5, {});
  bool refused = false;
  memory::fail(1, all);
  try {
    simulation.set_accuracy(1e-9);
  } catch (const std::bad_alloc&) {
    refused = true;
  }
  memory::stop();
  ASSERT_TRUE(refused);
  Simulation other(scene::read_scene(scene::tree_from_yaml(scene_text)));
  other.advance_to(0.5, {});
  for (Simulation* each : {&simulation, &other}) {
    each->set_accuracy(1e-9);
    each->advance_to(1, {});
  }
  EXPECT_EQ(simulation.state().position, other.state().position);
  EXPECT_EQ(simulation.evaluations(), other.evaluations());
}

}  // namespace
}  // namespace hybrid_sphere::testing::memory_test

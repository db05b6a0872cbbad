// After the first advance the step loop takes no memory, over however many outputs and switches.

#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <new>

#include "hybrid_sphere/simulation/simulation.hpp"
#include "support/agreement.hpp"

namespace {

std::atomic<long> allocations{0};
std::atomic<long> until_failure{-1};  // so many more succeed; negative: all

bool fails() { return until_failure >= 0 && until_failure-- == 0; }

void* counted(std::size_t size) {
  ++allocations;
  if (fails()) throw std::bad_alloc();
  if (void* memory = std::malloc(size > 0 ? size : 1)) return memory;
  throw std::bad_alloc();
}

void* counted(std::size_t size, std::align_val_t alignment) {
  ++allocations;
  if (fails()) throw std::bad_alloc();
  const auto step = static_cast<std::size_t>(alignment);
  if (void* memory = std::aligned_alloc(step, (size + step - 1) / step * step)) return memory;
  throw std::bad_alloc();
}

}  // namespace

void* operator new(std::size_t size) { return counted(size); }
void* operator new[](std::size_t size) { return counted(size); }
void* operator new(std::size_t size, std::align_val_t alignment) { return counted(size, alignment); }
void* operator new[](std::size_t size, std::align_val_t alignment) { return counted(size, alignment); }
// That of std::stable_sort and the like.
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  ++allocations;
  return fails() ? nullptr : std::malloc(size > 0 ? size : 1);
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete[](void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete[](void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete(void* memory, const std::nothrow_t&) noexcept { std::free(memory); }
void operator delete(void* memory, std::align_val_t) noexcept { std::free(memory); }
void operator delete[](void* memory, std::align_val_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept { std::free(memory); }
void operator delete[](void* memory, std::size_t, std::align_val_t) noexcept { std::free(memory); }

namespace hybrid_sphere::testing::allocation_test {
namespace {

// Strips, discs and squares, many of which share corners and edges, so that ties are decided exactly, too.
scene::Scene busy_scene() {
  scene::Scene scene{};
  scene.sphere = {1, 0.25, 0.1};
  scene.initial_state.position = {-1, 0};
  scene.initial_state.velocity = {1, 1};
  scene.initial_state.angular_velocity = {-4, 4, 1};
  for (int i = 0; i < 60; ++i) {
    const scene::Law law = i % 2 == 0 ? scene::Law::rough : scene::Law::smooth;
    const double x = i;
    const std::string n = std::to_string(i);
    scene.surface.regions.push_back({"strip_of_the_board_" + n, scene::HalfPlane{{x, 0}, {1, 0.1}}, law});
    scene.surface.regions.push_back({"disc_of_the_board_" + n, scene::Circle{{x, x + 1}, 0.5, false}, law});
    scene.surface.regions.push_back({"square_of_the_board_" + n,
                                     scene::Polygon{{{x, x}, {x + 1, x}, {x + 1, x + 1}, {x, x + 1}}, false},
                                     law});
  }
  return scene;
}

TEST(StepLoop, AllocatesNothingAfterItsFirstStep) {
  Simulation simulation(busy_scene());
  long switches = 0;
  const Simulation::SwitchSink sink = [&switches](const Switch& event) {
    switches += event.time >= 0 ? 1 : 0;
  };
  simulation.advance_to(0, sink);
  double checksum = 0;
  const long before = allocations;
  for (int i = 1; i <= 100000; ++i) {
    simulation.advance_to(1e-3 * i, sink);
    const State& state = simulation.state();
    checksum += state.position.x() + state.orientation.w();
  }
  EXPECT_EQ(allocations - before, 0) << "over " << switches << " switches";
  EXPECT_GT(switches, 50);
  EXPECT_TRUE(std::isfinite(checksum));
}

TEST(StepLoop, AllocatesNothingOverAThrowBack) {
  scene::Scene scene = busy_scene();
  scene.initial_state.angular_velocity = {0, -100, 0};
  Simulation simulation(scene);
  const Simulation::SwitchSink sink = [](const Switch&) {};
  simulation.advance_to(0, sink);
  const long before = allocations;
  simulation.advance_to(100, sink);
  EXPECT_EQ(allocations - before, 0);
  EXPECT_GE(simulation.switches(), 2U);
}

TEST(StepLoop, AllocatesNothingInAReset) {
  Simulation simulation(busy_scene());
  simulation.advance_to(10, {});
  const long before = allocations;
  simulation.reset();
  simulation.advance_to(10, {});
  EXPECT_EQ(allocations - before, 0);
}

scene::Scene pushed_scene() {
  scene::Scene scene = busy_scene();
  scene.forces.gravity = {0.25, 0.125, -8};
  return scene;
}

// Runs to and fro over its ground once to make room, then again from the start and counts.
long allocations_of_second_run(const scene::Scene& scene, bool commands = false) {
  Simulation simulation(scene);
  const Simulation::SwitchSink sink = [](const Switch&) {};
  const auto run = [&] {
    simulation.reset();
    for (int i = 1; i <= 4000; ++i) {
      if (commands) simulation.set_command({{1e-3 * (i % 7), 0.01}, {0, 0, 1e-3 * (i % 3)}});
      simulation.advance_to(2e-3 * i, sink);
      EXPECT_TRUE(simulation.state().position.allFinite());
    }
  };
  run();
  const long before = allocations;
  run();
  return allocations - before;
}

TEST(StepLoop, AllocatesNothingOnAnIncline) { EXPECT_EQ(allocations_of_second_run(pushed_scene()), 0); }

TEST(StepLoop, AllocatesNothingOnATurntable) {
  scene::Scene scene = busy_scene();
  scene.surface.base = scene::Law::rough;
  scene.surface.base.turntable_rate = 2;
  EXPECT_EQ(allocations_of_second_run(scene), 0);
}

TEST(StepLoop, AllocatesNothingOnCoulombGround) {
  scene::Scene scene = pushed_scene();
  for (scene::Region& region : scene.surface.regions) {
    if (region.material.law != scene::Law::rough) continue;
    region.material.law = scene::Law::coulomb;
    region.material.friction = 0.05;
  }
  EXPECT_EQ(allocations_of_second_run(scene), 0);
}

TEST(StepLoop, AllocatesNothingWhereTheMotionIsIntegrated) {
  scene::Scene scene = pushed_scene();
  scene.forces.drag.quadratic = 0.125;
  EXPECT_EQ(allocations_of_second_run(scene), 0);
}

TEST(StepLoop, AllocatesNothingForANewCommandAtEveryTick) {
  EXPECT_EQ(allocations_of_second_run(pushed_scene(), true), 0);
}

TEST(Counter, CountsAllocations) {
  const long before = allocations;
  const std::string text(100, 'x');
  EXPECT_EQ(allocations - before, 1) << text;
}

// Smooth, sliding and rolling with drag, so that motions are integrated; a belt takes over the rolling
// sphere.
scene::Scene varied_scene() {
  scene::Scene scene = busy_scene();
  scene.surface.regions.resize(12);
  scene.surface.regions[3].material.law = scene::Law::coulomb;
  scene.surface.regions[3].material.friction = 0.25;
  scene.surface.regions[6].material.rolling_resistance = 0.05;
  scene.surface.regions[9].material.law = scene::Law::rough;
  scene.surface.regions[9].material.belt = {0.25, 0.125};
  scene.forces.gravity = {0.1, 0, -9.81};
  scene.forces.drag.translational = 0.1;
  return scene;
}

struct Played {
  Switches switches;
  RecordedState last;
  bool halted = false;
};

// With the sink out of the count: only what the simulation takes may fail.
Played play(const scene::Scene& scene, long failing) {
  Simulation simulation(scene);
  Switches switches;
  const Simulation::SwitchSink sink = [&switches](const Switch& event) {
    const long left = until_failure.exchange(-1);
    switches.emplace_back(event);
    until_failure = left;
  };
  bool halted = false;
  until_failure = failing;
  try {
    for (int i = 1; i <= 12 && !halted; ++i) simulation.advance_to(0.5 * i, sink);
  } catch (const HaltedError&) {
    halted = true;
  }
  const State state = simulation.state();
  const Vector3d reaction = simulation.reaction();
  until_failure = -1;
  EXPECT_EQ(contradiction(state, reaction, switches), "") << failing << " at " << state.time;
  Played played{switches, RecordedState(simulation), halted};
  if (!halted) return played;
  // What has halted begins again as if nothing had been.
  simulation.reset();
  Switches again;
  for (int i = 1; i <= 12; ++i) simulation.advance_to(0.5 * i, recorder(again));
  played.last = RecordedState(simulation);
  for (std::size_t i = 0; i < switches.size(); ++i) EXPECT_EQ(again.at(i).time, switches[i].time) << failing;
  played.switches = again;
  return played;
}

TEST(OutOfMemory, HaltsTheSimulationInAConsistentState) {
  const scene::Scene scene = varied_scene();
  const Played whole = play(scene, -1);
  ASSERT_FALSE(whole.halted);
  ASSERT_GT(whole.switches.size(), 4U);
  long failing = 0;
  for (bool fails = true; fails; ++failing) {
    const Played played = play(scene, failing);
    fails = played.halted;
    ASSERT_EQ(played.switches.size(), whole.switches.size()) << failing;
    EXPECT_EQ(played.last.position, whole.last.position) << failing;
    EXPECT_EQ(played.last.orientation.coeffs(), whole.last.orientation.coeffs()) << failing;
  }
  EXPECT_GT(failing, 10) << "it takes memory";
}

TEST(OutOfMemory, LeavesTheGroundAsItWas) {
  const scene::Scene scene = varied_scene();
  scene::Surface other = scene.surface;
  other.base.law = scene::Law::rough;
  Simulation simulation(scene);
  simulation.advance_to(0.1, {});
  bool fails = true;
  for (long failing = 0; fails; ++failing) {
    const auto before = simulation.ground();
    until_failure = failing;
    try {
      simulation.set_surface(other);
      fails = false;
    } catch (const std::bad_alloc&) {
    }
    until_failure = -1;
    if (fails) {
      EXPECT_EQ(simulation.ground(), before);
      EXPECT_NO_THROW(simulation.advance_to(simulation.time() + 1e-6, {}));
    }
  }
  EXPECT_NO_THROW(simulation.advance_to(1, {}));
  EXPECT_EQ(simulation.surface().base.law, scene::Law::rough);
}

}  // namespace
}  // namespace hybrid_sphere::testing::allocation_test

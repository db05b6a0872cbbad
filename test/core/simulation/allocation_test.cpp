// After the first advance the step loop takes no memory, over however many outputs and switches.

#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <new>

#include "hybrid_sphere/simulation/simulation.hpp"

namespace {

std::atomic<long> allocations{0};

void* counted(std::size_t size) {
  ++allocations;
  if (void* memory = std::malloc(size > 0 ? size : 1)) return memory;
  throw std::bad_alloc();
}

void* counted(std::size_t size, std::align_val_t alignment) {
  ++allocations;
  const auto step = static_cast<std::size_t>(alignment);
  if (void* memory = std::aligned_alloc(step, (size + step - 1) / step * step)) return memory;
  throw std::bad_alloc();
}

}  // namespace

void* operator new(std::size_t size) { return counted(size); }
void* operator new[](std::size_t size) { return counted(size); }
void* operator new(std::size_t size, std::align_val_t alignment) { return counted(size, alignment); }
void* operator new[](std::size_t size, std::align_val_t alignment) { return counted(size, alignment); }
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete[](void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete[](void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::align_val_t) noexcept { std::free(memory); }
void operator delete[](void* memory, std::align_val_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept { std::free(memory); }
void operator delete[](void* memory, std::size_t, std::align_val_t) noexcept { std::free(memory); }

namespace hybrid_sphere::testing {
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

}  // namespace
}  // namespace hybrid_sphere::testing

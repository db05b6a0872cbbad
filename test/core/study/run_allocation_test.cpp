// Where the initial state alone varies and every motion has a closed form, a run takes no memory: what a
// block of runs takes does not depend on how many they are.

#include <gtest/gtest.h>

#include <cstdlib>
#include <new>

#include "study/experiment.hpp"

namespace {

long allocations = 0;

void* counted(std::size_t size) {
  ++allocations;
  if (void* memory = std::malloc(size > 0 ? size : 1)) return memory;
  throw std::bad_alloc();
}

}  // namespace

void* operator new(std::size_t size) { return counted(size); }
void* operator new[](std::size_t size) { return counted(size); }
// std::stable_sort takes its buffer with this one.
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  ++allocations;
  return std::malloc(size > 0 ? size : 1);
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete[](void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete(void* memory, const std::nothrow_t&) noexcept { std::free(memory); }
void operator delete[](void* memory, std::size_t) noexcept { std::free(memory); }

namespace hybrid_sphere::testing::run_allocation_test {
namespace {

using namespace study;

const char* const yaml = R"(
scene:
  sphere: {mass: 2, radius: 0.25, body: solid}
  initial_state: {position: [-1, 0.1], velocity: [1.5, 0.1]}
  surface:
    base: {law: coulomb, friction: 0.3}
    regions:
      - {name: the_belt_with_a_long_name, law: rough, belt: [0.5, 0.1], polygon: [[0, -3], [1, -3], [1, 3], [0, 3]]}
      - {name: ice, law: smooth, half_plane: {point: [1, 0], normal: [1, 0]}}
runs: 2000
duration: 4
vary:
  initial_state.velocity[0]: {normal: {mean: 1.5, deviation: 0.5}}
  initial_state.velocity[1]: {normal: {mean: 0, deviation: 0.5}}
correlate: [{variables: ['initial_state.velocity[0]', 'initial_state.velocity[1]'], covariance: [[0.25, 0.1], [0.1, 0.25]]}]
keep:
  end: [position, velocity, angular_velocity, orientation, slip, energy, stage, mode, region]
  at: {times: [0, 1, 2], fields: [position, region]}
  switches: {first: 4}
  entered: [ice, the_belt_with_a_long_name]
  extremes: [speed, slip, energy_lost]
)";

long allocations_of(Experiment& experiment, Chunk& chunk, std::uint64_t first, std::uint64_t count) {
  const std::function<bool()> go_on = [] { return false; };
  const long before = allocations;
  experiment.run(first, count, chunk, go_on);
  return allocations - before;
}

TEST(Run, TakesNoMemoryOfItsOwn) {
  const Study study = read_study_text(yaml);
  Experiment experiment(study);
  Chunk chunk(experiment.columns().all);
  allocations_of(experiment, chunk, 0, 1000);  // takes what all of them use
  const long of_few = allocations_of(experiment, chunk, 1000, 10);
  const long of_many = allocations_of(experiment, chunk, 1000, 1000);
  EXPECT_EQ(of_few, of_many);
  EXPECT_LT(of_few, 10);
}

}  // namespace
}  // namespace hybrid_sphere::testing::run_allocation_test

// What a study costs beside the simulation that it runs, in one thread; CSV, one line for each figure:
//   what,value
// The paper's scene for 5 s, with a velocity and a place that vary: alone, each run is set_initial_state(),
// advance_to() and state() of one Simulation, with the samples drawn before; as a study of eight kept
// numbers, it is all that a process does up to the journal on the disk. Blocks of both take turns. The same
// for a dearer scene. The journal: bytes a second that one process can append.
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <string>

#include "study/experiment.hpp"
#include "study/journal.hpp"

namespace {

using namespace hybrid_sphere;
using Clock = std::chrono::steady_clock;

study::Study read(const std::string& scene) {
  return study::read_study_text("scene: " SCENES "/" + scene +
                                "\nruns: 1000000\nsample: sobol\nseed: 1\nduration: 5\n"
                                "vary:\n"
                                "  initial_state.velocity[0]: {normal: {mean: 1.0, deviation: 0.05}}\n"
                                "  initial_state.position[1]: {uniform: [-0.5, 0.5]}\n"
                                "keep: {end: [position, velocity, angular_velocity, energy]}\n");
}

double seconds(const std::function<void()>& work) {
  const auto start = Clock::now();
  work();
  return std::chrono::duration<double>(Clock::now() - start).count();
}

std::string scratch_file() {
  return (std::filesystem::temp_directory_path() / ("study_costs_" + std::to_string(getpid()))).string();
}

/// ns a run: alone and as a study.
void compare(const char* name, const std::string& scene, std::uint64_t blocks) {
  const study::Study study = read(scene);
  study::Experiment experiment(study);
  const study::Samples samples(study);
  const std::string file = scratch_file();
  study::Journal journal = study::Journal::create(file, "costs");
  std::remove(file.c_str());
  scene::Scene start = study::scene_of(study, study.scene_tree);
  Simulation simulation(start);
  simulation.follow_orientation(false);
  study::Chunk chunk(experiment.columns().all);
  std::vector<unsigned char> bytes;
  std::vector<double> drawn(2 * study.chunk);
  double alone = 0;
  double whole = 0;
  double sum = 0;
  for (std::uint64_t block = 0; block < blocks; ++block) {
    samples.values(block * study.chunk, study.chunk, drawn.data());
    alone += seconds([&] {
      for (std::uint64_t i = 0; i < study.chunk; ++i) {
        start.initial_state.velocity.x() = drawn[2 * i];
        start.initial_state.position.y() = drawn[2 * i + 1];
        simulation.set_initial_state(start.initial_state);
        simulation.advance_to(study.duration);
        sum += simulation.state().position.x();
      }
    });
    whole += seconds([&] {
      experiment.run(block * study.chunk, study.chunk, chunk, [] { return false; });
      chunk.encode(bytes);
      journal.append(block, bytes);
    });
  }
  const auto runs = static_cast<double>(blocks * study.chunk);
  if (!(sum == sum)) std::puts("");
  std::printf("%s alone_ns,%.4g\n%s study_ns,%.4g\n%s bytes_a_run,%.3g\n", name, 1e9 * alone / runs, name,
              1e9 * whole / runs, name, static_cast<double>(bytes.size()) / static_cast<double>(study.chunk));
}

void measure_journal() {
  constexpr std::uint64_t records = 2000;
  const std::string file = scratch_file();
  study::Journal journal = study::Journal::create(file, "costs");
  std::remove(file.c_str());
  constexpr std::size_t size = 262144;  // of a chunk of 4096 runs
  const std::vector<unsigned char> bytes(size, 17);
  const double time = seconds([&] {
    for (std::uint64_t i = 0; i < records; ++i) journal.append(i, bytes);
  });
  std::printf("journal bytes_a_second,%.3g\n", static_cast<double>(records * bytes.size()) / time);
}

}  // namespace

int main() {
  std::puts("what,value");
  compare("paper", "paper.yaml", 500);
  compare("incline", "incline.yaml", 100);
  compare("turntable", "turntable.yaml", 20);
  measure_journal();
}

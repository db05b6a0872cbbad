#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "hybrid_sphere/simulation/simulation.hpp"
#include "python/kept_switches.hpp"
#include "python/scene_of.hpp"
#include "python/state_layout.hpp"
#include "simulation/scene_variation.hpp"

namespace hybrid_sphere::python {

/// Many runs: what is asked for.
struct BatchRequest {
  std::size_t runs = 0;
  std::vector<double> times;  ///< ascending [s]
  bool keep_switches = false;
  std::size_t threads = 1;
  std::vector<scene::Scene> scenes;  ///< one for each run; or empty, and
  SceneSource scene;                 ///< one for all, whose numbers at these paths
  std::vector<std::string> paths;
  std::vector<double> samples;  ///< are these, a run after another
};

/// Runs that could not be computed to their end.
struct BatchHalt {
  std::size_t run;
  HaltedError error;
};

/// The runs, in blocks that any number of threads compute; what they leave does not depend on how many.
class Batch {
 public:
  /// @param request  has to live as long as this
  /// @param items    of the states: runs x times
  Batch(const BatchRequest& request, const StateLayout& layout, char* items);

  /// @param should_stop  asked by the calling thread
  /// @throws SceneError   the one of the first run that is refused
  /// @throws Interrupted  if should_stop says so
  void compute(const std::function<bool()>& should_stop);

  /// Of all runs, in order. To be called once.
  KeptSwitches take_switches();
  std::vector<BatchHalt> halts() const;

 private:
  struct Block {
    KeptSwitches switches;
    std::vector<BatchHalt> halts;
  };
  class Worker;

  void work(const std::function<bool()>& should_stop);
  void fail(std::size_t run);

  const BatchRequest& request_;
  const StateLayout& layout_;
  char* items_;
  std::size_t block_size_;  // runs
  std::vector<Block> blocks_;
  std::atomic<std::size_t> next_block_{0};
  std::atomic<bool> stopped_{false};
  std::mutex failed_;
  std::size_t failed_run_ = static_cast<std::size_t>(-1);
  std::exception_ptr failure_;  // of that run, the first one so far
};

}  // namespace hybrid_sphere::python

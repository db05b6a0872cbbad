#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "hybrid_sphere/scene/scene.hpp"
#include "hybrid_sphere/simulation/records.hpp"

namespace hybrid_sphere::cli {

/// What a run has computed since the last block, in the order of time.
struct OutputBlock {
  const std::vector<State>& states;
  const std::vector<Vector3d>& reactions;  ///< at the states; empty unless a sink wants them [N]
  const std::vector<Switch>& switches;
};

/// What takes the outputs of a run.
class OutputSink {
 public:
  OutputSink() = default;
  virtual ~OutputSink() = default;
  OutputSink(const OutputSink&) = delete;
  OutputSink& operator=(const OutputSink&) = delete;

  /// Whether it needs the force of the ground at each state, which costs time.
  virtual bool wants_reactions() const { return false; }
  /// Throws WriteError.
  virtual void write(const OutputBlock& block) = 0;
  /// Called before finish() of a run that did not come to its end. @param why  a sentence without a stop
  virtual void ended_early(const std::string& why) { static_cast<void>(why); }
  /// Called once after the last block. Throws WriteError.
  virtual void finish() {}
};

/// How a run is written as a bag of ROS. What knows ROS provides it, so that this library does without.
struct BagFormat {
  double max_time;  ///< that a stamp can tell [s]
  /// Throws WriteError.
  std::function<std::unique_ptr<OutputSink>(const std::string& file, const scene::Scene& scene)> open;
};

}  // namespace hybrid_sphere::cli

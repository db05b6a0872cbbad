#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "hybrid_sphere/scene/scene.hpp"
#include "scene/tree.hpp"
#include "study/distribution.hpp"
#include "study/sampler.hpp"

/// Many runs of one scene whose numbers are uncertain: what a study file asks for, the samples, the runs,
/// their results and what follows from them.
namespace hybrid_sphere::study {

/// A number of the scene that is another one in each run.
struct Variable {
  std::string path;
  Distribution distribution;
  std::uint64_t levels = 1;  ///< of a grid
};

/// Normal variables that depend on each other: mean + L z for independent z.
struct Correlation {
  std::vector<std::size_t> variables;
  std::vector<double> lower;  ///< L, a row after another, with L L^T the covariance of the variables
};

/// What is known of the sphere at an instant.
enum class StateField : std::uint8_t {
  position,
  velocity,
  angular_velocity,
  orientation,
  slip,
  energy,
  stage,
  mode,
  region
};

/// The greatest of a quantity over a run, or its sum.
enum class Extreme : std::uint8_t {
  speed,        ///< of the centre
  spin,         ///< angular velocity
  slip,         ///< of the contact point
  energy_lost,  ///< by the impulses of all switches
};

/// What each run leaves.
struct Keep {
  std::vector<StateField> end;
  std::vector<double> times;  ///< ascending [s]
  std::vector<StateField> at;
  std::optional<std::uint64_t> switches;  ///< the number of switches, and this many of them
  std::vector<std::string> entered;       ///< regions: whether and when
  std::vector<Extreme> extremes;
  std::uint64_t instants = 100;  ///< between switches, at which extremes look
};

/// What is computed from the results of all runs.
struct Summarize {
  std::vector<double> quantiles;
  std::uint64_t histogram = 0;  ///< bins; 0: none
};

struct Study {
  std::string text;        ///< of the file
  std::string scene_text;  ///< of the file of the scene; empty if the scene is in the study
  scene::Tree scene_tree;
  std::string scene_directory;  ///< to which names of images refer
  std::uint64_t runs = 0;
  std::uint64_t seed = 0;
  Sampling sampling = Sampling::random;
  double duration = 0;  ///< of each run [s]
  std::vector<Variable> variables;
  std::vector<Correlation> correlations;
  Keep keep;
  std::optional<Summarize> summarize;
  bool sensitivity = false;
  std::uint64_t chunk = 0;  ///< runs that are computed, sent and written together
};

/// Reads a study file and the scene to which it refers.
/// @throws SceneError  with the key's full path, the value and what is allowed
Study read_study_file(const std::string& file);

/// @param directory  to which the name of the scene's file refers
Study read_study_text(const std::string& yaml, const std::string& directory = "");

Design design_of(const Study& study);

/// The scene of a tree, with what the study needs to be valid of it.
scene::Scene scene_of(const Study& study, const scene::Tree& tree);

/// As in study files.
const char* to_string(StateField field);
const char* to_string(Extreme extreme);
const char* to_string(Sampling sampling);

}  // namespace hybrid_sphere::study

#pragma once

#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

#include "hybrid_sphere/scene/scene.hpp"

namespace hybrid_sphere::cli {

/// What `simulate` was asked to do.
struct Options {
  std::string scene;
  double duration = 10;                         ///< [s]
  double rate = 100;                            ///< outputs per second [Hz]
  std::optional<std::vector<double>> times;     ///< output times instead of duration and rate, ascending [s]
  std::string states;                           ///< file, "-" for standard output, empty for none
  std::string switches;                         ///< the same
  std::optional<scene::Solver::Method> method;  ///< over the scene's solver.method
  std::optional<double> accuracy;               ///< over the scene's solver.accuracy
  bool explain = false;
  bool timing = false;
  bool quiet = false;
};

/// Exit codes of `simulate`.
enum ExitCode : int { done = 0, usage = 2, scene_refused = 3, could_not_go_on = 4 };

struct Parsed {
  std::optional<Options> options;  ///< none: exit with the code at once, everything is said
  int exit_code = done;
};

/// Reads the command line; help goes to `out`, refusals go to `err`.
Parsed parse_options(int argc, const char* const* argv, std::ostream& out, std::ostream& err);

}  // namespace hybrid_sphere::cli

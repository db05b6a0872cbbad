#pragma once

#include <iosfwd>
#include <optional>
#include <string>

#include "cli/exit_code.hpp"
#include "cli/output_options.hpp"
#include "hybrid_sphere/scene/scene.hpp"

namespace hybrid_sphere::cli {

/// What `simulate` was asked to do.
struct Options : OutputOptions {
  Options() {
    duration = 10;
    rate = 100;
  }

  std::string scene;
  std::string bag;                              ///< file of a rosbag, empty for none
  std::string html;                             ///< file of a page, "-" for standard output, empty for none
  std::optional<scene::Solver::Method> method;  ///< over the scene's solver.method
  std::optional<double> accuracy;               ///< over the scene's solver.accuracy
  std::optional<double> step;                   ///< over the scene's solver.step [s]
  bool explain = false;
  bool timing = false;
};

struct Parsed {
  std::optional<Options> options;  ///< none: exit with the code at once, everything is said
  int exit_code = done;
};

/// Reads the command line; help goes to `out`, refusals go to `err`.
Parsed parse_options(int argc, const char* const* argv, std::ostream& out, std::ostream& err);

}  // namespace hybrid_sphere::cli

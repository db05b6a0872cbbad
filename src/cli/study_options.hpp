#pragma once

#include <cstdint>
#include <iosfwd>
#include <optional>
#include <string>

#include "cli/exit_code.hpp"

namespace hybrid_sphere::cli::studies {

/// What `study` was asked to do.
struct Options {
  std::string study;                   ///< file
  std::string output;                  ///< file of the results
  bool resume = false;                 ///< go on with that file
  std::optional<int> processes;        ///< none: as many as there are cores
  std::optional<std::uint64_t> scene;  ///< write this run as a scene and do nothing else
  std::string csv;                     ///< directory of tables; empty for none
  bool timing = false;
  bool quiet = false;
};

struct Parsed {
  std::optional<Options> options;  ///< none: exit with the code at once, everything is said
  int exit_code = done;
};

/// Reads the command line; help goes to `out`, refusals go to `err`.
Parsed parse_options(int argc, const char* const* argv, std::ostream& out, std::ostream& err);

}  // namespace hybrid_sphere::cli::studies

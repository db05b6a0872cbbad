#pragma once

#include <cstdint>
#include <iosfwd>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cli/exit_code.hpp"
#include "cli/output_options.hpp"
#include "hybrid_sphere/mechanics/solve.hpp"

namespace hybrid_sphere::cli::three_stage {

enum class Command { list, explain, run };

/// What `three_stage` was asked to do.
struct Options : OutputOptions {
  Command command = Command::list;
  std::string name;                                         ///< of the catalogue's entry
  std::vector<std::pair<std::string, std::string>> values;  ///< --set KEY=VALUE, as they were written
  double accuracy = mechanics::Options{}.accuracy;
  std::uint64_t max_steps = mechanics::Options{}.max_steps;
  double max_step = mechanics::Options{}.max_step;  ///< [s]
  bool project = false;  ///< the initial velocities onto the constraints that hold from the start
  bool by_hand = false;  ///< derivatives
};

struct Parsed {
  std::optional<Options> options;  ///< none: exit with the code at once, everything is said
  int exit_code = done;
};

/// Reads the command line; help goes to `out`, refusals go to `err`.
Parsed parse_options(int argc, const char* const* argv, std::ostream& out, std::ostream& err);

}  // namespace hybrid_sphere::cli::three_stage

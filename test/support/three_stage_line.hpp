#pragma once

#include <sstream>
#include <string>
#include <vector>

#include "cli/three_stage_run.hpp"
#include "support/command_line.hpp"

namespace hybrid_sphere::testing {

/// Calls `three_stage` with these arguments, in this process.
inline CommandResult three_stage(const std::vector<std::string>& arguments) {
  std::vector<const char*> argv{"three_stage"};
  for (const std::string& argument : arguments) argv.push_back(argument.c_str());
  std::ostringstream out;
  std::ostringstream err;
  const auto parsed = cli::three_stage::parse_options(static_cast<int>(argv.size()), argv.data(), out, err);
  const int exit_code = parsed.options ? cli::three_stage::run(*parsed.options, out, err) : parsed.exit_code;
  return {exit_code, out.str(), err.str()};
}

}  // namespace hybrid_sphere::testing

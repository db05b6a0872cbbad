#pragma once

#include <sstream>
#include <string>
#include <vector>

#include "cli/run.hpp"

namespace hybrid_sphere::testing {

/// What a call of `simulate` left behind.
struct CommandResult {
  int exit_code = 0;
  std::string out;
  std::string err;
};

/// Calls `simulate` with these arguments, in this process.
inline CommandResult simulate(const std::vector<std::string>& arguments) {
  std::vector<const char*> argv{"simulate"};
  for (const std::string& argument : arguments) argv.push_back(argument.c_str());
  std::ostringstream out;
  std::ostringstream err;
  const cli::Parsed parsed = cli::parse_options(static_cast<int>(argv.size()), argv.data(), out, err);
  const int exit_code = parsed.options ? cli::run(*parsed.options, out, err) : parsed.exit_code;
  return {exit_code, out.str(), err.str()};
}

inline std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts;
  std::istringstream stream(text);
  for (std::string part; std::getline(stream, part, separator);) parts.push_back(part);
  return parts;
}

}  // namespace hybrid_sphere::testing

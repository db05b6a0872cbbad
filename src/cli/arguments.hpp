#pragma once

#include <iosfwd>
#include <stdexcept>
#include <string>
#include <vector>

#include "cli/exit_code.hpp"

namespace CLI {
class App;
class Error;
}  // namespace CLI

namespace hybrid_sphere::cli {

constexpr double longest_duration = 1e12;  ///< [s]

/// An argument that is refused, with its option, its value and what is allowed.
struct UsageError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Writes what is wrong as a line of a program: UTF-8, whatever the bytes of an argument in it are.
void write_error(const std::string& program, const std::string& what, std::ostream& err);

/// Reads a finite number. Throws UsageError unless low <= number <= high.
/// @param unit  as the refusal says it
double number_from(const std::string& option, const std::string& text, double low, double high,
                   const std::string& unit = "");

/// Reads ascending times [s], comma-separated. Throws UsageError.
std::vector<double> times_from(const std::string& option, const std::string& text);

/// Writes the help, or what is wrong with the arguments, and says with which code the program is to exit:
/// could_not_go_on where the help cannot be written.
ExitCode exit_code_of(const CLI::App& app, const CLI::Error& error, std::ostream& out, std::ostream& err);

}  // namespace hybrid_sphere::cli

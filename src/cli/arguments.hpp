#pragma once

#include <iosfwd>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "cli/command_line.hpp"
#include "cli/output_options.hpp"

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

/// --duration, --rate, --times, --states and --switches on a command line.
class OutputArguments {
 public:
  /// @param duration, rate  what is taken without the option; empty where the program tells
  OutputArguments(std::string duration, std::string rate)
      : duration_as_a_rule_(std::move(duration)), rate_as_a_rule_(std::move(rate)) {}

  void declare(CommandLine& command_line);
  /// What the parsed command line says, over what `options` holds. Throws UsageError.
  void read(OutputOptions& options) const;

 private:
  std::string duration_as_a_rule_;
  std::string rate_as_a_rule_;
  std::optional<std::string> duration_;
  std::optional<std::string> rate_;
  std::optional<std::string> times_;
  std::optional<std::string> states_;
  std::optional<std::string> switches_;
};

}  // namespace hybrid_sphere::cli

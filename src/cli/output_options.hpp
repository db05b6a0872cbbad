#pragma once

#include <optional>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace hybrid_sphere::cli {

/// When and where a program writes.
struct OutputOptions {
  std::optional<double> duration;            ///< [s]; none: that of the system
  std::optional<double> rate;                ///< outputs per second [Hz]; none: that of the system
  std::optional<std::vector<double>> times;  ///< output times instead of both, ascending [s]
  std::string states;                        ///< file, "-" for standard output, empty for none
  std::string switches;                      ///< the same
  bool quiet = false;
};

/// --duration, --rate, --times, --states and --switches on a command line.
class OutputArguments {
 public:
  /// @param duration, rate  what is taken without the option; empty where the program tells
  OutputArguments(std::string duration, std::string rate)
      : duration_as_a_rule_(std::move(duration)), rate_as_a_rule_(std::move(rate)) {}

  /// @param app  has to be parsed while this lives
  void declare(CLI::App& app);
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

#include "cli/output_options.hpp"

#include <CLI/CLI.hpp>

#include "cli/arguments.hpp"
#include "cli/table.hpp"
#include "text/refusal.hpp"

namespace hybrid_sphere::cli {
namespace {

constexpr double fastest = 1e9;  // Hz
constexpr double max_outputs = 1e10;

std::string file_from(const std::string& option, const std::optional<std::string>& file) {
  if (file && file->empty()) throw UsageError(refusal(option, "", "a file, or -"));
  return file.value_or("");
}

}  // namespace

void OutputArguments::declare(CLI::App& app) {
  auto* duration = app.add_option("--duration", duration_, "simulated time, from 0")
                       ->type_name("S")
                       ->default_str(duration_as_a_rule_);
  auto* rate = app.add_option("--rate", rate_, "outputs per simulated second")
                   ->type_name("HZ")
                   ->default_str(rate_as_a_rule_);
  app.add_option("--times", times_, "output times instead, ascending, comma-separated [s]")
      ->type_name("T1,T2,...")
      ->excludes(duration)
      ->excludes(rate);
  app.add_option("--states", states_, "write the states to this CSV file; - is standard output")
      ->type_name("F");
  app.add_option("--switches", switches_, "write the switches to this CSV file; - is standard output")
      ->type_name("F");
}

void OutputArguments::read(OutputOptions& options) const {
  if (duration_) options.duration = number_from("--duration", *duration_, 0, longest_duration, "[s]");
  if (rate_) options.rate = number_from("--rate", *rate_, 1e-9, fastest, "[Hz]");
  if (options.duration && options.rate && *options.duration * *options.rate > max_outputs) {
    throw UsageError(text::refusal("--duration times --rate: " + duration_.value_or(duration_as_a_rule_) +
                                       " s at " + rate_.value_or(rate_as_a_rule_) + " Hz",
                                   "at most 1e10 outputs"));
  }
  if (times_) options.times = times_from("--times", *times_);
  options.states = file_from("--states", states_);
  options.switches = file_from("--switches", switches_);
  if (options.states == "-" && options.switches == "-") {
    throw UsageError(text::refusal("--switches: \"-\" together with --states -", "a file"));
  }
}

}  // namespace hybrid_sphere::cli

#include "cli/arguments.hpp"

#include <CLI/CLI.hpp>
#include <sstream>

#include "cli/table.hpp"
#include "scene/printable.hpp"
#include "scene/tree.hpp"
#include "text/refusal.hpp"

namespace hybrid_sphere::cli {
namespace {

/// What is wrong with a command line, in the words of the other refusals.
std::string reason_of(const CLI::Error& error) {
  const std::string text = error.what();
  const std::size_t colon = text.find(": ");
  if (dynamic_cast<const CLI::ArgumentMismatch*>(&error) == nullptr || colon == std::string::npos)
    return text;
  const bool is_missing = text.find("missing", colon) != std::string::npos;
  return text.substr(0, colon) +
         (is_missing ? ": a value is required" : " is given more than once; allowed: once");
}

constexpr double fastest = 1e9;  // Hz
constexpr double max_outputs = 1e10;

std::string file_from(const std::string& option, const std::optional<std::string>& file) {
  if (file && file->empty()) throw UsageError(refusal(option, "", "a file, or -"));
  return file.value_or("");
}

}  // namespace

double number_from(const std::string& option, const std::string& text, double low, double high,
                   const std::string& unit) {
  const std::optional<double> number = scene::parse_number(text);
  if (!number || !(low <= *number && *number <= high)) {
    std::ostringstream allowed;
    allowed << "a number from " << low << " to " << high << (unit.empty() ? "" : " ") << unit;
    throw UsageError(refusal(option, text, allowed.str()));
  }
  return *number + 0.0;  // -0 is 0
}

std::vector<double> times_from(const std::string& option, const std::string& text) {
  std::vector<double> times;
  std::size_t begin = 0;
  for (bool more = true; more;) {
    const std::size_t comma = text.find(',', begin);
    more = comma != std::string::npos;
    const std::string time = text.substr(begin, comma - begin);
    times.push_back(number_from(option, time, 0, longest_duration, "[s]"));
    if (times.size() > 1 && times.back() < times[times.size() - 2]) {
      throw UsageError(refusal(option, time, "ascending times, comma-separated [s]"));
    }
    begin = comma + 1;
  }
  return times;
}

void write_error(const std::string& program, const std::string& what, std::ostream& err) {
  err << program << ": " << scene::escaped(what) << '\n';
}

ExitCode exit_code_of(const CLI::App& app, const CLI::Error& error, std::ostream& out, std::ostream& err) {
  std::ostringstream ignored;
  if (app.exit(error, out, ignored) != 0) {
    write_error(app.get_name(), reason_of(error), err);
    err << "Run with --help for more information.\n";
    return usage;
  }
  if (out.flush()) return done;
  write_error(app.get_name(), "standard output cannot be written", err);
  return could_not_go_on;
}

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

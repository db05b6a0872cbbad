#include "cli/arguments.hpp"

#include <ostream>
#include <sstream>

#include "cli/table.hpp"
#include "scene/printable.hpp"
#include "scene/tree.hpp"
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

void OutputArguments::declare(CommandLine& command_line) {
  command_line.add_option("--duration", duration_, "S", "simulated time, from 0", duration_as_a_rule_);
  command_line.add_option("--rate", rate_, "HZ", "outputs per simulated second", rate_as_a_rule_);
  command_line.add_option("--times", times_, "T1,T2,...",
                          "output times instead, ascending, comma-separated [s]", "",
                          {"--duration", "--rate"});
  command_line.add_option("--states", states_, "F",
                          "write the states to this CSV file; - is standard output");
  command_line.add_option("--switches", switches_, "F",
                          "write the switches to this CSV file; - is standard output");
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

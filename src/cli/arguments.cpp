#include "cli/arguments.hpp"

#include <CLI/CLI.hpp>
#include <sstream>

#include "cli/table.hpp"
#include "scene/printable.hpp"
#include "scene/tree.hpp"

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

}  // namespace hybrid_sphere::cli

#include "cli/three_stage_options.hpp"

#include <cmath>
#include <ostream>

#include "cli/arguments.hpp"
#include "cli/table.hpp"

namespace hybrid_sphere::cli::three_stage {
namespace {

struct Texts {
  OutputArguments outputs{"", ""};
  std::vector<std::string> values;
  std::optional<std::string> accuracy;
  std::optional<std::string> max_steps;
  std::optional<std::string> max_step;
  std::optional<std::string> derivatives;
};

std::string number_text(double number) {
  std::ostringstream text;
  text << number;
  return text.str();
}

void declare_run(CommandLine& run, Options& options, Texts& texts) {
  run.add_argument("NAME", options.name, "a system of the catalogue");
  run.add_repeated_option("--set", texts.values, "KEY=VALUE",
                          "a parameter of the system; any number of times");
  texts.outputs.declare(run);
  run.add_option("--accuracy", texts.accuracy, "A",
                 "requested error of q and v, relative to the scale of the motion",
                 number_text(options.accuracy));
  run.add_option("--most-steps", texts.max_steps, "N", "end the motion if it takes more steps than this",
                 number_text(static_cast<double>(options.max_steps)));
  run.add_option("--longest-step", texts.max_step, "S",
                 "longest step [s]: for effects so short that a longer step might miss them",
                 "as the accuracy allows");
  run.add_flag("--project", options.project,
               "project initial velocities onto constraints that hold from the start, instead of refusing");
  run.add_option("--derivatives", texts.derivatives, "D", "of L and f: automatic, by_hand", "automatic");
  run.add_flag("--quiet", options.quiet, "no summary, no warnings");
  run.set_footer(
      "Without --duration, that of the system applies (explain NAME); without --rate, 100 outputs follow "
      "the\n"
      "one at the start. Without --states and --switches, the switches go to standard output.\n"
      "Ctrl-C ends the motion; what is computed up to there is written.\n"
      "Exit code: 0 done, 2 usage, 3 system refused, 4 the motion or a table ended before the end.");
}

std::vector<std::pair<std::string, std::string>> values_from(const std::vector<std::string>& texts) {
  std::vector<std::pair<std::string, std::string>> values;
  for (const std::string& text : texts) {
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos || equals == 0) throw UsageError(refusal("--set", text, "KEY=VALUE"));
    const std::string key = text.substr(0, equals);
    for (const auto& value : values) {
      if (value.first == key) throw UsageError(refusal("--set", text, "each parameter once"));
    }
    values.emplace_back(key, text.substr(equals + 1));
  }
  return values;
}

std::uint64_t count_from(const std::string& option, const std::string& text) {
  constexpr double most = 1e15;
  const double count = number_from(option, text, 1, most);
  if (count != std::floor(count)) {
    throw UsageError(refusal(option, text, "a whole number from 1 to " + number_text(most)));
  }
  return static_cast<std::uint64_t>(count);
}

void read_texts(const Texts& texts, Options& options) {
  texts.outputs.read(options);
  options.values = values_from(texts.values);
  if (texts.accuracy) {
    options.accuracy =
        number_from("--accuracy", *texts.accuracy, mechanics::least_accuracy, mechanics::greatest_accuracy);
  }
  if (texts.max_steps) options.max_steps = count_from("--most-steps", *texts.max_steps);
  if (texts.max_step) {
    constexpr double shortest = 1e-100;
    options.max_step = number_from("--longest-step", *texts.max_step, shortest, longest_duration, "[s]");
  }
  const std::string derivatives = texts.derivatives.value_or("automatic");
  options.by_hand = derivatives == "by_hand";
  if (!options.by_hand && derivatives != "automatic") {
    throw UsageError(refusal("--derivatives", derivatives, "automatic, by_hand"));
  }
}

}  // namespace

Parsed parse_options(int argc, const char* const* argv, std::ostream& out, std::ostream& err) {
  CommandLine app(
      "Classical systems through the three stages: free motion, the impulse of a constraint that is "
      "suddenly\n"
      "applied, motion under it.",
      "three_stage");
  Options options;
  Texts texts;
  app.add_command("list", "list", "name the systems of the catalogue");
  CommandLine& explain =
      app.add_command("explain", "explain NAME", "say what a system is and what may be set");
  explain.add_argument("NAME", options.name, "a system of the catalogue");
  CommandLine& run = app.add_command("run", "run NAME", "compute its motion");
  declare_run(run, options, texts);
  const std::optional<ExitCode> exit_code = app.parse(argc, argv, out, err, [&] {
    if (explain.is_given()) options.command = Command::explain;
    if (run.is_given()) {
      options.command = Command::run;
      read_texts(texts, options);
    }
  });
  if (exit_code) return {std::nullopt, *exit_code};
  return {options, done};
}

}  // namespace hybrid_sphere::cli::three_stage

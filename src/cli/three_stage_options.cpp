#include "cli/three_stage_options.hpp"

#include <CLI/CLI.hpp>
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
  std::string derivatives = "automatic";
};

std::string number_text(double number) {
  std::ostringstream text;
  text << number;
  return text.str();
}

void declare_run(CLI::App& run, Options& options, Texts& texts) {
  run.add_option("NAME", options.name, "a system of the catalogue")->required()->type_name("");
  run.add_option("--set", texts.values, "a parameter of the system; any number of times")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
  texts.outputs.declare(run);
  run.add_option("--accuracy", texts.accuracy,
                 "requested error of q and v, relative to the scale of the motion")
      ->type_name("A")
      ->default_str(number_text(options.accuracy));
  run.add_option("--most-steps", texts.max_steps, "end the motion if it takes more steps than this")
      ->type_name("N")
      ->default_str(number_text(static_cast<double>(options.max_steps)));
  run.add_option("--longest-step", texts.max_step,
                 "longest step [s]: for effects so short that a longer step might miss them")
      ->type_name("S")
      ->default_str("as the accuracy allows");
  run.add_flag("--project", options.project,
               "project initial velocities onto constraints that hold from the start, instead of refusing");
  run.add_option("--derivatives", texts.derivatives, "of L and f: automatic, by_hand")
      ->type_name("D")
      ->capture_default_str();
  run.add_flag("--quiet", options.quiet, "no summary, no warnings");
  run.footer(
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
  options.by_hand = texts.derivatives == "by_hand";
  if (!options.by_hand && texts.derivatives != "automatic") {
    throw UsageError(refusal("--derivatives", texts.derivatives, "automatic, by_hand"));
  }
}

}  // namespace

Parsed parse_options(int argc, const char* const* argv, std::ostream& out, std::ostream& err) {
  CLI::App app(
      "Classical systems through the three stages: free motion, the impulse of a constraint that is "
      "suddenly\n"
      "applied, motion under it.",
      "three_stage");
  app.require_subcommand(1);
  Options options;
  Texts texts;
  app.add_subcommand("list", "name the systems of the catalogue");
  CLI::App* explain = app.add_subcommand("explain", "say what a system is and what may be set");
  explain->add_option("NAME", options.name, "a system of the catalogue")->required()->type_name("");
  CLI::App* run = app.add_subcommand("run", "compute its motion");
  declare_run(*run, options, texts);
  try {
    app.parse(argc, argv);
    if (explain->parsed()) options.command = Command::explain;
    if (run->parsed()) {
      options.command = Command::run;
      read_texts(texts, options);
    }
    return {options, done};
  } catch (const UsageError& error) {
    return {std::nullopt, exit_code_of(app, CLI::ValidationError(error.what()), out, err)};
  } catch (const CLI::RequiredError& error) {
    if (!app.get_subcommands().empty()) return {std::nullopt, exit_code_of(app, error, out, err)};
    constexpr const char* commands = "list, explain NAME, run NAME";
    const std::vector<std::string> others = app.remaining();
    const bool is_command = !others.empty() && others.front().compare(0, 1, "-") != 0;
    const std::string reason = is_command ? refusal("command", others.front(), commands)
                                          : std::string("a command is required; allowed: ") + commands;
    return {std::nullopt, exit_code_of(app, CLI::ValidationError(reason), out, err)};
  } catch (const CLI::ParseError& error) {
    return {std::nullopt, exit_code_of(app, error, out, err)};
  }
}

}  // namespace hybrid_sphere::cli::three_stage

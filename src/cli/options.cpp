#include "hybrid_sphere/cli/options.hpp"

#include <CLI/CLI.hpp>
#include <cmath>
#include <ostream>

#include "hybrid_sphere/scene/read_scene.hpp"

namespace hybrid_sphere::cli {
namespace {

constexpr double longest = 1e12;  // s
constexpr double fastest = 1e9;   // Hz
constexpr double most_outputs = 1e10;

double number_from(const std::string& option, const std::string& text, double low, double high) {
  const std::optional<double> number = scene::parse_number(text);
  if (!number || !(low <= *number && *number <= high)) {
    std::ostringstream message;
    message << option << ": \"" << text << "\" is refused; allowed: a number from " << low << " to " << high;
    throw CLI::ValidationError(message.str());
  }
  return *number + 0.0;  // -0 is 0
}

std::vector<double> times_from(const std::string& text) {
  std::vector<double> times;
  std::size_t begin = 0;
  for (bool more = true; more;) {
    const std::size_t comma = text.find(',', begin);
    more = comma != std::string::npos;
    times.push_back(number_from("--times", text.substr(begin, comma - begin), 0, longest));
    if (times.size() > 1 && times.back() < times[times.size() - 2]) {
      throw CLI::ValidationError("--times: \"" + text.substr(begin, comma - begin) +
                                 "\" is refused; allowed: ascending times, comma-separated [s]");
    }
    begin = comma + 1;
  }
  return times;
}

struct Texts {
  std::string duration = "10";
  std::string rate = "100";
  std::optional<std::string> times;
  std::optional<std::string> states;
  std::optional<std::string> switches;
  std::optional<std::string> method;
  std::optional<std::string> accuracy;
  std::optional<std::string> step;
};

// The scene's own reader decides what a method and an accuracy may be.
void read_solver_options(const Texts& texts, Options& options) {
  scene::Tree::Map keys;
  if (texts.method) keys.emplace_back("method", *texts.method);
  if (texts.accuracy) keys.emplace_back("accuracy", *texts.accuracy);
  if (texts.step) keys.emplace_back("step", *texts.step);
  try {
    const scene::Solver solver = scene::read_solver(keys, "");
    if (texts.method) options.method = solver.method;
    if (texts.accuracy) options.accuracy = solver.accuracy;
  } catch (const scene::SceneError& error) {
    throw CLI::ValidationError(std::string("--") + error.what());
  }
}

void declare(CLI::App& app, Options& options, Texts& texts) {
  app.add_option("SCENE", options.scene, "scene file (YAML)")->required()->type_name("");
  auto* duration = app.add_option("--duration", texts.duration, "simulated time, from 0")
                       ->type_name("S")
                       ->capture_default_str();
  auto* rate = app.add_option("--rate", texts.rate, "outputs per simulated second")
                   ->type_name("HZ")
                   ->capture_default_str();
  app.add_option("--times", texts.times, "output times instead, ascending, comma-separated [s]")
      ->type_name("T1,T2,...")
      ->excludes(duration)
      ->excludes(rate);
  app.add_option("--states", texts.states, "write the states to this CSV file; - is standard output")
      ->type_name("F");
  app.add_option("--switches", texts.switches, "write the switches to this CSV file; - is standard output")
      ->type_name("F");
  app.add_option("--method", texts.method, "over the scene's solver.method: auto, exact")->type_name("M");
  app.add_option("--accuracy", texts.accuracy,
                 "over the scene's solver.accuracy: relative error at every output")
      ->type_name("A");
  app.add_option("--step", texts.step, "over the scene's solver.step (no method has a fixed step yet)")
      ->type_name("DT");
  app.add_flag("--explain", options.explain,
               "say what the scene requires, what is not modelled, and which method is taken");
  app.add_flag("--timing", options.timing, "print one JSON line: what was computed and how long it took");
  app.add_flag("--quiet", options.quiet, "no progress bar, no summary");
  app.footer(
      "Without --states, --switches, --explain and --timing the switches go to standard output.\n"
      "Exit code: 0 done, 2 usage, 3 scene refused, 4 the computation could not go on.");
}

void read_texts(const Texts& texts, Options& options) {
  options.duration = number_from("--duration", texts.duration, 0, longest);
  options.rate = number_from("--rate", texts.rate, 1e-9, fastest);
  if (options.duration * options.rate > most_outputs) {
    throw CLI::ValidationError("--duration times --rate: " + texts.duration + " s at " + texts.rate +
                               " Hz is refused; allowed: at most 1e10 outputs");
  }
  if (texts.times) options.times = times_from(*texts.times);
  read_solver_options(texts, options);
  for (const auto& [option, file] :
       {std::pair("--states", texts.states), std::pair("--switches", texts.switches)}) {
    if (file && file->empty()) {
      throw CLI::ValidationError(std::string(option) + ": \"\" is refused; allowed: a file, or -");
    }
  }
  options.states = texts.states.value_or("");
  options.switches = texts.switches.value_or("");
  if (options.states == "-" && options.switches == "-") {
    throw CLI::ValidationError("--switches: \"-\" beside --states - is refused; allowed: a file");
  }
}

}  // namespace

Parsed parse_options(int argc, const char* const* argv, std::ostream& out, std::ostream& err) {
  CLI::App app("Runs a scene offline: the three stages of a sphere that slides onto rough ground.",
               "simulate");
  Options options;
  Texts texts;
  declare(app, options, texts);
  try {
    app.parse(argc, argv);
    read_texts(texts, options);
    return {options, done};
  } catch (const CLI::ParseError& error) {
    return {std::nullopt, app.exit(error, out, err) == 0 ? done : usage};
  }
}

}  // namespace hybrid_sphere::cli

#include "cli/options.hpp"

#include <ostream>

#include "cli/arguments.hpp"
#include "cli/table.hpp"
#include "scene/read_tree.hpp"
#include "text/refusal.hpp"

namespace hybrid_sphere::cli {
namespace {

struct Texts {
  OutputArguments outputs{"10", "100"};
  std::optional<std::string> bag;
  std::optional<std::string> html;
  std::optional<std::string> method;
  std::optional<std::string> accuracy;
  std::optional<std::string> step;
};

void read_bag_option(const Texts& texts, Options& options) {
  if (!texts.bag) return;
  if (texts.bag->empty() || *texts.bag == "-") throw UsageError(refusal("--bag", *texts.bag, "a file"));
  options.bag = *texts.bag;
}

void read_html_option(const Texts& texts, Options& options) {
  if (!texts.html) return;
  if (texts.html->empty()) throw UsageError(refusal("--html", "", "a file, or -"));
  options.html = *texts.html;
  if (options.html == "-" && (options.states == "-" || options.switches == "-")) {
    throw UsageError(text::refusal("--html: \"-\" together with a table on standard output", "a file"));
  }
}

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
    if (texts.step) options.step = solver.step;
  } catch (const scene::SceneError& error) {
    throw UsageError(std::string("--") + error.what());
  }
}

std::string methods() {
  std::string names;
  for (const scene::MethodName& named : scene::method_names)
    names += (names.empty() ? "" : ", ") + std::string(named.name);
  return names;
}

void declare(CommandLine& app, Options& options, Texts& texts) {
  app.add_argument("SCENE", options.scene, "scene file (YAML)");
  texts.outputs.declare(app);
  app.add_option("--bag", texts.bag, "F",
                 "write the messages of the node to this rosbag, with the stamp 1 s at t = 0");
  app.add_option("--html", texts.html, "F",
                 "write a page for a browser that shows the run in motion; - is standard output");
  app.add_option("--method", texts.method, "M", "overrides the scene's solver.method: " + methods());
  app.add_option("--accuracy", texts.accuracy, "A",
                 "overrides the scene's solver.accuracy: relative error at every output");
  app.add_option("--step", texts.step, "DT", "overrides the scene's solver.step, for fixed-step methods [s]");
  app.add_flag("--explain", options.explain,
               "say what the scene requires, what is not modelled, and which method is taken");
  app.add_flag("--timing", options.timing, "print one JSON line: what was computed and how long it took");
  app.add_flag("--quiet", options.quiet, "no progress bar, no summary");
  app.set_footer(
      "Without --states, --switches, --bag, --html, --explain or --timing, the switches go to standard "
      "output.\n"
      "Exit code: 0 done, 2 usage, 3 scene refused, 4 the computation could not go on,\n"
      "           128 + N ended by signal N: 130 by Ctrl-C, 143 by kill; everything up to there is written.");
}

}  // namespace

Parsed parse_options(int argc, const char* const* argv, std::ostream& out, std::ostream& err) {
  CommandLine app("Runs a scene offline: the three stages of a sphere that slides onto rough ground.",
                  "simulate");
  Options options;
  Texts texts;
  declare(app, options, texts);
  const std::optional<ExitCode> exit_code = app.parse(argc, argv, out, err, [&] {
    texts.outputs.read(options);
    read_bag_option(texts, options);
    read_html_option(texts, options);
    read_solver_options(texts, options);
  });
  if (exit_code) return {std::nullopt, *exit_code};
  return {options, done};
}

}  // namespace hybrid_sphere::cli

// The table of docs/extremes.md: for each scene of test/data/extremes what binary64 can reach and what each
// method does, relative to the scale of motion; a million switches; and what is refused past the limits.
//
//   extremes [--method WORD[:STEP]]... [--format markdown|csv] [--data DIRECTORY] [--slow] [--scenes]
//   [NAME...]
//
// WORD is a scene's solver.method, STEP the solver.step of a method with fixed steps in seconds. Without a
// method: the scene's own, auto. With --scenes or names the scenes alone.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <string>
#include <vector>

#include "scene/read_tree.hpp"
#include "scene/yaml.hpp"
#include "support/extremes.hpp"

namespace {

using namespace hybrid_sphere;
using namespace hybrid_sphere::testing;

struct Options {
  std::vector<std::string> methods;
  std::vector<std::string> names;
  std::string directory = std::string(TEST_DATA_DIR) + "/extremes";
  bool csv = false;
  bool slow = false;
  bool scenes_alone = false;
};

class Usage : public std::exception {};

Options parse(int argc, char** argv) {
  Options options;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    const auto value = [&]() -> std::string {
      if (++i == argc) throw Usage();
      return argv[i];
    };
    if (word == "--method") {
      options.methods.push_back(value());
    } else if (word == "--format") {
      const std::string format = value();
      if (format != "csv" && format != "markdown") throw Usage();
      options.csv = format == "csv";
    } else if (word == "--data") {
      options.directory = value();
    } else if (word == "--scenes") {
      options.scenes_alone = true;
    } else if (word == "--slow") {
      options.slow = true;
    } else if (word.empty() || word.front() == '-') {
      throw Usage();
    } else {
      options.names.push_back(word);
    }
  }
  if (options.methods.empty()) options.methods.emplace_back("auto");
  return options;
}

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1e", value);
  return value == 0 ? "0" : text;
}

/// Cells of one line, in either format.
void print(const Options& options, const std::vector<std::string>& cells) {
  std::string line = options.csv ? "" : "|";
  for (std::size_t i = 0; i < cells.size(); ++i) {
    std::string cell = cells[i];
    if (options.csv) {
      std::replace(cell.begin(), cell.end(), '"', '\'');
      line += (i == 0 ? "" : ",") + (cell.find(',') == std::string::npos ? cell : '"' + cell + '"');
    } else {
      line += " " + cell + " |";
    }
  }
  std::puts(line.c_str());
}

void print_head(const Options& options, const std::vector<std::string>& cells) {
  print(options, cells);
  if (!options.csv) print(options, std::vector<std::string>(cells.size(), "---"));
}

std::string failure_cell(const std::string& failure) { return "refused: " + failure; }

std::vector<std::string> cells_of(const Measured& measured) {
  if (!measured.failure.empty()) return {failure_cell(measured.failure), "", ""};
  char ratio[32];
  std::snprintf(ratio, sizeof ratio, "%.2g", measured.worst.ratio());
  return {number(measured.relative.error), number(measured.time.error), ratio};
}

void print_scenes(const Options& options) {
  std::vector<std::string> head{"scene", "floor", "floor of a switch's time [s]"};
  for (const std::string& method : options.methods) {
    for (const char* what : {"error", "error of a switch's time [s]", "over the floor", "cost [ms]"}) {
      head.push_back(method + ": " + what);
    }
  }
  print_head(options, head);
  for (const std::string& name : options.names) {
    std::vector<std::string> results;
    Measured measured;
    for (const std::string& method : options.methods) {
      const auto start = std::chrono::steady_clock::now();
      measured = measure(options.directory, name, method);
      const std::chrono::duration<double, std::milli> cost = std::chrono::steady_clock::now() - start;
      for (const std::string& cell : cells_of(measured)) results.push_back(cell);
      results.push_back(number(cost.count()));
    }
    std::vector<std::string> cells{name, number(measured.relative.floor), number(measured.time.floor)};
    cells.insert(cells.end(), results.begin(), results.end());
    print(options, cells);
    std::fflush(stdout);
  }
}

void print_strips(const Options& options) {
  constexpr int count = 1'000'000;
  std::puts("");
  print_head(options,
             {"method", "edges", "last switch [s]", "switches", "floor of its time [s]",
              "error of a switch's time [s]", "error of the way, relative", "cost of a switch [us]"});
  for (const std::string& method : options.methods) {
    for (const double spacing : {1e-3, 1.0, 1e3}) {
      const auto start = std::chrono::steady_clock::now();
      Strips strips;
      try {
        strips = run_over_strips(count, spacing, solver_of(method, 1e-9));
      } catch (const std::exception& error) {
        strips.failure = error.what();
      }
      const std::chrono::duration<double, std::micro> cost = std::chrono::steady_clock::now() - start;
      if (!strips.failure.empty()) {
        print(options, {method, std::to_string(count), "", "", "", "", failure_cell(strips.failure), ""});
        break;
      }
      print(options, {method, std::to_string(count), number(strips.end), std::to_string(strips.switches),
                      number(strips.time_floor), number(strips.time_error), number(strips.state_error),
                      number(cost.count() / count)});
    }
  }
}

/// Past the limits: what the reader of scenes says.
void print_refusals(const Options& options) {
  const std::string sphere = "sphere: {mass: 1, radius: 1, body: solid}\n";
  const std::string disc = "surface: {regions: [{name: a, circle: {center: [0, 0], radius: ";
  std::puts("");
  print_head(options, {"past the limit"});
  for (const std::string& scene :
       {std::string("sphere: {mass: 1.0e+61, radius: 1, body: solid}"),
        std::string("sphere: {mass: 1, radius: 1.0e-13, body: solid}"),
        std::string("sphere: {mass: 1, radius: 1, gyration_radius: 1.0e-10}"),
        std::string("sphere: {mass: 1, radius: 1, gyration_radius: 0.8165}"),
        sphere + "initial_state: {position: [1.1e+15, 0]}",
        sphere + "initial_state: {velocity: [1.1e+15, 0]}",
        sphere + disc + "1}, law: coulomb, friction: 1.1e+9}]}", sphere + disc + "1.0e-13}, law: rough}]}",
        sphere + "drag: {translational: 1.1e+15}", sphere + "spring: {stiffness: 1.1e+15}",
        sphere + "solver: {accuracy: 1.0e-15}"}) {
    try {
      scene::read_scene(scene::tree_from_yaml(scene));
      print(options, {"not refused: " + scene});
    } catch (const std::exception& error) {
      print(options, {error.what()});
    }
  }
}

void choose_scenes(Options& options) {
  if (!options.names.empty()) return;
  for (const auto& entry : std::filesystem::directory_iterator(options.directory)) {
    const std::filesystem::path stem = entry.path().stem();
    const bool is_scene = entry.path().extension() == ".yaml" && stem.extension() != ".expected";
    if (is_scene && (options.slow || stem.string().rfind("slow_", 0) != 0)) {
      options.names.push_back(stem.string());
    }
  }
  std::sort(options.names.begin(), options.names.end());
}

}  // namespace

int main(int argc, char** argv) {
  try {
    Options options = parse(argc, argv);
    const bool all = options.names.empty() && !options.scenes_alone;
    choose_scenes(options);
    print_scenes(options);
    if (all) {
      print_strips(options);
      print_refusals(options);
    }
    return 0;
  } catch (const Usage&) {
    std::fputs(
        "extremes [--method WORD[:STEP]]... [--format markdown|csv] [--data DIRECTORY] [--slow] [--scenes] "
        "[NAME...]\n",
        stderr);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "extremes: %s\n", error.what());
  }
  return 2;
}

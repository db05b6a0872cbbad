// What each optional feature costs where it is absent and where it is used, as a Markdown table. Unit: an
// output of the plain scene, which rolls on the level; a figure is the ratio of 2000 outputs at 1 kHz, with
// their start. All settings are run in turn, and the shortest of their runs are compared.
//
//     feature_costs [ROUNDS]

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "hybrid_sphere/simulation/simulation.hpp"
#include "scene/read_tree.hpp"
#include "scene/yaml.hpp"

namespace {

using namespace hybrid_sphere;

constexpr double rate = 1000;  // Hz
constexpr int outputs = 2000;
constexpr double least = 3e-4;  // of a measurement [s]

/// What is done at each output beside advancing to it.
using Look = std::function<void(Simulation&)>;

volatile double sink;

void look_at_state(Simulation& simulation) { sink = simulation.state().orientation.w(); }
void do_nothing(Simulation&) {}

/// One column of a feature.
struct Setting {
  std::string keys{};  // beside those of the plain scene
  std::string base = "{law: rough}";
  std::string regions{};
  Look look = look_at_state;
};

struct Feature {
  std::string name;
  Setting off;
  Setting on;
};

std::string scene_text(const Setting& setting) {
  return "sphere: {mass: 2, radius: 0.25, gyration_radius: 0.158}\n"
         "initial_state: {position: [-3, 0.5], velocity: [1, -0.375], angular_velocity: [0.5, 1, -2]}\n"
         "surface:\n  base: " +
         setting.base + "\n" + (setting.regions.empty() ? "" : "  regions:\n" + setting.regions) +
         setting.keys;
}

class Run {
 public:
  explicit Run(const Setting& setting)
      : simulation_(scene::read_scene(scene::tree_from_yaml(scene_text(setting)))), look_(setting.look) {
    // As often as a measurement wants it.
    for (double time = once(); time * repetitions_ < least;) {
      repetitions_ *= 2;
      time = std::min(time, once());
    }
  }

  /// Time of a run [s].
  double measure() {
    const auto begin = std::chrono::steady_clock::now();
    for (int i = 0; i < repetitions_; ++i) run();
    return seconds_since(begin) / repetitions_;
  }

 private:
  static double seconds_since(std::chrono::steady_clock::time_point begin) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  }

  double once() {
    const auto begin = std::chrono::steady_clock::now();
    run();
    return seconds_since(begin);
  }

  void run() {
    static const Simulation::SwitchSink ignore = [](const Switch&) {};
    simulation_.reset();
    for (int i = 0; i < outputs; ++i) {
      simulation_.advance_to(i / rate, ignore);
      look_(simulation_);
    }
  }

  Simulation simulation_;
  Look look_;
  int repetitions_ = 1;
};

/// Discs that the path does not come to.
std::string discs(int count) {
  std::string text;
  for (int i = 0; i < count; ++i) {
    text += "    - {name: d" + std::to_string(i) + ", circle: {center: [" + std::to_string(3 * (i % 100)) +
            ", " + std::to_string(10 + 3 * (i / 100)) + "], radius: 1}, law: smooth}\n";
  }
  return text;
}

Setting with(const std::string& keys) { return {keys}; }
Setting over(const std::string& base) { return {"", base}; }
Setting looked_at(const Look& look) { return {"", "{law: rough}", "", look}; }

std::vector<Feature> forces() {
  return {
      {"gravity along the slope", with("gravity: [0, 0, -9.81]\n"), with("gravity: [1, 0, -9.81]\n")},
      {"wrench", with("wrench: {force: [0, 0], torque: [0, 0, 0]}\n"), with("wrench: {force: [1, 0]}\n")},
      {"linear drag", with("drag: {translational: 0, rotational: 0}\n"),
       with("drag: {translational: 0.5, rotational: 0.01}\n")},
      {"quadratic drag, integrated", with("drag: {quadratic: 0}\n"), with("drag: {quadratic: 0.5}\n")},
      {"spring", with("spring: {stiffness: 0}\n"), with("spring: {stiffness: 3}\n")},
      {"every force",
       with("gravity: [0, 0, -9.81]\nwrench: {force: [0, 0], torque: [0, 0, 0]}\n"
            "drag: {translational: 0, rotational: 0, quadratic: 0}\nspring: {stiffness: 0}\n"),
       with("gravity: [1, 0, -9.81]\nwrench: {force: [1, 0], torque: [0, 0, 0.001]}\n"
            "drag: {translational: 0.5, rotational: 0.01, quadratic: 0.5}\nspring: {stiffness: 3}\n")},
  };
}

std::vector<Feature> grounds() {
  return {
      {"belt", over("{law: rough, belt: [0, 0]}"), over("{law: rough, belt: [0.2, 0.1]}")},
      {"turntable", over("{law: rough, turntable: {rate: 0, center: [0, 0]}}"),
       over("{law: rough, turntable: {rate: 3, center: [0, 0]}}")},
      {"rolling resistance", over("{law: rough, rolling_resistance: 0}"),
       over("{law: rough, rolling_resistance: 0.001}")},
      {"spin friction", over("{law: rough, spin_friction: 0}"), over("{law: rough, spin_friction: 0.001}")},
      {"coulomb friction, sliding", over("{law: coulomb, friction: 0}"),
       over("{law: coulomb, friction: 0.01}")},
      {"coulomb friction, grips after milliseconds", over("{law: rough}"),
       over("{law: coulomb, friction: 5}")},
      {"a map of 10,000 discs beside the path", over("{law: rough}"), {"", "{law: rough}", discs(10'000)}},
      {"one disc beside the path, `outside` of another",
       {"", "{law: rough}", discs(1)},
       {"", "{law: rough}",
        "    - {name: d, circle: {center: [0, 50], radius: 1}, outside: true, law: rough}\n"}},
  };
}

std::vector<Feature> questions() {
  const auto ask = [](const Look& more) {
    return looked_at([more](Simulation& simulation) {
      look_at_state(simulation);
      more(simulation);
    });
  };
  return {
      {"the state, looked at", looked_at(do_nothing), looked_at(look_at_state)},
      {"the ground's reaction", ask(do_nothing),
       ask([](Simulation& simulation) { sink = simulation.reaction().x(); })},
      {"error estimate and count of evaluations", ask(do_nothing), ask([](Simulation& simulation) {
         sink = simulation.estimated_error() + static_cast<double>(simulation.evaluations());
       })},
      {"a command, given at every output", ask([](Simulation& simulation) { simulation.set_command({}); }),
       ask([](Simulation& simulation) {
         simulation.set_command({{0.1 * simulation.time(), 0}, {0, 0, 0}});
       })},
  };
}

/// The shortest of the runs of a setting, which a busy neighbour has not delayed.
struct Column {
  std::unique_ptr<Run> run;
  double time = std::numeric_limits<double>::infinity();

  void measure() { time = std::min(time, run->measure()); }
};

std::string figure(double ratio) {
  char text[32];
  std::snprintf(text, sizeof text, ratio < 10 ? "%.2f" : "%.0f", ratio);
  return text;
}

void compare(const std::vector<Feature>& features, int rounds) {
  std::vector<Column> columns;
  for (const Feature& feature : features) {
    columns.push_back({std::make_unique<Run>(feature.off)});
    columns.push_back({std::make_unique<Run>(feature.on)});
  }
  Column plain{std::make_unique<Run>(Setting())};
  for (int round = 0; round < rounds; ++round) {
    for (Column& column : columns) {
      column.measure();
      plain.measure();
    }
  }
  std::printf("| feature | off | on |\n| --- | --- | --- |\n");
  for (std::size_t i = 0; i < features.size(); ++i) {
    std::printf("| %s | %s | %s |\n", features[i].name.c_str(),
                figure(columns[2 * i].time / plain.time).c_str(),
                figure(columns[2 * i + 1].time / plain.time).c_str());
  }
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<Feature> features{{"the plain scene beside itself", Setting(), Setting()}};
  for (const auto& more : {forces(), grounds(), questions()}) {
    features.insert(features.end(), more.begin(), more.end());
  }
  try {
    compare(features, argc > 1 ? std::max(1, std::atoi(argv[1])) : 100);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}

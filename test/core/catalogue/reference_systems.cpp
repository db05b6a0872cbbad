#include "core/catalogue/reference_systems.hpp"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <map>
#include <stdexcept>

#include "core/catalogue/vector_of.hpp"

namespace hybrid_sphere::mechanics::catalogue::testing {
namespace {

// Which entry a system of general_systems.json is, by the number that its name begins with, and what its
// parameters are called there. Coordinates are matched by their order. Elsewhere systems and parameters have
// the entry's names.
struct Row {
  std::string number;
  std::string entry;
  std::map<std::string, std::string> renamed;
};

const std::vector<Row> table = {
    {"g1", "chaplygin_sleigh", {}},
    {"g2", "rolling_disk", {}},
    {"g3", "knife_edge_incline", {}},
    {"g4", "appell_hamel", {}},
    {"g5", "constant_speed", {}},
    {"g6", "nonholonomic_particle", {}},
    {"g7", "turntable_ball", {}},
    {"g8", "explicit_time", {{"gam", "gamma"}, {"th0", "theta"}, {"Om", "Omega"}}},
    {"g9", "turntable_ball", {}},
};

Values values(const YAML::Node& system, const Row& row, const Entry& entry) {
  Values result(entry.parameters);
  for (const auto& parameter : system["parameters"]) {
    const auto name = parameter.first.as<std::string>();
    const auto renamed = row.renamed.find(name);
    result.set(renamed == row.renamed.end() ? name : renamed->second, parameter.second.as<double>());
  }
  result.set("t_switch", system["t_switch"].as<double>());
  const Model model = entry.build(result).model;
  for (std::size_t i = 0; i < model.coordinates.size(); ++i) {
    result.set(model.coordinates[i], system["q0"][i].as<double>());
    result.set(model.velocities[i], system["qd0"][i].as<double>());
  }
  return result;
}

ReferenceSystem read(const YAML::Node& node) {
  ReferenceSystem system;
  system.name = node["name"].as<std::string>();
  const auto row = std::find_if(table.begin(), table.end(), [&system](const Row& candidate) {
    return system.name.rfind(candidate.number + "_", 0) == 0 || system.name == candidate.entry;
  });
  if (row == table.end()) throw std::runtime_error("no entry of the catalogue is " + system.name);
  system.entry = row->entry;
  system.t_switch = node["t_switch"].as<double>();
  const Entry& entry = catalogue::entry(row->entry);
  system.example = entry.build(values(node, *row, entry));
  const YAML::Node& impulse = node["impulse"];
  system.impulse = {vector_of(impulse["q"]),        vector_of(impulse["qd_before"]),
                    vector_of(impulse["qd_after"]), vector_of(impulse["Lambda"]),
                    vector_of(impulse["P"]),        impulse["T_before"].as<double>(),
                    impulse["T_after"].as<double>()};
  for (const YAML::Node& state : node["states"]) {
    system.states.push_back({state["t"].as<double>(), state["stage"].as<int>(), vector_of(state["q"]),
                             vector_of(state["qd"]),
                             state["lambda"] ? vector_of(state["lambda"]) : Vector()});
  }
  return system;
}

}  // namespace

std::ostream& operator<<(std::ostream& stream, const ReferenceSystem& system) {
  return stream << system.name;
}

const std::vector<ReferenceSystem>& reference_systems() {
  static const std::vector<ReferenceSystem> all = [] {
    std::vector<ReferenceSystem> systems;
    for (const std::string name : {"general_systems", "classical_systems"}) {
      const YAML::Node file = YAML::LoadFile(std::string(TEST_DATA_DIR) + "/mechanics/" + name + ".json");
      for (const YAML::Node& node : file["systems"]) systems.push_back(read(node));
    }
    return systems;
  }();
  return all;
}

}  // namespace hybrid_sphere::mechanics::catalogue::testing

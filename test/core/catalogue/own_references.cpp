#include "core/catalogue/own_references.hpp"

#include <yaml-cpp/yaml.h>

#include "core/catalogue/vector_of.hpp"

namespace hybrid_sphere::mechanics::catalogue::testing {
namespace {

Values values(const YAML::Node& node, const Entry& entry) {
  Values result(entry.parameters);
  result.set("t_switch", node["t_switch"].as<double>());
  for (const auto& parameter : node["parameters"]) {
    result.set(parameter.first.as<std::string>(), parameter.second.as<double>());
  }
  for (std::size_t i = 0; i < node["q0"].size(); ++i) {
    result.set(node["coordinates"][i].as<std::string>(), node["q0"][i].as<double>());
  }
  for (std::size_t i = 0; i < node["qd0"].size(); ++i) {
    result.set(node["velocities"][i].as<std::string>(), node["qd0"][i].as<double>());
  }
  return result;
}

}  // namespace

ReferenceSystem own_reference(const std::string& name, const std::string& entry) {
  const YAML::Node file = YAML::LoadFile(std::string(TEST_DATA_DIR) + "/mechanics/" + name + ".json");
  const YAML::Node node = file["systems"][0];
  ReferenceSystem system;
  system.name = name;
  system.entry = entry;
  system.example = catalogue::entry(entry).build(values(node, catalogue::entry(entry)));
  system.t_switch = node["t_switch"].as<double>();
  const YAML::Node impulse = node["impulse"];
  system.impulse.q = vector_of(impulse["q"]);
  system.impulse.v_before = vector_of(impulse["qd_before"]);
  system.impulse.v_after = vector_of(impulse["qd_after"]);
  system.impulse.multipliers = vector_of(impulse["Lambda"]);
  for (const YAML::Node& state : node["states"]) {
    system.states.push_back({state["t"].as<double>(), state["stage"].as<int>(), vector_of(state["q"]),
                             vector_of(state["qd"]), vector_of(state["lambda"])});
  }
  return system;
}

}  // namespace hybrid_sphere::mechanics::catalogue::testing

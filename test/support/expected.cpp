#include "support/expected.hpp"

#include <yaml-cpp/yaml.h>

namespace hybrid_sphere::testing {
namespace {

Vector2d vector2(const YAML::Node& node) { return {node[0].as<double>(), node[1].as<double>()}; }

Twist twist(const YAML::Node& velocities, const YAML::Node& spins, std::size_t first_spin) {
  const auto spin = [&](std::size_t i) { return spins[first_spin + i].as<double>(); };
  return {vector2(velocities), Vector3d(spin(0), spin(1), spin(2))};
}

ExpectedState state(const YAML::Node& node) {
  ExpectedState state;
  state.time = node[0].as<double>();
  state.position = vector2(node[1]);
  const YAML::Node q = node[2];
  state.twist = twist(node[3], node[4], 0);
  const YAML::Node tolerances = node[5];
  state.position_tolerance = tolerances[0].as<double>();
  state.velocity_tolerance = tolerances[1].as<double>();
  state.spin_tolerance = tolerances[2].as<double>();
  if (q.size() == 4) {
    state.orientation =
        Quaterniond(q[3].as<double>(), q[0].as<double>(), q[1].as<double>(), q[2].as<double>());
    state.orientation_tolerance = tolerances[3].as<double>();
  }
  return state;
}

ExpectedSwitch one_switch(const YAML::Node& node) {
  ExpectedSwitch event;
  event.kind = node[0].as<std::string>() == "applied" ? SwitchKind::applied : SwitchKind::released;
  event.from = node[1].as<std::string>();
  event.to = node[2].as<std::string>();
  event.time = node[3].as<double>();
  event.position = vector2(node[4]);
  if (node.size() > 5)
    event.impulse = ExpectedImpulse{vector2(node[5]), twist(node[6], node[6], 2), twist(node[7], node[7], 2)};
  return event;
}

}  // namespace

Expected read_expected(const std::string& path) {
  const YAML::Node root = YAML::LoadFile(path);
  Expected expected;
  expected.event_time_tolerance = root["event_time_tolerance"].as<double>();
  for (const YAML::Node& node : root["states"]) expected.states.push_back(state(node));
  for (const YAML::Node& node : root["switches"]) expected.switches.push_back(one_switch(node));
  return expected;
}

}  // namespace hybrid_sphere::testing

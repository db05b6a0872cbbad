#include "support/expected.hpp"

#include <yaml-cpp/yaml.h>

#include <stdexcept>

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
  if (node.size() > 7) {
    state.mode = node[6].as<std::string>();
    state.region = node[7].as<std::string>();
  }
  return state;
}

SwitchKind kind_of(const std::string& word) {
  for (const SwitchKind kind : {SwitchKind::applied, SwitchKind::released, SwitchKind::exchanged}) {
    if (word == to_string(kind)) return kind;
  }
  throw std::runtime_error("no kind of switch: " + word);
}

Cause cause_of(const std::string& word) {
  for (const Cause cause : {Cause::edge, Cause::placed, Cause::slip_ended, Cause::grip_lost, Cause::livelock,
                            Cause::livelock_ended, Cause::kicked, Cause::accumulation}) {
    if (word == to_string(cause)) return cause;
  }
  throw std::runtime_error("no cause of a switch: " + word);
}

ExpectedImpulse impulse(const YAML::Node& node, const YAML::Node& before, const YAML::Node& after) {
  ExpectedImpulse impulse;
  impulse.impulse = vector2(node);
  if (node.size() > 2) impulse.normal = node[2].as<double>();
  impulse.before = twist(before, before, 2);
  impulse.after = twist(after, after, 2);
  return impulse;
}

ExpectedSwitch one_switch(const YAML::Node& node) {
  ExpectedSwitch event;
  event.kind = kind_of(node[0].as<std::string>());
  event.from = node[1].as<std::string>();
  event.to = node[2].as<std::string>();
  event.time = node[3].as<double>();
  event.position = vector2(node[4]);
  const YAML::Node last = node[node.size() - 1];
  event.cause = last.IsMap()      ? cause_of(last["cause"].as<std::string>())
                : event.time == 0 ? Cause::placed
                                  : Cause::edge;
  if (node.size() > 7) event.impulse = impulse(node[5], node[6], node[7]);
  return event;
}

}  // namespace

Expected read_expected(const std::string& path) {
  const YAML::Node root = YAML::LoadFile(path);
  Expected expected;
  expected.event_time_tolerance = root["event_time_tolerance"].as<double>();
  if (root["halted_at"]) expected.halted_at = root["halted_at"].as<double>();
  for (const YAML::Node& node : root["states"]) expected.states.push_back(state(node));
  for (const YAML::Node& node : root["switches"]) expected.switches.push_back(one_switch(node));
  return expected;
}

}  // namespace hybrid_sphere::testing

#pragma once

#include <string>
#include <vector>

#include "hybrid_sphere/simulation/simulation.hpp"

namespace hybrid_sphere::testing {

/// A switch with names of its own, so that it outlives the call that reported it.
struct RecordedSwitch : Switch {
  explicit RecordedSwitch(const Switch& event) : Switch(event), from(event.from_region), to(event.to_region) {
    from_region = to_region = {};
  }
  std::string from;
  std::string to;
};

/// A sink that keeps all switches.
inline Simulation::SwitchSink recorder(std::vector<RecordedSwitch>& switches) {
  return [&switches](const Switch& event) { switches.emplace_back(event); };
}

}  // namespace hybrid_sphere::testing

#pragma once

#include <cstdint>
#include <deque>
#include <functional>
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

/// A state with a name of its own, and the force of the ground.
struct RecordedState : State {
  explicit RecordedState(Simulation& simulation)
      : State(simulation.state()), name(region), reaction(simulation.reaction()) {
    region = {};
  }
  std::string name;
  Vector3d reaction;
};

/// Of a million none is moved, which would take as long as a run.
using Switches = std::deque<RecordedSwitch>;

/// A sink that keeps all switches.
inline Simulation::SwitchSink recorder(Switches& switches) {
  return [&switches](const Switch& event) { switches.emplace_back(event); };
}

/// All that a simulation tells.
struct Record {
  std::vector<RecordedState> states;
  Switches switches;
  std::string halt;          ///< why it halted; empty where it did not
  bool interrupted = false;  ///< it ends where it was asked to stop
  std::uint64_t evaluations = 0;
  double estimated_error = 0;  ///< see Simulation::estimated_error
};

/// @param until    [s]
/// @param outputs      so many states after the first one, evenly; fewer where the simulation halts
/// @param should_stop  see Simulation::set_interrupt
inline Record record(const scene::Scene& scene, double until, int outputs,
                     const std::function<bool()>& should_stop = {}) {
  Simulation simulation(scene);
  simulation.set_interrupt(should_stop);
  Record result;
  try {
    for (int i = 0; i <= outputs; ++i) {
      simulation.advance_to(i < outputs ? until * i / outputs : until, recorder(result.switches));
      result.states.emplace_back(simulation);
    }
  } catch (const HaltedError& error) {
    result.halt = error.what();
    result.states.emplace_back(simulation);
  } catch (const Interrupted&) {
    result.interrupted = true;
    result.states.emplace_back(simulation);
  }
  result.evaluations = simulation.evaluations();
  result.estimated_error = simulation.estimated_error();
  return result;
}

}  // namespace hybrid_sphere::testing

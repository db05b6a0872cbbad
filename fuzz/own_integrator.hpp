#pragma once

#include <optional>
#include <string>
#include <vector>

#include "own_motion.hpp"

namespace hybrid_sphere::fuzz::own {

/// A change of the constraint on the sphere.
struct OwnSwitch {
  Real time = 0;
  std::string to;
};

struct OwnState {
  Body body;
  std::string region;
};

/// A run of the independent integrator.
struct OwnRun {
  std::vector<OwnState> states;
  std::vector<OwnSwitch> switches;
  std::string gave_up;  ///< why it says nothing; empty where it does
  Real speed = 0;       ///< the greatest one
  Real way = 0;         ///< that it has come
};

/// @param times   of the outputs, ascending [s]
/// @param shorter  of the steps: 1, or more to see what hangs on their length
OwnRun integrate(const scene::Scene& scene, const std::vector<double>& times, Real shorter);

}  // namespace hybrid_sphere::fuzz::own

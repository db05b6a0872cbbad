#pragma once

#include <string>
#include <vector>

#include "hybrid_sphere/scene/scene.hpp"
#include "support/expected.hpp"

namespace hybrid_sphere::testing {

/// A scene of test/data with its solution in high precision.
struct SolvedScene {
  std::string name;
  scene::Scene scene;
  Expected expected;
};

/// All of test/data/oracle and test/data/reference.
std::vector<SolvedScene> solved_scenes();

/// What a method has delivered for an accuracy.
struct Delivered {
  /// The worst error of an output, in units of what was asked for: the accuracy times the scale of motion
  /// (the way so far, the greatest speed so far, the angle turned), times the condition of the output as the
  /// reference tells it, plus what binary64 allows.
  double worst = 0;
  std::string where;            ///< of it
  bool other_switches = false;  ///< a number of switches other than expected
  /// With other switches: whether an initial velocity that is off by the accuracy changes their number as
  /// well.
  bool hangs_on_less = false;
  std::string halt;     ///< why the computation could not go on; empty where it was not to
  double error = 0;     ///< the worst, relative to the scale of motion times the condition, beyond binary64's
  double estimate = 0;  ///< of it, by the simulation
  std::uint64_t evaluations = 0;  ///< of the right-hand side
};

Delivered deliver(const SolvedScene& solved, const scene::Solver& solver);

}  // namespace hybrid_sphere::testing

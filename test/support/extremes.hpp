#pragma once

#include <string>
#include <vector>

#include "hybrid_sphere/scene/scene.hpp"
#include "support/expected.hpp"

/// Measures a run of a scene with extreme numbers against its solution in a hundred digits. Shared by the
/// tests of the extremes and by the program that prints their table.
namespace hybrid_sphere::testing {

/// An error and what binary64 can reach in its place (test/data/extremes/README.md).
struct Reached {
  double error = 0;
  double floor = 0;
  std::string where;  ///< the quantity and its time of the largest error

  /// Error in units of the floor; 0/0 is 0.
  double ratio() const { return error == 0 ? 0 : error / floor; }
};

/// The worst of a run.
struct Measured {
  std::string
      failure;    ///< why there is no error: a refusal, a halt, other switches, a number that is not finite
  Reached worst;  ///< largest error in units of its floor, in the units of the quantity
  Reached relative;         ///< largest error relative to the scale of motion, and the largest floor so
  Reached time;             ///< of a switch: largest error, and its floor [s]
  bool integrated = false;  ///< some motion had no closed form
};

/// @param expected  its tolerances are floors
Measured measure(const scene::Scene& scene, const Expected& expected);

/// The same for a scene in the data, by a method as for read_extreme; a method that is refused is a failure.
Measured measure(const std::string& directory, const std::string& name, const std::string& method);

/// A run over strips that are smooth and rough in turn.
struct Strips {
  int switches = 0;         ///< that were reported
  double end = 0;           ///< time of the last one [s]
  double time_error = 0;    ///< largest of a switch's time [s]
  double moment_error = 0;  ///< largest of a switch's time with its rest [s]
  double time_floor =
      0;  ///< rounding of the last switch's time, as a result and as the place of its edge [s]
  double state_error = 0;  ///< of the last position, relative to the way
  std::string failure;     ///< why it ended before; empty where it did not
};

/// Compares each switch with the closed form: after the only impulse, at the first edge, the speed is 1 m/s.
/// @param count    edges
/// @param spacing  of the edges [m]
Strips run_over_strips(int count, double spacing, const scene::Solver& solver = {});

/// A solver as a scene's reader takes it.
/// @param method  word of solver.method; for a method of fixed steps WORD:STEP with solver.step in seconds
scene::Solver solver_of(const std::string& method, double accuracy);

/// @param directory  that of the data
/// @param method     as for solver_of; empty: that of the scene
scene::Scene read_extreme(const std::string& directory, const std::string& name,
                          const std::string& method = "");

}  // namespace hybrid_sphere::testing

#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "peer.hpp"

namespace hybrid_sphere::peers {

/// One simulator at one setting of its dial in one scene.
struct Row {
  static constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

  std::string scene;
  std::string simulator;
  double dial = unknown;            ///< step [s], or accuracy
  double position_error = unknown;  ///< relative to the scale of motion
  double velocity_error = unknown;  ///< relative to the scale of motion
  double cost = unknown;            ///< wall time of a simulated second [ns]
  double ratio = unknown;           ///< to hybrid_sphere's cost for the same outputs
  double step_ratio = unknown;      ///< to hybrid_sphere's cost for a whole state at every step of this row
  std::string note;

  bool ran() const { return std::isfinite(position_error) && std::isfinite(velocity_error); }
  double error() const { return std::max(position_error, velocity_error); }
};

struct Limits {
  bool quick = false;  ///< one run of one setting
  /// Wall time of a run beyond which a row is left out; from an eighth of it on a row is run but once [s].
  double seconds = 3;
};

/// What a scene's motion is measured by (docs/theory.md 7.5): the way that the centre has come at the end
/// [m], and the speed V at which the centre would hold all kinetic energy that the sphere has had [m/s].
struct Scale {
  double way = 0;
  double speed = 0;
};
Scale scale_of_motion(const Task& task, const std::vector<Sample>& truth);

/// hybrid_sphere and all peers in a scene, one row a setting.
std::vector<Row> compare(const Task& task, const std::vector<std::unique_ptr<Peer>>& peers,
                         const Limits& limits);

}  // namespace hybrid_sphere::peers

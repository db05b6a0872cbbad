#pragma once

#include <string>
#include <vector>

#include "hybrid_sphere/scene/scene.hpp"
#include "hybrid_sphere/simulation/records.hpp"

namespace hybrid_sphere::work_precision {

/// A scene with states of its motion that are good to rounding.
struct Problem {
  std::string name;
  scene::Scene scene;
  std::vector<State> truth;  ///< ascending in time, none near a switch
  std::size_t switches = 0;  ///< until the last of them
};

/// paper: the paper's sphere, off every grid of time steps. strips: 80 edges, oblique. incline: rolling down
/// a rough slope, over a smooth part of it, and on. sliding: friction on a slope. turntable: a turntable that
/// is tilted. quadratic_drag: over 100 edges.
std::vector<Problem> problems();

}  // namespace hybrid_sphere::work_precision

#pragma once

#include <string>

#include "hybrid_sphere/scene/scene.hpp"
#include "python/forward.hpp"
#include "scene/tree.hpp"

namespace hybrid_sphere::python {

/// A scene as it is written, not yet read.
struct SceneSource {
  scene::Tree tree;
  std::string directory;  ///< to which names of images refer; empty: the working directory
};

/// @param scene  the name of a file, a text (YAML: it begins with { or has more than one line), or a dict
/// @throws SceneError  if there is no such file, or it is no YAML
SceneSource source_of(const pybind11::handle& scene);

/// Warns (UserWarning) of what the reader has ignored.
/// @throws SceneError  also where the method exact is asked for and has no closed form
scene::Scene scene_of(const SceneSource& source);

}  // namespace hybrid_sphere::python

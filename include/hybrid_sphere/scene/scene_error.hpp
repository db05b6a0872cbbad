#pragma once

#include <stdexcept>
#include <string>

#include "hybrid_sphere/export.hpp"

namespace hybrid_sphere::scene {

/// A value that is refused. what() is "<path>: <value> is refused; allowed: <what is allowed>".
/// @code
/// const scene::SceneError error("sphere.mass", "-1", "a number from 1e-60 to 1e+60 [kg]");
/// const std::string message = error.what();  // sphere.mass: -1 is refused; allowed: ...
/// @endcode
class HYBRID_SPHERE_EXPORT SceneError : public std::runtime_error {
 public:
  /// @param path     full path of the key, e.g. surface.regions[2].circle.radius
  /// @param value    the value found there
  /// @param allowed  the allowed range or form
  SceneError(const std::string& path, const std::string& value, const std::string& allowed);
  /// A source that cannot be read at all (no such file, not YAML, too large).
  explicit SceneError(const std::string& message) : std::runtime_error(message) {}
  /// A required key is missing.
  static SceneError missing(const std::string& path, const std::string& allowed);
};

}  // namespace hybrid_sphere::scene

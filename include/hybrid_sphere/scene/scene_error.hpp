#pragma once

#include <memory>
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
  explicit SceneError(const std::string& message) : SceneError(message, {}) {}
  /// A required key is missing.
  static SceneError missing(const std::string& path, const std::string& allowed);
  /// A key that is not known. @param hint  put behind that in what()
  static SceneError unknown(const std::string& path, const std::string& hint, const std::string& allowed);

  /// The full path of the key; empty if the source cannot be read at all.
  const std::string& path() const { return parts_->path; }
  /// The value found there, as it is shown; empty if there is none.
  const std::string& value() const { return parts_->value; }
  /// What is allowed instead; empty if the source cannot be read at all.
  const std::string& allowed() const { return parts_->allowed; }

 private:
  struct Parts {
    std::string path;
    std::string value;
    std::string allowed;
  };
  SceneError(const std::string& message, Parts parts);

  std::shared_ptr<const Parts> parts_;  // shared, as the copy of an exception must not throw
};

}  // namespace hybrid_sphere::scene

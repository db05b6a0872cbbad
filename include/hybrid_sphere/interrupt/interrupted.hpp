#pragma once

#include <exception>

#include "hybrid_sphere/export.hpp"

namespace hybrid_sphere {

/// Thrown when the caller's function asks a computation to stop. Nothing is wrong: repeating the call resumes
/// it. Not derived from std::runtime_error, so that handlers of that class do not catch it.
/// @code
/// const auto tried = [](const auto& computation) {
///   try {
///     computation();
///   } catch (const Interrupted&) {
///     return false;
///   }
///   return true;
/// };
/// @endcode
class HYBRID_SPHERE_EXPORT Interrupted : public std::exception {
 public:
  const char* what() const noexcept override {
    return "interrupted: whoever asked for the computation wants it to stop";
  }
};

}  // namespace hybrid_sphere

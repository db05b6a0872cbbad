#pragma once

#include <exception>

#include "hybrid_sphere/export.hpp"

namespace hybrid_sphere {

/// The caller's function has said that a computation should stop. Nothing is wrong: the same call goes on.
/// No std::runtime_error, so that nobody who handles those takes it for one.
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

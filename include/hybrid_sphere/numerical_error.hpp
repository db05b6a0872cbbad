#pragma once

#include <stdexcept>

#include "hybrid_sphere/export.hpp"

namespace hybrid_sphere {

/// A numerical failure: no step is accurate enough, a derivative is not finite, or equations have no
/// solution. The only kind of exception that the computation itself throws and catches; what the caller's
/// functions throw is not of this kind and passes through.
/// @code
/// const auto checked = [](double x) {
///   if (!(x > 0)) throw NumericalError("no logarithm");
///   return std::log(x);
/// };
/// @endcode
class HYBRID_SPHERE_EXPORT NumericalError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace hybrid_sphere

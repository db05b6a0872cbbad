#pragma once

#include <stdexcept>

#include "hybrid_sphere/export.hpp"

namespace hybrid_sphere {

/// A number that cannot be computed: no step is accurate enough, a derivative is not finite, equations have
/// no solution. The one kind of exception that the computation itself throws and catches; what a function of
/// the caller throws is none and passes through.
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

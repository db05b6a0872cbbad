#pragma once

#include <string>

#include "hybrid_sphere/mechanics/solve.hpp"

namespace hybrid_sphere::mechanics {

constexpr double least_time = 1e-100;  ///< below, squares underflow

/// Throws std::invalid_argument: "WHAT = VALUE is refused; allowed: ALLOWED".
[[noreturn]] void refuse(const std::string& what, double value, const std::string& allowed);

/// Refuses a time, coordinates (N) and velocities (n) of other sizes than the model's, or with numbers that
/// are not finite, and coordinates that cannot be normalized. Throws std::invalid_argument with the name, the
/// value and the allowed range.
void check_state(const Model& model, double t, const Vector& q, const Vector& v);

/// Refuses a state of another model, in which a constraint slides that has no friction. Throws as above, and
/// std::out_of_range for an index that is not one of a constraint.
void check_state(const Model& model, const State& state);

/// Refuses a model, an initial state and options of which no motion can be computed. Throws
/// std::invalid_argument with the name, the value and the allowed range.
void check(const Model& model, const Initial& initial, const Options& options);

}  // namespace hybrid_sphere::mechanics

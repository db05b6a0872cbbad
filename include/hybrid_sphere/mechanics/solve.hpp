#pragma once

#include <cstdint>
#include <functional>
#include <limits>

#include "hybrid_sphere/export.hpp"
#include "hybrid_sphere/mechanics/solution.hpp"

namespace hybrid_sphere::mechanics {

constexpr double least_accuracy = 1e-13;
constexpr double greatest_accuracy = 0.1;

/// How far a motion has progressed.
struct Progress {
  double time = 0;             ///< t [s]
  std::uint64_t steps = 0;     ///< so far
  std::uint64_t switches = 0;  ///< so far
};

struct Options {
  /// Requested error of q and v, relative to the scale of motion.
  double accuracy = 1e-9;
  /// Projects initial velocities that violate a constraint said to hold already onto it, instead of refusing
  /// them.
  bool project_initial = false;
  /// Moves initial positions onto the holonomic constraints that hold from the start, instead of refusing
  /// positions that are off by more than the accuracy, such as published, rounded ones: by the smallest
  /// change in the metric of M. Solution::projection() reports the change. A contact holds if its gap is
  /// negative or Initial::active names it. Velocities are not changed by this; see project_initial.
  bool project_positions = false;
  std::uint64_t max_switches = 1'000'000;
  std::uint64_t max_steps = 10'000'000;
  /// The longest step [s], >= 1e-100: for forces and guards that act only for a short time, which a longer
  /// step may miss.
  double max_step = std::numeric_limits<double>::infinity();
  /// Called with the progress after each step, and now and then during a step, an impulse or a guard search
  /// that takes long; may be empty. If it returns false, the motion ends with Stop::cancelled.
  std::function<bool(const Progress&)> monitor;
};

/// The three stages: free motion, an impulse at each change of the constraints, motion under them.
/// A constraint with a guard holds where g > 0; at g = 0 the direction of the motion decides, first with the
/// velocity before an impulse, then with the one after it (docs/theory.md 7.6).
///
/// Throws std::invalid_argument for invalid input: a model that check() refuses, wrong sizes, numbers that
/// are not finite or out of range, and initial velocities that violate a constraint said to hold already
/// (with the residual). A failure during the motion ends it there, with a status that says why. Any other
/// exception of a user function leaves solve() unchanged.
/// @param duration  0, or >= 1e-100 [s]
/// @code
/// const auto after_a_second = [](const mechanics::Model& model) {
///   mechanics::Initial initial;
///   initial.q = initial.v = mechanics::Vector::Ones(1);
///   return mechanics::solve(model, initial, 1).at(1).q;
/// };
/// @endcode
HYBRID_SPHERE_EXPORT Solution solve(const Model& model, const Initial& initial, double duration,
                                    const Options& options = {});

}  // namespace hybrid_sphere::mechanics

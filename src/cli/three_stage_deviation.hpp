#pragma once

#include <cstdint>

#include "catalogue/catalogue.hpp"
#include "mechanics/motion_scale.hpp"

namespace hybrid_sphere::cli::three_stage {

/// How far a computed motion is from the one known by a formula, in units of its scale: MotionScale for q and
/// v; for a multiplier the one that alone makes the largest acceleration of the motion, or changes its
/// velocity by its own size within the duration.
class Deviation {
 public:
  /// @param q         at the start
  /// @param duration  of the motion [s]
  /// @param step      time between two states that are added, as a rule [s]
  Deviation(const mechanics::Model& model, const mechanics::Vector& q, double duration, double step);

  /// Takes in a state, and what it should be.
  void add(const mechanics::State& state, const mechanics::catalogue::Known& known);

  std::uint64_t states() const { return states_; }  ///< added so far
  double of_coordinates() const;
  double of_velocities() const;
  double of_multipliers() const;

 private:
  void see_reactions(const mechanics::State& state);

  mechanics::ConstrainedMotion motion_;
  mechanics::MotionScale scale_;
  double duration_;
  double step_;
  std::uint64_t states_ = 0;
  double acceleration_ = 0;           // largest one in the metric of M
  mechanics::Vector error_;           // largest abs of q and v stacked (N + n)
  mechanics::Vector reaction_error_;  // largest abs, of the multipliers
  mechanics::Vector reaction_;        // largest abs of the known ones
  mechanics::Vector effect_;          // smallest acceleration by a multiplier of 1, in the metric of M
};

}  // namespace hybrid_sphere::cli::three_stage

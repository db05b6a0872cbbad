#pragma once

#include "hybrid_sphere/mechanics/solution.hpp"
#include "python/motion_table.hpp"

/// The two tables of a motion: their first columns are those that `three_stage` writes.
namespace hybrid_sphere::python {

/// t stage coordinates velocities lambda_constraints energy kinetic_energy residual estimated_error active
/// sliding penetrating
MotionTable state_table(const mechanics::Model& model);
void add(const mechanics::Model& model, const mechanics::State& state, MotionTable& table);

/// index t applied released coordinates velocities_before velocities_after Lambda_constraints
/// P_velocities rank energy_before energy_after kinetic_energy_before kinetic_energy_after active sliding
/// events
MotionTable switch_table(const mechanics::Model& model);
void add(const mechanics::Model& model, const mechanics::Switch& event, MotionTable& table);

}  // namespace hybrid_sphere::python

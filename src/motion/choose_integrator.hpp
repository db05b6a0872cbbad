#pragma once

#include <memory>

#include "hybrid_sphere/scene/scene.hpp"
#include "integration/integrators.hpp"

namespace hybrid_sphere::numeric {

/// The method that integrates where a scene has no closed form: the one it names, or for `automatic` the one
/// that costs least of those that keep the accuracy. Source: measured, docs/speed_and_accuracy.md.
scene::Solver::Method chosen_method(const scene::Solver& solver);

/// Whether a segment that drag makes stiff is gone on with by cvode_bdf: for `automatic` at accuracies that
/// it keeps. One that dry friction makes stiff always is, by `automatic`.
bool turns_implicit(const scene::Solver& solver);

/// chosen_method(solver), ready to be used. Source: docs/theory.md 4.7.
std::unique_ptr<integration::Integrator> make_integrator(const scene::Solver& solver);

}  // namespace hybrid_sphere::numeric

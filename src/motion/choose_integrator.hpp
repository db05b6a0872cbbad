#pragma once

#include <memory>

#include "hybrid_sphere/scene/scene.hpp"
#include "integration/integrators.hpp"

namespace hybrid_sphere::numeric {

/// The method that integrates motions without a closed form: the one that the scene names, or for `automatic`
/// the cheapest one that keeps the accuracy. Source: measured, docs/speed_and_accuracy.md.
scene::Solver::Method chosen_method(const scene::Solver& solver);

/// Whether cvode_bdf continues a segment that drag makes stiff: with `automatic`, at accuracies that it
/// keeps. With `automatic` it always continues a segment that dry friction makes stiff.
bool turns_implicit(const scene::Solver& solver);

/// chosen_method(solver), ready to be used. Source: docs/theory.md 4.7.
std::unique_ptr<integration::Integrator> make_integrator(const scene::Solver& solver);

}  // namespace hybrid_sphere::numeric

#pragma once

#include "hybrid_sphere/mechanics/model.hpp"

namespace hybrid_sphere::mechanics {

/// A model on which generalised forces act besides its own: M v' = h + u + C^T lambda.
/// @param forces  u, constant, on each velocity (n); where all are 0 this is the model as it is, to the bit
Model with_generalised_forces(Model model, const Vector& forces);

}  // namespace hybrid_sphere::mechanics

#pragma once

#include "hybrid_sphere/mechanics/model.hpp"

namespace hybrid_sphere::ros_interface {

/// A model on which generalised forces act besides its own: M v' = h + u + C^T lambda.
/// @param forces  u, constant, on each velocity (n); where all are 0 this is the model as it is, to the bit
mechanics::Model with_generalised_forces(mechanics::Model model, const mechanics::Vector& forces);

}  // namespace hybrid_sphere::ros_interface

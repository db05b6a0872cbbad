#pragma once

/// Equations of motion, constraints and guards that are differentiated automatically.
#include <Eigen/Geometry>  // for the functions: cross, Quaternion

#include "hybrid_sphere/mechanics/automatic_constraint.hpp"
#include "hybrid_sphere/mechanics/automatic_equations.hpp"

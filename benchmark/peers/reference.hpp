#pragma once

#include <string>
#include <vector>

#include "peer.hpp"

namespace hybrid_sphere::peers {

/// The motion of a scene of smooth and rough ground at rest under gravity, computed apart from the library
/// that is measured: parabolas between the switches, edges met and velocities changed in 113-bit arithmetic,
/// and rounded to binary64 at the end. The formulas are those of docs/theory.md 3.1 and 4.2.
/// @throws std::invalid_argument  for any other scene
std::vector<Sample> reference(const scene::Scene& scene, const std::vector<double>& times);

/// The times of a task's outputs [s].
std::vector<double> output_times(const Task& task);

/// Compares the reference with a solution in thirty digits that comes from elsewhere.
/// @param stem  path of STEM.yaml and STEM.expected.yaml of test/data/oracle, without its endings
/// @return      the largest error of position, velocity and angular velocity, relative to the tolerances of
/// that file
double check_reference(const std::string& stem);

}  // namespace hybrid_sphere::peers

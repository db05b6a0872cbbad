#pragma once

#include <string>
#include <vector>

#include "simulation/scene_variation.hpp"
#include "study/study.hpp"

namespace hybrid_sphere::study {

/// The scene of a study, whose variables are those of the study. @throws SceneError  as its constructor
SceneVariation variation_of(const Study& study);

/// What is said before the runs: which variables leave the allowed range, and how often.
/// @throws SceneError  if one of them is never within it
std::vector<std::string> warnings(const Study& study, const SceneVariation& variation);

}  // namespace hybrid_sphere::study

#pragma once

#include <string>
#include <vector>

#include "scene/tree.hpp"
#include "study/study.hpp"

namespace hybrid_sphere::study {

/// A list of {variables: [paths], covariance: [[..], ..]}; the variables are normal ones of the study, whose
/// variances are the diagonal of the covariance.
/// @throws SceneError  with the key's full path, the value and what is allowed
std::vector<Correlation> read_correlations(const scene::Tree& tree, const std::string& path,
                                           const std::vector<Variable>& variables);

}  // namespace hybrid_sphere::study

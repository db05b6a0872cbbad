#include "study/study_scene.hpp"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <limits>
#include <optional>
#include <sstream>

namespace hybrid_sphere::study {

SceneVariation variation_of(const Study& study) {
  std::vector<std::string> paths;
  for (const Variable& variable : study.variables) paths.push_back(variable.path);
  return {study.scene_tree, study.scene_directory, paths, "vary."};
}

std::vector<std::string> warnings(const Study& study, const SceneVariation& variation) {
  const bool varies_sphere =
      std::any_of(study.variables.begin(), study.variables.end(),
                  [](const Variable& variable) { return variable.path.rfind("sphere.", 0) == 0; });
  const std::vector<scene::SceneNumber>& numbers = variation.numbers();
  std::vector<std::string> result = variation.scene().warnings;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const std::optional<scene::SceneField>& field = numbers[i].field;
    if (!field || (field->is_bounded_by_sphere && varies_sphere)) continue;  // only each run knows its range
    const scene::Range& range = field->range;
    const Variable& variable = study.variables[i];
    const double below = cumulative(variable.distribution,
                                    std::nextafter(range.low, -std::numeric_limits<double>::infinity()));
    const double share = below + (1 - cumulative(variable.distribution, range.high));
    if (share >= 1) {
      throw scene::SceneError("vary." + variable.path, "a distribution outside of the range",
                              range.describe());
    }
    constexpr double few = 1e-3;  // runs that are expected to be refused
    if (!(share * static_cast<double>(study.runs) > few)) continue;
    std::ostringstream warning;
    warning << std::setprecision(5) << "vary." << variable.path << ": a share of " << share
            << " of the samples will be refused; allowed: " << range.describe();
    result.push_back(warning.str());
  }
  return result;
}

}  // namespace hybrid_sphere::study

#include "study/scene_variation.hpp"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <limits>
#include <sstream>

#include "hybrid_sphere/scene/validate.hpp"
#include "simulation/check_method.hpp"

namespace hybrid_sphere::study {

SceneVariation::SceneVariation(const Study& study)
    : study_(&study), scene_(scene_of(study, study.scene_tree)) {
  find_numbers();
  const scene::Tree body = scene::at_place(study.scene_tree, {std::string("sphere"), std::string("body")});
  if (const auto word = body.as_text()) body_factor_ = std::sqrt(*word == "solid" ? 2. / 5 : 2. / 3);
  check_as_file();
  if (varies_initial_state_alone_) check_method(scene_);
  if (!has_fields_) read_ = scene_;
}

void SceneVariation::find_numbers() {
  for (const Variable& variable : study_->variables) {
    const std::string where = "vary." + variable.path;
    numbers_.push_back(find_number(scene_, study_->scene_tree, variable.path, where));
    const SceneNumber& number = numbers_.back();
    const auto first = std::find_if(numbers_.begin(), numbers_.end(), [&](const SceneNumber& other) {
      return other.place == number.place && other.index == number.index;
    });
    if (&*first != &number) {
      const auto i = static_cast<std::size_t>(first - numbers_.begin());
      throw scene::SceneError(where, "the number of " + study_->variables[i].path, "each number once");
    }
    has_fields_ = has_fields_ && number.field;
    varies_initial_state_alone_ =
        varies_initial_state_alone_ && number.field && number.field->path.rfind("initial_state.", 0) == 0;
  }
}

/// Only the reader knows what may not stand beside each other in a file: it reads the scene's own numbers.
void SceneVariation::check_as_file() const {
  scene::Tree tree = study_->scene_tree;
  for (const SceneNumber& number : numbers_) {
    if (number.field) tree = with_number(tree, number, number.field->data[number.index]);
  }
  scene_of(*study_, tree);
}

bool SceneVariation::is_within_ranges(const double* sample) const {
  return std::all_of(numbers_.begin(), numbers_.end(),
                     [&](const SceneNumber& number) { return number.field->range.holds(*sample++); });
}

void SceneVariation::set(const double* sample) {
  if (!has_fields_) {
    read_ = scene_of(*study_, tree_of(sample));
    check_method(read_);
    return;
  }
  for (std::size_t i = 0; i < numbers_.size(); ++i) {
    numbers_[i].field->data[numbers_[i].index] = sample[i];
  }
  if (varies_initial_state_alone_ && is_within_ranges(sample)) return;
  if (body_factor_ > 0) scene_.sphere.gyration_radius = scene_.sphere.radius * body_factor_;
  scene::validate(scene_);
  check_method(scene_);
}

scene::Tree SceneVariation::tree_of(const double* sample) const {
  scene::Tree tree = study_->scene_tree;
  for (const SceneNumber& number : numbers_) tree = with_number(tree, number, *sample++);
  return tree;
}

std::vector<std::string> SceneVariation::warnings() const {
  const bool varies_sphere =
      std::any_of(study_->variables.begin(), study_->variables.end(),
                  [](const Variable& variable) { return variable.path.rfind("sphere.", 0) == 0; });
  std::vector<std::string> result;
  for (std::size_t i = 0; i < numbers_.size(); ++i) {
    const std::optional<SceneField>& field = numbers_[i].field;
    if (!field || (field->is_bounded_by_sphere && varies_sphere)) continue;  // only each run knows its range
    const scene::Range& range = field->range;
    const Variable& variable = study_->variables[i];
    const double below = cumulative(variable.distribution,
                                    std::nextafter(range.low, -std::numeric_limits<double>::infinity()));
    const double share = below + (1 - cumulative(variable.distribution, range.high));
    if (share >= 1) {
      throw scene::SceneError("vary." + variable.path, "a distribution outside of the range",
                              range.describe());
    }
    constexpr double few = 1e-3;  // runs that are expected to be refused
    if (!(share * static_cast<double>(study_->runs) > few)) continue;
    std::ostringstream warning;
    warning << std::setprecision(5) << "vary." << variable.path << ": a share of " << share
            << " of the samples will be refused; allowed: " << range.describe();
    result.push_back(warning.str());
  }
  return result;
}

}  // namespace hybrid_sphere::study

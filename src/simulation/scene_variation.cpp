#include "simulation/scene_variation.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "hybrid_sphere/scene/validate.hpp"
#include "scene/read_tree.hpp"
#include "scene/tree_place.hpp"
#include "simulation/check_method.hpp"

namespace hybrid_sphere {

SceneVariation::SceneVariation(scene::Tree scene, std::string directory,
                               const std::vector<std::string>& paths, const std::string& where)
    : tree_(std::move(scene)),
      directory_(std::move(directory)),
      scene_(scene::read_scene(tree_, directory_)) {
  find_numbers(paths, where);
  const scene::Tree body = scene::at_place(tree_, {std::string("sphere"), std::string("body")});
  if (const auto word = body.as_text()) body_factor_ = std::sqrt(*word == "solid" ? 2. / 5 : 2. / 3);
  check_as_file();
  if (varies_initial_state_alone_) check_method(scene_);
  if (!has_fields_) read_ = scene_;
}

void SceneVariation::find_numbers(const std::vector<std::string>& paths, const std::string& where) {
  for (const std::string& path : paths) {
    numbers_.push_back(scene::find_number(scene_, tree_, path, where + path));
    const scene::SceneNumber& number = numbers_.back();
    const auto first = std::find_if(numbers_.begin(), numbers_.end(), [&](const scene::SceneNumber& other) {
      return other.place == number.place && other.index == number.index;
    });
    if (&*first != &number) {
      const auto i = static_cast<std::size_t>(first - numbers_.begin());
      throw scene::SceneError(where + path, "the number of " + paths[i], "each number once");
    }
    has_fields_ = has_fields_ && number.field;
    varies_initial_state_alone_ =
        varies_initial_state_alone_ && number.field && number.field->path.rfind("initial_state.", 0) == 0;
  }
}

/// Only the reader knows what may not stand beside each other in a file: it reads the scene's own numbers.
void SceneVariation::check_as_file() const {
  scene::Tree tree = tree_;
  for (const scene::SceneNumber& number : numbers_) {
    if (number.field) tree = scene::with_number(tree, number, number.field->data[number.index]);
  }
  scene::read_scene(tree, directory_);
}

bool SceneVariation::is_within_ranges(const double* sample) const {
  return std::all_of(numbers_.begin(), numbers_.end(),
                     [&](const scene::SceneNumber& number) { return number.field->range.holds(*sample++); });
}

void SceneVariation::set(const double* sample) {
  if (!has_fields_) {
    read_ = scene::read_scene(tree_of(sample), directory_);
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
  scene::Tree tree = tree_;
  for (const scene::SceneNumber& number : numbers_) tree = scene::with_number(tree, number, *sample++);
  return tree;
}

}  // namespace hybrid_sphere

#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "hybrid_sphere/scene/scene.hpp"
#include "scene/ranges.hpp"
#include "scene/tree_place.hpp"

namespace hybrid_sphere::scene {

/// A number of a scene, or a list of numbers, as it was read.
struct SceneField {
  std::string path;                   ///< as in a scene file, with the index of a region
  double* data;                       ///< in the scene
  std::size_t size;                   ///< 0: a number, not a list
  Range range;                        ///< of each number
  bool is_bounded_by_sphere = false;  ///< the range depends on numbers of the sphere
};

/// A number of a scene by its path, such as `surface.regions[rough_half].friction` or
/// `initial_state.velocity[0]`. Regions have their names or their indices.
struct SceneNumber {
  std::optional<SceneField> field;  ///< that it is, or belongs to; none: only the reader knows what it does
  std::size_t index = 0;            ///< in the list of the field
  TreePlace place;                  ///< of the field; without one, of the number
};

/// @param scene  to which the result refers
/// @param tree   from which it was read
/// @param where  put before the path in refusals
/// @throws SceneError  with the path and the nearest one that there is
SceneNumber find_number(Scene& scene, const Tree& tree, const std::string& path, const std::string& where);

/// The tree with another value of the number. A list that the tree does not give is made of the field's
/// values.
Tree with_number(const Tree& tree, const SceneNumber& number, double value);

/// The unit in a range's text: "m/s" of "[m/s]"; empty if there is none.
std::string unit_of(const Range& range);

}  // namespace hybrid_sphere::scene

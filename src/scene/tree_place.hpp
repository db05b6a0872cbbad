#pragma once

#include <cstddef>
#include <string>
#include <variant>
#include <vector>

#include "scene/tree.hpp"

namespace hybrid_sphere::scene {

/// A place in a tree: keys of maps and indices of lists, from the root on.
using TreePlace = std::vector<std::variant<std::string, std::size_t>>;

/// The value at a place; null if there is none.
Tree at_place(const Tree& tree, const TreePlace& place);

/// The tree with another value at a place. Maps on the way there that are missing are made.
/// @throws std::invalid_argument  if the place leads through what is neither a map nor an item of a list
Tree with_value(const Tree& tree, const TreePlace& place, const Tree& value);

/// YAML that reads back as the same tree, if its texts are UTF-8 and its keys shorter than 1000 bytes.
/// Numbers keep every bit.
std::string to_yaml(const Tree& tree);

}  // namespace hybrid_sphere::scene

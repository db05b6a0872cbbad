#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "hybrid_sphere/scene/scene.hpp"
#include "scene/printable.hpp"
#include "scene/ranges.hpp"
#include "scene/tree.hpp"

namespace hybrid_sphere::scene {

/// A finite number within the range. Text that spells a number counts as one: the parameter server's YAML 1.1
/// takes 1e-9 (no dot) for text.
double read_number(const Tree& tree, const std::string& path, const Range& range);

/// A list of exactly `size` numbers, each within the range.
std::vector<double> read_numbers(const Tree& tree, const std::string& path, std::size_t size,
                                 const Range& range);

/// The same for a point or a vector in the plane.
Vector2d read_vector2(const Tree& tree, const std::string& path, const Range& range);

/// One of the given words.
std::string read_word(const Tree& tree, const std::string& path, const std::vector<const char*>& words);

bool read_flag(const Tree& tree, const std::string& path);

using Keys = std::vector<const char*>;  ///< literals

/// Concatenates two lists of keys.
Keys with(Keys keys, const Keys& more);

/// The keys of a map. An unknown key is refused before any other fault of the map.
class MapReader {
 public:
  /// @param known   all keys that the map may have
  /// @param beside  further allowed keys that are not in this map: listed when a key is unknown
  /// @throws SceneError  if the tree is not a map, or has an unknown or duplicate key
  MapReader(const Tree& tree, std::string path, const Keys& known, const Keys& beside = {});

  /// Ignores unknown keys, with a warning for each.
  /// @throws SceneError  if the tree is not a map, or has a duplicate key
  MapReader(const Tree& tree, std::string path, const Keys& known, std::vector<std::string>& warnings);

  /// Null if the key is missing; lives as long as the tree does.
  const Tree* find(const char* key) const;
  /// @throws SceneError  "<path>: is missing; allowed: ..."
  const Tree& require(const char* key, const std::string& allowed) const;

  /// Refuses the key if it is present: "not to give this key: <why>".
  void refuse(const char* key, const char* why) const;

  std::string path_of(std::string_view key) const {
    return path_.empty() ? printable(key) : path_ + "." + printable(key);
  }
  const std::string& path() const { return path_; }

 private:
  void refuse_unknown(const Keys& known, const Keys& beside) const;
  void refuse_repeated() const;

  Tree::MapView map_;
  std::string path_;
};

}  // namespace hybrid_sphere::scene

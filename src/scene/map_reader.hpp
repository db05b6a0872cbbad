#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "hybrid_sphere/scene/scene.hpp"
#include "scene/printable.hpp"
#include "scene/ranges.hpp"
#include "scene/tree.hpp"

namespace hybrid_sphere::scene {

/// A finite number within the range. Text that is a number counts as one: YAML 1.1 as read by the parameter
/// server takes 1e-9 (no dot) for text.
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

/// The ones, then the others.
Keys with(Keys keys, const Keys& more);

/// The keys of a map. A key that is not known is refused before anything else that is wrong with the map.
class MapReader {
 public:
  /// @param known   all keys that the map may have
  /// @param beside  more keys that are allowed, but are not in this map: named where a key is unknown
  /// @throws SceneError  when the tree is no map, has a key that is not known, or one twice
  MapReader(const Tree& tree, std::string path, const Keys& known, const Keys& beside = {});

  /// Null when the key is not there; lives as long as the tree does.
  const Tree* find(const char* key) const;
  /// @throws SceneError  "<path>: is missing; allowed: ..."
  const Tree& require(const char* key, const std::string& allowed) const;

  /// Refuses the key when it is there: "not to give this key: <why>".
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

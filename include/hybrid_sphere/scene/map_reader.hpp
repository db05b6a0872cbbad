#pragma once

#include <initializer_list>
#include <limits>
#include <string>
#include <vector>

#include "hybrid_sphere/scene/scene.hpp"
#include "hybrid_sphere/scene/tree.hpp"

namespace hybrid_sphere::scene {

/// An interval of allowed numbers and their unit.
struct Range {
  double low;
  double high;
  const char* unit;
  std::string describe() const;
};

inline constexpr Range coordinate_range{-1e15, 1e15, "[m]"};

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

/// Keys of a map, each of which must be asked for: what is left at the end is refused as unknown.
class MapReader {
 public:
  /// @throws SceneError  when the tree is no map or has a key twice
  MapReader(const Tree& tree, std::string path);

  /// Null when the key is not there. The key must outlive the reader: a literal.
  const Tree* find(const char* key);
  const Tree& require(const char* key, const std::string& allowed);

  /// Refuses the key when it is there: "not to give this key: <why>".
  void refuse(const char* key, const char* why);

  /// To be called last: refuses keys that nobody asked for.
  /// @param beside  more keys that are allowed, but are not in this map
  void refuse_unknown(const std::vector<const char*>& beside = {}) const;

  std::string path_of(const std::string& key) const {
    return path_.empty() ? printable(key) : path_ + "." + printable(key);
  }
  const std::string& path() const { return path_; }

 private:
  const Tree::Map& map_;
  std::string path_;
  std::vector<const char*> known_;
};

}  // namespace hybrid_sphere::scene

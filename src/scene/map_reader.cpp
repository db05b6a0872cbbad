#include "hybrid_sphere/scene/map_reader.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string_view>

namespace hybrid_sphere::scene {
namespace {

constexpr std::size_t most_keys = 16;  // that a map of the scene format knows

const Tree::Map& map_of(const Tree& tree, const std::string& path) {
  if (const Tree::Map* map = tree.as_map()) return *map;
  throw SceneError(path.empty() ? "scene" : path, tree.describe(), "a map of keys");
}

std::string listed(const std::vector<const char*>& words) {
  std::string list;
  for (const char* word : words) list += (list.empty() ? "" : ", ") + std::string(word);
  return list;
}

bool contains(const std::vector<const char*>& words, const std::string& word) {
  return std::any_of(words.begin(), words.end(), [&](const char* each) { return word == each; });
}

std::optional<double> number_within(const Tree& tree, const Range& range) {
  const double* value = tree.as_number();
  std::optional<double> parsed;
  if (tree.as_text() && (parsed = parse_number(*tree.as_text()))) value = &*parsed;
  if (!value || !(range.low <= *value && *value <= range.high)) return std::nullopt;
  return *value;
}

}  // namespace

std::string Range::describe() const {
  return "a number from " + Tree(low).describe() + " to " + Tree(high).describe() + (*unit ? " " : "") + unit;
}

double read_number(const Tree& tree, const std::string& path, const Range& range) {
  if (const auto number = number_within(tree, range)) return *number;
  throw SceneError(path, tree.describe(), range.describe());
}

std::vector<double> read_numbers(const Tree& tree, const std::string& path, std::size_t size,
                                 const Range& range) {
  const Tree::List* list = tree.as_list();
  if (!list || list->size() != size) {
    throw SceneError(path, tree.describe(), "a list of " + std::to_string(size) + " numbers " + range.unit);
  }
  std::vector<double> numbers(size);
  for (std::size_t i = 0; i < size; ++i) {
    const auto number = number_within((*list)[i], range);
    numbers[i] = number ? *number : read_number((*list)[i], path + "[" + std::to_string(i) + "]", range);
  }
  return numbers;
}

Vector2d read_vector2(const Tree& tree, const std::string& path, const Range& range) {
  return Vector2d(read_numbers(tree, path, 2, range).data());
}

std::string read_word(const Tree& tree, const std::string& path, const std::vector<const char*>& words) {
  const std::string* word = tree.as_text();
  if (word && contains(words, *word)) return *word;
  throw SceneError(path, tree.describe(), listed(words));
}

bool read_flag(const Tree& tree, const std::string& path) {
  if (const bool* flag = tree.as_bool()) return *flag;
  throw SceneError(path, tree.describe(), "true, false");
}

MapReader::MapReader(const Tree& tree, std::string path) : map_(map_of(tree, path)), path_(std::move(path)) {
  std::vector<std::string_view> seen;
  seen.reserve(map_.size());
  for (const auto& [key, value] : map_) seen.push_back(key);
  std::sort(seen.begin(), seen.end());
  const auto repeated = std::adjacent_find(seen.begin(), seen.end());
  if (repeated != seen.end())
    throw SceneError(path_of(std::string(*repeated)), "a second value", "each key once");
  known_.reserve(most_keys);
}

const Tree* MapReader::find(const char* key) {
  known_.push_back(key);
  const auto found =
      std::find_if(map_.begin(), map_.end(), [&](const auto& entry) { return entry.first == key; });
  return found == map_.end() ? nullptr : &found->second;
}

const Tree& MapReader::require(const char* key, const std::string& allowed) {
  if (const Tree* tree = find(key)) return *tree;
  throw SceneError(path_of(key), "nothing", allowed);
}

void MapReader::refuse(const char* key, const char* why) {
  if (const Tree* tree = find(key)) {
    throw SceneError(path_of(key), tree->describe(), std::string("not to give this key: ") + why);
  }
  known_.pop_back();
}

void MapReader::refuse_unknown(const std::vector<const char*>& beside) const {
  for (const auto& [key, value] : map_) {
    if (std::find(known_.begin(), known_.end(), key) != known_.end()) continue;
    std::vector<const char*> names = known_;
    names.insert(names.end(), beside.begin(), beside.end());
    throw SceneError(path_of(key), "an unknown key", listed(names));
  }
}

}  // namespace hybrid_sphere::scene

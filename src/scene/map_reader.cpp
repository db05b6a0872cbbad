#include "scene/map_reader.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string_view>

namespace hybrid_sphere::scene {
namespace {

Tree::MapView map_of(const Tree& tree, const std::string& path) {
  if (const auto map = tree.as_map()) return *map;
  throw SceneError(path.empty() ? "scene" : path, tree.describe(), "a map of keys");
}

std::string listed(const std::vector<const char*>& words) {
  std::string list;
  for (const char* word : words) list += (list.empty() ? "" : ", ") + std::string(word);
  return list;
}

bool contains(const std::vector<const char*>& words, std::string_view word) {
  return std::any_of(words.begin(), words.end(), [&](const char* each) { return word == each; });
}

/// Characters to put in, take out, replace or swap with the next one, to make one word of another.
/// Source: F. J. Damerau, A technique for computer detection and correction of spelling errors, 1964.
std::size_t edits(std::string_view a, std::string_view b) {
  std::vector<std::vector<std::size_t>> least(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i) {
    for (std::size_t j = 0; j <= b.size(); ++j) {
      std::size_t& here = least[i][j] = i == 0 ? j : i;
      if (i == 0 || j == 0) continue;
      here =
          std::min({least[i - 1][j] + 1, least[i][j - 1] + 1, least[i - 1][j - 1] + (a[i - 1] != b[j - 1])});
      const bool swapped = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
      if (swapped) here = std::min(here, least[i - 2][j - 2] + 1);
    }
  }
  return least[a.size()][b.size()];
}

/// The word that a mistyped one most likely stands for: at most a third of its characters are wrong.
const char* nearest(std::string_view word, const Keys& words) {
  constexpr std::size_t longest = 40;
  if (word.size() > longest) return nullptr;
  const char* best = nullptr;
  std::size_t least = std::max<std::size_t>(1, word.size() / 3) + 1;
  for (const char* each : words) {
    const std::size_t distance = edits(word, each);
    if (distance >= least) continue;
    least = distance;
    best = each;
  }
  return best;
}

/// " (did you mean friction?)", or nothing.
std::string question(std::string_view word, const Keys& words) {
  const char* meant = nearest(word, words);
  return meant == nullptr ? "" : std::string(" (did you mean ") + meant + "?)";
}

std::optional<double> number_within(const Tree& tree, const Range& range) {
  std::optional<double> value = tree.as_number();
  if (const auto text = tree.as_text()) value = parse_number(*text);
  if (!value || !range.holds(*value)) return std::nullopt;
  return value;
}

}  // namespace

std::string Range::describe() const {
  return "a number from " + Tree(low).describe() + " to " + Tree(high).describe() + (*unit ? " " : "") + unit;
}

std::string Range::describe_least() const {
  return "0, or a number of at least " + Tree(least).describe() + " in magnitude" + (*unit ? " " : "") + unit;
}

double read_number(const Tree& tree, const std::string& path, const Range& range) {
  if (const auto number = number_within(tree, range)) return *number;
  const bool is_small = number_within(tree, {range.low, range.high, range.unit, 0}).has_value();
  throw SceneError(path, tree.describe(), is_small ? range.describe_least() : range.describe());
}

std::vector<double> read_numbers(const Tree& tree, const std::string& path, std::size_t size,
                                 const Range& range) {
  const auto list = tree.as_list();
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
  const auto word = tree.as_text();
  if (word && contains(words, *word)) return std::string(*word);
  throw SceneError(path, tree.describe(), listed(words));
}

bool read_flag(const Tree& tree, const std::string& path) {
  if (const auto flag = tree.as_bool()) return *flag;
  throw SceneError(path, tree.describe(), "true, false");
}

Keys with(Keys keys, const Keys& more) {
  keys.insert(keys.end(), more.begin(), more.end());
  return keys;
}

MapReader::MapReader(const Tree& tree, std::string path, const Keys& known, const Keys& beside)
    : map_(map_of(tree, path)), path_(std::move(path)) {
  refuse_unknown(known, beside);
  refuse_repeated();
}

MapReader::MapReader(const Tree& tree, std::string path, const Keys& known,
                     std::vector<std::string>& warnings)
    : map_(map_of(tree, path)), path_(std::move(path)) {
  for (const auto& [key, value] : map_) {
    if (contains(known, key)) continue;
    warnings.push_back(path_of(key) + ": an unknown key is ignored" + question(key, known) +
                       "; known: " + listed(known));
  }
  refuse_repeated();
}

void MapReader::refuse_unknown(const Keys& known, const Keys& beside) const {
  for (const auto& [key, value] : map_) {
    if (contains(known, key)) continue;
    const Keys names = with(known, beside);
    throw SceneError::unknown(path_of(key), question(key, names), listed(names));
  }
}

void MapReader::refuse_repeated() const {
  for (std::size_t i = 1; i < map_.size(); ++i) {
    const std::string_view key = map_[i].key;
    if (map_.find(key) != &map_[i].value) throw SceneError(path_of(key), "a second value", "each key once");
  }
}

const Tree* MapReader::find(const char* key) const { return map_.find(key); }

const Tree& MapReader::require(const char* key, const std::string& allowed) const {
  if (const Tree* tree = find(key)) return *tree;
  throw SceneError::missing(path_of(key), allowed);
}

void MapReader::refuse(const char* key, const char* why) const {
  if (const Tree* tree = find(key)) {
    throw SceneError(path_of(key), tree->describe(), std::string("omitting this key: ") + why);
  }
}

}  // namespace hybrid_sphere::scene

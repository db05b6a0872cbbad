#include "scene/tree_place.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <stdexcept>

#include "text/refusal.hpp"

namespace hybrid_sphere::scene {
namespace {

using Step = TreePlace::value_type;

Tree value_at(const Tree& tree, const Step& step) {
  if (const auto* key = std::get_if<std::string>(&step)) {
    const auto map = tree.as_map();
    const Tree* value = map ? map->find(*key) : nullptr;
    return value == nullptr ? Tree() : *value;
  }
  const auto list = tree.as_list();
  const std::size_t index = std::get<std::size_t>(step);
  return list && index < list->size() ? (*list)[index] : Tree();
}

Tree with_entry(const Tree& tree, const std::string& key, const Tree& value) {
  Tree::Map entries;
  const auto map = tree.as_map();
  if (!map && !tree.is_null()) throw std::invalid_argument("no map at \"" + key + "\"");
  bool is_known = false;
  if (map) {
    for (std::size_t i = 0; i < map->size(); ++i) {
      const bool is_it = (*map)[i].key == key;
      is_known = is_known || is_it;
      entries.emplace_back(std::string((*map)[i].key), is_it ? value : (*map)[i].value);
    }
  }
  if (!is_known) entries.emplace_back(key, value);
  return entries;
}

Tree with_item(const Tree& tree, std::size_t index, const Tree& value) {
  const auto list = tree.as_list();
  if (!list || index >= list->size()) throw std::invalid_argument("no item " + std::to_string(index));
  Tree::List items;
  for (const Tree& item : *list) items.push_back(item);
  items[index] = value;
  return items;
}

Tree with_value_from(const Tree& tree, const TreePlace& place, std::size_t depth, const Tree& value) {
  if (depth == place.size()) return value;
  const Step& step = place[depth];
  const Tree inner = with_value_from(value_at(tree, step), place, depth + 1, value);
  if (const auto* key = std::get_if<std::string>(&step)) return with_entry(tree, *key, inner);
  return with_item(tree, std::get<std::size_t>(step), inner);
}

/// The character that begins at i, which is moved behind it. The text is UTF-8: RFC 3629, section 3.
char32_t next_character(std::string_view text, std::size_t& i) {
  const auto byte = [&](std::size_t k) { return static_cast<unsigned char>(text[k]); };
  const unsigned first = byte(i++);
  if (first < 0x80) return first;
  std::size_t more = first < 0xe0 ? 1 : first < 0xf0 ? 2 : 3;
  char32_t character = first & (0x3fU >> more);
  for (; more > 0 && i < text.size(); --more) character = character << 6U | (byte(i++) & 0x3fU);
  return character;
}

/// What a reader of YAML 1.1 refuses as it is, or takes for the end of a line.
bool is_to_be_escaped(char32_t c) {
  return c < 0x20 || (c >= 0x7f && c < 0xa0) || c == 0x2028 || c == 0x2029 || c == 0xfeff || c == 0xfffe ||
         c == 0xffff;
}

/// In double quotes, whatever is in it.
std::string quoted(std::string_view text) {
  std::string result = "\"";
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t begin = i;
    const char32_t c = next_character(text, i);
    if (is_to_be_escaped(c)) {
      std::array<char, 8> escaped{};
      std::snprintf(escaped.data(), escaped.size(), c < 0x100 ? "\\x%02x" : "\\u%04x",
                    static_cast<unsigned>(c));
      result += escaped.data();
    } else {
      if (c == '"' || c == '\\') result += '\\';
      result += text.substr(begin, i - begin);
    }
  }
  return result + '"';
}

std::string written(double number) {
  if (std::isnan(number)) return ".nan";
  if (std::isinf(number)) return number > 0 ? ".inf" : "-.inf";
  return text::shortest(number);
}

bool is_simple(const Tree& tree) { return !tree.as_list() && !tree.as_map(); }

std::string scalar(const Tree& tree) {
  if (const auto text = tree.as_text()) return quoted(*text);
  if (const auto number = tree.as_number()) return written(*number);
  if (const auto flag = tree.as_bool()) return *flag ? "true" : "false";
  return "null";
}

/// On one line: lists of numbers, and what is empty.
bool is_short(const Tree& tree) {
  if (const auto list = tree.as_list()) {
    for (const Tree& item : *list) {
      if (!is_simple(item)) return false;
    }
    return true;
  }
  const auto map = tree.as_map();
  return !map || map->size() == 0;
}

std::string on_one_line(const Tree& tree) {
  if (tree.as_map()) return "{}";
  const auto list = tree.as_list();
  if (!list) return scalar(tree);
  std::string line = "[";
  for (const Tree& item : *list) line += (line.size() > 1 ? ", " : "") + scalar(item);
  return line + "]";
}

// A list in a list is a block that begins on the line of its dash.
void write(const Tree& tree, const std::string& indent, std::string& yaml) {
  if (const auto map = tree.as_map()) {
    for (std::size_t i = 0; i < map->size(); ++i) {
      const Tree& value = (*map)[i].value;
      if (i > 0) yaml += indent;
      yaml += quoted((*map)[i].key) + ":";
      if (is_short(value)) {
        yaml += " " + on_one_line(value) + "\n";
      } else {
        yaml += "\n" + indent + "  ";
        write(value, indent + "  ", yaml);
      }
    }
    return;
  }
  const auto list = tree.as_list();
  bool is_first = true;
  for (const Tree& item : *list) {
    if (!is_first) yaml += indent;
    is_first = false;
    yaml += "- ";
    if (is_short(item)) {
      yaml += on_one_line(item) + "\n";
    } else {
      write(item, indent + "  ", yaml);
    }
  }
}

}  // namespace

Tree at_place(const Tree& tree, const TreePlace& place) {
  Tree value = tree;
  for (const Step& step : place) value = value_at(value, step);
  return value;
}

Tree with_value(const Tree& tree, const TreePlace& place, const Tree& value) {
  return with_value_from(tree, place, 0, value);
}

std::string to_yaml(const Tree& tree) {
  if (is_short(tree)) return on_one_line(tree) + "\n";
  std::string yaml;
  write(tree, "", yaml);
  return yaml;
}

}  // namespace hybrid_sphere::scene

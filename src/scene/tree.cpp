#include "hybrid_sphere/scene/tree.hpp"

#include <cmath>
#include <cstdio>

namespace hybrid_sphere::scene {
namespace {

constexpr std::size_t longest_text = 60;

std::string shortest(double number) {
  if (std::isnan(number)) return "nan";  // whatever its sign bit
  char buffer[40];
  for (int digits : {6, 15, 17}) {
    std::snprintf(buffer, sizeof buffer, "%.*g", digits, number);
    if (std::strtod(buffer, nullptr) == number) break;
  }
  return buffer;
}

std::string printable(const std::string& text) {
  std::string shown;
  for (const char c : text.substr(0, longest_text)) {
    const auto byte = static_cast<unsigned char>(c);
    shown += byte < 0x20 || byte == 0x7f ? '?' : c;
  }
  return '"' + shown + (text.size() > longest_text ? "...\"" : "\"");
}

std::string describe_list(const Tree::List& list) {
  std::string shown = "[";
  for (const Tree& item : list) {
    if (item.as_list() || item.as_map() || shown.size() > longest_text) {
      return "a list of " + std::to_string(list.size());
    }
    shown += (shown.size() > 1 ? ", " : "") + item.describe();
  }
  return shown + "]";
}

}  // namespace

std::string Tree::describe() const {
  if (const auto* value = as_bool()) return *value ? "true" : "false";
  if (const auto* value = as_number()) return shortest(*value);
  if (const auto* value = as_text()) return printable(*value);
  if (const auto* value = as_list()) return describe_list(*value);
  if (const auto* value = as_map()) return "a map with " + std::to_string(value->size()) + " keys";
  return "nothing";
}

SceneError::SceneError(const std::string& path, const std::string& value, const std::string& allowed)
    : std::runtime_error(path + ": " + value + " is refused; allowed: " + allowed) {}

}  // namespace hybrid_sphere::scene

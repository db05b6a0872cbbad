#include "hybrid_sphere/scene/tree.hpp"

#include <cmath>
#include <cstdio>
#include <cstdlib>

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

std::optional<double> parse_number(const std::string& text) {
  if (text.empty() || text.find_first_not_of("0123456789+-.eE") != std::string::npos) return std::nullopt;
  const std::string digits = text.substr(text.find_first_not_of("+-") == 1 ? 1 : 0);
  const bool is_whole = digits.find_first_not_of("0123456789") == std::string::npos;
  if (is_whole && digits.size() > 1 && digits.front() == '0') return std::nullopt;
  char* end = nullptr;
  const double number = std::strtod(text.c_str(), &end);
  if (end != text.c_str() + text.size()) return std::nullopt;
  return number;
}

std::string printable(const std::string& text) {
  std::string shown;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    const bool begins_character = (byte & 0xc0) != 0x80;  // of UTF-8
    if (shown.size() >= longest_text && begins_character) return shown + "...";
    shown += byte < 0x20 || byte == 0x7f ? '?' : c;
  }
  return shown;
}

std::string Tree::describe() const {
  if (const auto* value = as_bool()) return *value ? "true" : "false";
  if (const auto* value = as_number()) return shortest(*value);
  if (const auto* value = as_text()) return '"' + printable(*value) + '"';
  if (const auto* value = as_list()) return describe_list(*value);
  if (const auto* value = as_map()) return "a map with " + std::to_string(value->size()) + " keys";
  return "nothing";
}

SceneError::SceneError(const std::string& path, const std::string& value, const std::string& allowed)
    : std::runtime_error(path + ": " + value + " is refused; allowed: " + allowed) {}

}  // namespace hybrid_sphere::scene

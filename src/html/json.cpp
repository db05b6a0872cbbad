#include "html/json.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "scene/printable.hpp"
#include "text/refusal.hpp"

namespace hybrid_sphere::html {
namespace {

std::string base64(const std::vector<std::uint8_t>& bytes) {
  constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k) group = group << 8U | (i + k < bytes.size() ? bytes[i + k] : 0U);
    for (std::size_t k = 0; k < 4; ++k) {
      const bool padding = i + k > bytes.size();
      text += padding ? '=' : digits[group >> (18U - 6U * static_cast<unsigned>(k)) & 63U];
    }
  }
  return text;
}

template <class Bits, class Value>
std::string packed_as(const std::vector<Value>& values) {
  static_assert(sizeof(Bits) == sizeof(Value));
  std::vector<std::uint8_t> bytes;
  bytes.reserve(values.size() * sizeof(Value));
  for (const Value value : values) {
    Bits bits{};
    std::memcpy(&bits, &value, sizeof value);
    for (std::size_t k = 0; k < sizeof bits; ++k) bytes.push_back(static_cast<std::uint8_t>(bits >> 8U * k));
  }
  return '"' + base64(bytes) + '"';
}

/// U+001f as in \u001f.
std::string code_unit(unsigned char c) {
  constexpr std::string_view digits = "0123456789abcdef";
  return std::string("\\u00") + digits[c >> 4U] + digits[c & 15U];
}

}  // namespace

std::string quoted(std::string_view text) {
  std::string result = "\"";
  for (const char c : scene::escaped(text)) {
    const bool plain = static_cast<unsigned char>(c) >= ' ' && std::strchr("\"\\<>&", c) == nullptr;
    result += plain ? std::string(1, c) : code_unit(static_cast<unsigned char>(c));
  }
  return result + '"';
}

std::string number(double value) { return std::isfinite(value) ? text::shortest(value) : "null"; }

std::string html_text(std::string_view text) {
  std::string result;
  for (const char c : scene::escaped(text)) {
    const bool plain = static_cast<unsigned char>(c) >= ' ' && std::strchr("\"'<>&", c) == nullptr;
    result += plain ? std::string(1, c) : "&#" + std::to_string(static_cast<unsigned char>(c)) + ';';
  }
  return result;
}

std::string packed(const std::vector<std::uint8_t>& values) { return '"' + base64(values) + '"'; }
std::string packed(const std::vector<std::uint16_t>& values) { return packed_as<std::uint16_t>(values); }
std::string packed(const std::vector<std::uint32_t>& values) { return packed_as<std::uint32_t>(values); }
std::string packed(const std::vector<double>& values) { return packed_as<std::uint64_t>(values); }

std::string packed_floats(const std::vector<double>& values) {
  double largest = 0;
  for (const double value : values) {
    if (std::isfinite(value)) largest = std::max(largest, std::abs(value));
  }
  const double scale = largest > 0 ? std::exp2(std::clamp(std::ilogb(largest), -1000, 1000)) : 1;
  std::vector<float> floats;
  floats.reserve(values.size());
  for (const double value : values) {
    floats.push_back(std::isfinite(value) ? static_cast<float>(value / scale) : 0);
  }
  return "{\"scale\":" + number(scale) + ",\"data\":" + packed_as<std::uint32_t>(floats) + '}';
}

std::string packed_fractions(const std::vector<double>& values) {
  std::vector<std::uint16_t> steps;
  steps.reserve(values.size());
  for (const double value : values) {
    const double finite = std::isfinite(value) ? std::clamp(value, -1.0, 1.0) : 0;
    steps.push_back(static_cast<std::uint16_t>(static_cast<std::int16_t>(std::lround(32767 * finite))));
  }
  return packed(steps);
}

}  // namespace hybrid_sphere::html

#pragma once

#include <yaml-cpp/yaml.h>

#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

namespace hybrid_sphere::testing {

/// The bytes of a text in base64.
inline std::vector<std::uint8_t> bytes_of(const std::string& text) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::vector<std::uint8_t> bytes;
  std::uint32_t bits = 0;
  unsigned count = 0;
  for (const char c : text) {
    if (c == '=') break;
    bits = bits << 6U | static_cast<std::uint32_t>(digits.find(c));
    count += 6;
    if (count < 8) continue;
    count -= 8;
    bytes.push_back(static_cast<std::uint8_t>(bits >> count));
  }
  return bytes;
}

/// Numbers in base64, on a little-endian machine.
template <class Number>
std::vector<Number> numbers_of(const std::string& text) {
  const std::vector<std::uint8_t> bytes = bytes_of(text);
  std::vector<Number> numbers(bytes.size() / sizeof(Number));
  if (!numbers.empty()) std::memcpy(numbers.data(), bytes.data(), numbers.size() * sizeof(Number));
  return numbers;
}

/// {"scale": ..., "data": ...}
inline std::vector<double> floats_of(const YAML::Node& packed) {
  std::vector<double> values;
  for (const float value : numbers_of<float>(packed["data"].as<std::string>())) {
    values.push_back(packed["scale"].as<double>() * static_cast<double>(value));
  }
  return values;
}

/// The data of a page as its scripts read them: JSON, which is YAML.
inline YAML::Node data_of(const std::string& page) {
  const std::string begin = "<script type=\"application/json\" id=\"data\">";
  const std::size_t at = page.find(begin) + begin.size();
  return YAML::Load(page.substr(at, page.find("</script>", at) - at));
}

}  // namespace hybrid_sphere::testing

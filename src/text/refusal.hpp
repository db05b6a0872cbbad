#pragma once

#include <array>
#include <charconv>
#include <cmath>
#include <string>

/// How numbers and refusals are worded.
namespace hybrid_sphere::text {

/// A number with as many digits as read back as the same number, 6 or 15 to 17.
inline std::string shortest(double number) {
  if (std::isnan(number)) return "nan";  // whatever its sign bit
  std::array<char, 40> text{};
  char* const begin = text.data();
  char* end = begin;
  for (const int digits : {6, 15, 16, 17}) {
    end = std::to_chars(begin, begin + text.size(), number, std::chars_format::general, digits).ptr;
    double back = 0;
    std::from_chars(begin, end, back);
    if (back == number) break;
  }
  return {begin, end};
}

/// "<what> is refused; allowed: <allowed>"
/// @param what  the name and the value
inline std::string refusal(const std::string& what, const std::string& allowed) {
  return what + " is refused; allowed: " + allowed;
}

}  // namespace hybrid_sphere::text

#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

/// The data of a page as JSON that may stand in a script element, whatever users have called their regions.
namespace hybrid_sphere::html {

/// A string with its quotes: no <, > or &, and UTF-8 whatever the bytes are.
std::string quoted(std::string_view text);

/// A number that reads back as the same one; null where it is not finite.
std::string number(double value);

/// Text in HTML, also in an attribute.
std::string html_text(std::string_view text);

/// Arrays as strings in base64, little-endian.
std::string packed(const std::vector<std::uint8_t>& values);
std::string packed(const std::vector<std::uint16_t>& values);
std::string packed(const std::vector<std::uint32_t>& values);
std::string packed(const std::vector<double>& values);

/// The same as binary32, {"scale": ..., "data": ...}: multiples of a power of two near the largest of them,
/// so that any magnitude has its place. What is not finite is 0.
std::string packed_floats(const std::vector<double>& values);

/// Of numbers from -1 to 1, in steps of 1/32767.
std::string packed_fractions(const std::vector<double>& values);

}  // namespace hybrid_sphere::html

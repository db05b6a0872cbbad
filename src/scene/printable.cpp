#include "scene/printable.hpp"

#include <cstdio>

namespace hybrid_sphere::scene {
namespace {

constexpr std::size_t longest_text = 60;

unsigned byte_at(std::string_view text, std::size_t i) {
  return i < text.size() ? static_cast<unsigned char>(text[i]) : 0U;
}

/// Bytes of the character that begins at i; 0: it is no UTF-8. RFC 3629, section 4.
std::size_t character(std::string_view text, std::size_t i) {
  const unsigned first = byte_at(text, i);
  if (first < 0x80) return 1;
  if (first < 0xc2 || first > 0xf4) return 0;
  const std::size_t size = first < 0xe0 ? 2 : first < 0xf0 ? 3 : 4;
  const unsigned second = byte_at(text, i + 1);
  const unsigned low = first == 0xe0 ? 0xa0 : first == 0xf0 ? 0x90 : 0x80;
  const unsigned high = first == 0xed ? 0x9f : first == 0xf4 ? 0x8f : 0xbf;
  if (second < low || second > high) return 0;
  for (std::size_t k = 2; k < size; ++k) {
    if ((byte_at(text, i + k) & 0xc0U) != 0x80) return 0;
  }
  return size;
}

/// U+0000 to U+001F, U+007F to U+009F, and what ends a line or turns its direction: U+2028 to U+202E, U+2066
/// to U+2069.
bool is_control(std::string_view character) {
  const unsigned first = byte_at(character, 0), second = byte_at(character, 1), third = byte_at(character, 2);
  if (first < 0x20 || first == 0x7f) return true;
  if (first == 0xc2) return second < 0xa0;
  return first == 0xe2 && ((second == 0x80 && third >= 0xa8 && third <= 0xae) ||
                           (second == 0x81 && third >= 0xa6 && third <= 0xa9));
}

std::string shown(std::string_view text, std::size_t longest) {
  std::string shown;
  for (std::size_t i = 0; i < text.size();) {
    if (shown.size() >= longest) return shown + "...";
    const std::size_t size = character(text, i);
    if (size == 0) {
      char hex[5];
      std::snprintf(hex, sizeof hex, "\\x%02x", byte_at(text, i));
      shown += hex;
    } else {
      const std::string_view bytes = text.substr(i, size);
      shown += is_control(bytes) ? "?" : bytes;
    }
    i += size == 0 ? 1 : size;
  }
  return shown;
}

}  // namespace

bool is_utf8(std::string_view text) {
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t size = character(text, i);
    if (size == 0) return false;
    i += size;
  }
  return true;
}

std::string escaped(std::string_view text) { return shown(text, std::string_view::npos); }

std::string printable(std::string_view text) { return shown(text, longest_text); }

}  // namespace hybrid_sphere::scene

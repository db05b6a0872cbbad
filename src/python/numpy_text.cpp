#include "python/numpy_text.hpp"

#include <algorithm>
#include <cstring>

namespace hybrid_sphere::python {

std::u32string numpy_text(std::string_view text) {
  std::u32string result;
  for (std::size_t i = 0; i < text.size();) {
    const auto first = static_cast<unsigned char>(text[i]);
    const std::size_t more = first < 0x80 ? 0 : first < 0xe0 ? 1 : first < 0xf0 ? 2 : 3;
    char32_t character = more == 0 ? first : first & (0x3fU >> more);
    for (std::size_t k = 1; k <= more && i + k < text.size(); ++k) {
      character = (character << 6U) | (static_cast<unsigned char>(text[i + k]) & 0x3fU);
    }
    result += character;
    i += more + 1;
  }
  return result;
}

void put_text(std::u32string_view text, std::size_t width, char* item) {
  const std::size_t size = std::min(text.size(), width) * sizeof(char32_t);
  std::memcpy(item, text.data(), size);
  std::memset(item + size, 0, width * sizeof(char32_t) - size);
}

}  // namespace hybrid_sphere::python

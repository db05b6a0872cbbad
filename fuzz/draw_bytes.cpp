#include "draw_bytes.hpp"

#include <cstring>

#include "support/random_scenes.hpp"

namespace hybrid_sphere::fuzz {
namespace {

const std::uint8_t* next = nullptr;
const std::uint8_t* end = nullptr;

std::uint64_t draw(int bytes) {
  std::uint64_t value = 0;
  for (int i = 0; i < bytes; ++i) value = value << 8U | (next < end ? *next++ : 0U);
  return value;
}

}  // namespace

void draw_from(const std::uint8_t* bytes, std::size_t size) {
  next = bytes;
  end = bytes + size;
}

double draw_double() {
  if (draw(1) % 4 != 0) return testing::integer(-4096, 4096) / 64.0;
  const std::uint64_t bits = draw(8);
  double value = 0;
  std::memcpy(&value, &bits, sizeof value);
  return value;
}

}  // namespace hybrid_sphere::fuzz

namespace hybrid_sphere::testing {

int integer(int low, int high) {
  const auto range = static_cast<std::uint64_t>(high - low) + 1;
  return low + static_cast<int>(fuzz::draw(range <= 256 ? 1 : range <= 65536 ? 2 : 4) % range);
}

}  // namespace hybrid_sphere::testing

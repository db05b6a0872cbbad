#include "draw_seeded.hpp"

#include "support/random_scenes.hpp"

namespace hybrid_sphere::fuzz {
namespace {

std::uint64_t state = 0;

// SplitMix64: Steele, Lea, Flood, Fast splittable pseudorandom number generators, OOPSLA 2014.
std::uint64_t next() {
  std::uint64_t z = state += 0x9e3779b97f4a7c15U;
  z = (z ^ (z >> 30U)) * 0xbf58476d1ce4e5b9U;
  z = (z ^ (z >> 27U)) * 0x94d049bb133111ebU;
  return z ^ (z >> 31U);
}

}  // namespace

void begin_draws(std::uint64_t seed, std::uint64_t number) {
  state = seed;
  state = next() ^ number;
  next();
}

}  // namespace hybrid_sphere::fuzz

namespace hybrid_sphere::testing {

int integer(int low, int high) {
  return low + static_cast<int>(fuzz::next() % static_cast<std::uint64_t>(high - low + 1));
}

}  // namespace hybrid_sphere::testing

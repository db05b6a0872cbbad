#include "study/permutation.hpp"

#include <cmath>

namespace hybrid_sphere::study {
namespace {

std::uint64_t root_above(std::uint64_t number) {
  auto root = static_cast<std::uint64_t>(std::sqrt(static_cast<double>(number)));
  while (root * root < number) ++root;
  return root;
}

/// A pseudo-random number below `size`, which is at most 2^32. The multipliers are those of D. Stafford's
/// mixer 13.
std::uint64_t scrambled(std::uint64_t number, std::uint64_t key, std::uint64_t size) {
  std::uint64_t word = (number ^ key) * 0xbf58476d1ce4e5b9;
  word = (word ^ (word >> 32)) * 0x94d049bb133111eb;
  return ((word >> 32) * size) >> 32;
}

std::uint64_t added(std::uint64_t a, std::uint64_t b, std::uint64_t size) {
  const std::uint64_t sum = a + b;
  return sum < size ? sum : sum - size;
}

}  // namespace

Permutation::Permutation(std::uint64_t size, const Stream& stream, std::uint64_t part)
    : size_(size), columns_(root_above(size)), rows_((size + columns_ - 1) / columns_) {
  for (std::size_t i = 0; i < rounds; ++i) {
    keys_[i] = stream.words(i / 4, part, Purpose::permutation)[i % 4];
  }
}

std::uint64_t Permutation::operator()(std::uint64_t index) const {
  do {
    std::uint64_t row = index / columns_;
    std::uint64_t column = index % columns_;
    for (std::size_t i = 0; i < rounds; i += 2) {
      row = added(row, scrambled(column, keys_[i], rows_), rows_);
      column = added(column, scrambled(row, keys_[i + 1], columns_), columns_);
    }
    index = row * columns_ + column;
  } while (index >= size_);
  return index;
}

}  // namespace hybrid_sphere::study

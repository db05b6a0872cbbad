#include "study/sampler.hpp"

#include <algorithm>
#include <boost/random/sobol.hpp>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace hybrid_sphere::study {
namespace {

constexpr double below_one = 1 - 0x1p-53;
constexpr unsigned index_bits = 64;

/// What the bits of a Gray code are to be exchanged by in the components of a point of Sobol's sequence:
/// Boost's engine, which leaves out the origin, is at the code of n + 1 after seed(n).
std::vector<std::uint64_t> sobol_directions(std::size_t dimensions) {
  boost::random::sobol engine(dimensions);
  std::vector<std::uint64_t> directions(index_bits * dimensions);
  auto next = directions.begin();
  for (unsigned bit = 0; bit < index_bits; ++bit) {
    const std::uint64_t ones =
        ~std::uint64_t{0} >> (index_bits - 1 - bit);  // its Gray code is this bit alone
    engine.seed(ones - 1);
    for (std::size_t i = 0; i < dimensions; ++i) *next++ = engine();
  }
  return directions;
}

/// Bits that the numbers below `count` have at most.
unsigned bits_below(std::uint64_t count) {
  unsigned bits = 0;
  while (bits < index_bits && (count - 1) >> bits != 0) ++bits;
  return bits;
}

/// The least bit of a number other than 0.
unsigned least_bit(std::uint64_t number) { return static_cast<unsigned>(__builtin_ctzll(number)); }

}  // namespace

Sampler::Sampler(Design design)
    : design_(std::move(design)),
      group_size_(design_.saltelli ? design_.variables.size() + 2 : 1),
      groups_((design_.runs + group_size_ - 1) / group_size_) {
  const std::size_t parts = design_.saltelli ? 2 : 1;
  for (std::size_t part = 0; part < parts; ++part) {
    for (const std::string& variable : design_.variables) {
      const Stream stream{design_.seed, fnv1a(variable)};
      components_.push_back({stream, part});
      if (design_.sampling == Sampling::latin_hypercube) strata_.emplace_back(groups_, stream, part);
      if (design_.sampling == Sampling::sobol) shifts_.push_back(stream.word(0, part, Purpose::shift));
    }
  }
  if (design_.sampling == Sampling::sobol) directions_ = sobol_directions(components_.size());
}

void Sampler::points(std::uint64_t first, std::uint64_t count, double* out) const {
  if (first > design_.runs || count > design_.runs - first) {
    throw std::out_of_range("points beyond the " + std::to_string(design_.runs) + " runs of the study");
  }
  if (count == 0) return;
  if (design_.saltelli) {
    fill_groups(first, count, out);
  } else {
    fill(first, count, out);
  }
}

/// All components of the points `first` .. first + count - 1, which are runs, or groups of runs.
void Sampler::fill(std::uint64_t first, std::uint64_t count, double* out) const {
  switch (design_.sampling) {
    case Sampling::random: return fill_random(first, count, out);
    case Sampling::latin_hypercube: return fill_latin_hypercube(first, count, out);
    case Sampling::sobol: return fill_sobol(first, count, out);
    case Sampling::grid: return fill_grid(first, count, out);
  }
}

void Sampler::fill_random(std::uint64_t first, std::uint64_t count, double* out) const {
  for (std::uint64_t i = first; i - first < count; ++i) {
    for (const Component& component : components_) {
      *out++ = in_unit_interval(component.stream.word(i, component.part, Purpose::place));
    }
  }
}

void Sampler::fill_latin_hypercube(std::uint64_t first, std::uint64_t count, double* out) const {
  // The place in the stratum has only as many bits as the sum with its number has room for: no rounding leads
  // into the next one.
  const unsigned taken = std::min(bits_below(groups_), 52U);
  const double unit = std::ldexp(1, static_cast<int>(taken) - 52);
  for (std::uint64_t i = first; i - first < count; ++i) {
    for (std::size_t j = 0; j < components_.size(); ++j) {
      const std::uint64_t word = components_[j].stream.word(i, components_[j].part, Purpose::place);
      const double place = (static_cast<double>(word >> 12 >> taken) + 0.5) * unit;
      const double sum = static_cast<double>(strata_[j](i)) + place;
      *out++ = std::min(sum / static_cast<double>(groups_), below_one);
    }
  }
}

void Sampler::fill_sobol(std::uint64_t first, std::uint64_t count, double* out) const {
  const std::size_t dimensions = components_.size();
  std::vector<std::uint64_t> point = shifts_;
  const auto exchange = [&](unsigned bit) {
    const std::uint64_t* direction = directions_.data() + bit * dimensions;
    for (std::size_t j = 0; j < dimensions; ++j) point[j] ^= direction[j];
  };
  for (std::uint64_t code = first ^ (first >> 1); code != 0; code &= code - 1) exchange(least_bit(code));
  for (std::uint64_t i = 0; i < count; ++i) {
    for (std::size_t j = 0; j < dimensions; ++j) *out++ = in_unit_interval(point[j]);
    exchange(least_bit(first + i + 1));
  }
}

void Sampler::fill_grid(std::uint64_t first, std::uint64_t count, double* out) const {
  const std::vector<std::uint64_t>& levels = design_.levels;
  std::vector<std::uint64_t> digits(levels.size());
  for (std::size_t j = levels.size(); j-- > 0; first /= levels[j]) digits[j] = first % levels[j];
  for (std::uint64_t i = 0; i < count; ++i) {
    for (std::size_t j = 0; j < levels.size(); ++j) {
      const double place = (static_cast<double>(digits[j]) + 0.5) / static_cast<double>(levels[j]);
      *out++ = std::min(place, below_one);
    }
    for (std::size_t j = levels.size(); j-- > 0;) {
      if (++digits[j] < levels[j]) break;
      digits[j] = 0;
    }
  }
}

void Sampler::fill_groups(std::uint64_t first, std::uint64_t count, double* out) const {
  constexpr std::uint64_t most_groups = 64;  // at a time
  const std::size_t variables = design_.variables.size();
  std::uint64_t member = first % group_size_;
  std::uint64_t group = first / group_size_;
  const std::uint64_t groups = (member + count + group_size_ - 1) / group_size_;
  std::vector<double> both(std::min(groups, most_groups) * 2 * variables);
  while (count > 0) {
    const std::uint64_t here = std::min((member + count + group_size_ - 1) / group_size_, most_groups);
    fill(group, here, both.data());
    group += here;
    for (const double* a = both.data(); a != both.data() + here * 2 * variables; a += 2 * variables) {
      const double* b = a + variables;
      for (; member < group_size_ && count > 0; ++member, --count, out += variables) {
        std::copy_n(member == 1 ? b : a, variables, out);
        if (member > 1) out[member - 2] = b[member - 2];
      }
      member = 0;
    }
  }
}

}  // namespace hybrid_sphere::study

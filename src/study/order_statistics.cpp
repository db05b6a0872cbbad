#include "study/order_statistics.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

namespace hybrid_sphere::study {
namespace {

/// The bits of a double, in the order of the doubles.
using Key = std::uint64_t;
constexpr Key sign = Key{1} << 63U;

constexpr unsigned key_bits = 64;
constexpr unsigned digit_bits = 16;
constexpr std::size_t digit_values = std::size_t{1} << digit_bits;

Key key_of(double x) {
  Key bits = 0;
  std::memcpy(&bits, &x, sizeof bits);
  return (bits & sign) != 0 ? ~bits : bits | sign;
}

double number_of(Key key) {
  const Key bits = (key & sign) != 0 ? key ^ sign : ~key;
  double x = 0;
  std::memcpy(&x, &bits, sizeof x);
  return x;
}

template <typename Take>
void for_each_key(const Blocks& values, Take take) {
  values([&](const double* block, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) {
      if (std::isfinite(block[i])) take(key_of(block[i]));
    }
  });
}

/// The keys that begin with the same bits.
struct Branch {
  Key prefix;
  std::uint64_t before;  ///< how many keys are less
  std::uint64_t size;
  std::vector<std::uint64_t>
      ranks;  ///< wanted ones that lie here, from 0 for the least of all keys; ascending
};

/// Branches of the same number of leading bits, ascending.
class Branches {
 public:
  Branches(std::uint64_t count, std::vector<std::uint64_t> ranks) {
    branches_.push_back({0, 0, count, std::move(ranks)});
  }

  bool complete() const { return bits_ == key_bits; }

  std::uint64_t size() const {
    std::uint64_t sum = 0;
    for (const Branch& branch : branches_) sum += branch.size;
    return sum;
  }

  /// Follows the wanted ranks through the next digit of the keys.
  void split(const Blocks& values) {
    std::vector<std::vector<std::uint64_t>> counts(branches_.size(),
                                                   std::vector<std::uint64_t>(digit_values));
    const unsigned shift = key_bits - digit_bits - bits_;
    for_each_member(values, [&](std::size_t i, Key key) { ++counts[i][(key >> shift) % digit_values]; });
    std::vector<Branch> next;
    for (std::size_t i = 0; i < branches_.size(); ++i) append_children(branches_[i], counts[i], next);
    branches_ = std::move(next);
    bits_ += digit_bits;
  }

  /// The numbers of the wanted ranks, ascending.
  std::vector<double> numbers(const Blocks& values) const;

 private:
  /// Hands over the index of its branch with each key that lies in one.
  template <typename Take>
  void for_each_member(const Blocks& values, Take take) const {
    if (bits_ == 0) {
      for_each_key(values, [&](Key key) { take(0, key); });
      return;
    }
    std::vector<Key> prefixes;
    for (const Branch& branch : branches_) prefixes.push_back(branch.prefix);
    const unsigned shift = key_bits - bits_;
    for_each_key(values, [&](Key key) {
      const Key prefix = key >> shift;
      const auto place = std::lower_bound(prefixes.begin(), prefixes.end(), prefix);
      if (place != prefixes.end() && *place == prefix) {
        take(static_cast<std::size_t>(place - prefixes.begin()), key);
      }
    });
  }

  static void append_children(const Branch& branch, const std::vector<std::uint64_t>& counts,
                              std::vector<Branch>& children) {
    std::uint64_t before = branch.before;
    auto rank = branch.ranks.begin();
    for (std::size_t digit = 0; digit < digit_values && rank != branch.ranks.end(); ++digit) {
      const auto past = std::lower_bound(rank, branch.ranks.end(), before + counts[digit]);
      if (past != rank) {
        children.push_back({(branch.prefix << digit_bits) + digit, before, counts[digit], {rank, past}});
      }
      rank = past;
      before += counts[digit];
    }
  }

  std::vector<Branch> branches_;
  unsigned bits_ = 0;
};

using Ranks = std::vector<std::uint64_t>::const_iterator;

/// Puts the keys of some ranks where they would be if all keys were sorted.
/// @param offset  the rank that the key at `begin` would have
void select(std::vector<Key>::iterator begin, std::vector<Key>::iterator end, std::uint64_t offset,
            Ranks first_rank, Ranks last_rank) {
  while (first_rank != last_rank) {
    const Ranks middle = first_rank + (last_rank - first_rank) / 2;
    const auto place = begin + static_cast<std::ptrdiff_t>(*middle - offset);
    std::nth_element(begin, place, end);
    select(begin, place, offset, first_rank, middle);
    begin = place + 1;
    offset = *middle + 1;
    first_rank = middle + 1;
  }
}

std::vector<double> Branches::numbers(const Blocks& values) const {
  std::vector<double> numbers;
  if (complete()) {
    for (const Branch& branch : branches_) {
      numbers.insert(numbers.end(), branch.ranks.size(), number_of(branch.prefix));
    }
    return numbers;
  }
  std::vector<std::vector<Key>> keys(branches_.size());
  for (std::size_t i = 0; i < keys.size(); ++i) keys[i].reserve(branches_[i].size);
  for_each_member(values, [&](std::size_t i, Key key) { keys[i].push_back(key); });
  for (std::size_t i = 0; i < keys.size(); ++i) {
    const Branch& branch = branches_[i];
    select(keys[i].begin(), keys[i].end(), branch.before, branch.ranks.begin(), branch.ranks.end());
    for (const std::uint64_t rank : branch.ranks) numbers.push_back(number_of(keys[i][rank - branch.before]));
  }
  return numbers;
}

/// A place between the order statistics of the ranks `rank` and `next`.
struct Place {
  std::uint64_t rank;
  std::uint64_t next;
  double share;  ///< of the way to the next one, from 0 to below 1
};

Place place_of(double probability, std::uint64_t count) {
  const double place = probability * static_cast<double>(count - 1);
  const auto rank = std::min(static_cast<std::uint64_t>(place), count - 1);
  return {rank, std::min(rank + 1, count - 1), place - std::floor(place)};
}

/// Not outside of them, and 0.0 for -0.0.
/// @param low    not above high
/// @param share  below 1
double between(double low, double high, double share) {
  const double way = high - low;
  // Halves only where they are needed: half the least double is 0.
  return std::isfinite(way) ? low + share * way : 2 * (low / 2 + share * (high / 2 - low / 2));
}

}  // namespace

std::vector<double> quantiles(const Blocks& values, std::uint64_t count,
                              const std::vector<double>& probabilities, std::size_t memory) {
  if (count == 0 || probabilities.empty()) return {};
  std::vector<std::uint64_t> ranks;
  for (const double probability : probabilities) {
    const Place place = place_of(probability, count);
    ranks.insert(ranks.end(), {place.rank, place.next});
  }
  std::sort(ranks.begin(), ranks.end());
  ranks.erase(std::unique(ranks.begin(), ranks.end()), ranks.end());

  Branches branches(count, ranks);
  while (!branches.complete() && branches.size() > memory / sizeof(Key)) branches.split(values);
  const std::vector<double> numbers = branches.numbers(values);

  const auto number = [&](std::uint64_t rank) {
    return numbers[static_cast<std::size_t>(std::lower_bound(ranks.begin(), ranks.end(), rank) -
                                            ranks.begin())];
  };
  std::vector<double> result;
  for (const double probability : probabilities) {
    const Place place = place_of(probability, count);
    result.push_back(between(number(place.rank), number(place.next), place.share));
  }
  return result;
}

}  // namespace hybrid_sphere::study

#include "study/sobol_indices.hpp"

#include <Random123/philox.h>

#include <algorithm>
#include <cmath>

#include "study/moments.hpp"
#include "study/order_statistics.hpp"

namespace hybrid_sphere::study {
namespace {

constexpr std::uint64_t greatest_parts = 1000;
constexpr std::uint32_t resamples = 1000;

using Group = std::vector<double>;  ///< f(A), f(B), f(AB_1) .. f(AB_d)

bool is_complete(const Group& group) {
  return std::all_of(group.begin(), group.end(), [](double value) { return std::isfinite(value); });
}

/// Hands over each whole group, however the blocks cut them.
template <typename Take>
void for_each_group(const Blocks& output, std::size_t variables, Take take) {
  Group group(variables + 2);
  std::size_t filled = 0;
  output([&](const double* values, std::size_t count) {
    while (count > 0) {
      const std::size_t taken = std::min(count, group.size() - filled);
      std::copy_n(values, taken, group.data() + filled);
      values += taken;
      count -= taken;
      filled += taken;
      if (filled < group.size()) return;
      take(group);
      filled = 0;
    }
  });
}

/// Of each variable the first index, then of each the total one.
using Estimates = std::vector<double>;

/// The sums over groups that the indices follow from.
class Sums {
 public:
  explicit Sums(std::size_t variables) : products_(2 * variables) {}

  double groups() const { return groups_; }

  /// @param group  less the mean: without it the first indices would be differences of large numbers
  void add(const Group& group) {
    const double a = group[0];
    const double b = group[1];
    const std::size_t variables = products_.size() / 2;
    groups_ += 1;
    values_ += a + b;
    squares_ += a * a + b * b;
    for (std::size_t j = 0; j < variables; ++j) {
      const double change = group[2 + j] - a;
      products_[j] += b * change;
      products_[variables + j] += change * change / 2;
    }
  }

  void add(const Sums& other, double times) {
    groups_ += times * other.groups_;
    values_ += times * other.values_;
    squares_ += times * other.squares_;
    for (std::size_t k = 0; k < products_.size(); ++k) products_[k] += times * other.products_[k];
  }

  /// Of f(A) and f(B) together; 0 where it is not above what rounding may leave of it.
  double variance() const {
    if (groups_ == 0) return 0;
    const double n = 2 * groups_;
    const double squares = squares_ - values_ * values_ / n;
    return squares > n * 0x1p-52 * squares_ ? squares / (n - 1) : 0;
  }

  Estimates estimates() const {
    Estimates estimates = products_;
    for (double& estimate : estimates) estimate /= groups_ * variance();
    return estimates;
  }

 private:
  double groups_ = 0;
  double values_ = 0;
  double squares_ = 0;
  std::vector<double> products_;
};

/// What a pass over all groups finds out before the indices can be estimated.
struct Extent {
  std::uint64_t groups = 0;  ///< with those that miss a value
  std::uint64_t missing = 0;
  Overview values;  ///< of the groups without a missing value
};

Extent extent_of(const Blocks& output, std::size_t variables) {
  Extent extent;
  for_each_group(output, variables, [&](const Group& group) {
    ++extent.groups;
    if (!is_complete(group)) {
      ++extent.missing;
      return;
    }
    for (const double value : group) extent.values.add(value);
  });
  return extent;
}

/// The sums over consecutive parts of the groups, without parts of which nothing is left.
std::vector<Sums> parts_of(const Blocks& output, std::size_t variables, const Extent& extent) {
  const std::uint64_t count = std::min(extent.groups, greatest_parts);
  const double scale = extent.values.scale();
  const double center = extent.values.mean() * scale;
  std::vector<Sums> parts(count, Sums(variables));
  Group centered(variables + 2);
  std::uint64_t index = 0;
  for_each_group(output, variables, [&](const Group& group) {
    const std::uint64_t part = index++ * count / extent.groups;
    if (!is_complete(group)) return;
    for (std::size_t i = 0; i < group.size(); ++i) centered[i] = group[i] * scale - center;
    parts[part].add(centered);
  });
  const auto is_empty = [](const Sums& part) { return part.groups() == 0; };
  parts.erase(std::remove_if(parts.begin(), parts.end(), is_empty), parts.end());
  return parts;
}

/// How often each part is drawn when as many are drawn as there are.
std::vector<double> draw(std::size_t parts, std::uint32_t resample, std::uint64_t seed) {
  using Generator = r123::Philox4x32;
  const Generator::key_type key = {
      {static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32U)}};
  std::vector<double> times(parts);
  Generator::ctr_type numbers = {};
  for (std::size_t i = 0; i < parts; ++i) {
    if (i % numbers.size() == 0) {
      const Generator::ctr_type counter = {{static_cast<std::uint32_t>(i), resample, 0, 0}};
      numbers = Generator()(counter, key);
    }
    // Some parts are more probable than others by 1000 / 2^32 at most.
    times[(std::uint64_t{numbers[i % numbers.size()]} * parts) >> 32U] += 1;
  }
  return times;
}

/// The estimates of each resample, one list for each of them; resamples without variance have none.
std::vector<std::vector<double>> bootstrap(const std::vector<Sums>& parts, std::size_t variables,
                                           std::uint64_t seed) {
  std::vector<std::vector<double>> lists(2 * variables);
  for (std::uint32_t resample = 0; resample < resamples; ++resample) {
    const std::vector<double> times = draw(parts.size(), resample, seed);
    Sums sums(variables);
    for (std::size_t i = 0; i < parts.size(); ++i) {
      if (times[i] > 0) sums.add(parts[i], times[i]);
    }
    if (sums.variance() == 0) continue;
    const Estimates estimates = sums.estimates();
    for (std::size_t k = 0; k < lists.size(); ++k) lists[k].push_back(estimates[k]);
  }
  return lists;
}

SobolIndex with_interval(double estimate, const std::vector<double>& resampled) {
  const Blocks values = [&](const auto& take) { take(resampled.data(), resampled.size()); };
  const std::vector<double> ends = quantiles(values, resampled.size(), {0.025, 0.975});
  return ends.empty() ? SobolIndex{estimate, estimate, estimate} : SobolIndex{estimate, ends[0], ends[1]};
}

}  // namespace

SobolIndices sobol_indices(const Blocks& output, std::size_t variables, std::uint64_t seed) {
  const Extent extent = extent_of(output, variables);
  SobolIndices indices;
  indices.groups = extent.groups - extent.missing;
  indices.missing = extent.missing;
  const std::vector<Sums> parts = parts_of(output, variables, extent);
  Sums sums(variables);
  for (const Sums& part : parts) sums.add(part, 1);
  if (sums.variance() == 0) return indices;
  const double scale = extent.values.scale();
  indices.variance = sums.variance() / scale / scale;
  const Estimates estimates = sums.estimates();
  const std::vector<std::vector<double>> resampled = bootstrap(parts, variables, seed);
  for (std::size_t j = 0; j < variables; ++j) {
    const std::size_t total = variables + j;
    indices.first.push_back(with_interval(estimates[j], resampled[j]));
    indices.total.push_back(with_interval(estimates[total], resampled[total]));
  }
  return indices;
}

}  // namespace hybrid_sphere::study

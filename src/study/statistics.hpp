#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

namespace hybrid_sphere::study {

/// The values of one column in the order of the runs, a block after another. May be asked for again and
/// again, with the same result; what is not finite is missing.
using Blocks = std::function<void(const std::function<void(const double* values, std::size_t count)>& take)>;

/// Equal bins from the least to the greatest value; none if all values are equal.
struct Histogram {
  std::vector<double> edges;          ///< bins + 1
  std::vector<std::uint64_t> counts;  ///< bins; a value on an edge counts above it, the greatest below it
};

struct Summary {
  std::uint64_t count = 0;    ///< of the values that are there
  std::uint64_t missing = 0;  ///< of the others
  double mean = 0;
  double deviation = 0;  ///< standard deviation, with count - 1; 0 for a single value
  double least = 0;
  double greatest = 0;
  std::vector<double> quantiles;  ///< for each of the probabilities; empty if no value is there
  Histogram histogram;
};

/// The same to the bit however the values are cut into blocks. Memory does not grow with their number:
/// quantiles are found by counting digits, in several passes, unless the values fit into 64 MB. They are
/// exact: between the order statistics k and k + 1 around p (n - 1), linearly (type 7 of R. J. Hyndman, Y.
/// Fan, Am. Stat. 50 (1996) 361-365).
/// @param probabilities  from 0 to 1
/// @param bins           0: no histogram
Summary summarize(const Blocks& values, const std::vector<double>& probabilities, std::size_t bins);

struct Interval {
  double low;
  double high;
};

/// The exact interval of Clopper and Pearson for a probability of which `successes` of `trials` were seen;
/// [0, 1] without trials.
/// Source: C. J. Clopper, E. S. Pearson, Biometrika 26 (1934) 404-413.
/// @param trials      up to 1e13, beyond which the inverse of the beta function fails
/// @param confidence  above 0 and below 1
Interval probability_interval(std::uint64_t successes, std::uint64_t trials, double confidence = 0.95);

}  // namespace hybrid_sphere::study

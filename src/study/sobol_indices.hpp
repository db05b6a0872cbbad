#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "study/statistics.hpp"

namespace hybrid_sphere::study {

/// A Sobol' index and its interval of confidence, 95 %.
struct SobolIndex {
  double value = 0;
  double low = 0;
  double high = 0;
};

struct SobolIndices {
  std::uint64_t groups = 0;   ///< that count
  std::uint64_t missing = 0;  ///< groups of which a value is missing; an incomplete last group counts nowhere
  double variance = 0;        ///< of the output at the points A and B together, with their number - 1
  std::vector<SobolIndex> first;  ///< of each variable; empty if the variance is 0
  std::vector<SobolIndex> total;
};

/// Which share of the variance of an output each variable has by itself, and with all others.
/// First indices: A. Saltelli et al., Comput. Phys. Commun. 181 (2010) 259-270, table 2 (b); total: (f),
/// Jansen. The interval is that of the percentiles of a bootstrap over parts of the groups; with fewer than
/// two groups, or where every resample is constant, it is the estimate itself. The same to the bit however
/// the output is cut into blocks. Memory does not grow with the number of runs.
/// @param output     in the order of the runs of a design with `saltelli` (sampler.hpp)
/// @param variables  d
/// @param seed       of the bootstrap
SobolIndices sobol_indices(const Blocks& output, std::size_t variables, std::uint64_t seed);

}  // namespace hybrid_sphere::study

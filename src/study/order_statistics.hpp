#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "study/statistics.hpp"

namespace hybrid_sphere::study {

/// The quantiles of the finite values, as in Summary.
///
/// A pass counts the next 16 bits of those values that may still be among the wanted order statistics, until
/// they fit into memory; 512 KiB are needed besides for each order statistic that differs in the bits before.
/// @param count          of the finite values
/// @param probabilities  from 0 to 1
/// @param memory         bytes that may be filled with values; any amount leads to the same result
/// @return one number for each probability; none if count is 0
std::vector<double> quantiles(const Blocks& values, std::uint64_t count,
                              const std::vector<double>& probabilities,
                              std::size_t memory = std::size_t{64} << 20U);

}  // namespace hybrid_sphere::study

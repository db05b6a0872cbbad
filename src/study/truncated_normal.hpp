#pragma once

#include "study/distribution.hpp"

/// The truncated normal distribution, wherever its limits are.
namespace hybrid_sphere::study {

/// Within the limits; to a few roundings of the largest of |mean|, deviation and |x|.
/// @param u  0 < u < 1
double quantile(const TruncatedNormal& distribution, double u);

/// The share of samples <= x.
double cumulative(const TruncatedNormal& distribution, double x);

}  // namespace hybrid_sphere::study

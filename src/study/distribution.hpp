#pragma once

#include <variant>
#include <vector>

namespace hybrid_sphere::study {

struct Uniform {
  double low;
  double high;
};
struct LogUniform {
  double low;  ///< > 0
  double high;
};
struct Normal {
  double mean;
  double deviation;  ///< > 0
};
/// A normal distribution of which only what lies between two limits is left.
struct TruncatedNormal {
  double mean;
  double deviation;
  double low;
  double high;
};
/// The logarithm is normal.
struct Lognormal {
  double median;
  double log_deviation;  ///< standard deviation of the logarithm, > 0
};
struct Triangular {
  double low;
  double mode;
  double high;
};
/// One of several numbers.
struct Values {
  std::vector<double> values;  ///< ascending; may repeat
  std::vector<double>
      until;  ///< sum of the weights up to each, over that of all: ascending, the last one is 1
};

using Distribution =
    std::variant<Uniform, LogUniform, Normal, TruncatedNormal, Lognormal, Triangular, Values>;

/// The number below which a share u of the samples lies, 0 < u < 1: the inverse distribution function.
/// Finite, within the limits that the distribution has, and not decreasing with u but for rounding.
double quantile(const Distribution& distribution, double u);

/// The share of samples <= x.
double cumulative(const Distribution& distribution, double x);

}  // namespace hybrid_sphere::study

#include "study/statistics.hpp"

#include <algorithm>
#include <boost/math/special_functions/beta.hpp>
#include <cmath>

#include "study/moments.hpp"
#include "study/order_statistics.hpp"

namespace hybrid_sphere::study {
namespace {

/// Counts finite values in equal bins between the ends of their range.
class Bins {
 public:
  /// @param overview  of values that are not all equal
  /// @param bins      > 0
  Bins(const Overview& overview, std::size_t bins)
      : scale_(overview.scale()), low_(overview.least() * scale_) {
    const double width = overview.greatest() * scale_ - low_;
    const auto n = static_cast<double>(bins);
    per_width_ = n / width;
    for (std::size_t i = 0; i <= bins; ++i) {
      histogram_.edges.push_back((low_ + static_cast<double>(i) * width / n) / scale_);
    }
    // Not what is left of them after scaling.
    histogram_.edges.front() = overview.least();
    histogram_.edges.back() = overview.greatest();
    histogram_.counts.resize(bins);
  }

  void add(double x) {
    const std::vector<double>& edges = histogram_.edges;
    const std::size_t last = histogram_.counts.size() - 1;
    std::size_t bin = std::min(static_cast<std::size_t>((x * scale_ - low_) * per_width_), last);
    // A guess, up to rounding: what counts are the edges.
    while (bin > 0 && x < edges[bin]) --bin;
    while (bin < last && x >= edges[bin + 1]) ++bin;
    ++histogram_.counts[bin];
  }

  const Histogram& histogram() const { return histogram_; }

 private:
  double scale_;
  double low_;
  double per_width_ = 0;
  Histogram histogram_;
};

template <typename Take>
void for_each_value(const Blocks& values, Take take) {
  values([&](const double* block, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) take(block[i]);
  });
}

/// What is found with the range and the mean known.
void add_spread(const Blocks& values, const Overview& overview, std::size_t bins, Summary& summary) {
  Deviation deviation(overview);
  if (bins == 0) {
    for_each_value(values, [&](double x) {
      if (std::isfinite(x)) deviation.add(x);
    });
  } else {
    Bins counted(overview, bins);
    for_each_value(values, [&](double x) {
      if (!std::isfinite(x)) return;
      deviation.add(x);
      counted.add(x);
    });
    summary.histogram = counted.histogram();
  }
  summary.deviation = deviation.value();
}

}  // namespace

Summary summarize(const Blocks& values, const std::vector<double>& probabilities, std::size_t bins) {
  Overview overview;
  for_each_value(values, [&](double x) { overview.add(x); });
  Summary summary;
  summary.count = overview.count();
  summary.missing = overview.missing();
  summary.mean = overview.mean();
  summary.least = overview.least();
  summary.greatest = overview.greatest();
  if (overview.least() < overview.greatest()) add_spread(values, overview, bins, summary);
  summary.quantiles = quantiles(values, overview.count(), probabilities);
  return summary;
}

Interval probability_interval(std::uint64_t successes, std::uint64_t trials, double confidence) {
  const double outside = (1 - confidence) / 2;
  const auto k = static_cast<double>(successes);
  const auto others = static_cast<double>(trials - successes);
  return {successes == 0 ? 0 : boost::math::ibeta_inv(k, others + 1, outside),
          successes == trials ? 1 : boost::math::ibetac_inv(k + 1, others, outside)};
}

}  // namespace hybrid_sphere::study

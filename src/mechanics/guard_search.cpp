#include "mechanics/guard_search.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "integration/bracketed_root.hpp"
#include "interrupt/interrupt.hpp"

namespace hybrid_sphere::mechanics {
namespace {

// No simple fraction, so that a guard that repeats itself does not look the same at all samples.
constexpr double part = 0.4142135623730951;
constexpr int max_samples = 200;  // a guard that is nearly 0 all along is as good as sampled

/// What a guard may be between two samples: the cubic c with their values and rates, and off it by up to
/// e s^2 (1 - s)^2, s from 0 to 1, which is the form of that cubic's error. By Bernstein coefficients of
/// degree 4, of which that error is in the middle one alone: a function lies between the smallest and the
/// largest.
class Band {
 public:
  Band(const GuardSample& low, const GuardSample& middle, const GuardSample& high) {
    constexpr double caution = 2;
    const double h = high.x - low.x;
    const double b[] = {low.value, low.value + low.rate * h / 3, high.value - high.rate * h / 3, high.value};
    const double rest = 1 - part;
    const double cubic =
        rest * rest * (rest * b[0] + 3 * part * b[1]) + part * part * (3 * rest * b[2] + part * b[3]);
    error_ = caution * std::abs(middle.value - cubic) / (6 * part * part * rest * rest);
    coefficients_ = {b[0], (b[0] + 3 * b[1]) / 4, (b[1] + b[2]) / 2, (3 * b[2] + b[3]) / 4, b[3]};
    for (std::size_t i = 0; i < slopes_.size(); ++i) slopes_[i] = coefficients_[i + 1] - coefficients_[i];
  }

  bool has_one_sign() const {
    const auto& c = coefficients_;
    return std::min({c[0], c[1], c[2] - error_, c[3], c[4]}) > 0 ||
           std::max({c[0], c[1], c[2] + error_, c[3], c[4]}) < 0;
  }

  bool is_monotone() const {
    const auto& d = slopes_;
    return std::min({d[0], d[1] - error_, d[2] - error_, d[3]}) >= 0 ||
           std::max({d[0], d[1] + error_, d[2] + error_, d[3]}) <= 0;
  }

  /// Signs of the slopes change once.
  bool has_one_extremum() const {
    const auto& d = slopes_;
    const bool minimum = d[0] < 0 && d[3] > 0 && !(d[1] + error_ > 0 && d[2] - error_ < 0);
    const bool maximum = d[0] > 0 && d[3] < 0 && !(d[1] - error_ < 0 && d[2] + error_ > 0);
    return minimum || maximum;
  }

 private:
  double error_;  // in the middle coefficient
  std::array<double, 5> coefficients_;
  std::array<double, 4> slopes_;
};

/// Whether all values are round-off, times a factor.
bool are_within(double factor, const GuardSample& low, const GuardSample& middle, const GuardSample& high) {
  return std::abs(low.value) <= factor * low.roundoff && std::abs(middle.value) <= factor * middle.roundoff &&
         std::abs(high.value) <= factor * high.roundoff;
}

class GuardSearch {
 public:
  GuardSearch(const std::function<GuardSample(double x)>& sample, std::vector<double>& found)
      : sample_(sample), found_(found) {}

  void between(const GuardSample& low, const GuardSample& high);

 private:
  double extremum(const GuardSample& low, const GuardSample& high) const;

  const std::function<GuardSample(double x)>& sample_;
  std::vector<double>& found_;
  int samples_ = 0;
};

double GuardSearch::extremum(const GuardSample& low, const GuardSample& high) const {
  const auto rate = [this](double x) { return sample_(x).rate; };
  const integration::Bracket bracket = integration::bracketed_root(rate, low.x, high.x, low.rate, high.rate);
  return 0.5 * (bracket.low + bracket.high);
}

void GuardSearch::between(const GuardSample& low, const GuardSample& high) {
  const double x = low.x + part * (high.x - low.x);
  if (!(low.x < x && x < high.x) || ++samples_ > max_samples) {
    found_.push_back(high.x);
    return;
  }
  interruption_point();
  const GuardSample middle = sample_(x);
  // Within a few round-offs the signs say nothing: a change is found beyond them.
  constexpr double undecided = 4;
  if (are_within(1, low, middle, high)) return;
  if (are_within(undecided, low, middle, high)) {
    found_.push_back(high.x);
    return;
  }
  const Band band(low, middle, high);
  const bool crosses = (low.value > 0) != (high.value > 0);
  if (!crosses && band.has_one_sign()) return;
  if (crosses && band.is_monotone()) {
    found_.push_back(low.x);
    found_.push_back(high.x);
    return;
  }
  const bool turns = low.rate != 0 && high.rate != 0 && (low.rate > 0) != (high.rate > 0);
  if (!crosses && turns && band.has_one_extremum()) {
    found_.push_back(extremum(low, high));
    found_.push_back(high.x);
    return;
  }
  between(low, middle);
  between(middle, high);
}

}  // namespace

void search_guard(const std::function<GuardSample(double x)>& sample, const GuardSample& low,
                  const GuardSample& high, std::vector<double>& found) {
  GuardSearch(sample, found).between(low, high);
}

}  // namespace hybrid_sphere::mechanics

#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "geometry/double_double.hpp"

/// What a pass over many numbers finds out, number by number in their order: the result does not depend on
/// how they come in blocks.
namespace hybrid_sphere::study {

/// A sum that is kept in two doubles: its error is n^2 2^-106 of the sum of the magnitudes, and one rounding.
/// Source: A. Neumaier, ZAMM 54 (1974) 39-51.
class CompensatedSum {
 public:
  void add(double x) {
    const exact::DoubleDouble sum = exact::two_sum(value_, x);
    value_ = sum.value;
    remainder_ += sum.remainder;
  }
  void add(const CompensatedSum& other, double factor) {
    add(other.value_ * factor);
    add(other.remainder_ * factor);
  }
  double value() const { return value_ + remainder_; }
  /// The quotient of the sum and n, rounded once.
  double over(double n) const {
    const double quotient = value_ / n;
    return quotient + (std::fma(-quotient, n, value_) + remainder_) / n;
  }

 private:
  double value_ = 0;
  double remainder_ = 0;
};

/// The number, the mean and the range of the finite values.
class Overview {
 public:
  void add(double x) {
    if (!std::isfinite(x)) {
      ++missing_;
      return;
    }
    x += 0.0;  // makes 0.0 of -0.0
    least_ = count_ == 0 ? x : std::min(least_, x);
    greatest_ = count_ == 0 ? x : std::max(greatest_, x);
    ++count_;
    if (std::abs(x) < huge) {
      sum_.add(x);
    } else {
      sum_of_huge_.add(x * down);
    }
  }

  std::uint64_t count() const { return count_; }
  std::uint64_t missing() const { return missing_; }
  double least() const { return least_; }
  double greatest() const { return greatest_; }

  /// 0 where there is no value.
  double mean() const {
    if (count_ == 0) return 0;
    const auto n = static_cast<double>(count_);
    if (std::max(-least_, greatest_) < huge) return sum_.over(n);
    CompensatedSum sum = sum_of_huge_;
    sum.add(sum_, down);
    return sum.over(n) / down;
  }

  /// The power of two that takes the largest magnitude into [1, 2). It stays within what can be divided by,
  /// which leaves numbers up to 2^24 and down to 2^-74: their squares are far from the ends of the range,
  /// too.
  double scale() const {
    const double size = std::max(-least_, greatest_);
    return size > 0 ? std::ldexp(1.0, std::clamp(-std::ilogb(size), -1000, 1000)) : 1;
  }

 private:
  static constexpr double huge = 0x1p900;   // 2^64 numbers below it can be summed
  static constexpr double down = 0x1p-100;  // and this times the largest double is below it

  std::uint64_t count_ = 0;
  std::uint64_t missing_ = 0;
  double least_ = 0;
  double greatest_ = 0;
  CompensatedSum sum_;
  CompensatedSum sum_of_huge_;
};

/// The standard deviation of finite values, in a second pass.
/// Source: the corrected two-pass algorithm of T. F. Chan, G. H. Golub, R. J. LeVeque, Am. Stat. 37 (1983)
/// 242-247.
class Deviation {
 public:
  explicit Deviation(const Overview& overview)
      : scale_(overview.scale()), center_(overview.mean() * scale_), count_(overview.count()) {}

  void add(double x) {
    const double y = x * scale_ - center_;
    sum_.add(y);
    squares_.add(y * y);
  }

  /// With count - 1; 0 for a single value.
  double value() const {
    if (count_ < 2) return 0;
    const auto n = static_cast<double>(count_);
    const double squares = squares_.value() - sum_.value() * sum_.value() / n;
    return std::sqrt(std::max(0.0, squares) / (n - 1)) / scale_;
  }

 private:
  double scale_;
  double center_;
  std::uint64_t count_;
  CompensatedSum sum_;
  CompensatedSum squares_;
};

}  // namespace hybrid_sphere::study

#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace hybrid_sphere::exact {

/// An integer wide enough for sums of products of two differences of any doubles, counted in units of
/// 2^-1074: these have 4200 bits.
class WideInteger {
 public:
  WideInteger() = default;
  /// A double in units of 2^unit.
  /// @param x  finite, a multiple of the unit
  WideInteger(double x, int unit);

  int sign() const { return sign_; }

  friend WideInteger operator+(const WideInteger& a, const WideInteger& b);
  friend WideInteger operator-(const WideInteger& a, const WideInteger& b);
  friend WideInteger operator*(const WideInteger& a, const WideInteger& b);

 private:
  static constexpr std::size_t max_digits = 134;

  int compare_size(const WideInteger& other) const;
  void add_size(const WideInteger& other);
  void subtract_smaller_size(const WideInteger& other);
  void drop_leading_zeros();

  int sign_ = 0;
  std::size_t size_ = 0;                          // of the digits in use; the last one is not 0
  std::array<std::uint32_t, max_digits> digits_;  // to the base 2^32, ascending
};

}  // namespace hybrid_sphere::exact

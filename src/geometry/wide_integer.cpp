#include "geometry/wide_integer.hpp"

#include <cmath>

namespace hybrid_sphere::exact {
namespace {

constexpr int digit_bits = 32;

std::uint32_t low_digit(std::uint64_t x) { return static_cast<std::uint32_t>(x); }

}  // namespace

WideInteger::WideInteger(double x, int unit) : sign_((x > 0) - (x < 0)) {
  if (x == 0) return;
  const int exponent = std::ilogb(x) - 52;
  auto mantissa = static_cast<std::uint64_t>(std::ldexp(std::abs(x), -exponent));
  int shift = exponent - unit;
  if (shift < 0) {
    mantissa >>= -shift;  // of a denormal number: only zeros are lost
    shift = 0;
  }
  const auto zeros = static_cast<std::size_t>(shift / digit_bits);
  for (; size_ < zeros; ++size_) digits_[size_] = 0;
  const int rest = shift % digit_bits;
  const std::uint64_t low = (mantissa & 0xffffffffU) << rest;
  const std::uint64_t high = ((mantissa >> digit_bits) << rest) + (low >> digit_bits);
  digits_[size_++] = low_digit(low);
  digits_[size_++] = low_digit(high);
  digits_[size_++] = low_digit(high >> digit_bits);
  drop_leading_zeros();
}

void WideInteger::drop_leading_zeros() {
  while (size_ > 0 && digits_[size_ - 1] == 0) --size_;
  if (size_ == 0) sign_ = 0;
}

/// Compares the absolute values: -1, 0 or 1.
int WideInteger::compare_size(const WideInteger& other) const {
  if (size_ != other.size_) return size_ < other.size_ ? -1 : 1;
  for (std::size_t i = size_; i-- > 0;) {
    if (digits_[i] != other.digits_[i]) return digits_[i] < other.digits_[i] ? -1 : 1;
  }
  return 0;
}

void WideInteger::add_size(const WideInteger& other) {
  std::uint64_t carry = 0;
  for (std::size_t i = 0; i < other.size_ || carry != 0; ++i) {
    if (i == size_) digits_[size_++] = 0;
    carry += digits_[i];
    if (i < other.size_) carry += other.digits_[i];
    digits_[i] = low_digit(carry);
    carry >>= digit_bits;
  }
}

void WideInteger::subtract_smaller_size(const WideInteger& other) {
  std::uint64_t borrow = 0;
  for (std::size_t i = 0; i < other.size_ || borrow != 0; ++i) {
    const std::uint64_t subtrahend = (i < other.size_ ? other.digits_[i] : 0) + borrow;
    borrow = subtrahend > digits_[i] ? 1 : 0;
    digits_[i] = low_digit(digits_[i] - subtrahend);
  }
  drop_leading_zeros();
}

WideInteger operator+(const WideInteger& a, const WideInteger& b) {
  if (a.sign_ == 0) return b;
  WideInteger sum = a;
  if (a.sign_ * b.sign_ >= 0) {
    sum.add_size(b);
  } else if (a.compare_size(b) >= 0) {
    sum.subtract_smaller_size(b);
  } else {
    sum = b;
    sum.subtract_smaller_size(a);
  }
  return sum;
}

WideInteger operator-(const WideInteger& a, const WideInteger& b) {
  WideInteger opposite = b;
  opposite.sign_ = -b.sign_;
  return a + opposite;
}

WideInteger operator*(const WideInteger& a, const WideInteger& b) {
  WideInteger product;
  product.sign_ = a.sign_ * b.sign_;
  if (product.sign_ == 0) return product;
  product.size_ = a.size_ + b.size_;
  for (std::size_t i = 0; i < product.size_; ++i) product.digits_[i] = 0;
  for (std::size_t i = 0; i < a.size_; ++i) {
    std::uint64_t carry = 0;
    for (std::size_t j = 0; j < b.size_; ++j) {
      carry += std::uint64_t{a.digits_[i]} * b.digits_[j] + product.digits_[i + j];
      product.digits_[i + j] = low_digit(carry);
      carry >>= digit_bits;
    }
    product.digits_[i + b.size_] = low_digit(carry);
  }
  product.drop_leading_zeros();
  return product;
}

}  // namespace hybrid_sphere::exact

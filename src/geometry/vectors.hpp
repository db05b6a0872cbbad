#pragma once

#include <Eigen/Core>
#include <type_traits>

/// Sums and multiples of vectors with two or three components as vectors instead of Eigen's expressions. The
/// results are the same, but the compiler does not instantiate a class for each formula.
namespace hybrid_sphere {

template <int size>
using SmallVector = std::enable_if_t<size == 2 || size == 3, Eigen::Matrix<double, size, 1>>;

template <class Number>
using IsNumber = std::enable_if_t<std::is_arithmetic_v<Number>, int>;

template <int size>
SmallVector<size> operator+(const Eigen::Matrix<double, size, 1>& a,
                            const Eigen::Matrix<double, size, 1>& b) {
  Eigen::Matrix<double, size, 1> sum = a;
  return sum += b;
}

template <int size>
SmallVector<size> operator-(const Eigen::Matrix<double, size, 1>& a,
                            const Eigen::Matrix<double, size, 1>& b) {
  Eigen::Matrix<double, size, 1> difference = a;
  return difference -= b;
}

template <int size>
SmallVector<size> operator-(const Eigen::Matrix<double, size, 1>& a) {
  Eigen::Matrix<double, size, 1> opposite;
  for (int i = 0; i < size; ++i) opposite[i] = -a[i];
  return opposite;
}

template <int size, class Number, IsNumber<Number> = 0>
SmallVector<size> operator*(Number factor, const Eigen::Matrix<double, size, 1>& a) {
  Eigen::Matrix<double, size, 1> product = a;
  return product *= static_cast<double>(factor);
}

template <int size, class Number, IsNumber<Number> = 0>
SmallVector<size> operator*(const Eigen::Matrix<double, size, 1>& a, Number factor) {
  return factor * a;
}

template <int size, class Number, IsNumber<Number> = 0>
SmallVector<size> operator/(const Eigen::Matrix<double, size, 1>& a, Number divisor) {
  Eigen::Matrix<double, size, 1> quotient = a;
  return quotient /= static_cast<double>(divisor);
}

/// The length of a vector whose square may overflow or underflow.
double stable_norm(const Eigen::Vector2d& a);
double stable_norm(const Eigen::Vector3d& a);

/// The unit vector in its direction, likewise; 0 if the vector is 0.
Eigen::Vector2d stable_normalized(const Eigen::Vector2d& a);

}  // namespace hybrid_sphere

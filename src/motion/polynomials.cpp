#include "motion/polynomials.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>

// One version of a function for processors with AVX and one for all, chosen when the program starts, which
// the thread sanitizer does not survive.
#if defined(__x86_64__) && defined(__GLIBC__) && !defined(__clang__) && !defined(__SANITIZE_THREAD__)
#define HYBRID_SPHERE_VERSIONS __attribute__((target_clones("avx", "default")))
#else
#define HYBRID_SPHERE_VERSIONS
#endif

namespace hybrid_sphere::polynomials::detail {
namespace {

using Four __attribute__((vector_size(4 * sizeof(double)))) = double;

// Even and odd powers apart: two short chains of operations instead of a long one.
template <std::ptrdiff_t rows>
__attribute__((always_inline)) inline void evaluate(const double* powers, double x, double* values) {
  const double square = x * x;
  for (std::ptrdiff_t row = 0; row < rows; row += 4) {
    Four even, odd, next;
    const double* column = powers + (size - 2) * rows + row;
    std::memcpy(&even, column, sizeof even);
    std::memcpy(&odd, column + rows, sizeof odd);
    for (int k = size - 4; k >= 0; k -= 2) {
      column -= 2 * rows;
      std::memcpy(&next, column, sizeof next);
      even = even * square + next;
      std::memcpy(&next, column + rows, sizeof next);
      odd = odd * square + next;
    }
    const Four value = even + odd * x;
    std::memcpy(values + row, &value, sizeof value);
  }
}

/// (0, w) q for quaternions (x, y, z, w) and w along each axis: their sum with w is that for any w.
struct Products {
  Four x, y, z;
  __attribute__((always_inline)) explicit Products(const Four& q)
      : x(Four{1, -1, 1, -1} * __builtin_shufflevector(q, q, 3, 2, 1, 0)),
        y(Four{1, 1, -1, -1} * __builtin_shufflevector(q, q, 2, 3, 0, 1)),
        z(Four{-1, 1, 1, -1} * __builtin_shufflevector(q, q, 1, 0, 3, 2)) {}
};

__attribute__((always_inline)) inline void follow_rates(const double* rates, int terms, int count,
                                                        double* quaternions) {
  Four products[long_size][3];
  Four q;
  std::memcpy(&q, quaternions, sizeof q);
  for (int n = 0; n + 1 < count; ++n) {
    const Products now(q);
    products[n][0] = now.x;
    products[n][1] = now.y;
    products[n][2] = now.z;
    Four x{}, y{}, z{};
    for (int k = n < terms ? n : terms - 1; k >= 0; --k) {
      const double* w = rates + std::ptrdiff_t{3} * k;
      x += w[0] * products[n - k][0];
      y += w[1] * products[n - k][1];
      z += w[2] * products[n - k][2];
    }
    q = (x + (y + z)) * (1 / (n + 1.0));
    std::memcpy(quaternions + std::ptrdiff_t{4} * (n + 1), &q, sizeof q);
  }
}

/// The same for two rates: n! q_n follow one from another by fewer operations that have to wait for the one
/// before.
__attribute__((always_inline)) inline void follow_two(const double* rates, int count, double* quaternions) {
  Four now, before{};
  std::memcpy(&now, quaternions, sizeof now);
  double factorial = 1;
  for (int n = 0; n + 1 < count; ++n) {
    const Products a(now), b(before);
    const Four by_first = rates[0] * a.x + (rates[1] * a.y + rates[2] * a.z);
    const Four by_second = rates[3] * b.x + (rates[4] * b.y + rates[5] * b.z);
    before = now;
    now = by_first + n * by_second;
    factorial *= n + 1;
    const Four q = now * (1 / factorial);
    std::memcpy(quaternions + std::ptrdiff_t{4} * (n + 1), &q, sizeof q);
  }
}

/// What the powers from x^size on are on [-1, 1] without T_size and all after it, and their parts of the
/// first two of these.
struct Economization {
  static constexpr int more = long_size - size;
  double powers[size][more / 2] = {};  ///< a row for each power, of those of its parity
  double left_out[more] = {};
  Economization() {
    long double of_t[size][size] = {};  // the powers of T_k
    of_t[0][0] = of_t[1][1] = 1;
    for (int k = 2; k < size; ++k) {
      for (int n = 0; n < size; ++n) of_t[k][n] = (n > 0 ? 2 * of_t[k - 1][n - 1] : 0) - of_t[k - 2][n];
    }
    // x^m in T_k, from x T_k = (T_(k+1) + T_abs(k-1))/2.
    long double in_t[long_size + 1] = {};
    in_t[0] = 1;
    for (int m = 1; m < long_size; ++m) {
      long double next[long_size + 1] = {};
      for (int k = 0; k < m; ++k) {
        next[k + 1] += in_t[k] / (k == 0 ? 1 : 2);
        if (k > 0) next[k - 1] += in_t[k] / 2;
      }
      std::memcpy(in_t, next, sizeof in_t);
      if (m < size) continue;
      left_out[m - size] = static_cast<double>(in_t[m % 2 == 0 ? size : size + 1]);
      for (int n = 0; n < size; ++n) {
        long double sum = 0;
        for (int k = n; k < size; ++k) sum += in_t[k] * of_t[k][n];
        if (n % 2 == m % 2) powers[n][(m - size) / 2] = static_cast<double>(sum);
      }
    }
  }
};

__attribute__((always_inline)) inline double economize(const Economization& map, const double* powers,
                                                       double* economized) {
  constexpr int more = Economization::more;
  Four higher[more];
  std::memcpy(higher, powers + std::ptrdiff_t{4} * size, sizeof higher);
  for (int n = 0; n < size; ++n) {
    Four sum;
    std::memcpy(&sum, powers + std::ptrdiff_t{4} * n, sizeof sum);
    for (int m = 0; m < more / 2; ++m) sum += map.powers[n][m] * higher[2 * m + n % 2];
    std::memcpy(economized + std::ptrdiff_t{4} * n, &sum, sizeof sum);
  }
  Four left_out[2] = {};
  for (int m = 0; m < more; ++m) left_out[m % 2] += map.left_out[m] * higher[m];
  double largest[2] = {};
  for (int parity = 0; parity < 2; ++parity) {
    for (int row = 0; row < 4; ++row)
      largest[parity] = std::max(largest[parity], std::abs(left_out[parity][row]));
  }
  return largest[0] + largest[1];
}

__attribute__((always_inline)) inline void multiply(const double* matrix, double* powers) {
  Four columns[4];
  std::memcpy(columns, matrix, sizeof columns);
  for (int n = 0; n < size; ++n) {
    double* q = powers + std::ptrdiff_t{4} * n;
    const Four product = (columns[0] * q[0] + columns[1] * q[1]) + (columns[2] * q[2] + columns[3] * q[3]);
    std::memcpy(q, &product, sizeof product);
  }
}

}  // namespace

HYBRID_SPHERE_VERSIONS void follow(const double* rates, int terms, int count, double* quaternions) {
  if (terms == 2) {
    follow_two(rates, count, quaternions);
  } else {
    follow_rates(rates, terms, count, quaternions);
  }
}
HYBRID_SPHERE_VERSIONS double economize4(const double* powers, double* economized) {
  static const Economization map;
  return economize(map, powers, economized);
}
HYBRID_SPHERE_VERSIONS void multiply4(const double* matrix, double* powers) { multiply(matrix, powers); }
HYBRID_SPHERE_VERSIONS void evaluate4(const double* powers, double x, double* values) {
  evaluate<4>(powers, x, values);
}
HYBRID_SPHERE_VERSIONS void evaluate8(const double* powers, double x, double* values) {
  evaluate<8>(powers, x, values);
}
HYBRID_SPHERE_VERSIONS void evaluate12(const double* powers, double x, double* values) {
  evaluate<12>(powers, x, values);
}

}  // namespace hybrid_sphere::polynomials::detail

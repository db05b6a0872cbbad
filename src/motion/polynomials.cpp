#include "motion/polynomials.hpp"

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

}  // namespace

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

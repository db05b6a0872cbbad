#include "python/number.hpp"

#include <cmath>

namespace hybrid_sphere::python {

using mechanics::Partials;

void scale(double value, double a, const NumberView& x, double* result) {
  const std::size_t size = x.shape.size();
  result[0] = value;
  for (std::size_t i = 1; i < size; ++i) result[i] = a * x.data[i];
}

void combine(double value, double a, const NumberView& x, double b, const NumberView& y, double* result) {
  const std::size_t size = x.shape.size();
  result[0] = value;
  for (std::size_t i = 1; i < size; ++i) result[i] = a * x.data[i] + b * y.data[i];
}

void compose(const Partials& f, const NumberView& x, double* result) {
  scale(f.value, f.x, x, result);
  const double* const slopes = x.data + 1;
  double* second = result + 1 + x.shape.slopes;
  for (int i = 0; i < x.shape.second; ++i) {
    const double of_row = f.xx * slopes[i];
    for (int j = 0; j <= i; ++j) *second++ += of_row * slopes[j];
  }
}

void compose(const Partials& f, const NumberView& x, const NumberView& y, double* result) {
  combine(f.value, f.x, x, f.y, y, result);
  const double* const u = x.data + 1;
  const double* const w = y.data + 1;
  double* second = result + 1 + x.shape.slopes;
  for (int i = 0; i < x.shape.second; ++i) {
    const double along_u = f.xx * u[i] + f.xy * w[i];
    const double along_w = f.xy * u[i] + f.yy * w[i];
    for (int j = 0; j <= i; ++j) *second++ += along_u * u[j] + along_w * w[j];
  }
}

Partials power(double x, double exponent) {
  if (exponent == 2) return {x * x, 2 * x, 0, 2, 0, 0};
  return pow(Taylor(x), exponent).f;
}

Partials power_of_base(double base, double x) { return pow(base, Taylor(x)).f; }

Partials power_of_both(double x, double y) { return pow(Taylor(x), Taylor(y)).f; }

}  // namespace hybrid_sphere::python

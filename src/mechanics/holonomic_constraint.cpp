#include "hybrid_sphere/mechanics/holonomic_constraint.hpp"

namespace hybrid_sphere::mechanics {
namespace {

/// Row i of dg/dq times a direction.
double along(const HolonomicSlopes& slopes, Index i, const double* direction, Index coordinates) {
  double sum = 0;
  for (Index k = 0; k < coordinates; ++k) sum += slopes.place[i * coordinates + k] * direction[k];
  return sum;
}

void set_gradient(const HolonomicSlopes& slopes, const Matrix& directions, Matrix& gradient) {
  gradient.resize(slopes.size, directions.cols());
  for (Index j = 0; j < directions.cols(); ++j) {
    for (Index i = 0; i < slopes.size; ++i) {
      gradient(i, j) = along(slopes, i, directions.col(j).data(), directions.rows());
    }
  }
}

}  // namespace

void set_holonomic_terms(const HolonomicSlopes& slopes, const Vector& rate, const Matrix& directions,
                         const Vector& drift, ConstraintTerms& terms) {
  set_gradient(slopes, directions, terms.gradient);
  terms.value.resize(slopes.size);
  terms.gamma.resize(slopes.size);
  for (Index i = 0; i < slopes.size; ++i) {
    terms.value[i] = along(slopes, i, rate.data(), rate.size()) + slopes.time[i];
    terms.gamma[i] = -along(slopes, i, drift.data(), drift.size()) - slopes.along_path[i];
  }
}

void set_holonomic_gradient(const HolonomicSlopes& slopes, const Matrix& directions, const Vector& v,
                            Vector& value, Matrix& gradient) {
  set_gradient(slopes, directions, gradient);
  value.noalias() = gradient * v;
  for (Index i = 0; i < slopes.size; ++i) value[i] += slopes.time[i];
}

}  // namespace hybrid_sphere::mechanics

#include "motion/collocation_lu.hpp"

namespace hybrid_sphere {
namespace {

using EigenColumn = Eigen::Matrix<std::complex<double>, polynomials::size, 1>;

}  // namespace

CollocationLu::CollocationLu(const Square& matrix)
    : decomposition_(Eigen::Map<const Matrix>(matrix[0].data())) {}

CollocationLu::Column CollocationLu::solve(const Column& right) const {
  Column x;
  Eigen::Map<EigenColumn>(x.data()) =
      decomposition_.solve(EigenColumn(Eigen::Map<const EigenColumn>(right.data())));
  return x;
}

}  // namespace hybrid_sphere

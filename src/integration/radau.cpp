#include "integration/radau.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <boost/math/quadrature/gauss.hpp>
#include <cmath>

namespace hybrid_sphere::integration {
namespace {

Radau make_radau() {
  Radau method;
  // (1 + x)/2 for the zeros x of P_5 - P_4, Legendre's polynomials.
  method.nodes << 0.057104196114517682193, 0.276843013638123827680, 0.583590432368916820180,
      0.860240135656219447550, 1;
  // Exact for the polynomials of degree 4 that these are.
  using Quadrature = boost::math::quadrature::gauss<double, Radau::stages>;
  for (Eigen::Index i = 0; i < Radau::stages; ++i) {
    for (Eigen::Index j = 0; j < Radau::stages; ++j) {
      const auto basis = [&](double s) { return method.basis(j, s); };
      method.slopes(i, j) = Quadrature::integrate(basis, 0.0, method.nodes[i]);
    }
    method.start[i] = method.basis(i, 0);
  }
  method.inverse = method.slopes.inverse();
  const Eigen::EigenSolver<Radau::Square> solver(method.inverse);
  method.eigenvalues = solver.eigenvalues();
  method.vectors = solver.eigenvectors();
  method.vectors_inverse = method.vectors.inverse();
  for (const std::complex<double>& eigenvalue : method.eigenvalues) {
    if (eigenvalue.imag() == 0) method.real_eigenvalue = eigenvalue.real();
  }
  return method;
}

}  // namespace

double Radau::basis(Eigen::Index i, double s) const {
  double product = 1;
  for (Eigen::Index k = 0; k < stages; ++k) {
    if (k != i) product *= (s - nodes[k]) / (nodes[i] - nodes[k]);
  }
  return product;
}

const Radau& radau() {
  static const Radau method = make_radau();
  return method;
}

}  // namespace hybrid_sphere::integration

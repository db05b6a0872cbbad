#include "mechanics/implicit_step.hpp"

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <complex>
#include <utility>

#include "mechanics/decompositions/eigenvalues.hpp"

namespace hybrid_sphere::mechanics {
namespace {

using integration::radau;

constexpr Eigen::Index stages = integration::Radau::stages;

}  // namespace

ImplicitStart::ImplicitStart(Eigen::MatrixXd jacobian_, Eigen::VectorXd scale_)
    : jacobian(std::move(jacobian_)), scale(std::move(scale_)) {
  constexpr double part = 0.5;
  if (!jacobian.allFinite()) throw NumericalError("a derivative of the accelerations is not finite");
  const Eigen::MatrixXd scaled = scale.cwiseInverse().asDiagonal() * jacobian * scale.asDiagonal();
  const Eigen::VectorXcd rates = eigenvalues(scaled);
  Eigen::Index fastest = 0;
  fastest_rate = rates.cwiseAbs().maxCoeff(&fastest);
  decays = rates[fastest].real() < -part * fastest_rate;
}

void ImplicitStep::take(const Derivative& derivative, const std::shared_ptr<const ImplicitStart>& start,
                        double x, const Eigen::VectorXd& y, double h) {
  constexpr int most = 15;
  constexpr double converged = DBL_EPSILON / 2;
  constexpr double nearly_converged = 1e-11;  // what rounding of the forces may leave
  constexpr double slow = 0.5;
  decompose(start, h);
  x_ = x;
  y_ = y;
  changes_.setZero(y.size(), stages);
  slopes_.resize(y.size(), stages);
  contraction_ = 0;
  double before = 0;
  for (int i = 0; i < most; ++i) {
    evaluate_stages(derivative);
    const double size = improve();
    if (!std::isfinite(size)) break;
    const double contraction = i == 0 ? 0 : size / before;
    if (i == 1 || (i > 1 && before > nearly_converged)) contraction_ = contraction;
    const bool is_slow = contraction > slow;
    const bool is_last = is_slow || i == most - 1;
    if (size <= converged || (i > 0 && !is_slow && contraction * size <= converged) ||
        (is_last && size <= nearly_converged)) {
      end_ = y_ + changes_.rightCols(1).col(0);
      return;
    }
    if (contraction > 1 && i > 1) break;
    before = size;
  }
  throw StepError("the equations of an implicit step have no solution near its start");
}

void ImplicitStep::decompose(const std::shared_ptr<const ImplicitStart>& start, double h) {
  if (start_ == start && h_ == h) return;
  start_ = start;
  h_ = h;
  matrices_.clear();
  const Eigen::Index size = start->scale.size();
  for (const std::complex<double>& eigenvalue : radau().eigenvalues) {
    if (eigenvalue.imag() < 0) continue;
    Eigen::MatrixXcd matrix = -start->jacobian.cast<std::complex<double>>();
    matrix += (eigenvalue / h) * Eigen::MatrixXcd::Identity(size, size);
    matrices_.emplace_back(matrix);
  }
}

void ImplicitStep::evaluate_stages(const Derivative& derivative) {
  Eigen::VectorXd state;
  for (Eigen::Index i = 0; i < stages; ++i) {
    state = y_ + changes_.col(i);
    derivative(x_ + radau().nodes[i] * h_, state, slopes_.col(i));
  }
}

/// One of Newton's iterations, in the eigenvectors of A^-1; guards are sums of their rates.
/// @return  the largest change of q and v in units of their scale or size
double ImplicitStep::improve() {
  const Eigen::Index size = start_->scale.size();
  const Stages rest = slopes_.topRows(size) - changes_.topRows(size) * radau().inverse.transpose() / h_;
  const Eigen::MatrixXcd transformed =
      rest.cast<std::complex<double>>() * radau().vectors_inverse.transpose();
  Stages step = Stages::Zero(size, stages);
  std::size_t matrix = 0;
  for (Eigen::Index k = 0; k < stages; ++k) {
    const double imaginary = radau().eigenvalues[k].imag();
    if (imaginary < 0) continue;
    const Eigen::VectorXcd part = matrices_[matrix++].solve(transformed.col(k));
    step += (imaginary > 0 ? 2 : 1) * (part * radau().vectors.col(k).transpose()).real();
  }
  changes_.topRows(size) += step;
  const Eigen::Index guards = y_.size() - size;
  changes_.bottomRows(guards) = h_ * slopes_.bottomRows(guards) * radau().slopes.transpose();
  const Eigen::ArrayXd units = start_->scale.array() + y_.head(size).array().abs();
  return (step.array().abs().colwise() / units).maxCoeff();
}

/// (1 - gamma h J)^-1 of the difference of q and v, 1/gamma being the real eigenvalue of A^-1.
Eigen::VectorXd ImplicitStep::without_fast_part(const Eigen::VectorXd& difference) const {
  std::size_t matrix = 0;
  for (const std::complex<double>& eigenvalue : radau().eigenvalues) {
    if (eigenvalue.imag() == 0) break;
    if (eigenvalue.imag() > 0) ++matrix;
  }
  Eigen::VectorXd result = difference;
  const Eigen::Index size = start_->scale.size();
  const Eigen::VectorXcd right = difference.head(size).cast<std::complex<double>>();
  result.head(size) = (radau().real_eigenvalue / h_) * matrices_[matrix].solve(right).real();
  return result;
}

// The rates of the stages, extrapolated to the start, miss the rate there by what collocation misses: gamma h
// times that is the difference to an embedded method of order 5. A state off the balance with a fast damper
// by little has a rate that says nothing of the step: where the state is mended by the estimate, it does.
void ImplicitStep::estimate_error(const Derivative& derivative, const Eigen::VectorXd& slope,
                                  Eigen::VectorXd& difference) {
  const double weight = h_ / radau().real_eigenvalue;
  const Eigen::Index size = start_->scale.size();
  // The last of Newton's iterations has changed the rates of q and v.
  slopes_.topRows(size) = changes_.topRows(size) * radau().inverse.transpose() / h_;
  const Eigen::VectorXd extrapolated = slopes_ * radau().start;
  difference = without_fast_part(weight * (slope - extrapolated));
  Eigen::VectorXd mended = y_;
  mended.head(size) += difference.head(size);
  Eigen::VectorXd rate(y_.size());
  try {
    derivative(x_, mended, rate);
  } catch (const NumericalError&) {
    return;
  }
  difference.head(size) = without_fast_part(weight * (rate - extrapolated)).head(size);
}

void ImplicitStep::interpolate(double x, Eigen::Ref<Eigen::VectorXd> y) const {
  const double s = (x - x_) / h_;
  y = y_.head(y.size());
  for (Eigen::Index i = 0; i < stages; ++i) {
    y += s / radau().nodes[i] * radau().basis(i, s) * changes_.col(i).head(y.size());
  }
}

}  // namespace hybrid_sphere::mechanics

#include "hybrid_sphere/mechanics/modes.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "mechanics/check_initial.hpp"
#include "mechanics/decompositions/cholesky.hpp"
#include "mechanics/decompositions/complex_lu.hpp"
#include "mechanics/decompositions/eigenvalues.hpp"
#include "mechanics/decompositions/eigenvectors.hpp"
#include "mechanics/decompositions/least_norm.hpp"
#include "mechanics/decompositions/linear_equations.hpp"
#include "mechanics/nearby_states.hpp"
#include "mechanics/split_directions.hpp"
#include "text/refusal.hpp"

namespace hybrid_sphere::mechanics {
namespace {

// A motion is steady if what is left of its accelerations is at most this part of their terms. Computed
// motions and published equilibria are good to 1e-8 or so; motions that are not steady miss it by their size.
constexpr double max_unsteadiness = 1e-6;

// Constraints are dependent, and eigenvalues 0, up to this. Differences leave some 1e-11, and the error of a
// steady motion that was computed, some 1e-9.
constexpr double max_dependence = 1e-9;
constexpr double max_zero = 1e-8;

[[noreturn]] void refuse_unsteady(const Model& model, const State& state, const std::string& what) {
  throw std::invalid_argument(text::refusal("state: " + what, "an equilibrium or a steady motion") + " (" +
                              describe(model, state.time, state.q, state.v) + ")");
}

/// The linear equations z' = A z on the directions z that the constraints leave free at a steady motion,
/// along which A is constant: dx = T K z, T(t) = (B S W, 0; 0, S W) with its axes S.
class SteadyMotion {
 public:
  SteadyMotion(const Model& model, const State& state) : nearby_(model, state) {
    const Vector acceleration = nearby_.motion().acceleration();
    model.equations->steady_axes(state.q, state.v, acceleration, axes_, axes_rate_);
    const Vector expected = axes_rate_ * solve_linear_equations(axes_, state.v);
    const Vector weights = nearby_.weights();
    axes_ *= weights.cwiseInverse().asDiagonal();
    axes_rate_ *= weights.cwiseInverse().asDiagonal();
    places_ = nearby_.directions() * axes_;
    places_rate_ = nearby_.directions_rate() * axes_ + nearby_.directions() * axes_rate_;
    find_free();
    find_rates(model, state);
    const double off = weights.cwiseProduct(acceleration - expected).norm();
    const double size = size_of_acceleration() + weights.cwiseProduct(expected).norm();
    if (off <= max_unsteadiness * size) return;
    refuse_unsteady(model, state,
                    "its accelerations are off by " + text::shortest(off / size) +
                        " of their terms; at most " + text::shortest(max_unsteadiness));
  }

  const Matrix& rates() const { return rates_; }  ///< A (k x k)
  const Matrix& free() const { return free_; }    ///< K (2n x k), orthonormal
  /// dx of directions z (k x m).
  Eigen::MatrixXcd in_coordinates(const Eigen::MatrixXcd& z) const {
    const Index size = axes_.cols();
    const Eigen::MatrixXcd y = free_ * z;
    Eigen::MatrixXcd x(places_.rows() + size, z.cols());
    x << places_ * y.topRows(size), axes_ * y.bottomRows(size);
    return x;
  }

 private:
  void find_free() {
    const Index size = axes_.cols();
    const Matrix changes = nearby_.changes_of_constraints(places_);
    const Index rows = changes.rows() / 2;
    Matrix conditions = Matrix::Zero(2 * rows, 2 * size);
    conditions.leftCols(size) = changes;
    if (rows > 0) conditions.bottomRightCorner(rows, size) = nearby_.motion().gradient() * axes_;
    for (Index i = 0; i < conditions.rows(); ++i) {
      const double length = conditions.row(i).norm();
      if (length > 0) conditions.row(i) /= length;
    }
    free_ = split_directions(conditions, max_dependence).kernel;
  }

  void find_rates(const Model& model, const State& state) {
    const Index size = axes_.cols();
    const LeastNorm from_places(places_);
    Matrix y_rates(2 * size, free_.cols());
    for (Index i = 0; i < free_.cols(); ++i) {
      const Vector y = free_.col(i);
      Vector direction(places_.rows() + size);
      direction << places_ * y.head(size), axes_ * y.tail(size);
      const Vector change = nearby_.change_of_rate(direction);
      const Vector place = change.head(places_.rows()) - places_rate_ * y.head(size);
      const Vector velocity = change.tail(size) - axes_rate_ * y.tail(size);
      y_rates.col(i) << from_places.solve(place), solve_linear_equations(axes_, velocity);
    }
    rates_ = free_.transpose() * y_rates;
    stiffness_ = (y_rates.bottomRows(size) * free_.topRows(size).transpose()).norm();
    const double off = (y_rates - free_ * rates_).norm();
    if (!(off <= max_unsteadiness * y_rates.norm())) {
      refuse_unsteady(model, state, "the directions that its constraints leave free change along the motion");
    }
  }

  /// Forces that are each 0, as those on a pendulum that hangs, are compared with those nearby.
  double size_of_acceleration() const {
    const double reach = std::max(1.0, nearby_.q().lpNorm<Eigen::Infinity>());
    return nearby_.size_of_acceleration() + stiffness_ * reach * nearby_.weights().maxCoeff();
  }

  NearbyStates nearby_;
  double stiffness_ = 0;  // change of S W accelerations by positions [1/s^2]
  Matrix axes_;           // S W (n x n)
  Matrix axes_rate_;      // S' W
  Matrix places_;         // B S W (N x n)
  Matrix places_rate_;    // (B S)' W
  Matrix free_;
  Matrix rates_;
};

/// A in units in which positions and velocities of the fastest mode are alike, and without dimension.
class ScaledRates {
 public:
  explicit ScaledRates(const SteadyMotion& motion) : rates_(motion.rates()) {
    if (rates_.size() == 0) return;
    fastest_ = eigenvalues(rates_).cwiseAbs().maxCoeff();
    if (!(fastest_ > 0)) return;
    Matrix scaled = motion.free();
    scaled.bottomRows(scaled.rows() / 2) /= fastest_;
    metric_.compute(scaled.transpose() * scaled);  // L L^T; the scaled directions are L^T z
    Matrix transposed = rates_.transpose() / fastest_;
    metric_.solve_l(transposed);
    rates_ = transposed.transpose();
    for (Index i = 0; i < rates_.cols(); ++i) {
      Eigen::VectorXd column = metric_.l().triangularView<Eigen::Lower>().transpose() * rates_.col(i);
      rates_.col(i) = column;
    }
  }
  double fastest() const { return fastest_; }  ///< [1/s]
  const Matrix& rates() const { return rates_; }
  /// The directions z of scaled ones (k x m).
  Eigen::MatrixXcd unscaled(const Eigen::MatrixXcd& scaled) const {
    Matrix real = scaled.real();
    Matrix imaginary = scaled.imag();
    for (Index i = 0; i < scaled.cols(); ++i) {
      metric_.solve_l_transposed(real.col(i));
      metric_.solve_l_transposed(imaginary.col(i));
    }
    Eigen::MatrixXcd z(scaled.rows(), scaled.cols());
    z.real() = real;
    z.imag() = imaginary;
    return z;
  }

 private:
  Matrix rates_;
  Cholesky metric_;
  double fastest_ = 0;
};

/// Orthonormal directions N in which A^j N = 0 for some j, and the others: (N, P)^T A (N, P) has the blocks
/// (nilpotent, A12; 0, A22).
SplitDirections split_neutral(const Matrix& rates) {
  const Index size = rates.cols();
  SplitDirections split{Matrix(size, 0), Matrix::Identity(size, size)};
  while (split.rest.cols() > 0) {
    const Matrix left = split.rest.transpose() * rates * split.rest;
    const SplitDirections next = split_directions(left, max_zero);
    if (next.kernel.cols() == 0) break;
    Matrix neutral(size, split.kernel.cols() + next.kernel.cols());
    neutral << split.kernel, split.rest * next.kernel;
    split = {neutral, split.rest * next.rest};
  }
  return split;
}

/// Eigenvectors of A (k x m) for those of A22.
Eigen::MatrixXcd lifted(const Matrix& rates, const SplitDirections& split, const Eigenvectors& found) {
  const Index neutral = split.kernel.cols();
  const Matrix first = split.kernel.transpose() * rates * split.kernel;
  const Matrix second = split.kernel.transpose() * rates * split.rest;
  Eigen::MatrixXcd all(rates.cols(), found.values.size());
  for (Index i = 0; i < found.values.size(); ++i) {
    const Eigen::VectorXcd u = found.vectors.col(i);
    all.col(i) = split.rest * u;
    if (neutral == 0) continue;
    Eigen::MatrixXcd shifted = -first;
    shifted.diagonal().array() += found.values[i];
    all.col(i) += split.kernel * ComplexLu(shifted).solve(second * u);
  }
  return all;
}

/// The order of Modes::eigenvalues.
std::vector<Index> descending(const Eigen::VectorXcd& values) {
  std::vector<Index> order(static_cast<std::size_t>(values.size()));
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<Index>(i);
  // A pair has equal real parts and stands together.
  std::stable_sort(order.begin(), order.end(), [&](Index a, Index b) {
    if (values[a].real() != values[b].real()) return values[a].real() > values[b].real();
    return std::abs(values[a].imag()) > std::abs(values[b].imag());
  });
  return order;
}

}  // namespace

Modes modes(const Model& model, const State& state) {
  check(model);
  check_state(model, state);
  const SteadyMotion motion(model, state);
  const ScaledRates scaled(motion);
  Modes result;
  const SplitDirections split = split_neutral(scaled.rates());
  result.neutral = split.kernel.cols();
  const Eigenvectors found = eigenvectors(split.rest.transpose() * scaled.rates() * split.rest);
  const Index count = found.values.size();
  result.eigenvalues.resize(count);
  result.vectors.resize(state.q.size() + state.v.size(), count);
  if (count == 0) return result;
  const Eigen::MatrixXcd vectors =
      motion.in_coordinates(scaled.unscaled(lifted(scaled.rates(), split, found)));
  const std::vector<Index> order = descending(found.values);
  for (Index i = 0; i < count; ++i) {
    const Index from = order[static_cast<std::size_t>(i)];
    result.eigenvalues[i] = scaled.fastest() * found.values[from];
    result.vectors.col(i) = vectors.col(from).normalized();
  }
  return result;
}

}  // namespace hybrid_sphere::mechanics

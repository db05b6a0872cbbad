#pragma once

#include <Eigen/Core>
#include <functional>
#include <memory>
#include <vector>

#include "hybrid_sphere/numerical_error.hpp"
#include "integration/radau.hpp"
#include "mechanics/decompositions/complex_lu.hpp"

namespace hybrid_sphere::mechanics {

/// The integration finds no step that is accurate enough.
class StepError : public NumericalError {
 public:
  using NumericalError::NumericalError;
};

/// What an implicit step from a node needs besides the node; nodes may share it.
struct ImplicitStart {
  /// Throws NumericalError if the Jacobian is not finite.
  ImplicitStart(Eigen::MatrixXd jacobian_, Eigen::VectorXd scale_);

  Eigen::MatrixXd jacobian;  ///< of the rates of q and v, at the node or at one before it (N + n)^2
  Eigen::VectorXd scale;     ///< of q and v, > 0 (N + n)
  double fastest_rate = 0;   ///< the largest eigenvalue of the Jacobian in size [1/s]
  bool decays = false;       ///< whether that is one of a decay
};

/// Steps of Radau's method IIA of order 9, for the motion of q and v and for guards that are integrated
/// beside it. Newton's iterations go on to rounding, so that a step depends on nothing but where it starts
/// and its length.
class ImplicitStep {
 public:
  /// The rates at (x, y): of q and v and, behind them, of the guards.
  using Derivative =
      std::function<void(double x, const Eigen::VectorXd& y, Eigen::Ref<Eigen::VectorXd> slope)>;

  /// From y to x + h.
  /// @param y  q, v and the guards
  /// Throws StepError where Newton's iterations do not converge, and what `derivative` throws.
  void take(const Derivative& derivative, const std::shared_ptr<const ImplicitStart>& start, double x,
            const Eigen::VectorXd& y, double h);

  // Of the step taken last:
  const Eigen::VectorXd& end() const { return end_; }  ///< y(x + h)
  /// The difference to a method of order 5, without what a fast damper takes away from it.
  /// @param slope  rates at (x, y)
  void estimate_error(const Derivative& derivative, const Eigen::VectorXd& slope,
                      Eigen::VectorXd& difference);
  /// By what factor the last of Newton's iterations but one has come nearer.
  double contraction() const { return contraction_; }
  /// q and v at x, to the order 5, by collocation.
  void interpolate(double x, Eigen::Ref<Eigen::VectorXd> y) const;

 private:
  using Stages = Eigen::Matrix<double, Eigen::Dynamic, integration::Radau::stages>;

  void decompose(const std::shared_ptr<const ImplicitStart>& start, double h);
  void evaluate_stages(const Derivative& derivative);
  double improve();
  Eigen::VectorXd without_fast_part(const Eigen::VectorXd& difference) const;

  std::shared_ptr<const ImplicitStart> start_;
  double x_ = 0;
  double h_ = 0;
  Eigen::VectorXd y_;
  Stages changes_;  // of y up to the stages
  Stages slopes_;
  Eigen::VectorXd end_;
  double contraction_ = 0;
  std::vector<ComplexLu> matrices_;  // eigenvalue/h - J, of those with Im >= 0
};

}  // namespace hybrid_sphere::mechanics

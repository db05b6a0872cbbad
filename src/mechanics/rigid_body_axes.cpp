// The axes of steady motions of rigid bodies.
#include <algorithm>
#include <cmath>

#include "mechanics/decompositions/cholesky.hpp"
#include "mechanics/rigid_body_equations.hpp"

namespace hybrid_sphere::mechanics {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Least squares for three unknowns.
class LeastSquares {
 public:
  void add(double weight, const Matrix3d& a, const Vector3d& b) {
    square_ += weight * a.transpose() * a;
    right_side_ += weight * a.transpose() * b;
  }
  /// The shortest solution.
  Vector3d solve() const {
    constexpr double damping = 1e-10;  // parts of the matrix below 1e-5 of it are round-off
    constexpr int refinements = 3;     // each reduces the error by the damping
    const double size = square_.trace();
    if (!(size > 0)) return Vector3d::Zero();
    const Cholesky damped(Matrix(square_ + damping * size * Matrix3d::Identity()));
    Vector3d x = Vector3d::Zero();
    for (int i = 0; i < refinements; ++i) {
      Eigen::VectorXd change = right_side_ - square_ * x;
      damped.solve(change);
      x += change;
    }
    return x;
  }

 private:
  Matrix3d square_ = Matrix3d::Zero();
  Vector3d right_side_ = Vector3d::Zero();
};

/// [e] I - I [e] for each unit vector e: the rate of a tensor in the world that turns about e, as columns for
/// its row i.
Matrix3d turning_of_row(const Matrix3d& inertia, Index i) {
  Matrix3d columns;
  for (Index j = 0; j < 3; ++j) {
    const Matrix3d cross = cross_matrix(Vector3d::Unit(j));
    columns.col(j) = (cross * inertia - inertia * cross).row(i);
  }
  return columns;
}

}  // namespace

/// W satisfies x'' = W x x', w' = W x w, and (W - w) turns no tensor of inertia.
Eigen::Vector3d RigidBodyEquations::turning_of_motion(const Vector& q, const Vector& v,
                                                      const Vector& acceleration) const {
  double fastest = 0;
  for (Index i = 0; i < count(); ++i) {
    fastest = std::max(fastest, v.segment<3>(body_velocities * i + 3).squaredNorm());
  }
  if (!(fastest > 0)) return Vector3d::Zero();
  LeastSquares equations;
  for (Index i = 0; i < count(); ++i) {
    const Index place = body_velocities * i;
    const Matrix3d R = BodyMotion::at(i, q).R;
    const Matrix3d inertia = R * body(i).inertia * R.transpose();
    const double moment = inertia.trace();
    const Vector3d w = R * v.segment<3>(place + 3);
    equations.add(body(i).mass, -cross_matrix(v.segment<3>(place)), acceleration.segment<3>(place));
    equations.add(moment, -cross_matrix(w), R * acceleration.segment<3>(place + 3));
    if (!(moment > 0)) continue;
    for (Index row = 0; row < 3; ++row) {
      const Matrix3d turned = turning_of_row(inertia, row);
      equations.add(fastest / moment, turned, turned * w);
    }
  }
  return equations.solve();
}

void RigidBodyEquations::steady_axes(const Vector& q, const Vector& v, const Vector& acceleration,
                                     Matrix& axes, Matrix& axes_rate) const {
  axes.setIdentity(velocities(), velocities());
  axes_rate.setZero(velocities(), velocities());
  const Matrix3d turning = cross_matrix(turning_of_motion(q, v, acceleration));
  for (Index i = 0; i < count(); ++i) {
    const Index place = body_velocities * i;
    const Matrix3d R = BodyMotion::at(i, q).R;
    const Matrix3d spin = cross_matrix(R * v.segment<3>(place + 3));
    axes_rate.block<3, 3>(place, place) = turning;
    axes.block<3, 3>(place + 3, place + 3) = R.transpose();
    axes_rate.block<3, 3>(place + 3, place + 3) = R.transpose() * (turning - spin);
  }
}

}  // namespace hybrid_sphere::mechanics

#pragma once

#include <chrono>
#include <cmath>
#include <vector>

#include <Eigen/Core>

namespace engine_costs {

/// The accelerations of a chain of bars on hinges with the y axis, of 1 m and 1 kg each, by the algorithm of
/// articulated bodies, written by hand in space: what a program for trees of bodies alone does.
/// Source: R. Featherstone, Rigid Body Dynamics Algorithms (2008), table 7.1.
class ArticulatedChain {
 public:
  using Vector6 = Eigen::Matrix<double, 6, 1>;  // angular part first
  using Matrix6 = Eigen::Matrix<double, 6, 6>;

  const double mass = 1;                                           // [kg]
  const Eigen::Vector3d inertia{0.02 / 12, 1.01 / 12, 1.01 / 12};  // about the centre [kg m^2]

  ArticulatedChain(int bars, double gravity) : gravity_(gravity), links_(std::size_t(bars)) {
    const Eigen::Matrix3d arm = cross({0.5, 0, 0});
    inertia_ << Eigen::Matrix3d(inertia.asDiagonal()) + mass * arm * arm.transpose(), mass * arm,
        mass * arm.transpose(), mass * Eigen::Matrix3d::Identity();
  }

  /// @param angles  of each bar to the one before it [rad] @param rates  of them [rad/s]
  /// @param accelerations  of them [rad/s^2]
  void evaluate(const Eigen::VectorXd& angles, const Eigen::VectorXd& rates,
                Eigen::VectorXd& accelerations) const {
    Vector6 velocity = Vector6::Zero();
    for (std::size_t i = 0; i < links_.size(); ++i) {
      Link& link = links_[i];
      const auto k = Eigen::Index(i);
      link.transform = to_next(angles[k], i == 0 ? 0 : 1);
      velocity = link.transform * velocity;
      velocity[axis] += rates[k];
      link.bias_acceleration = motion_cross(velocity).col(axis) * rates[k];
      link.articulated = inertia_;
      link.bias_force = -motion_cross(velocity).transpose() * (inertia_ * velocity);
    }
    for (std::size_t i = links_.size(); i-- > 0;) {
      Link& link = links_[i];
      link.U = link.articulated.col(axis);
      link.rest = -link.bias_force[axis];
      if (i == 0) break;
      const Matrix6 I = link.articulated - link.U * link.U.transpose() / link.U[axis];
      const Vector6 p = link.bias_force + I * link.bias_acceleration + link.U * (link.rest / link.U[axis]);
      links_[i - 1].articulated += link.transform.transpose() * I * link.transform;
      links_[i - 1].bias_force += link.transform.transpose() * p;
    }
    Vector6 acceleration = Vector6::Zero();
    acceleration[5] = gravity_;  // the ground accelerates upwards instead
    for (std::size_t i = 0; i < links_.size(); ++i) {
      const Link& link = links_[i];
      acceleration = link.transform * acceleration + link.bias_acceleration;
      const auto k = Eigen::Index(i);
      accelerations[k] = (link.rest - link.U.dot(acceleration)) / link.U[axis];
      acceleration[axis] += accelerations[k];
    }
  }

  /// The mean over many, each at the state to which the last one has led.
  double seconds_of_an_evaluation() const {
    constexpr int count = 20000;
    constexpr double step = 1e-4;  // [s]
    const auto n = Eigen::Index(links_.size());
    Eigen::VectorXd angles = Eigen::VectorXd::Zero(n), rates = angles, accelerations = angles;
    const auto begin = std::chrono::steady_clock::now();
    for (int i = 0; i < count; ++i) {
      evaluate(angles, rates, accelerations);
      rates += step * accelerations;
      angles += step * rates;
    }
    const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - begin;
    return passed.count() / count;
  }

 private:
  static constexpr int axis = 1;  // of the hinges: y

  struct Link {
    Matrix6 transform, articulated;
    Vector6 bias_acceleration, bias_force, U;
    double rest = 0;
  };

  static Eigen::Matrix3d cross(const Eigen::Vector3d& r) {
    Eigen::Matrix3d matrix;
    matrix << 0, -r.z(), r.y(), r.z(), 0, -r.x(), -r.y(), r.x(), 0;
    return matrix;
  }

  /// Transforms motions from the frame at the hinge before to that at the next one, `length` along its x
  /// axis.
  static Matrix6 to_next(double angle, double length) {
    Eigen::Matrix3d E;
    E << std::cos(angle), 0, -std::sin(angle), 0, 1, 0, std::sin(angle), 0, std::cos(angle);
    Matrix6 transform = Matrix6::Zero();
    transform.topLeftCorner<3, 3>() = transform.bottomRightCorner<3, 3>() = E;
    transform.bottomLeftCorner<3, 3>() = -E * cross({length, 0, 0});
    return transform;
  }

  static Matrix6 motion_cross(const Vector6& v) {
    Matrix6 matrix = Matrix6::Zero();
    matrix.topLeftCorner<3, 3>() = matrix.bottomRightCorner<3, 3>() = cross(v.head<3>());
    matrix.bottomLeftCorner<3, 3>() = cross(v.tail<3>());
    return matrix;
  }

  double gravity_;
  Matrix6 inertia_;  // of a bar about its hinge
  mutable std::vector<Link> links_;
};

}  // namespace engine_costs

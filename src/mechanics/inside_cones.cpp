#include "mechanics/inside_cones.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "interrupt/interrupt.hpp"
#include "mechanics/decompositions/pivoted_qr.hpp"

namespace hybrid_sphere::mechanics {
namespace {

constexpr double barrier_part = 0.01;  // of the barrier: an x that is well inside stays about where it is

bool are_around(const std::vector<SecondOrderCone>& cones, const Vector& x) {
  return std::all_of(cones.begin(), cones.end(), [&](const SecondOrderCone& cone) {
    return cone.u + cone.s.dot(x) > (cone.w + cone.B * x).norm();
  });
}

/// Minimises weights (x - target)^2/2 - sum log(u^2 - w^2) by Newton's method with damped steps. With the
/// eigenvalues u + abs(w) and u - abs(w) of a cone, its Hessian is a sum of squares, J^T J: by J, thin
/// insides do not cost half of the digits.
class Barrier {
 public:
  Barrier(const std::vector<SecondOrderCone>& cones, Vector target, Vector weights)
      : cones_(cones), target_(std::move(target)), weights_(std::move(weights)) {}

  Vector& weights() { return weights_; }

  /// @param x  in: inside of the cones @return  the decrement: how far off the minimum x was, before
  double step(Vector& x) {
    constexpr double near = 0.25;  // where Newton's method converges quadratically
    differentiate(x);
    qr_.compute(jacobian_);
    Vector change = qr_.solve(right_);
    const double decrement = (jacobian_ * change).norm();
    if (!(decrement > 0 && std::isfinite(decrement))) return 0;
    if (decrement > near) change /= 1 + decrement;
    // It stays inside but for rounding.
    for (int halvings = 0; !are_around(cones_, x + change); ++halvings) {
      if (halvings == std::numeric_limits<double>::digits) return 0;
      change /= 2;
    }
    x += change;
    return decrement;
  }

 private:
  /// J and right-hand sides r: the step minimises abs(J step - r).
  void differentiate(const Vector& x) {
    const Index k = x.size();
    Index rows = k;
    for (const SecondOrderCone& cone : cones_) rows += std::max<Index>(2, cone.w.size() + 1);
    jacobian_.setZero(rows, k);
    right_.setZero(rows);
    jacobian_.topRows(k) = weights_.cwiseSqrt().asDiagonal();
    right_.head(k) = weights_.cwiseSqrt().cwiseProduct(target_ - x);
    Index row = k;
    for (const SecondOrderCone& cone : cones_) {
      const double u = cone.u + cone.s.dot(x);
      const Vector w = cone.w + cone.B * x;
      const double length = w.norm();
      Vector along = Vector::Zero(k);
      if (w.size() > 0) {
        const Vector direction = length > 0 ? Vector(w / length) : Vector(Vector::Unit(w.size(), 0));
        along = cone.B.transpose() * direction;
        if (w.size() == 2) {
          const Eigen::Vector2d across(-direction[1], direction[0]);
          jacobian_.row(row + 2) = std::sqrt(2 / ((u + length) * (u - length))) * across.transpose() * cone.B;
        }
      }
      jacobian_.row(row) = (cone.s + along).transpose() / (u + length);
      jacobian_.row(row + 1) = (cone.s - along).transpose() / (u - length);
      right_.segment<2>(row).setOnes();
      row += std::max<Index>(2, w.size() + 1);
    }
  }

  const std::vector<SecondOrderCone>& cones_;
  Vector target_;
  Vector weights_;
  Matrix jacobian_;
  Vector right_;
  PivotedQr qr_;
};

/// Cones of (x, r) that are wider by r.
std::vector<SecondOrderCone> widened(const std::vector<SecondOrderCone>& cones) {
  std::vector<SecondOrderCone> all = cones;
  for (SecondOrderCone& cone : all) {
    const Index k = cone.s.size();
    cone.s.conservativeResize(k + 1);
    cone.s[k] = 1;
    cone.B.conservativeResize(cone.B.rows(), k + 1);
    cone.B.col(k).setZero();
  }
  return all;
}

/// An x inside of the cones; if there is none, that for which they must be widened least.
Vector any_inside(const std::vector<SecondOrderCone>& cones, Index dimensions) {
  constexpr double finest = 1e-15;  // of the widening
  constexpr double rough = 0.1;     // decrement with which the next, finer problem begins
  constexpr int most = 50;          // steps of one problem; ten are usual
  Vector x = Vector::Zero(dimensions + 1);
  for (const SecondOrderCone& cone : cones) x[dimensions] = std::max(x[dimensions], cone.w.norm() - cone.u);
  x[dimensions] += 0.1;
  const std::vector<SecondOrderCone> wide = widened(cones);
  // The widening is drawn to -1, beyond what the units allow.
  Barrier barrier(wide, -Vector::Unit(dimensions + 1, dimensions), Vector::Ones(dimensions + 1));
  for (double fineness = 1; fineness > finest; fineness /= 10) {
    interruption_point();
    barrier.weights()[dimensions] = 1 / fineness;
    for (int i = 0; i < most; ++i) {
      const double decrement = barrier.step(x);
      if (are_around(cones, x.head(dimensions)) || !(decrement > rough)) break;
    }
    if (are_around(cones, x.head(dimensions))) break;
  }
  return x.head(dimensions);
}

}  // namespace

Vector inside_cones(const std::vector<SecondOrderCone>& cones, Index dimensions) {
  constexpr double small = 1e-3;  // decrement from which on it must become less
  constexpr int most = 100;
  Vector x = Vector::Zero(dimensions);
  if (!are_around(cones, x)) x = any_inside(cones, dimensions);
  if (!are_around(cones, x)) return x;
  Barrier barrier(cones, Vector::Zero(dimensions), Vector::Constant(dimensions, 1 / barrier_part));
  double before = std::numeric_limits<double>::infinity();
  for (int i = 0; i < most; ++i) {
    const double decrement = barrier.step(x);
    if (!(decrement > 0) || (decrement < small && !(decrement < 0.5 * before))) break;
    before = decrement;
  }
  return x;
}

}  // namespace hybrid_sphere::mechanics

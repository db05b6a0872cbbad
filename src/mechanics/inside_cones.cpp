#include "mechanics/inside_cones.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "interrupt/interrupt.hpp"
#include "mechanics/decompositions/cholesky.hpp"

namespace hybrid_sphere::mechanics {
namespace {

constexpr double part = 0.01;  // of the barrier: an x that is well inside stays about where it is

bool are_around(const std::vector<SecondOrderCone>& cones, const Vector& x) {
  return std::all_of(cones.begin(), cones.end(), [&](const SecondOrderCone& cone) {
    const double u = cone.u + cone.s.dot(x);
    return u > 0 && u * u > (cone.w + cone.B * x).squaredNorm();
  });
}

/// Minimises linear x + x diagonal x/2 - sum log(u^2 - w^2) by Newton's method with damped steps.
class Barrier {
 public:
  Barrier(const std::vector<SecondOrderCone>& cones, Vector linear, Vector diagonal)
      : cones_(cones), linear_(std::move(linear)), diagonal_(std::move(diagonal)) {}

  Vector& linear() { return linear_; }

  /// @param x  in: inside of the cones @return  the decrement: how far off the minimum x was, before
  double step(Vector& x) {
    constexpr double near = 0.25;  // where Newton's method converges quadratically
    differentiate(x);
    if (!cholesky_.compute(hessian_)) return 0;
    change_ = -gradient_;
    cholesky_.solve(change_);
    const double square = -gradient_.dot(change_);
    if (!(square > 0)) return 0;
    const double decrement = std::sqrt(square);
    if (decrement > near) change_ /= 1 + decrement;
    // It stays inside but for rounding.
    for (int halvings = 0; !are_around(cones_, x + change_); ++halvings) {
      if (halvings == std::numeric_limits<double>::digits) return 0;
      change_ /= 2;
    }
    x += change_;
    return decrement;
  }

 private:
  void differentiate(const Vector& x) {
    gradient_ = linear_ + diagonal_.cwiseProduct(x);
    hessian_ = diagonal_.asDiagonal();
    for (const SecondOrderCone& cone : cones_) {
      const double u = cone.u + cone.s.dot(x);
      w_ = cone.w + cone.B * x;
      const double inside = u * u - w_.squaredNorm();
      rate_.noalias() = (u / inside) * cone.s;
      rate_.noalias() -= cone.B.transpose() * w_ / inside;
      gradient_ -= 2 * rate_;
      hessian_.noalias() += 4 * rate_ * rate_.transpose();
      hessian_.noalias() -= (2 / inside) * cone.s * cone.s.transpose();
      hessian_.noalias() += (2 / inside) * cone.B.transpose() * cone.B;
    }
  }

  const std::vector<SecondOrderCone>& cones_;
  Vector linear_;
  Vector diagonal_;
  Vector gradient_;
  Matrix hessian_;
  Cholesky cholesky_;
  Vector change_;
  Vector w_;
  Vector rate_;
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
  Vector diagonal = Vector::Ones(dimensions + 1);
  diagonal[dimensions] = 0;
  const std::vector<SecondOrderCone> wide = widened(cones);
  Barrier barrier(wide, Vector::Zero(dimensions + 1), diagonal);
  for (double fineness = 1; fineness > finest; fineness /= 10) {
    interruption_point();
    barrier.linear()[dimensions] = 1 / fineness;
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
  Barrier barrier(cones, Vector::Zero(dimensions), Vector::Constant(dimensions, 1 / part));
  double before = std::numeric_limits<double>::infinity();
  for (int i = 0; i < most; ++i) {
    const double decrement = barrier.step(x);
    if (!(decrement > 0) || (decrement < small && !(decrement < 0.5 * before))) break;
    before = decrement;
  }
  return x;
}

}  // namespace hybrid_sphere::mechanics

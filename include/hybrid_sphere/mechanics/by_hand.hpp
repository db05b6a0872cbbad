#pragma once

#include <cmath>
#include <limits>
#include <memory>
#include <utility>

#include "hybrid_sphere/mechanics/constraint.hpp"
#include "hybrid_sphere/mechanics/equations_of_motion.hpp"

namespace hybrid_sphere::mechanics {

/// Equations of motion whose terms a user function fills in.
/// @code
/// const auto equations = mechanics::equations_by_hand(
///     1, 1,
///     [](double, const mechanics::Vector&, const mechanics::Vector& v, mechanics::MotionTerms& terms) {
///       terms.lagrangian = v[0] * v[0] / 2;
///       terms.rate = terms.momentum = v;
///       terms.mass.setOnes();
///       terms.force.setZero();
///     });
/// @endcode
template <class Function>
class EquationsByHand final : public EquationsOfMotion {
 public:
  EquationsByHand(Index coordinates, Index velocities, Function fill)
      : coordinates_(coordinates), velocities_(velocities), fill_(std::move(fill)) {}

  Index coordinates() const override { return coordinates_; }
  Index velocities() const override { return velocities_; }

  void evaluate(double t, const Vector& q, const Vector& v, MotionTerms& terms) const override {
    fill(t, q, v, terms);
    if (!(std::isfinite(terms.lagrangian) && is_finite(terms.rate) && is_finite(terms.momentum) &&
          is_finite(terms.mass) && is_finite(terms.force))) {
      throw NotFinite("equations by hand");
    }
  }

  void momentum(double t, const Vector& q, const Vector& v, Vector& p, Matrix& mass) const override {
    MotionTerms terms;
    evaluate(t, q, v, terms);
    p = terms.momentum;
    mass = terms.mass;
  }

  /// The rate does not depend on the time; the other terms may be undefined at the time used here.
  void rate(const Vector& q, const Vector& v, Vector& rate) const override {
    MotionTerms terms;
    fill(0, q, v, terms);
    if (!is_finite(terms.rate)) throw NotFinite("rate of equations by hand");
    rate = terms.rate;
  }

 private:
  static constexpr double unset = std::numeric_limits<double>::quiet_NaN();

  void fill(double t, const Vector& q, const Vector& v, MotionTerms& terms) const {
    terms.lagrangian = unset;
    terms.rate.setConstant(coordinates_, unset);
    terms.momentum.setConstant(velocities_, unset);
    terms.mass.setConstant(velocities_, velocities_, unset);
    terms.force.setConstant(velocities_, unset);
    fill_(t, q, v, terms);
  }

  Index coordinates_;
  Index velocities_;
  Function fill_;
};

/// @param fill  void(double t, const Vector& q (N), const Vector& v (n), MotionTerms& terms); every field of
///              terms already has its size and must be set
template <class Function>
std::shared_ptr<const EquationsOfMotion> equations_by_hand(Index coordinates, Index velocities,
                                                           Function fill) {
  return std::make_shared<EquationsByHand<Function>>(coordinates, velocities, std::move(fill));
}

/// Constraints whose terms user functions fill in.
template <class Function, class Curvature>
class ConstraintByHand final : public ConstraintFunction {
 public:
  ConstraintByHand(Index size, Function fill, Curvature curvature)
      : size_(size), fill_(std::move(fill)), curvature_(std::move(curvature)) {}

  Index size() const override { return size_; }

  void evaluate(double t, const Vector& q, const Vector& v, const Vector& rate,
                ConstraintTerms& terms) const override {
    terms.value.setConstant(size_, unset);
    terms.gradient.setConstant(size_, v.size(), unset);
    terms.gamma.setConstant(size_, unset);
    fill_(t, q, v, rate, terms);
    if (!(is_finite(terms.value) && is_finite(terms.gradient) && is_finite(terms.gamma))) {
      throw NotFinite("constraint by hand");
    }
  }

  void evaluate(double t, const Vector& q, const Vector& v, Vector& value, Matrix& gradient) const override {
    ConstraintTerms terms;
    evaluate(t, q, v, Vector::Zero(q.size()), terms);
    value = terms.value;
    gradient = terms.gradient;
  }

  void add_curvature(double t, const Vector& q, const Vector& v, const Vector& multipliers,
                     Matrix& sum) const override {
    curvature_(t, q, v, multipliers, sum);
  }

 private:
  static constexpr double unset = std::numeric_limits<double>::quiet_NaN();

  Index size_;
  Function fill_;
  Curvature curvature_;
};

/// Constraints that are nonlinear in v.
/// @param fill       void(double t, const Vector& q, const Vector& v, const Vector& rate, ConstraintTerms&
///                   terms); every field of terms already has its size and must be set
/// @param curvature  void(double t, const Vector& q, const Vector& v, const Vector& multipliers,
///                   Matrix& sum), see ConstraintFunction::add_curvature
template <class Function, class Curvature>
std::shared_ptr<const ConstraintFunction> constraint_by_hand(Index size, Function fill, Curvature curvature) {
  return std::make_shared<ConstraintByHand<Function, Curvature>>(size, std::move(fill), std::move(curvature));
}

/// Constraints that are linear in v.
template <class Function>
std::shared_ptr<const ConstraintFunction> constraint_by_hand(Index size, Function fill) {
  return constraint_by_hand(size, std::move(fill), [](auto&&...) {});
}

}  // namespace hybrid_sphere::mechanics

#pragma once

#include <memory>
#include <type_traits>
#include <utility>

#include "hybrid_sphere/mechanics/equations_of_motion.hpp"
#include "hybrid_sphere/mechanics/kinematics.hpp"
#include "hybrid_sphere/mechanics/lagrangian_terms.hpp"
#include "hybrid_sphere/mechanics/user_function.hpp"

namespace hybrid_sphere::mechanics {

/// Q = 0.
struct NoForces {};

/// Equations of motion from functions, differentiated exactly. Allocates nothing once the terms have their
/// sizes. Safe to use from several threads if the functions are. See automatic_equations().
/// @code
/// const auto equations = mechanics::automatic_equations<1>(
///     [](const auto& t, const auto& q, const auto& v) { return v[0] * v[0] / 2 - q[0] * q[0]; });
/// @endcode
template <int n, int N, class Kinematics, class L, class Forces>
class AutomaticEquations final : public EquationsOfMotion {
 public:
  AutomaticEquations(Kinematics kinematics, L lagrangian, Forces forces)
      : kinematics_(std::move(kinematics)), lagrangian_(std::move(lagrangian)), forces_(std::move(forces)) {}

  Index coordinates() const override { return N; }
  Index velocities() const override { return n; }

  void evaluate(double t, const Vector& q_any, const Vector& v_any, MotionTerms& terms) const override {
    const auto q = user_function::constants<double, N>("q", q_any);
    const auto v = user_function::constants<double, n>("v", v_any);
    terms.rate.resize(N);
    terms.momentum.resize(n);
    terms.mass.resize(n, n);
    terms.force.resize(n);
    const auto kinematics = kinematics_.terms(q, v);
    for (int i = 0; i < N; ++i) terms.rate.coeffRef(i) = kinematics.rate.coeff(i);
    lagrangian_.evaluate(t, q, v, kinematics, terms);
    kinematics.add_hamel(terms.momentum, terms.force);
    add_forces(t, q, v, terms.force);
    check(is_finite(terms.momentum) && is_finite(terms.force));
  }

  void momentum(double t, const Vector& q, const Vector& v, Vector& p, Matrix& mass) const override {
    lagrangian_.momentum(t, user_function::constants<double, N>("q", q),
                         user_function::constants<double, n>("v", v), p, mass);
    check(is_finite(p));
  }

  void rate(const Vector& q, const Vector& v, Vector& rate) const override {
    rate = kinematics_.rate(user_function::constants<double, N>("q", q),
                            user_function::constants<double, n>("v", v));
  }

  void directions(const Vector& q_any, const Vector& v_any, Matrix& directions,
                  Vector& drift) const override {
    const auto q = user_function::constants<double, N>("q", q_any);
    const auto v = user_function::constants<double, n>("v", v_any);
    const auto kinematics = kinematics_.terms(q, v);
    directions.resize(N, n);
    drift.resize(N);
    for (int i = 0; i < N; ++i) {
      for (int j = 0; j < n; ++j) directions(i, j) = kinematics.directions(i, j);
      drift.coeffRef(i) = kinematics.drift(i);
    }
  }

 private:
  static void check(bool finite) { user_function::check_derivative(finite, "lagrangian"); }

  void add_forces(double t, const user_function::VectorOf<double, N>& q,
                  const user_function::VectorOf<double, n>& v, Vector& sum) const {
    if constexpr (!std::is_same_v<Forces, NoForces>) {
      static_assert(std::is_invocable_v<const Forces&, const double&, decltype(q), decltype(v)>,
                    "the forces have to be a function Q(t, q, v)");
      user_function::ArrayOf<double, n> forces;
      user_function::convert<double, n, 1>(forces_(t, q, v), forces);
      user_function::check_value(are_finite(forces, n), "forces");
      for (int i = 0; i < n; ++i) sum.coeffRef(i) += forces[i];
    }
  }

  Kinematics kinematics_;
  DifferentiatedLagrangian<n, N, L> lagrangian_;
  Forces forces_;
};

/// The Lagrangian v^T M(t, q) v/2 - V(t, q), which is faster in this form than written out: M and V are
/// differentiated only once. Accepted wherever a Lagrangian is.
/// @param mass       M(t, q), a matrix (n x n, Eigen, fixed size); only its symmetric part counts
/// @param potential  V(t, q)
template <class Mass, class Potential>
MassMatrixLagrangian<Mass, Potential> with_mass_matrix(Mass mass, Potential potential) {
  return {std::move(mass), std::move(potential)};
}

/// Equations of motion for n velocities and n coordinates, q' = v.
///
/// Functions of (t, q, v) are called with a number t and vectors q and v (Eigen, fixed size) of that number's
/// type T: double, or a Dual. They return a number or a vector of T, or doubles and ints where the result is
/// constant. They may return an Eigen expression (`return 2.0 * v`) if it refers to nothing that is destroyed
/// on return; an expression of local variables, or of a temporary such as v.normalized(), needs an explicit
/// return type, -> Eigen::Matrix<T, n, 1>.
/// @param lagrangian  L(t, q, v), or with_mass_matrix(M, V)
/// @param forces      Q(t, q, v), a vector (n); called with doubles only
template <int n, class L, class Forces>
std::shared_ptr<const EquationsOfMotion> automatic_equations(L lagrangian, Forces forces) {
  using Kinematics = CoordinateVelocities<n>;
  return std::unique_ptr<const EquationsOfMotion>(new AutomaticEquations<n, n, Kinematics, L, Forces>(
      Kinematics(), std::move(lagrangian), std::move(forces)));
}
template <int n, class L>
std::shared_ptr<const EquationsOfMotion> automatic_equations(L lagrangian) {
  return automatic_equations<n>(std::move(lagrangian), NoForces());
}

/// Equations of motion for n quasi-velocities and N coordinates. Source: (15).
/// @param rate  q' as a function rate(q, v), linear in v, a vector (N); the n directions that it spans must
///              be independent and closed under brackets, as those of a rotation are
template <int n, int N, class Rate, class L, class Forces>
std::shared_ptr<const EquationsOfMotion> automatic_equations(Rate rate, L lagrangian, Forces forces) {
  using Kinematics = QuasiVelocities<n, N, Rate>;
  return std::unique_ptr<const EquationsOfMotion>(new AutomaticEquations<n, N, Kinematics, L, Forces>(
      Kinematics(std::move(rate)), std::move(lagrangian), std::move(forces)));
}
template <int n, int N, class Rate, class L>
std::shared_ptr<const EquationsOfMotion> automatic_equations(Rate rate, L lagrangian) {
  return automatic_equations<n, N>(std::move(rate), std::move(lagrangian), NoForces());
}

}  // namespace hybrid_sphere::mechanics

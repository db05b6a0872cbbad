#pragma once

#include <type_traits>
#include <utility>

#include "hybrid_sphere/mechanics/dual.hpp"
#include "hybrid_sphere/mechanics/user_function.hpp"

namespace hybrid_sphere::mechanics {

/// L and its derivatives at (t, q, v), where q' = W and v are the velocities along the n directions B_j.
/// @code
/// const auto stiffness = [](const mechanics::LagrangianTerms<1>& terms) { return terms.mass(0, 0); };
/// @endcode
template <int n>
struct LagrangianTerms {
  double lagrangian;                  ///< L
  Eigen::Matrix<double, n, 1> p;      ///< dL/dv
  Eigen::Matrix<double, n, n> mass;   ///< d2L/dv2
  Eigen::Matrix<double, n, 1> force;  ///< B_j . dL/dq - (dp/dq) W - dp/dt
};

template <int n>
Eigen::Matrix<double, n, n> symmetric_part(const Eigen::Matrix<double, n, n>& matrix) {
  return 0.5 * (matrix + matrix.transpose());
}

/// A Lagrangian v^T M(t, q) v/2 - V(t, q), see with_mass_matrix().
template <class Mass, class Potential>
struct MassMatrixLagrangian {
  Mass mass;
  Potential potential;
};

/// Differentiates L(t, q, v), n velocities and N coordinates.
template <int n, int N, class L>
class DifferentiatedLagrangian {
 public:
  explicit DifferentiatedLagrangian(L lagrangian) : lagrangian_(std::move(lagrangian)) {}

  /// @param directions  B (N x n) @param rate  W (N)
  template <class Directions>
  LagrangianTerms<n> terms(double t, const Eigen::Matrix<double, N, 1>& q,
                           const Eigen::Matrix<double, n, 1>& v, const Directions& directions,
                           const Eigen::Matrix<double, N, 1>& rate) const {
    // Outer derivatives: along v; inner derivatives: along v and along the motion (t + s, q + s W).
    using Inner = Dual<double, n + 1>;
    Eigen::Matrix<Inner, N, 1> moving = q.template cast<Inner>();
    for (int i = 0; i < N; ++i) moving[i].derivatives[n] = rate[i];
    Inner time = t;
    time.derivatives[n] = 1;
    const auto L2 = second_order(time, moving, v);

    LagrangianTerms<n> terms;
    terms.lagrangian = L2.value.value;
    Eigen::Matrix<double, n, n> mass;
    for (int i = 0; i < n; ++i) {
      terms.p[i] = L2.derivatives[i].value;
      mass.col(i) = L2.derivatives[i].derivatives.template head<n>();
      terms.force[i] = -L2.derivatives[i].derivatives[n];
    }
    terms.mass = symmetric_part<n>(mass);  // already symmetric, up to rounding
    terms.force += gradient(t, q, v, directions);
    user_function::check_derivative(terms.p.allFinite() && terms.mass.allFinite() && terms.force.allFinite(),
                                    name);
    return terms;
  }

  /// p and M.
  void momentum(double t, const Eigen::Matrix<double, N, 1>& q, const Eigen::Matrix<double, n, 1>& v,
                Vector& p, Matrix& mass) const {
    using Inner = Dual<double, n + 1>;  // as in terms(): halves what there is to compile
    const auto L2 = second_order(Inner(t), q.template cast<Inner>().eval(), v);
    Eigen::Matrix<double, n, n> second;
    p.resize(n);
    for (int i = 0; i < n; ++i) {
      p[i] = L2.derivatives[i].value;
      second.col(i) = L2.derivatives[i].derivatives.template head<n>();
    }
    const auto symmetric = symmetric_part<n>(second);
    mass.resize(n, n);
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < n; ++j) mass(i, j) = symmetric(i, j);
    }
    user_function::check_derivative(p.allFinite() && mass.allFinite(), name);
  }

 private:
  static constexpr const char* name = "lagrangian";

  template <class T>
  T call(const T& t, const Eigen::Matrix<T, N, 1>& q, const Eigen::Matrix<T, n, 1>& v) const {
    static_assert(std::is_invocable_v<const L&, decltype(t), decltype(q), decltype(v)>,
                  "the Lagrangian has to be a function L(t, q, v) of numbers of any type: [](const auto& t, "
                  "const auto& q, const auto& v)");
    const T result = user_function::to_number<T>(lagrangian_(t, q, v));
    user_function::check_value(std::isfinite(plain(result)), name);
    return result;
  }

  /// L with derivatives along v: outer ones in all directions, inner ones in the first n directions of Inner.
  template <class Inner>
  Dual<Inner, n> second_order(const Inner& t, const Eigen::Matrix<Inner, N, 1>& q,
                              const Eigen::Matrix<double, n, 1>& v) const {
    using T = Dual<Inner, n>;
    Eigen::Matrix<T, N, 1> coordinates;
    for (int i = 0; i < N; ++i) coordinates[i].value = q[i];
    Eigen::Matrix<T, n, 1> velocities = v.template cast<T>();
    for (int i = 0; i < n; ++i) {
      velocities[i].value.derivatives[i] = 1;
      velocities[i].derivatives[i] = 1;
    }
    T time;
    time.value = t;
    return call<T>(time, coordinates, velocities);
  }

  /// B_j . dL/dq
  template <class Directions>
  Eigen::Matrix<double, n, 1> gradient(double t, const Eigen::Matrix<double, N, 1>& q,
                                       const Eigen::Matrix<double, n, 1>& v,
                                       const Directions& directions) const {
    using T = Dual<double, n>;
    Eigen::Matrix<T, N, 1> coordinates = q.template cast<T>();
    for (int i = 0; i < N; ++i) coordinates[i].derivatives = directions.row(i);
    return call<T>(T(t), coordinates, v.template cast<T>()).derivatives;
  }

  L lagrangian_;
};

/// Differentiates M and V once; only the symmetric part of M is in L.
template <int n, int N, class Mass, class Potential>
class DifferentiatedLagrangian<n, N, MassMatrixLagrangian<Mass, Potential>> {
 public:
  explicit DifferentiatedLagrangian(MassMatrixLagrangian<Mass, Potential> lagrangian)
      : lagrangian_(std::move(lagrangian)) {}

  template <class Directions>
  LagrangianTerms<n> terms(double t, const Eigen::Matrix<double, N, 1>& q,
                           const Eigen::Matrix<double, n, 1>& v, const Directions& directions,
                           const Eigen::Matrix<double, N, 1>& rate) const {
    // Derivatives along the n directions, and along the motion (t + s, q + s W).
    using T = Dual<double, n + 1>;
    Eigen::Matrix<T, N, 1> coordinates = q.template cast<T>();
    for (int i = 0; i < N; ++i) {
      coordinates[i].derivatives.template head<n>() = directions.row(i);
      coordinates[i].derivatives[n] = rate[i];
    }
    T time = t;
    time.derivatives[n] = 1;
    const Eigen::Matrix<T, n, n> mass = call_mass<T>(time, coordinates);
    const T potential = call_potential<T>(time, coordinates);
    user_function::check_derivative(is_finite(potential), "potential");

    T lagrangian = -potential;
    Eigen::Matrix<double, n, n> value;
    Eigen::Matrix<double, n, n> change;
    for (int i = 0; i < n * n; ++i) {
      user_function::check_derivative(is_finite(mass(i)), "mass matrix");
      lagrangian += mass(i) * (0.5 * v[i / n] * v[i % n]);
      value(i) = mass(i).value;
      change(i) = mass(i).derivatives[n];
    }
    LagrangianTerms<n> terms;
    terms.lagrangian = lagrangian.value;
    terms.mass = symmetric_part<n>(value);
    terms.p = terms.mass * v;
    terms.force = lagrangian.derivatives.template head<n>() - symmetric_part<n>(change) * v;
    return terms;
  }

  void momentum(double t, const Eigen::Matrix<double, N, 1>& q, const Eigen::Matrix<double, n, 1>& v,
                Vector& p, Matrix& mass) const {
    const Eigen::Matrix<double, n, n> symmetric = symmetric_part<n>(call_mass<double>(t, q));
    mass = symmetric;
    p = symmetric * v;
  }

 private:
  template <class T>
  Eigen::Matrix<T, n, n> call_mass(const T& t, const Eigen::Matrix<T, N, 1>& q) const {
    static_assert(std::is_invocable_v<const Mass&, decltype(t), decltype(q)>,
                  "the mass matrix has to be a function M(t, q) of numbers of any type");
    const Eigen::Matrix<T, n, n> result = user_function::to_matrix<T, n, n>(lagrangian_.mass(t, q));
    for (int i = 0; i < n * n; ++i) {
      user_function::check_value(std::isfinite(plain(result(i))), "mass matrix");
    }
    return result;
  }

  template <class T>
  T call_potential(const T& t, const Eigen::Matrix<T, N, 1>& q) const {
    static_assert(std::is_invocable_v<const Potential&, decltype(t), decltype(q)>,
                  "the potential has to be a function V(t, q) of numbers of any type");
    const T result = user_function::to_number<T>(lagrangian_.potential(t, q));
    user_function::check_value(std::isfinite(plain(result)), "potential");
    return result;
  }

  MassMatrixLagrangian<Mass, Potential> lagrangian_;
};

}  // namespace hybrid_sphere::mechanics

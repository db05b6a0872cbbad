#pragma once

#include <algorithm>
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
    user_function::VectorOf<Inner, N> moving = q.template cast<Inner>();
    for (int i = 0; i < N; ++i) moving[i].derivatives[block] = rate[i];
    Inner time = t;
    time.derivatives[block] = 1;

    LagrangianTerms<n> terms;
    Eigen::Matrix<double, n, n> mass;
    differentiate_twice(time, moving, v, terms.p, mass, [&](int i, const Second& L2, const Inner& along_v) {
      terms.lagrangian = L2.value.value;
      terms.force[i] = -along_v.derivatives[block];
    });
    terms.mass = symmetric_part<n>(mass);  // already symmetric, up to rounding
    terms.force += gradient(t, q, v, directions);
    user_function::check_derivative(terms.p.allFinite() && terms.mass.allFinite() && terms.force.allFinite(),
                                    name);
    return terms;
  }

  /// p and M.
  void momentum(double t, const Eigen::Matrix<double, N, 1>& q, const Eigen::Matrix<double, n, 1>& v,
                Vector& p, Matrix& mass) const {
    Eigen::Matrix<double, n, n> second;
    p.resize(n);
    differentiate_twice(Inner(t), q.template cast<Inner>(), v, p, second,
                        [](int, const Second&, const Inner&) {});
    const auto symmetric = symmetric_part<n>(second);
    mass.resize(n, n);
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < n; ++j) mass(i, j) = symmetric(i, j);
    }
    user_function::check_derivative(p.allFinite() && mass.allFinite(), name);
  }

 private:
  static constexpr const char* name = "lagrangian";
  static constexpr int side = std::max(n, N);
  static constexpr int part = user_function::directions_at_once<user_function::FirstDerivatives, n, side>();
  static constexpr int block = user_function::directions_at_once<user_function::SecondDerivatives, n, side>();
  using Inner = Dual<double, block + 1>;
  using Second = Dual<Inner, block>;

  template <class T>
  T call(const T& t, const user_function::VectorOf<T, N>& q, const user_function::VectorOf<T, n>& v) const {
    static_assert(std::is_invocable_v<const L&, decltype(t), decltype(q), decltype(v)>,
                  "the Lagrangian has to be a function L(t, q, v) of numbers of any type: [](const auto& t, "
                  "const auto& q, const auto& v)");
    const T result = user_function::to_number<T>(lagrangian_(t, q, v));
    user_function::check_value(std::isfinite(plain(result)), name);
    return result;
  }

  /// p = dL/dv and d2L/dv2, a block of this after another; see(i, L2, along_v) for each velocity i besides:
  /// L2 is of a call that differentiates along velocity i, along_v its derivative along that.
  template <class P, class See>
  void differentiate_twice(const Inner& t, const user_function::VectorOf<Inner, N>& q,
                           const Eigen::Matrix<double, n, 1>& v, P& p, Eigen::Matrix<double, n, n>& mass,
                           See see) const {
    for (int row = 0; row < n; row += block) {
      for (int column = row; column < n; column += block) {
        const Second L2 = second_order(t, q, v, row, column);
        for (int i = row; i < n && i < row + block; ++i) {
          const Inner& along_v = L2.derivatives[i - row];
          for (int j = column; j < n && j < column + block; ++j) {
            mass(j, i) = along_v.derivatives[j - column];
            if (column != row) mass(i, j) = mass(j, i);
          }
          if (column != row) continue;
          p[i] = along_v.value;
          see(i, L2, along_v);
        }
      }
    }
  }

  /// L with derivatives along v: outer ones from velocity `outer` on, inner ones from `inner` on, beside
  /// those that t and q have.
  Second second_order(const Inner& t, const user_function::VectorOf<Inner, N>& q,
                      const Eigen::Matrix<double, n, 1>& v, int outer, int inner) const {
    user_function::VectorOf<Second, N> coordinates;
    for (int i = 0; i < N; ++i) coordinates[i].value = q[i];
    user_function::VectorOf<Second, n> velocities = v.template cast<Second>();
    for (int i = 0; i < block; ++i) {
      if (inner + i < n) velocities[inner + i].value.derivatives[i] = 1;
      if (outer + i < n) velocities[outer + i].derivatives[i] = 1;
    }
    Second time;
    time.value = t;
    return call<Second>(time, coordinates, velocities);
  }

  /// B_j . dL/dq
  template <class Directions>
  Eigen::Matrix<double, n, 1> gradient(double t, const Eigen::Matrix<double, N, 1>& q,
                                       const Eigen::Matrix<double, n, 1>& v,
                                       const Directions& directions) const {
    using T = Dual<double, part>;
    Eigen::Matrix<double, n, 1> gradient;
    user_function::each_part<n, part>([&](int first, auto count) {
      user_function::VectorOf<T, N> coordinates = q.template cast<T>();
      for (int i = 0; i < N; ++i) {
        coordinates[i].derivatives.template head<decltype(count)::value>() =
            directions.row(i).template segment<decltype(count)::value>(first);
      }
      const T value = call<T>(T(t), coordinates, v.template cast<T>());
      gradient.template segment<decltype(count)::value>(first) =
          value.derivatives.template head<decltype(count)::value>();
    });
    return gradient;
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
    // Derivatives along the directions, and along the motion (t + s, q + s W).
    LagrangianTerms<n> terms;
    Eigen::Matrix<double, n, n> value;
    Eigen::Matrix<double, n, n> change;
    user_function::each_part<n, part>([&](int first, auto part_size) {
      constexpr int count = decltype(part_size)::value;
      user_function::VectorOf<T, N> coordinates = q.template cast<T>();
      for (int i = 0; i < N; ++i) {
        coordinates[i].derivatives.template head<count>() = directions.row(i).template segment<count>(first);
        coordinates[i].derivatives[part] = rate[i];
      }
      const T lagrangian = differentiate(t, coordinates, v, value, change);
      terms.lagrangian = lagrangian.value;
      terms.force.template segment<count>(first) = lagrangian.derivatives.template head<count>();
    });
    terms.mass = symmetric_part<n>(value);
    terms.p = terms.mass * v;
    terms.force -= symmetric_part<n>(change) * v;
    return terms;
  }

  void momentum(double t, const Eigen::Matrix<double, N, 1>& q, const Eigen::Matrix<double, n, 1>& v,
                Vector& p, Matrix& mass) const {
    const Eigen::Matrix<double, n, n> symmetric = symmetric_part<n>(call_mass<double>(t, q));
    mass = symmetric;
    p = symmetric * v;
  }

 private:
  static constexpr int part =
      user_function::directions_at_once<user_function::FirstDerivatives, n, std::max(n, N)>();
  using T = Dual<double, part + 1>;

  /// L. @param coordinates  with derivatives along some directions, and along the motion
  /// @param value   receives M @param change  receives its derivative along the motion
  T differentiate(double t, const user_function::VectorOf<T, N>& coordinates,
                  const Eigen::Matrix<double, n, 1>& v, Eigen::Matrix<double, n, n>& value,
                  Eigen::Matrix<double, n, n>& change) const {
    T time = t;
    time.derivatives[part] = 1;
    const Eigen::Matrix<T, n, n> mass = call_mass<T>(time, coordinates);
    const T potential = call_potential<T>(time, coordinates);
    user_function::check_derivative(is_finite(potential), "potential");
    T lagrangian = -potential;
    for (int i = 0; i < n * n; ++i) {
      user_function::check_derivative(is_finite(mass(i)), "mass matrix");
      lagrangian += mass(i) * (0.5 * v[i / n] * v[i % n]);
      value(i) = mass(i).value;
      change(i) = mass(i).derivatives[part];
    }
    return lagrangian;
  }

  template <class Number>
  Eigen::Matrix<Number, n, n> call_mass(const Number& t, const user_function::VectorOf<Number, N>& q) const {
    static_assert(std::is_invocable_v<const Mass&, decltype(t), decltype(q)>,
                  "the mass matrix has to be a function M(t, q) of numbers of any type");
    const Eigen::Matrix<Number, n, n> result = user_function::to_matrix<Number, n, n>(lagrangian_.mass(t, q));
    for (int i = 0; i < n * n; ++i) {
      user_function::check_value(std::isfinite(plain(result(i))), "mass matrix");
    }
    return result;
  }

  template <class Number>
  Number call_potential(const Number& t, const user_function::VectorOf<Number, N>& q) const {
    static_assert(std::is_invocable_v<const Potential&, decltype(t), decltype(q)>,
                  "the potential has to be a function V(t, q) of numbers of any type");
    const auto result = user_function::to_number<Number>(lagrangian_.potential(t, q));
    user_function::check_value(std::isfinite(plain(result)), "potential");
    return result;
  }

  MassMatrixLagrangian<Mass, Potential> lagrangian_;
};

}  // namespace hybrid_sphere::mechanics

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
    LagrangianTerms<n> terms;
    user_function::VectorOf<T, N> moving = q.template cast<T>();
    for (int i = 0; i < N; ++i) moving[i].slopes[T::motion] = rate[i];
    T time = t;
    time.slopes[T::motion] = 1;
    Second::each_call([&](const auto& along) {
      for (int a = 0; a < Second::at_once; ++a) {
        for (int i = 0; i < N; ++i) {
          moving[i].slopes[T::first_of_further + a] = along[a] == Second::none ? 0 : directions(i, along[a]);
        }
      }
      const T result = call(time, moving, along_velocities(v, along));
      terms.lagrangian = result.value;
      set_momentum(result, along, terms.p, terms.mass);
      for (int a = 0; a < Second::at_once; ++a) {
        if (along[a] == Second::none) continue;
        terms.force[along[a]] = result.slopes[T::first_of_further + a] - result.second(a, T::motion);
      }
    });
    user_function::check_derivative(terms.p.allFinite() && terms.mass.allFinite() && terms.force.allFinite(),
                                    name);
    return terms;
  }

  /// p and M.
  void momentum(double t, const Eigen::Matrix<double, N, 1>& q, const Eigen::Matrix<double, n, 1>& v,
                Vector& p, Matrix& mass) const {
    p.resize(n);
    mass.resize(n, n);
    const user_function::VectorOf<T, N> coordinates = q.template cast<T>();
    Second::each_call([&](const auto& along) {
      set_momentum(call(T(t), coordinates, along_velocities(v, along)), along, p, mass);
    });
    user_function::check_derivative(p.allFinite() && mass.allFinite(), name);
  }

 private:
  static constexpr const char* name = "lagrangian";
  static constexpr int side = std::max(n, N);
  using Second = user_function::SecondDerivatives<n, side>;
  using T = typename Second::Number;

  T call(const T& t, const user_function::VectorOf<T, N>& q, const user_function::VectorOf<T, n>& v) const {
    static_assert(std::is_invocable_v<const L&, decltype(t), decltype(q), decltype(v)>,
                  "the Lagrangian has to be a function L(t, q, v) of numbers of any type: [](const auto& t, "
                  "const auto& q, const auto& v)");
    const T result = user_function::to_number<T>(lagrangian_(t, q, v));
    user_function::check_value(std::isfinite(plain(result)), name);
    return result;
  }

  template <class Along>
  static user_function::VectorOf<T, n> along_velocities(const Eigen::Matrix<double, n, 1>& v,
                                                        const Along& along) {
    user_function::VectorOf<T, n> velocities = v.template cast<T>();
    for (int a = 0; a < Second::at_once; ++a) {
      if (along[a] != Second::none) velocities[along[a]].slopes[a] = 1;
    }
    return velocities;
  }

  template <class Along, class P, class M>
  static void set_momentum(const T& lagrangian, const Along& along, P& p, M& mass) {
    for (int a = 0; a < Second::at_once; ++a) {
      if (along[a] == Second::none) continue;
      p[along[a]] = lagrangian.slopes[a];
      for (int b = a; b < Second::at_once; ++b) {
        if (along[b] != Second::none)
          mass(along[a], along[b]) = mass(along[b], along[a]) = lagrangian.second(a, b);
      }
    }
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

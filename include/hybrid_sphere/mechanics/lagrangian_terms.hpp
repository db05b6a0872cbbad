#pragma once

#include <algorithm>
#include <type_traits>
#include <utility>

#include "hybrid_sphere/mechanics/dual.hpp"
#include "hybrid_sphere/mechanics/taped_number.hpp"
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
    user_function::check_derivative(user_function::is_finite(terms.p) &&
                                        user_function::is_finite(terms.mass) &&
                                        user_function::is_finite(terms.force),
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
    user_function::check_derivative(user_function::is_finite(p) && user_function::is_finite(mass), name);
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
    LagrangianTerms<n> terms;
    Eigen::Matrix<double, n, n> value;
    Eigen::Matrix<double, n, n> change;
    if constexpr (is_taped) {
      differentiate_backwards(t, q, v, directions, rate, terms, value, change);
    } else {
      differentiate_forwards(t, q, v, directions, rate, terms, value, change);
    }
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
  static constexpr int side = std::max(n, N);
  static constexpr int part = user_function::directions_at_once<user_function::FirstDerivatives, n, side>();
  using T = Dual<double, part + 1>;

  /// Where a number with all its derivatives is dearer than an entry on a tape.
  static constexpr bool is_taped = n > 8 && user_function::fits<TapedNumber, side>();

  /// L, B_j . dL/dq, M, and its derivative along the motion (t + s, q + s W), by derivatives along B_j.
  template <class Directions>
  void differentiate_forwards(double t, const Eigen::Matrix<double, N, 1>& q,
                              const Eigen::Matrix<double, n, 1>& v, const Directions& directions,
                              const Eigen::Matrix<double, N, 1>& rate, LagrangianTerms<n>& terms,
                              Eigen::Matrix<double, n, n>& value, Eigen::Matrix<double, n, n>& change) const {
    T time = t;
    time.derivatives[part] = 1;
    user_function::each_part<n, part>([&](int first, auto part_size) {
      constexpr int count = decltype(part_size)::value;
      user_function::VectorOf<T, N> coordinates = q.template cast<T>();
      for (int i = 0; i < N; ++i) {
        coordinates[i].derivatives.template head<count>() = directions.row(i).template segment<count>(first);
        coordinates[i].derivatives[part] = rate[i];
      }
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
      terms.lagrangian = lagrangian.value;
      terms.force.template segment<count>(first) = lagrangian.derivatives.template head<count>();
    });
  }

  /// The same by the gradients of -V and v.Mv/2 on a tape.
  template <class Directions>
  void differentiate_backwards(double t, const Eigen::Matrix<double, N, 1>& q,
                               const Eigen::Matrix<double, n, 1>& v, const Directions& directions,
                               const Eigen::Matrix<double, N, 1>& rate, LagrangianTerms<n>& terms,
                               Eigen::Matrix<double, n, n>& value,
                               Eigen::Matrix<double, n, n>& change) const {
    thread_local Tape tape;
    tape.resize(0);
    const TapedNumber time = tape.input(t, 1);
    user_function::VectorOf<TapedNumber, N> coordinates;
    for (int i = 0; i < N; ++i) coordinates[i] = tape.input(q[i], rate[i]);
    const int inputs = tape.size();
    const auto add_gradient = [&](Eigen::Matrix<double, N, 1>& gradient, const char* function) {
      tape.propagate();
      for (int i = 0; i < N; ++i) gradient[i] += tape.adjoint(coordinates[i]);
      user_function::check_derivative(user_function::is_finite(gradient), function);
      tape.resize(inputs);
    };
    Eigen::Matrix<double, N, 1> gradient = Eigen::Matrix<double, N, 1>::Zero();
    const TapedNumber potential = call_potential<TapedNumber>(time, coordinates);
    user_function::check_derivative(std::isfinite(potential.rate), "potential");
    terms.lagrangian = -potential.value;
    tape.seed(potential, -1);
    add_gradient(gradient, "potential");
    const Eigen::Matrix<TapedNumber, n, n> mass = call_mass<TapedNumber>(time, coordinates);
    for (int i = 0; i < n * n; ++i) {
      const double weight = 0.5 * v[i / n] * v[i % n];
      terms.lagrangian += weight * mass(i).value;
      tape.seed(mass(i), weight);
      value(i) = mass(i).value;
      change(i) = mass(i).rate;
    }
    user_function::check_derivative(user_function::is_finite(change), "mass matrix");
    add_gradient(gradient, "mass matrix");
    terms.force = directions.transpose() * gradient;
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

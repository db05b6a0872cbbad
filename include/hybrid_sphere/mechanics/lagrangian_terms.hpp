#pragma once

#include <algorithm>
#include <type_traits>
#include <utility>

#include "hybrid_sphere/mechanics/dual.hpp"
#include "hybrid_sphere/mechanics/taped_number.hpp"
#include "hybrid_sphere/mechanics/user_function.hpp"

namespace hybrid_sphere::mechanics {

/// A Lagrangian v^T M(t, q) v/2 - V(t, q), see with_mass_matrix().
template <class Mass, class Potential>
struct MassMatrixLagrangian {
  Mass mass;
  Potential potential;
};

/// Differentiates L(t, q, v), n velocities and N coordinates.
/// @code
/// const auto spring = [](const auto& t, const auto& q, const auto& v) { return (v[0] * v[0] - q[0] * q[0]) /
/// 2; }; const mechanics::DifferentiatedLagrangian<1, 1, decltype(spring)> lagrangian(spring);
/// mechanics::Vector p;
/// mechanics::Matrix mass;
/// lagrangian.momentum(0, {1.0}, {2.0}, p, mass);  // 2, and 1
/// @endcode
template <int n, int N, class L>
class DifferentiatedLagrangian {
 public:
  using Coordinates = user_function::VectorOf<double, N>;
  using Velocities = user_function::VectorOf<double, n>;

  explicit DifferentiatedLagrangian(L lagrangian) : lagrangian_(std::move(lagrangian)) {}

  /// Fills L, p, M and B_j . dL/dq - (dp/dq) W - dp/dt, the force, into terms, whose sizes are right.
  /// @param kinematics  with W and the directions B (N x n)
  template <class Kinematics>
  void evaluate(double t, const Coordinates& q, const Velocities& v, const Kinematics& kinematics,
                MotionTerms& terms) const {
    auto moving = user_function::constants<T>(q);
    for (int i = 0; i < N; ++i) moving.coeffRef(i).slopes[T::motion] = kinematics.rate.coeff(i);
    T time = t;
    time.slopes[T::motion] = 1;
    Second::each_call([&](const auto& along) {
      for (int a = 0; a < Second::at_once; ++a) {
        for (int i = 0; i < N; ++i) {
          moving.coeffRef(i).slopes[T::first_of_further + a] =
              along[a] == Second::none ? 0 : kinematics.directions(i, along[a]);
        }
      }
      const T result = call(time, moving, along_velocities(v, along));
      terms.lagrangian = result.value;
      set_momentum(result, along, terms.momentum, terms.mass);
      for (int a = 0; a < Second::at_once; ++a) {
        if (along[a] == Second::none) continue;
        terms.force.coeffRef(along[a]) = result.slopes[T::first_of_further + a] - result.second(a, T::motion);
      }
    });
    user_function::check_derivative(
        is_finite(terms.momentum) && is_finite(terms.mass) && is_finite(terms.force), name);
  }

  /// p and M.
  void momentum(double t, const Coordinates& q, const Velocities& v, Vector& p, Matrix& mass) const {
    p.resize(n);
    mass.resize(n, n);
    const auto coordinates = user_function::constants<T>(q);
    Second::each_call([&](const auto& along) {
      set_momentum(call(T(t), coordinates, along_velocities(v, along)), along, p, mass);
    });
    user_function::check_derivative(is_finite(p) && is_finite(mass), name);
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
  static user_function::VectorOf<T, n> along_velocities(const Velocities& v, const Along& along) {
    auto velocities = user_function::constants<T>(v);
    for (int a = 0; a < Second::at_once; ++a) {
      if (along[a] != Second::none) velocities.coeffRef(along[a]).slopes[a] = 1;
    }
    return velocities;
  }

  template <class Along>
  static void set_momentum(const T& lagrangian, const Along& along, Vector& p, Matrix& mass) {
    for (int a = 0; a < Second::at_once; ++a) {
      if (along[a] == Second::none) continue;
      p.coeffRef(along[a]) = lagrangian.slopes[a];
      for (int b = a; b < Second::at_once; ++b) {
        if (along[b] != Second::none)
          mass(along[a], along[b]) = mass(along[b], along[a]) = lagrangian.second(a, b);
      }
    }
  }

  L lagrangian_;
};

template <int n>
Eigen::Matrix<double, n, n> symmetric_part(const Eigen::Matrix<double, n, n>& matrix) {
  return 0.5 * (matrix + matrix.transpose());
}

/// Momentum and force terms of a mass matrix M (n x n). Compiled once for each n, whatever the user's
/// functions.
template <int n>
struct MassMatrixTerms {
  using Square = Eigen::Matrix<double, n, n>;

  static void set_momentum(const Square& value, const Eigen::Matrix<double, n, 1>& v, Vector& p,
                           Matrix& mass) {
    const Square symmetric = symmetric_part<n>(value);
    mass = symmetric;
    p = symmetric * v;
  }
  /// Subtracts M' v. @param change  M', along the motion
  static void subtract_change(const Square& change, const Eigen::Matrix<double, n, 1>& v, Vector& force) {
    force -= symmetric_part<n>(change) * v;
  }
};

/// Differentiates M and V once; only the symmetric part of M is in L.
template <int n, int N, class Mass, class Potential>
class DifferentiatedLagrangian<n, N, MassMatrixLagrangian<Mass, Potential>> {
 public:
  using Coordinates = user_function::VectorOf<double, N>;
  using Velocities = user_function::VectorOf<double, n>;

  explicit DifferentiatedLagrangian(MassMatrixLagrangian<Mass, Potential> lagrangian)
      : lagrangian_(std::move(lagrangian)) {}

  template <class Kinematics>
  void evaluate(double t, const Coordinates& q, const Velocities& v, const Kinematics& kinematics,
                MotionTerms& terms) const {
    Square value;
    Square change;
    if constexpr (is_taped) {
      differentiate_backwards(t, q, v, kinematics, terms, value, change);
    } else {
      differentiate_forwards(t, q, v, kinematics, terms, value, change);
    }
    MassMatrixTerms<n>::set_momentum(value, v, terms.momentum, terms.mass);
    MassMatrixTerms<n>::subtract_change(change, v, terms.force);
  }

  void momentum(double t, const Coordinates& q, const Velocities& v, Vector& p, Matrix& mass) const {
    Square value;
    call_mass<double>(t, q, value.data());
    MassMatrixTerms<n>::set_momentum(value, v, p, mass);
  }

 private:
  using Square = typename MassMatrixTerms<n>::Square;
  static constexpr int side = std::max(n, N);
  static constexpr int part = user_function::directions_at_once<user_function::FirstDerivatives, n, side>();
  using T = Dual<double, part + 1>;

  /// Where a number with all its derivatives is dearer than an entry on a tape.
  static constexpr bool is_taped = n > 8 && user_function::fits<TapedNumber, side>();

  /// L, B_j . dL/dq, M, and its derivative along the motion (t + s, q + s W), by derivatives along B_j.
  template <class Kinematics>
  void differentiate_forwards(double t, const Coordinates& q, const Velocities& v,
                              const Kinematics& kinematics, MotionTerms& terms, Square& value,
                              Square& change) const {
    T time = t;
    time.derivatives[part] = 1;
    user_function::each_part<n, part>([&](int first, auto part_size) {
      auto coordinates = user_function::constants<T>(q);
      for (int i = 0; i < N; ++i) {
        T& coordinate = coordinates.coeffRef(i);
        for (int j = 0; j < part_size; ++j) coordinate.derivatives[j] = kinematics.directions(i, first + j);
        coordinate.derivatives[part] = kinematics.rate.coeff(i);
      }
      user_function::ArrayOf<T, n * n> mass;
      call_mass<T>(time, coordinates, mass);
      const T potential = call_potential<T>(time, coordinates);
      user_function::check_derivative(is_finite(potential), "potential");
      T lagrangian = -potential;
      for (int i = 0; i < n * n; ++i) {
        user_function::check_derivative(is_finite(mass[i]), "mass matrix");
        lagrangian += mass[i] * (0.5 * v.coeff(i / n) * v.coeff(i % n));
        value.coeffRef(i) = mass[i].value;
        change.coeffRef(i) = mass[i].derivatives[part];
      }
      terms.lagrangian = lagrangian.value;
      for (int j = 0; j < part_size; ++j) terms.force.coeffRef(first + j) = lagrangian.derivatives[j];
    });
  }

  /// The same by the gradients of -V and v.Mv/2 on a tape.
  template <class Kinematics>
  void differentiate_backwards(double t, const Coordinates& q, const Velocities& v,
                               const Kinematics& kinematics, MotionTerms& terms, Square& value,
                               Square& change) const {
    thread_local Tape tape;
    tape.resize(0);
    const TapedNumber time = tape.input(t, 1);
    user_function::VectorOf<TapedNumber, N> coordinates;
    for (int i = 0; i < N; ++i) coordinates.coeffRef(i) = tape.input(q.coeff(i), kinematics.rate.coeff(i));
    const int inputs = tape.size();
    user_function::ArrayOf<double, N> gradient = {};
    const auto add_gradient = [&](const char* function) {
      tape.propagate();
      for (int i = 0; i < N; ++i) gradient[i] += tape.adjoint(coordinates.coeff(i));
      user_function::check_derivative(are_finite(gradient, N), function);
      tape.resize(inputs);
    };
    const TapedNumber potential = call_potential<TapedNumber>(time, coordinates);
    user_function::check_derivative(std::isfinite(potential.rate), "potential");
    terms.lagrangian = -potential.value;
    tape.seed(potential, -1);
    add_gradient("potential");
    user_function::ArrayOf<TapedNumber, n * n> mass;
    call_mass<TapedNumber>(time, coordinates, mass);
    for (int i = 0; i < n * n; ++i) {
      const double weight = 0.5 * v.coeff(i / n) * v.coeff(i % n);
      terms.lagrangian += weight * mass[i].value;
      tape.seed(mass[i], weight);
      value.coeffRef(i) = mass[i].value;
      change.coeffRef(i) = mass[i].rate;
    }
    user_function::check_derivative(is_finite(change), "mass matrix");
    add_gradient("mass matrix");
    for (int j = 0; j < n; ++j) {
      double along = 0;
      for (int i = 0; i < N; ++i) along += kinematics.directions(i, j) * gradient[i];
      terms.force.coeffRef(j) = along;
    }
  }

  /// @param mass  n x n, a column after another
  template <class Number>
  void call_mass(const Number& t, const user_function::VectorOf<Number, N>& q, Number* mass) const {
    static_assert(std::is_invocable_v<const Mass&, decltype(t), decltype(q)>,
                  "the mass matrix has to be a function M(t, q) of numbers of any type");
    user_function::convert<Number, n, n>(lagrangian_.mass(t, q), mass);
    for (int i = 0; i < n * n; ++i) {
      user_function::check_value(std::isfinite(plain(mass[i])), "mass matrix");
    }
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

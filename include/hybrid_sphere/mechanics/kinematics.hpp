#pragma once

#include <algorithm>
#include <type_traits>
#include <utility>

#include "hybrid_sphere/mechanics/dual.hpp"
#include "hybrid_sphere/mechanics/user_function.hpp"

namespace hybrid_sphere::mechanics {

/// q' = v: velocities are the derivatives of the coordinates.
/// @code
/// const mechanics::CoordinateVelocities<2> plain;
/// const mechanics::CheckedVector<double, 2> q = {0, 0}, v = {1, 2};
/// const double rate = plain.rate(q, v)[1];  // 2
/// @endcode
template <int n>
class CoordinateVelocities {
 public:
  using Numbers = user_function::VectorOf<double, n>;

  struct Terms {
    const Numbers& rate;  ///< W
    /// B: the velocity v_j moves q along its column j.
    static double directions(int i, int j) { return i == j ? 1 : 0; }
    static double drift(int /*i*/) { return 0; }  ///< (DB v) W
    /// Adds the Hamel terms of p.
    static void add_hamel(const Vector& /*p*/, Vector& /*force*/) {}
  };

  const Numbers& rate(const Numbers& /*q*/, const Numbers& v) const { return v; }
  Terms terms(const Numbers& /*q*/, const Numbers& v) const { return {v}; }
};

/// The input and output arrays of complete_quasi_velocities(), owned by the caller. Matrices are stored by
/// columns.
struct QuasiVelocityArrays {
  Index coordinates;         ///< N
  Index velocities;          ///< n
  const double* v;           ///< (n)
  const double* rate;        ///< W (N)
  const double* directions;  ///< B (N x n)
  const double* change;      ///< (DB_j) W (N x n)
  const double* variation;   ///< (DW) B_j (N x n)
  double* drift;             ///< to be filled: (DB v) W (N)
  double* square;            ///< B^T B, its lower half (n x n); overwritten
  double* brackets;          ///< B^T D, D with the columns (DB_j) W - (DW) B_j (n x n); to be B^+ D
};

/// Fills the drift and the brackets. Throws NotFinite, or std::invalid_argument if W is not B v.
HYBRID_SPHERE_EXPORT void complete_quasi_velocities(const QuasiVelocityArrays& arrays);

/// Throws std::invalid_argument if the directions are not closed under brackets. @param remainder  D - B B^+
/// D
HYBRID_SPHERE_EXPORT void check_closed(const QuasiVelocityArrays& arrays, const double* remainder);

/// The terms of n quasi-velocities and N coordinates, see QuasiVelocities.
template <int n, int N>
struct QuasiVelocityTerms {
  user_function::VectorOf<double, N> rate;                  ///< W
  user_function::ArrayOf<double, N * n> direction_columns;  ///< B
  user_function::ArrayOf<double, N> drifts;
  user_function::ArrayOf<double, n * n> brackets;  ///< column j: B^+ ((DB_j) W - (DW) B_j)

  double directions(int i, int j) const { return direction_columns[j * N + i]; }
  double drift(int i) const { return drifts[i]; }  ///< (DB v) W
  /// Adds the Hamel terms of p.
  void add_hamel(const Vector& p, Vector& force) const {
    for (int j = 0; j < n; ++j) {
      double sum = 0;
      for (int i = 0; i < n; ++i) sum += brackets[j * n + i] * p.coeff(i);
      force.coeffRef(j) += sum;
    }
  }
};

/// q' = W = B(q) v: n quasi-velocities and N coordinates. Source: (14), (15).
///
/// A variation dq = B eta of the motion varies the velocities by
///   dv = eta' + B^+ ((DB_j) W - (DW) B_j) eta_j,
/// with D the derivative along the vector after it at fixed v: q' varies by the rate of the variation. So the
/// virtual work of p gives, besides p' and B^T dL/dq, the Hamel terms p . B^+ ((DB_j) W - (DW) B_j).
template <int n, int N, class Rate>
class QuasiVelocities {
 public:
  using Terms = QuasiVelocityTerms<n, N>;
  using Coordinates = user_function::VectorOf<double, N>;
  using Velocities = user_function::VectorOf<double, n>;

  explicit QuasiVelocities(Rate rate) : rate_(std::move(rate)) {}

  Coordinates rate(const Coordinates& q, const Velocities& v) const {
    Coordinates rate;
    call<double>(q, v, rate.data());
    user_function::check_value(is_finite(rate), name);
    return rate;
  }

  /// Throws NotFinite, or std::invalid_argument if the rate is not linear in v or its directions are not
  /// closed under brackets.
  Terms terms(const Coordinates& q, const Velocities& v) const {
    Terms terms;
    terms.rate = rate(q, v);
    Columns change, variation, difference;
    differentiate(q, v, terms, change);
    differentiate_along_directions(q, v, terms, variation);
    for (int k = 0; k < N * n; ++k) difference[k] = change[k] - variation[k];
    // By least squares, B^+ = (B^T B)^-1 B^T.
    user_function::ArrayOf<double, n * n> square;
    for (int j = 0; j < n; ++j) {
      for (int i = 0; i < n; ++i) {
        if (i >= j) square[j * n + i] = dot(terms.direction_columns + i * N, terms.direction_columns + j * N);
        terms.brackets[j * n + i] = dot(terms.direction_columns + i * N, difference + j * N);
      }
    }
    const QuasiVelocityArrays arrays = {N,
                                        n,
                                        v.data(),
                                        terms.rate.data(),
                                        terms.direction_columns,
                                        change,
                                        variation,
                                        terms.drifts,
                                        square,
                                        terms.brackets};
    complete_quasi_velocities(arrays);
    if constexpr (N > n) {
      for (int j = 0; j < n; ++j) {
        for (int k = 0; k < n; ++k) {
          const double weight = terms.brackets[j * n + k];
          for (int i = 0; i < N; ++i) difference[j * N + i] -= weight * terms.direction_columns[k * N + i];
        }
      }
      check_closed(arrays, difference);
    }
    return terms;
  }

 private:
  using Columns = user_function::ArrayOf<double, N * n>;
  static constexpr const char* name = "rate";
  static constexpr int side = std::max(n, N);

  static double dot(const double* a, const double* b) {
    double sum = a[0] * b[0];
    for (int i = 1; i < N; ++i) sum += a[i] * b[i];
    return sum;
  }

  template <class T>
  void call(const user_function::VectorOf<T, N>& q, const user_function::VectorOf<T, n>& v, T* rate) const {
    static_assert(std::is_invocable_v<const Rate&, decltype(q), decltype(v)>,
                  "the rate has to be a function rate(q, v) of numbers of any type");
    user_function::convert<T, N, 1>(rate_(q, v), rate);
  }

  /// (DW) B_j of all j. @param terms  with B
  void differentiate_along_directions(const Coordinates& q, const Velocities& v, const Terms& terms,
                                      Columns& variation) const {
    constexpr int part = user_function::directions_at_once<user_function::FirstDerivatives, n, side>();
    using T = Dual<double, part>;
    const auto velocities = user_function::constants<T>(v);
    user_function::each_part<n, part>([&](int first, auto part_size) {
      auto coordinates = user_function::constants<T>(q);
      for (int i = 0; i < N; ++i) {
        for (int j = 0; j < part_size; ++j) {
          coordinates.coeffRef(i).derivatives[j] = terms.directions(i, first + j);
        }
      }
      user_function::ArrayOf<T, N> result;
      call<T>(coordinates, velocities, result);
      for (int i = 0; i < N; ++i) {
        for (int j = 0; j < part_size; ++j) variation[(first + j) * N + i] = result[i].derivatives[j];
      }
    });
  }

  /// B into terms, and (DB_j) W of all j. @param terms  with W
  void differentiate(const Coordinates& q, const Velocities& v, Terms& terms, Columns& change) const {
    // Outer derivatives: along v; inner derivatives: along the motion.
    constexpr int part = user_function::directions_at_once<user_function::DerivativesAlongMotion, n, side>();
    using T = Dual<Dual<double, 1>, part>;
    auto coordinates = user_function::constants<T>(q);
    for (int i = 0; i < N; ++i) coordinates.coeffRef(i).value.derivatives[0] = terms.rate.coeff(i);
    user_function::each_part<n, part>([&](int first, auto part_size) {
      auto velocities = user_function::constants<T>(v);
      for (int j = 0; j < part_size; ++j) velocities.coeffRef(first + j).derivatives[j] = 1;
      user_function::ArrayOf<T, N> along_motion;
      call<T>(coordinates, velocities, along_motion);
      for (int i = 0; i < N; ++i) {
        for (int j = 0; j < part_size; ++j) {
          const int place = (first + j) * N + i;
          terms.direction_columns[place] = along_motion[i].derivatives[j].value;
          change[place] = along_motion[i].derivatives[j].derivatives[0];
        }
      }
    });
  }

  Rate rate_;
};

}  // namespace hybrid_sphere::mechanics

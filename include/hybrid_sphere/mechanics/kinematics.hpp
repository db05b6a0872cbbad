#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
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

/// Far above round-off, and far below the error of an invalid rate function, relative to the sizes of what is
/// compared.
inline constexpr double max_relative_rate_error = 1e-6;

[[noreturn]] HYBRID_SPHERE_EXPORT void refuse_nonlinear_rate();

/// Solves square x = right sides, in place. Throws NotFinite. Matrices are stored by columns.
/// @param square       B^T B, its lower half (n x n); overwritten
/// @param right_sides  (n x n); to be the solution
HYBRID_SPHERE_EXPORT void solve_for_brackets(Index n, double* square, double* right_sides);

/// Throws std::invalid_argument if the directions are not closed under brackets. All have `count` numbers.
/// @param remainder  D - B B^+ D, with D = change - variation
HYBRID_SPHERE_EXPORT void check_closed(const double* remainder, const double* change, const double* variation,
                                       Index count);

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
    user_function::check_derivative(are_finite(terms.direction_columns, N * n) && are_finite(change, N * n) &&
                                        are_finite(variation, N * n),
                                    name);
    set_drift(v, change, terms);
    for (int k = 0; k < N * n; ++k) difference[k] = change[k] - variation[k];
    set_brackets(difference, terms);
    if constexpr (N > n) {
      subtract_spanned(terms, difference);
      check_closed(difference, change, variation, N * n);
    }
    return terms;
  }

 private:
  using Columns = user_function::ArrayOf<double, N * n>;
  static constexpr const char* name = "rate";
  static constexpr int side = std::max(n, N);

  /// The drift. Throws std::invalid_argument if W is not B v.
  static void set_drift(const Velocities& v, const Columns& change, Terms& terms) {
    for (int i = 0; i < N; ++i) {
      double drift = 0, difference = terms.rate.coeff(i), size = std::abs(difference);
      for (int j = 0; j < n; ++j) {
        drift += change[j * N + i] * v.coeff(j);
        const double part = terms.directions(i, j) * v.coeff(j);
        difference -= part;
        size += std::abs(part);
      }
      terms.drifts[i] = drift;
      if (std::abs(difference) > max_relative_rate_error * size + std::numeric_limits<double>::min()) {
        refuse_nonlinear_rate();
      }
    }
  }

  /// B^+ difference by least squares, B^+ = (B^T B)^-1 B^T.
  static void set_brackets(const Columns& difference, Terms& terms) {
    user_function::ArrayOf<double, n * n> square;
    for (int j = 0; j < n; ++j) {
      for (int i = 0; i < n; ++i) {
        const double* const direction = terms.direction_columns + i * N;
        if (i >= j) square[j * n + i] = dot(direction, terms.direction_columns + j * N);
        terms.brackets[j * n + i] = dot(direction, difference + j * N);
      }
    }
    solve_for_brackets(n, square, terms.brackets);
  }

  /// Subtracts B brackets.
  static void subtract_spanned(const Terms& terms, Columns& difference) {
    for (int j = 0; j < n; ++j) {
      for (int k = 0; k < n; ++k) {
        const double weight = terms.brackets[j * n + k];
        for (int i = 0; i < N; ++i) difference[j * N + i] -= weight * terms.directions(i, k);
      }
    }
  }

  /// By two sums, of the even and the odd places, which do not wait for each other.
  static double dot(const double* a, const double* b) {
    if constexpr (N == 1) {
      return a[0] * b[0];
    } else {
      double even = a[0] * b[0], odd = a[1] * b[1];
      for (int i = 2; i + 1 < N; i += 2) {
        even += a[i] * b[i];
        odd += a[i + 1] * b[i + 1];
      }
      return N % 2 == 0 ? even + odd : even + odd + a[N - 1] * b[N - 1];
    }
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

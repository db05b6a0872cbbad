#pragma once

#include <Eigen/Cholesky>
#include <algorithm>
#include <cfloat>
#include <cmath>
#include <stdexcept>
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

/// The terms of n quasi-velocities and N coordinates, see QuasiVelocities. They do not depend on the type of
/// the user's function, so that they are compiled once for all functions of the same sizes.
template <int n, int N>
struct QuasiVelocityTerms {
  Eigen::Matrix<double, N, 1> rate;        ///< W
  Eigen::Matrix<double, N, n> directions;  ///< B
  Eigen::Matrix<double, N, 1> drift_;      ///< (DB v) W
  Eigen::Matrix<double, n, n> brackets;    ///< column j: B^+ ((DB_j) W - (DW) B_j)

  double drift(int i) const { return drift_.coeff(i); }
  void add_hamel(const Vector& p, Vector& force) const {
    const Eigen::Matrix<double, n, 1> momentum = p;
    force += brackets.transpose() * momentum;
  }

  /// Sets the drift and the brackets from W and B. Throws std::invalid_argument if W is not linear in v, or
  /// the directions are not closed under brackets.
  /// @param change     (DB_j) W, a column each
  /// @param variation  (DW) B_j
  void complete(const Eigen::Matrix<double, n, 1>& v, const Eigen::Matrix<double, N, n>& change,
                const Eigen::Matrix<double, N, n>& variation) {
    drift_ = change * v;
    check_linear(v);
    set_brackets(change, variation);
  }

 private:
  /// Throws std::invalid_argument if W is not B v.
  void check_linear(const Eigen::Matrix<double, n, 1>& v) const {
    const Eigen::Matrix<double, N, 1> difference = rate - directions * v;
    const Eigen::Matrix<double, N, 1> size = rate.cwiseAbs() + directions.cwiseAbs() * v.cwiseAbs();
    if (!user_function::is_finite(size)) return;  // reported elsewhere
    if ((difference.cwiseAbs().array() > max_relative_error * size.array() + DBL_MIN).any()) {
      throw std::invalid_argument("the rate of the coordinates is not linear in the velocities");
    }
  }

  /// Sets the brackets B^+ (change - variation), by least squares: B^+ = (B^T B)^-1 B^T.
  void set_brackets(const Eigen::Matrix<double, N, n>& change, const Eigen::Matrix<double, N, n>& variation) {
    const Eigen::Matrix<double, N, n> differences = change - variation;
    const Eigen::Matrix<double, n, n> square = directions.transpose() * directions;
    const Eigen::LLT<Eigen::Matrix<double, n, n>> cholesky(square);
    Eigen::Matrix<double, n, n> result = directions.transpose() * differences;
    cholesky.solveInPlace(result);
    user_function::check_value(cholesky.info() == Eigen::Success && user_function::is_finite(result),
                               "inverse of rate");
    if (N > n && (differences - directions * result).norm() >
                     max_relative_error * (change.norm() + variation.norm())) {
      throw std::invalid_argument(
          "the directions in which the velocities move the coordinates are not closed under brackets");
    }
    brackets = result;
  }

  // Far above round-off, and far below what an invalid function produces.
  static constexpr double max_relative_error = 1e-6;
};

/// An attitude: three angular velocities, four components of a quaternion. Compiled in the library.
extern template struct HYBRID_SPHERE_EXPORT QuasiVelocityTerms<3, 4>;

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
    user_function::check_value(user_function::is_finite(rate), name);
    return rate;
  }

  /// Throws NotFinite, or std::invalid_argument if the rate is not linear in v or its directions are not
  /// closed under brackets.
  Terms terms(const Coordinates& q, const Velocities& v) const {
    Terms terms;
    terms.rate = rate(q, v);
    Directions change;  // (DB_j) W
    differentiate(q, v, terms, change);
    Directions variation;  // (DW) B_j
    differentiate_along_directions(q, v, terms.directions, variation);
    user_function::check_derivative(user_function::is_finite(terms.directions) &&
                                        user_function::is_finite(change) &&
                                        user_function::is_finite(variation),
                                    name);
    terms.complete(v, change, variation);
    return terms;
  }

 private:
  using Directions = Eigen::Matrix<double, N, n>;
  static constexpr const char* name = "rate";
  static constexpr int side = std::max(n, N);

  template <class T>
  void call(const user_function::VectorOf<T, N>& q, const user_function::VectorOf<T, n>& v, T* rate) const {
    static_assert(std::is_invocable_v<const Rate&, decltype(q), decltype(v)>,
                  "the rate has to be a function rate(q, v) of numbers of any type");
    user_function::convert<T, N, 1>(rate_(q, v), rate);
  }

  void differentiate_along_directions(const Coordinates& q, const Velocities& v, const Directions& directions,
                                      Directions& variation) const {
    constexpr int part = user_function::directions_at_once<user_function::FirstDerivatives, n, side>();
    using T = Dual<double, part>;
    const auto velocities = user_function::constants<T>(v);
    user_function::each_part<n, part>([&](int first, auto part_size) {
      auto coordinates = user_function::constants<T>(q);
      for (int i = 0; i < N; ++i) {
        for (int j = 0; j < part_size; ++j) {
          coordinates.coeffRef(i).derivatives[j] = directions(i, first + j);
        }
      }
      user_function::ArrayOf<T, N> result;
      call<T>(coordinates, velocities, result);
      for (int i = 0; i < N; ++i) {
        for (int j = 0; j < part_size; ++j) variation(i, first + j) = result[i].derivatives[j];
      }
    });
  }

  /// B into terms, and (DB_j) W of all j. @param terms  with W
  void differentiate(const Coordinates& q, const Velocities& v, Terms& terms, Directions& change) const {
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
          terms.directions(i, first + j) = along_motion[i].derivatives[j].value;
          change(i, first + j) = along_motion[i].derivatives[j].derivatives[0];
        }
      }
    });
  }

  Rate rate_;
};

}  // namespace hybrid_sphere::mechanics

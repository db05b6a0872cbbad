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
/// const Eigen::Vector2d rate = plain.rate({0, 0}, {1, 2});  // (1, 2)
/// @endcode
template <int n>
class CoordinateVelocities {
 public:
  struct Terms {
    Eigen::Matrix<double, n, 1> rate;  ///< W
    /// B: the velocity v_j moves q along its column j.
    Eigen::Matrix<double, n, n> directions = Eigen::Matrix<double, n, n>::Identity();
    Eigen::Matrix<double, n, 1> drift = Eigen::Matrix<double, n, 1>::Zero();  ///< (DB v) W
    /// The Hamel terms of p.
    Eigen::Matrix<double, n, 1> hamel(const Eigen::Matrix<double, n, 1>& /*p*/) const {
      return Eigen::Matrix<double, n, 1>::Zero();
    }
  };

  Eigen::Matrix<double, n, 1> rate(const Eigen::Matrix<double, n, 1>& /*q*/,
                                   const Eigen::Matrix<double, n, 1>& v) const {
    return v;
  }
  Terms terms(const Eigen::Matrix<double, n, 1>& /*q*/, const Eigen::Matrix<double, n, 1>& v) const {
    return {v};
  }
};

/// The terms of n quasi-velocities and N coordinates, see QuasiVelocities. They do not depend on the type of
/// the user's function, so that they are compiled once for all functions of the same sizes.
template <int n, int N>
struct QuasiVelocityTerms {
  Eigen::Matrix<double, N, 1> rate;        ///< W
  Eigen::Matrix<double, N, n> directions;  ///< B
  Eigen::Matrix<double, N, 1> drift;       ///< (DB v) W
  Eigen::Matrix<double, n, n> brackets;    ///< column j: B^+ ((DB_j) W - (DW) B_j)

  Eigen::Matrix<double, n, 1> hamel(const Eigen::Matrix<double, n, 1>& p) const {
    return brackets.transpose() * p;
  }

  /// Throws std::invalid_argument if W is not B v.
  void check_linear(const Eigen::Matrix<double, n, 1>& v) const {
    const Eigen::Matrix<double, N, 1> difference = rate - directions * v;
    const Eigen::Matrix<double, N, 1> size = rate.cwiseAbs() + directions.cwiseAbs() * v.cwiseAbs();
    if (!user_function::is_finite(size)) return;  // reported elsewhere
    if ((difference.cwiseAbs().array() > max_relative_error * size.array() + DBL_MIN).any()) {
      throw std::invalid_argument("the rate of the coordinates is not linear in the velocities");
    }
  }

  /// Sets the brackets B^+ (change - variation), by least squares: B^+ = (B^T B)^-1 B^T. Throws
  /// std::invalid_argument if the directions are not closed under brackets.
  /// @param change     (DB_j) W, a column each
  /// @param variation  (DW) B_j
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

 private:
  // Far above round-off, and far below what an invalid function produces.
  static constexpr double max_relative_error = 1e-6;
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

  explicit QuasiVelocities(Rate rate) : rate_(std::move(rate)) {}

  Eigen::Matrix<double, N, 1> rate(const Eigen::Matrix<double, N, 1>& q,
                                   const Eigen::Matrix<double, n, 1>& v) const {
    const Eigen::Matrix<double, N, 1> rate = call<double>(q, v);
    user_function::check_value(user_function::is_finite(rate), name);
    return rate;
  }

  /// Throws NotFinite, or std::invalid_argument if the rate is not linear in v or its directions are not
  /// closed under brackets.
  Terms terms(const Eigen::Matrix<double, N, 1>& q, const Eigen::Matrix<double, n, 1>& v) const {
    Terms terms;
    terms.rate = rate(q, v);

    Eigen::Matrix<double, N, n> change;  // (DB_j) W
    differentiate(q, v, terms, change);
    const Eigen::Matrix<double, N, n> variation = along_directions(q, v, terms.directions);  // (DW) B_j
    user_function::check_derivative(user_function::is_finite(terms.directions) &&
                                        user_function::is_finite(change) &&
                                        user_function::is_finite(variation),
                                    name);
    terms.drift = change * v;
    terms.check_linear(v);
    terms.set_brackets(change, variation);
    return terms;
  }

 private:
  static constexpr const char* name = "rate";
  static constexpr int side = std::max(n, N);

  template <class T>
  user_function::VectorOf<T, N> call(const user_function::VectorOf<T, N>& q,
                                     const user_function::VectorOf<T, n>& v) const {
    static_assert(std::is_invocable_v<const Rate&, decltype(q), decltype(v)>,
                  "the rate has to be a function rate(q, v) of numbers of any type");
    return user_function::to_vector<T, N>(rate_(q, v));
  }

  Eigen::Matrix<double, N, n> along_directions(const Eigen::Matrix<double, N, 1>& q,
                                               const Eigen::Matrix<double, n, 1>& v,
                                               const Eigen::Matrix<double, N, n>& directions) const {
    constexpr int part = user_function::directions_at_once<user_function::FirstDerivatives, n, side>();
    using T = Dual<double, part>;
    Eigen::Matrix<double, N, n> variation;
    user_function::each_part<n, part>([&](int first, auto part_size) {
      constexpr int count = decltype(part_size)::value;
      user_function::VectorOf<T, N> coordinates = q.template cast<T>();
      for (int i = 0; i < N; ++i) {
        coordinates[i].derivatives.template head<count>() = directions.row(i).template segment<count>(first);
      }
      const auto result = call<T>(coordinates, v.template cast<T>());
      for (int i = 0; i < N; ++i) {
        variation.row(i).template segment<count>(first) = result[i].derivatives.template head<count>();
      }
    });
    return variation;
  }

  /// B into terms, and (DB_j) W of all j. @param terms  with W
  void differentiate(const Eigen::Matrix<double, N, 1>& q, const Eigen::Matrix<double, n, 1>& v, Terms& terms,
                     Eigen::Matrix<double, N, n>& change) const {
    // Outer derivatives: along v; inner derivatives: along the motion.
    constexpr int part = user_function::directions_at_once<user_function::DerivativesAlongMotion, n, side>();
    using T = Dual<Dual<double, 1>, part>;
    user_function::VectorOf<T, N> coordinates = q.template cast<T>();
    for (int i = 0; i < N; ++i) coordinates[i].value.derivatives[0] = terms.rate[i];
    user_function::each_part<n, part>([&](int first, auto part_size) {
      user_function::VectorOf<T, n> velocities = v.template cast<T>();
      for (int j = 0; j < part_size; ++j) velocities[first + j].derivatives[j] = 1;
      const auto along_motion = call<T>(coordinates, velocities);
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

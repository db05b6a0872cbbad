#pragma once

#include <memory>
#include <string>
#include <type_traits>
#include <utility>

#include "hybrid_sphere/mechanics/constraint.hpp"
#include "hybrid_sphere/mechanics/dual.hpp"
#include "hybrid_sphere/mechanics/user_function.hpp"

namespace hybrid_sphere::mechanics {

/// The derivatives of functions g(t, q) of N coordinates, as arrays.
struct HolonomicSlopes {
  Index size;                ///< how many functions
  const double* place;       ///< dg/dq (size x N), a row after another
  const double* time;        ///< dg/dt
  const double* along_path;  ///< the second derivative along (1, q'), or null where it is not asked for
};
/// @param directions  B (N x n) @param drift  (DB v) B v
HYBRID_SPHERE_EXPORT void set_holonomic_terms(const HolonomicSlopes& slopes, const Vector& rate,
                                              const Matrix& directions, const Vector& drift,
                                              ConstraintTerms& terms);
HYBRID_SPHERE_EXPORT void set_holonomic_gradient(const HolonomicSlopes& slopes, const Matrix& directions,
                                                 const Vector& v, Vector& value, Matrix& gradient);

/// The rate of functions g(t, q) that vanish, differentiated exactly: f = (dg/dq) q' + dg/dt. See
/// holonomic_constraint().
/// @code
/// const auto rod = [](const std::shared_ptr<const mechanics::EquationsOfMotion>& equations) {
///   return mechanics::holonomic_constraint<2, 2>(
///       "rod", equations, [](const auto& t, const auto& q) { return q[0] * q[0] + q[1] * q[1] - 1.0; });
/// };
/// @endcode
template <int n, int N, class Function>
class HolonomicConstraint final : public ConstraintFunction {
 public:
  HolonomicConstraint(std::string label, std::shared_ptr<const EquationsOfMotion> equations,
                      Function function)
      : label_(std::move(label)), equations_(std::move(equations)), function_(std::move(function)) {}

  Index size() const override { return size_; }

  void evaluate(double t, const Vector& q, const Vector& v, const Vector& rate,
                ConstraintTerms& terms) const override {
    Matrix directions;
    Vector drift;
    equations_->directions(q, v, directions, drift);
    Numbers along_path;
    differentiate_twice(t, q, rate, along_path);
    Place place;
    Numbers time;
    differentiate(t, q, place, time);
    set_holonomic_terms({size_, place, time, along_path}, rate, directions, drift, terms);
    user_function::check_derivative(is_finite(terms.gradient) && is_finite(terms.gamma), label_);
  }

  void evaluate(double t, const Vector& q, const Vector& v, Vector& value, Matrix& gradient) const override {
    Matrix directions;
    Vector drift;
    equations_->directions(q, v, directions, drift);
    Place place;
    Numbers time;
    differentiate(t, q, place, time);
    set_holonomic_gradient({size_, place, time, nullptr}, directions, v, value, gradient);
    user_function::check_derivative(is_finite(gradient) && is_finite(value), label_);
  }

  void add_curvature(double, const Vector&, const Vector&, const Vector&, Matrix&) const override {}

  bool has_position() const override { return true; }
  void position(double t, const Vector& q, Vector& value) const override {
    value.resize(size_);
    call<double>(t, user_function::constants<double, N>("q", q), value.data());
  }

 private:
  using Number = Dual<double, user_function::directions_at_once<user_function::FirstDerivatives, N, N>()>;
  template <class T>
  using Result = std::invoke_result_t<const Function&, const T&, const user_function::VectorOf<T, N>&>;
  static_assert(
      std::is_invocable_v<const Function&, const Number&, const user_function::VectorOf<Number, N>&>,
      "a holonomic constraint has to be a function g(t, q) of numbers of any type: [](const auto& t, "
      "const auto& q)");
  static constexpr int size_ = user_function::Shape<std::decay_t<Result<Number>>>::rows;
  static_assert(size_ > 0, "wrong sizes: it returns a number or a vector (Eigen) of fixed size");

  using Place = user_function::ArrayOf<double, size_ * N>;
  using Numbers = user_function::ArrayOf<double, size_>;

  void differentiate(double t, const Vector& at, double* place, double* slope_of_time) const {
    constexpr int part = user_function::directions_at_once<user_function::FirstDerivatives, N, N>();
    using T = Dual<double, part + 1>;
    T time = t;
    time.derivatives[part] = 1;
    user_function::each_part<N, part>([&](int first, auto part_size) {
      auto q = user_function::constants<T, N>("q", at);
      for (int j = 0; j < part_size; ++j) q.coeffRef(first + j).derivatives[j] = 1;
      user_function::ArrayOf<T, size_> g;
      call<T>(time, q, g);
      for (int i = 0; i < size_; ++i) {
        for (int j = 0; j < part_size; ++j) place[i * N + first + j] = g[i].derivatives[j];
        slope_of_time[i] = g[i].derivatives[part];
      }
    });
  }

  /// The second derivative along (1, q').
  void differentiate_twice(double t, const Vector& at, const Vector& rate, double* second) const {
    using T = Dual<Dual<double, 1>, 1>;
    user_function::check_size("the rate of q", rate, N);
    auto q = user_function::constants<T, N>("q", at);
    const auto set_slope = [](T& number, double slope) {
      number.value.derivatives[0] = slope;
      number.derivatives[0].value = slope;
    };
    for (int i = 0; i < N; ++i) set_slope(q.coeffRef(i), rate.coeff(i));
    T time = t;
    set_slope(time, 1);
    user_function::ArrayOf<T, size_> g;
    call<T>(time, q, g);
    for (int i = 0; i < size_; ++i) second[i] = g[i].derivatives[0].derivatives[0];
  }

  template <class T>
  void call(const T& t, const user_function::VectorOf<T, N>& q, T* g) const {
    user_function::convert<T, size_, 1>(function_(t, q), g);
    for (int i = 0; i < size_; ++i) user_function::check_value(std::isfinite(plain(g[i])), label_);
  }

  std::string label_;
  std::shared_ptr<const EquationsOfMotion> equations_;
  Function function_;
};

/// Constraints g(t, q) = 0 of the coordinates of `equations`.
/// @param label     the name that NotFinite reports: "constraint rod"
/// @param function  g(t, q), one number or a vector (Eigen, fixed size); see automatic_equations()
template <int n, int N, class Function>
std::shared_ptr<const ConstraintFunction> holonomic_constraint(
    std::string label, std::shared_ptr<const EquationsOfMotion> equations, Function function) {
  return std::unique_ptr<const ConstraintFunction>(
      new HolonomicConstraint<n, N, Function>(std::move(label), std::move(equations), std::move(function)));
}

/// A load from a function.
template <int n, int N, class Function>
class FunctionLoad final : public Load {
 public:
  FunctionLoad(std::string label, Function function)
      : label_(std::move(label)), function_(std::move(function)) {}

  double value(double t, const Vector& q, const Vector& v) const override {
    const double load = user_function::to_number<double>(function_(
        t, user_function::constants<double, N>("q", q), user_function::constants<double, n>("v", v)));
    user_function::check_value(std::isfinite(load), label_);
    return load;
  }

 private:
  std::string label_;
  Function function_;
};

}  // namespace hybrid_sphere::mechanics

#pragma once

#include <memory>
#include <string>
#include <type_traits>
#include <utility>

#include "hybrid_sphere/mechanics/constraint.hpp"
#include "hybrid_sphere/mechanics/dual.hpp"
#include "hybrid_sphere/mechanics/user_function.hpp"

namespace hybrid_sphere::mechanics {

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
    const Slopes slopes = differentiate(t, user_function::fixed<N>("q", q));
    terms.value = slopes.place * rate + slopes.time;
    terms.gradient = slopes.place * directions;
    terms.gamma = -slopes.place * drift - second_rate(t, user_function::fixed<N>("q", q),
                                                      user_function::fixed<N>("the rate of q", rate));
    user_function::check_derivative(
        user_function::is_finite(terms.gradient) && user_function::is_finite(terms.gamma), label_);
  }

  void evaluate(double t, const Vector& q, const Vector& v, Vector& value, Matrix& gradient) const override {
    Matrix directions;
    Vector drift;
    equations_->directions(q, v, directions, drift);
    const Slopes slopes = differentiate(t, user_function::fixed<N>("q", q));
    gradient = slopes.place * directions;
    value = gradient * v + slopes.time;
    user_function::check_derivative(user_function::is_finite(gradient) && user_function::is_finite(value),
                                    label_);
  }

  void add_curvature(double, const Vector&, const Vector&, const Vector&, Matrix&) const override {}

  bool has_position() const override { return true; }
  void position(double t, const Vector& q, Vector& value) const override {
    value = call<double>(t, user_function::fixed<N>("q", q));
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

  struct Slopes {
    Eigen::Matrix<double, size_, N> place;  // dg/dq
    Eigen::Matrix<double, size_, 1> time;   // dg/dt
  };

  Slopes differentiate(double t, const user_function::VectorOf<double, N>& at) const {
    constexpr int part = user_function::directions_at_once<user_function::FirstDerivatives, N, N>();
    using T = Dual<double, part + 1>;
    Slopes slopes;
    T time = t;
    time.derivatives[part] = 1;
    user_function::each_part<N, part>([&](int first, auto part_size) {
      constexpr int count = decltype(part_size)::value;
      user_function::VectorOf<T, N> q = at.template cast<T>();
      for (int i = 0; i < count; ++i) q[first + i].derivatives[i] = 1;
      const Eigen::Matrix<T, size_, 1> g = call<T>(time, q);
      for (int i = 0; i < size_; ++i) {
        slopes.place.row(i).template segment<count>(first) = g[i].derivatives.template head<count>();
        slopes.time[i] = g[i].derivatives[part];
      }
    });
    return slopes;
  }

  /// The second derivative along (1, q').
  Eigen::Matrix<double, size_, 1> second_rate(double t, const user_function::VectorOf<double, N>& at,
                                              const user_function::VectorOf<double, N>& rate) const {
    using T = Dual<Dual<double, 1>, 1>;
    const auto moving = [](double value, double slope) {
      T number = value;
      number.value.derivatives[0] = slope;
      number.derivatives[0].value = slope;
      return number;
    };
    user_function::VectorOf<T, N> q;
    for (int i = 0; i < N; ++i) q[i] = moving(at[i], rate[i]);
    const Eigen::Matrix<T, size_, 1> g = call<T>(moving(t, 1), q);
    Eigen::Matrix<double, size_, 1> result;
    for (int i = 0; i < size_; ++i) result[i] = g[i].derivatives[0].derivatives[0];
    return result;
  }

  template <class T>
  Eigen::Matrix<T, size_, 1> call(const T& t, const user_function::VectorOf<T, N>& q) const {
    const Eigen::Matrix<T, size_, 1> g = user_function::to_vector<T, size_>(function_(t, q));
    for (int i = 0; i < size_; ++i) user_function::check_value(std::isfinite(plain(g[i])), label_);
    return g;
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
  return std::make_shared<HolonomicConstraint<n, N, Function>>(std::move(label), std::move(equations),
                                                               std::move(function));
}

/// A load from a function.
template <int n, int N, class Function>
class FunctionLoad final : public Load {
 public:
  FunctionLoad(std::string label, Function function)
      : label_(std::move(label)), function_(std::move(function)) {}

  double value(double t, const Vector& q, const Vector& v) const override {
    const double load = user_function::to_number<double>(
        function_(t, user_function::fixed<N>("q", q), user_function::fixed<n>("v", v)));
    user_function::check_value(std::isfinite(load), label_);
    return load;
  }

 private:
  std::string label_;
  Function function_;
};

}  // namespace hybrid_sphere::mechanics

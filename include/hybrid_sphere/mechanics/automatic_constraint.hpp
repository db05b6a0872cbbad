#pragma once

#include <algorithm>
#include <memory>
#include <string>
#include <type_traits>
#include <utility>

#include "hybrid_sphere/mechanics/constraint.hpp"
#include "hybrid_sphere/mechanics/dual.hpp"
#include "hybrid_sphere/mechanics/user_function.hpp"

namespace hybrid_sphere::mechanics {

/// Constraints from a function, differentiated exactly. See automatic_constraint().
/// @code
/// const auto blade = mechanics::automatic_constraint<2, 2>(
///     "blade", [](const auto& t, const auto& q, const auto& v) { return v[0] * q[1] - v[1]; });
/// @endcode
template <int n, int N, class Function>
class AutomaticConstraint final : public ConstraintFunction {
 public:
  AutomaticConstraint(std::string label, Function function)
      : label_(std::move(label)), function_(std::move(function)) {}

  Index size() const override { return g; }

  void evaluate(double t, const Vector& q, const Vector& v, const Vector& rate,
                ConstraintTerms& terms) const override {
    user_function::check_size("the rate of q", rate, N);
    terms.gamma.resize(g);
    differentiate(t, q, v, rate.data(), terms.value, terms.gradient, terms.gamma.data());
    user_function::check_derivative(is_finite(terms.gradient) && is_finite(terms.gamma), label_);
  }

  void evaluate(double t, const Vector& q, const Vector& v, Vector& value, Matrix& gradient) const override {
    differentiate(t, q, v, nullptr, value, gradient, nullptr);
    user_function::check_derivative(is_finite(gradient), label_);
  }

  void add_curvature(double t, const Vector& q_any, const Vector& v_any, const Vector& multipliers,
                     Matrix& sum) const override {
    using Second = user_function::SecondDerivatives<n, side>;
    using T = typename Second::Number;
    user_function::check_size("the vector of multipliers", multipliers, g);
    const auto q = user_function::constants<T, N>("q", q_any);
    user_function::ArrayOf<double, n * n> curvature;
    Second::each_call([&](const auto& along) {
      auto v = user_function::constants<T, n>("v", v_any);
      for (int a = 0; a < Second::at_once; ++a) {
        if (along[a] != Second::none) v.coeffRef(along[a]).slopes[a] = 1;
      }
      user_function::ArrayOf<T, g> f;
      call<T>(T(t), q, v, f);
      for (int a = 0; a < Second::at_once; ++a) {
        for (int b = a; b < Second::at_once; ++b) {
          if (along[a] == Second::none || along[b] == Second::none) continue;
          double weighted = 0;
          for (int beta = 0; beta < g; ++beta) weighted += multipliers.coeff(beta) * f[beta].second(a, b);
          curvature[along[b] * n + along[a]] = curvature[along[a] * n + along[b]] = weighted;
        }
      }
    });
    for (int i = 0; i < n * n; ++i) sum.coeffRef(i) += curvature[i];
    user_function::check_derivative(is_finite(sum), label_);
  }

 private:
  template <class T>
  using Result = std::invoke_result_t<const Function&, const T&, const user_function::VectorOf<T, N>&,
                                      const user_function::VectorOf<T, n>&>;
  static constexpr int side = std::max(n, N);
  static constexpr int part = user_function::directions_at_once<user_function::FirstDerivatives, n, side>();
  static_assert(
      std::is_invocable_v<const Function&, const Dual<double, part + 1>&,
                          const user_function::VectorOf<Dual<double, part + 1>, N>&,
                          const user_function::VectorOf<Dual<double, part + 1>, n>&>,
      "a constraint has to be a function f(t, q, v) of numbers of any type: [](const auto& t, const "
      "auto& q, const auto& v)");
  static constexpr int g = user_function::Shape<std::decay_t<Result<Dual<double, part + 1>>>>::rows;
  static_assert(g > 0, "wrong sizes: a constraint returns a number or a vector (Eigen) of fixed size");

  /// Derivatives along v, and gamma along the motion (t + s, q + s q').
  /// @param rate  q' (N), or null: without gamma
  void differentiate(double t, const Vector& q_any, const Vector& v_any, const double* rate, Vector& value,
                     Matrix& gradient, double* gamma) const {
    using T = Dual<double, part + 1>;
    auto q = user_function::constants<T, N>("q", q_any);
    T time = t;
    if (rate) {
      for (int i = 0; i < N; ++i) q.coeffRef(i).derivatives[part] = rate[i];
      time.derivatives[part] = 1;
    }
    value.resize(g);
    gradient.resize(g, n);
    user_function::each_part<n, part>([&](int first, auto part_size) {
      auto v = user_function::constants<T, n>("v", v_any);
      for (int j = 0; j < part_size; ++j) v.coeffRef(first + j).derivatives[j] = 1;
      user_function::ArrayOf<T, g> f;
      call<T>(time, q, v, f);
      for (int i = 0; i < g; ++i) {
        value.coeffRef(i) = f[i].value;
        for (int j = 0; j < part_size; ++j) gradient(i, first + j) = f[i].derivatives[j];
        if (rate) gamma[i] = -f[i].derivatives[part];
      }
    });
  }

  template <class T>
  void call(const T& t, const user_function::VectorOf<T, N>& q, const user_function::VectorOf<T, n>& v,
            T* f) const {
    user_function::convert<T, g, 1>(function_(t, q, v), f);
    for (int i = 0; i < g; ++i) user_function::check_value(std::isfinite(plain(f[i])), label_);
  }

  std::string label_;
  Function function_;
};

/// Constraints f(t, q, v) = 0 of n velocities and N coordinates.
/// @param label     the name that NotFinite reports: "constraint blade"
/// @param function  f(t, q, v), one number or a vector (Eigen, fixed size); see automatic_equations()
template <int n, int N, class Function>
std::shared_ptr<const ConstraintFunction> automatic_constraint(std::string label, Function function) {
  return std::unique_ptr<const ConstraintFunction>(
      new AutomaticConstraint<n, N, Function>(std::move(label), std::move(function)));
}

/// A guard from a function, differentiated exactly. See automatic_guard().
template <int N, class Function>
class AutomaticGuard final : public Guard {
 public:
  AutomaticGuard(std::string label, Function function)
      : label_(std::move(label)), function_(std::move(function)) {}

  double value(double t, const Vector& q) const override {
    return call<double>(t, user_function::constants<double, N>("q", q));
  }

  double rate(double t, const Vector& q, const Vector& q_rate) const override {
    using T = Dual<double, 1>;
    auto moving = user_function::constants<T, N>("q", q);
    user_function::check_size("the rate of q", q_rate, N);
    for (int i = 0; i < N; ++i) moving.coeffRef(i).derivatives[0] = q_rate.coeff(i);
    T time = t;
    time.derivatives[0] = 1;
    const double rate = call<T>(time, moving).derivatives[0];
    user_function::check_derivative(std::isfinite(rate), label_);
    return rate;
  }

 private:
  template <class T>
  T call(const T& t, const user_function::VectorOf<T, N>& q) const {
    static_assert(
        std::is_invocable_v<const Function&, decltype(t), decltype(q)>,
        "a guard has to be a function g(t, q) of numbers of any type: [](const auto& t, const auto& q)");
    const T result = user_function::to_number<T>(function_(t, q));
    user_function::check_value(std::isfinite(plain(result)), label_);
    return result;
  }

  std::string label_;
  Function function_;
};

/// A guard g(t, q) of N coordinates.
/// @param label     the name that NotFinite reports: "guard of constraint blade"
/// @param function  g(t, q), a number; see automatic_equations()
template <int N, class Function>
std::shared_ptr<const Guard> automatic_guard(std::string label, Function function) {
  return std::unique_ptr<const Guard>(new AutomaticGuard<N, Function>(std::move(label), std::move(function)));
}

}  // namespace hybrid_sphere::mechanics

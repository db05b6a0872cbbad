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

  void evaluate(double t, const Vector& q_any, const Vector& v_any, const Vector& rate,
                ConstraintTerms& terms) const override {
    // Derivatives along v, and along the motion (t + s, q + s q').
    using T = Dual<double, part + 1>;
    user_function::VectorOf<T, N> q = user_function::fixed<N>("q", q_any).template cast<T>();
    const auto q_rate = user_function::fixed<N>("the rate of q", rate);
    for (int i = 0; i < N; ++i) q[i].derivatives[part] = q_rate[i];
    T time = t;
    time.derivatives[part] = 1;
    terms.value.resize(g);
    terms.gradient.resize(g, n);
    terms.gamma.resize(g);
    user_function::each_part<n, part>([&](int first, auto part_size) {
      constexpr int count = decltype(part_size)::value;
      const Eigen::Matrix<T, g, 1> f = call<T>(time, q, along_velocities<T, count>(v_any, first));
      for (int i = 0; i < g; ++i) {
        terms.value[i] = f[i].value;
        terms.gradient.row(i).template segment<count>(first) = f[i].derivatives.template head<count>();
        terms.gamma[i] = -f[i].derivatives[part];
      }
    });
    user_function::check_derivative(
        user_function::is_finite(terms.gradient) && user_function::is_finite(terms.gamma), label_);
  }

  void evaluate(double t, const Vector& q_any, const Vector& v_any, Vector& value,
                Matrix& gradient) const override {
    using T = Dual<double, part + 1>;  // the type that the other one uses: less to compile
    const user_function::VectorOf<T, N> q = user_function::fixed<N>("q", q_any).template cast<T>();
    value.resize(g);
    gradient.resize(g, n);
    user_function::each_part<n, part>([&](int first, auto part_size) {
      constexpr int count = decltype(part_size)::value;
      const Eigen::Matrix<T, g, 1> f = call<T>(T(t), q, along_velocities<T, count>(v_any, first));
      for (int i = 0; i < g; ++i) {
        value[i] = f[i].value;
        gradient.row(i).template segment<count>(first) = f[i].derivatives.template head<count>();
      }
    });
    user_function::check_derivative(user_function::is_finite(gradient), label_);
  }

  void add_curvature(double t, const Vector& q_any, const Vector& v_any, const Vector& multipliers,
                     Matrix& sum) const override {
    using Second = user_function::SecondDerivatives<n, side>;
    using T = typename Second::Number;
    const auto weights = user_function::fixed<g>("the vector of multipliers", multipliers);
    const user_function::VectorOf<T, N> q = user_function::fixed<N>("q", q_any).template cast<T>();
    Eigen::Matrix<double, n, n> curvature;
    Second::each_call([&](const auto& along) {
      user_function::VectorOf<T, n> v = user_function::fixed<n>("v", v_any).template cast<T>();
      for (int a = 0; a < Second::at_once; ++a) {
        if (along[a] != Second::none) v[along[a]].slopes[a] = 1;
      }
      const Eigen::Matrix<T, g, 1> f = call<T>(T(t), q, v);
      for (int a = 0; a < Second::at_once; ++a) {
        for (int b = a; b < Second::at_once; ++b) {
          if (along[a] == Second::none || along[b] == Second::none) continue;
          double weighted = 0;
          for (int beta = 0; beta < g; ++beta) weighted += weights[beta] * f[beta].second(a, b);
          curvature(along[b], along[a]) = curvature(along[a], along[b]) = weighted;
        }
      }
    });
    sum += curvature;
    user_function::check_derivative(user_function::is_finite(sum), label_);
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

  /// v with derivatives along `count` velocities, the `first` and those after it.
  template <class T, int count>
  static user_function::VectorOf<T, n> along_velocities(const Vector& v_any, int first) {
    user_function::VectorOf<T, n> v = user_function::fixed<n>("v", v_any).template cast<T>();
    for (int i = 0; i < count; ++i) v[first + i].derivatives[i] = 1;
    return v;
  }

  template <class T>
  Eigen::Matrix<T, g, 1> call(const T& t, const user_function::VectorOf<T, N>& q,
                              const user_function::VectorOf<T, n>& v) const {
    const Eigen::Matrix<T, g, 1> f = user_function::to_vector<T, g>(function_(t, q, v));
    for (int i = 0; i < g; ++i) user_function::check_value(std::isfinite(plain(f[i])), label_);
    return f;
  }

  std::string label_;
  Function function_;
};

/// Constraints f(t, q, v) = 0 of n velocities and N coordinates.
/// @param label     the name that NotFinite reports: "constraint blade"
/// @param function  f(t, q, v), one number or a vector (Eigen, fixed size); see automatic_equations()
template <int n, int N, class Function>
std::shared_ptr<const ConstraintFunction> automatic_constraint(std::string label, Function function) {
  return std::make_shared<AutomaticConstraint<n, N, Function>>(std::move(label), std::move(function));
}

/// A guard from a function, differentiated exactly. See automatic_guard().
template <int N, class Function>
class AutomaticGuard final : public Guard {
 public:
  AutomaticGuard(std::string label, Function function)
      : label_(std::move(label)), function_(std::move(function)) {}

  double value(double t, const Vector& q) const override {
    return call<double>(t, user_function::fixed<N>("q", q));
  }

  double rate(double t, const Vector& q, const Vector& q_rate) const override {
    using T = Dual<double, 1>;
    user_function::VectorOf<T, N> moving = user_function::fixed<N>("q", q).template cast<T>();
    const auto direction = user_function::fixed<N>("the rate of q", q_rate);
    for (int i = 0; i < N; ++i) moving[i].derivatives[0] = direction[i];
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
  return std::make_shared<AutomaticGuard<N, Function>>(std::move(label), std::move(function));
}

}  // namespace hybrid_sphere::mechanics

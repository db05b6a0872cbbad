// What the derivatives of a Lagrangian cost: L, p = dL/dv, M = d2L/dv2 and dL/dq - (dp/dq) v - dp/dt at one
// (t, q, v), by this package's Dual, by Eigen's AutoDiffScalar and Boost's autodiff_fvar, both nested, and by
// hand. What counts is the ratio of two lines of one run.
#include <benchmark/benchmark.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <boost/math/differentiation/autodiff.hpp>
#include <cmath>
#include <cstdlib>
#include <unsupported/Eigen/AutoDiff>
#include <vector>

#include "hybrid_sphere/mechanics/automatic.hpp"

namespace {

using hybrid_sphere::mechanics::automatic_equations;
using hybrid_sphere::mechanics::CheckedVector;
using hybrid_sphere::mechanics::CoordinateVelocities;
using hybrid_sphere::mechanics::DifferentiatedLagrangian;
using hybrid_sphere::mechanics::MotionTerms;
using hybrid_sphere::mechanics::with_mass_matrix;

template <int n>
using Numbers = Eigen::Matrix<double, n, 1>;

template <int n>
struct LagrangianTerms {
  double lagrangian;                  ///< L
  Eigen::Matrix<double, n, 1> p;      ///< dL/dv
  Eigen::Matrix<double, n, n> mass;   ///< d2L/dv2
  Eigen::Matrix<double, n, 1> force;  ///< dL/dq - (dp/dq) v - dp/dt
};

/// By this package.
template <int n, class L>
LagrangianTerms<n> terms_of(const DifferentiatedLagrangian<n, n, L>& lagrangian, double t,
                            const Numbers<n>& q, const Numbers<n>& v) {
  const CheckedVector<double, n> place = q, velocity = v;
  MotionTerms terms;
  terms.momentum.resize(n);
  terms.mass.resize(n, n);
  terms.force.resize(n);
  lagrangian.evaluate(t, place, velocity, CoordinateVelocities<n>().terms(place, velocity), terms);
  return {terms.lagrangian, terms.momentum, terms.mass, terms.force};
}

/// Chaplygin's sleigh, mass centre ahead of the blade.
struct Sleigh {
  static constexpr int n = 3;
  double m = 1.3, J = 0.7, a = 0.4;

  // Intermediate results have the type T: AutoDiffScalar's own are expressions that outlive their parts.
  template <class T>
  T operator()(const T&, const Eigen::Matrix<T, n, 1>& q, const Eigen::Matrix<T, n, 1>& v) const {
    using std::cos, std::sin;
    const T s = sin(q[2]);
    const T c = cos(q[2]);
    const T w = a * v[2];
    const T x = v[0] - w * s;
    const T y = v[1] + w * c;
    return m / 2 * (x * x + y * y) + J / 2 * (v[2] * v[2]);
  }

  template <class T>
  Eigen::Matrix<T, n, n> mass(const Eigen::Matrix<T, n, 1>& q) const {
    using std::cos, std::sin;
    const T x = -m * a * sin(q[2]);
    const T y = m * a * cos(q[2]);
    Eigen::Matrix<T, n, n> mass;
    mass << m, 0, x, 0, m, y, x, y, J + m * a * a;
    return mass;
  }

  LagrangianTerms<n> by_hand(const Numbers<n>& q, const Numbers<n>& v) const {
    const double s = std::sin(q[2]);
    const double c = std::cos(q[2]);
    LagrangianTerms<n> terms;
    terms.mass << m, 0, -m * a * s, 0, m, m * a * c, -m * a * s, m * a * c, J + m * a * a;
    terms.p = terms.mass * v;
    terms.lagrangian = v.dot(terms.p) / 2;
    terms.force << m * a * c * v[2] * v[2], m * a * s * v[2] * v[2], 0;
    return terms;
  }
};

/// A ball in z-x-z Euler angles, (12).
struct EulerBall {
  static constexpr int n = 5;
  double m = 1.3, A = 0.52;

  template <class T>
  T operator()(const T&, const Eigen::Matrix<T, n, 1>& q, const Eigen::Matrix<T, n, 1>& v) const {
    using std::cos;
    const T c = cos(q[3]);
    return m / 2 * (v[0] * v[0] + v[1] * v[1]) +
           A / 2 * (v[2] * v[2] + v[3] * v[3] + v[4] * v[4] + 2 * (v[4] * v[2] * c));
  }

  template <class T>
  Eigen::Matrix<T, n, n> mass(const Eigen::Matrix<T, n, 1>& q) const {
    using std::cos;
    Eigen::Matrix<T, n, n> mass = Eigen::Matrix<T, n, n>::Constant(T(0.0));
    mass.diagonal() << m, m, A, A, A;
    mass(2, 4) = mass(4, 2) = A * cos(q[3]);
    return mass;
  }

  LagrangianTerms<n> by_hand(const Numbers<n>& q, const Numbers<n>& v) const {
    const double s = std::sin(q[3]);
    LagrangianTerms<n> terms;
    terms.mass = mass(q);
    terms.p = terms.mass * v;
    terms.lagrangian = v.dot(terms.p) / 2;
    terms.force << 0, 0, A * v[4] * v[3] * s, -A * v[4] * v[2] * s, A * v[2] * v[3] * s;
    return terms;
  }
};

template <class S>
struct ByHand {
  S system;
  LagrangianTerms<S::n> operator()(double, const Numbers<S::n>& q, const Numbers<S::n>& v) const {
    return system.by_hand(q, v);
  }
};

template <class S>
struct ByDual {
  DifferentiatedLagrangian<S::n, S::n, S> lagrangian{S()};
  LagrangianTerms<S::n> operator()(double t, const Numbers<S::n>& q, const Numbers<S::n>& v) const {
    return terms_of(lagrangian, t, q, v);
  }
};

template <class S>
struct ByMassMatrix {
  LagrangianTerms<S::n> operator()(double t, const Numbers<S::n>& q, const Numbers<S::n>& v) const {
    const auto mass = [](const auto&, const auto& x) { return S().mass(x); };
    auto lagrangian = with_mass_matrix(mass, [](const auto&, const auto&) { return 0; });
    const DifferentiatedLagrangian<S::n, S::n, decltype(lagrangian)> differentiated(lagrangian);
    return terms_of(differentiated, t, q, v);
  }
};

/// Outside derivatives along v, inside along v and the motion, and dL/dq by one more pass.
template <class S>
struct ByEigen {
  static constexpr int n = S::n;
  template <class T, int k>
  using Scalar = Eigen::AutoDiffScalar<Eigen::Matrix<T, k, 1>>;
  using Inner = Scalar<double, n + 1>;
  using Outer = Scalar<Inner, n>;

  static Outer constant(const Inner& x) { return {x, Eigen::Matrix<Inner, n, 1>::Constant(Inner(0.0))}; }

  LagrangianTerms<n> operator()(double t, const Numbers<n>& q, const Numbers<n>& v) const {
    Eigen::Matrix<Outer, n, 1> x;
    Eigen::Matrix<Outer, n, 1> w;
    using First = Scalar<double, n>;
    Eigen::Matrix<First, n, 1> y;
    Eigen::Matrix<First, n, 1> u;
    for (int i = 0; i < n; ++i) {
      x[i] = constant(q[i]);
      x[i].value().derivatives()[n] = v[i];
      w[i] = constant(Inner(v[i], n + 1, i));
      w[i].derivatives()[i] = 1.0;
      y[i] = First(q[i], n, i);
      u[i] = v[i];
    }
    const Outer L = S()(constant(Inner(t, n + 1, n)), x, w);
    LagrangianTerms<n> terms;
    terms.lagrangian = L.value().value();
    terms.force = S()(First(t), y, u).derivatives();
    for (int i = 0; i < n; ++i) {
      terms.p[i] = L.derivatives()[i].value();
      terms.mass.col(i) = L.derivatives()[i].derivatives().template head<n>();
      terms.force[i] -= L.derivatives()[i].derivatives()[n];
    }
    return terms;
  }
};

/// One pass for each second derivative, and one for each dL/dq.
template <class S>
struct ByBoost {
  static constexpr int n = S::n;
  using First = boost::math::differentiation::autodiff_fvar<double, 1>;
  using Second = boost::math::differentiation::autodiff_fvar<double, 1, 1>;

  LagrangianTerms<n> operator()(double t, const Numbers<n>& q, const Numbers<n>& v) const {
    const auto zero = boost::math::differentiation::make_ftuple<double, 1, 1>(0.0, 0.0);
    const Second e = std::get<0>(zero);
    const Second s = std::get<1>(zero);
    Eigen::Matrix<Second, n, 1> x = q.template cast<Second>();
    Eigen::Matrix<Second, n, 1> w = v.template cast<Second>();
    Eigen::Matrix<First, n, 1> y = q.template cast<First>();
    const Eigen::Matrix<First, n, 1> u = v.template cast<First>();
    LagrangianTerms<n> terms;
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j <= i; ++j) {
        w[i] += e;
        w[j] += s;
        terms.mass(i, j) = terms.mass(j, i) = S()(Second(t), x, w).derivative(1, 1);
        w[i] = Second(v[i]);
        w[j] = Second(v[j]);
      }
    }
    for (int i = 0; i < n; ++i) x[i] = s * v[i] + q[i];
    for (int i = 0; i < n; ++i) {
      w[i] += e;
      const Second L = S()(s + t, x, w);
      w[i] = Second(v[i]);
      terms.lagrangian = L.derivative(0, 0);
      terms.p[i] = L.derivative(1, 0);
      y[i] = boost::math::differentiation::make_fvar<double, 1>(q[i]);
      terms.force[i] = S()(First(t), y, u).derivative(1) - L.derivative(1, 1);
      y[i] = First(q[i]);
    }
    return terms;
  }
};

template <int n>
double difference(const LagrangianTerms<n>& a, const LagrangianTerms<n>& b) {
  return std::max({std::abs(a.lagrangian - b.lagrangian), (a.p - b.p).cwiseAbs().maxCoeff(),
                   (a.mass - b.mass).cwiseAbs().maxCoeff(), (a.force - b.force).cwiseAbs().maxCoeff()});
}

/// 64 states of numbers in [-2, 2].
template <int n>
std::array<Numbers<n>, 64> states(unsigned seed) {
  std::srand(seed);
  std::array<Numbers<n>, 64> states;
  for (Numbers<n>& state : states) state = 2 * Numbers<n>::Random();
  return states;
}

template <class S, template <class> class Method>
void derivatives(benchmark::State& state) {
  constexpr int n = S::n;
  const Method<S> method{};
  const auto q = states<n>(1);
  const auto v = states<n>(2);
  for (std::size_t i = 0; i < q.size(); ++i) {
    if (!(difference<n>(method(0, q[i], v[i]), S().by_hand(q[i], v[i])) < 1e-13)) {
      return state.SkipWithError("other derivatives than by hand");
    }
  }
  std::size_t i = 0;
  for (auto _ : state) {
    const LagrangianTerms<n> terms = method(0, q[i], v[i]);
    benchmark::DoNotOptimize(&terms);
    benchmark::ClobberMemory();
    i = (i + 1) % q.size();
  }
}

/// The same by way of EquationsOfMotion, as the engine asks for it.
template <class S>
void equations(benchmark::State& state) {
  const auto equations = automatic_equations<S::n>(S());
  const auto fixed_q = states<S::n>(1);
  const auto fixed_v = states<S::n>(2);
  const std::vector<hybrid_sphere::mechanics::Vector> q(fixed_q.begin(), fixed_q.end());
  const std::vector<hybrid_sphere::mechanics::Vector> v(fixed_v.begin(), fixed_v.end());
  MotionTerms terms;
  std::size_t i = 0;
  for (auto _ : state) {
    equations->evaluate(0, q[i], v[i], terms);
    benchmark::ClobberMemory();
    i = (i + 1) % q.size();
  }
}

BENCHMARK(derivatives<Sleigh, ByHand>);
BENCHMARK(derivatives<Sleigh, ByMassMatrix>);
BENCHMARK(derivatives<Sleigh, ByDual>);
BENCHMARK(equations<Sleigh>);
BENCHMARK(derivatives<Sleigh, ByEigen>);
BENCHMARK(derivatives<Sleigh, ByBoost>);
BENCHMARK(derivatives<EulerBall, ByHand>);
BENCHMARK(derivatives<EulerBall, ByMassMatrix>);
BENCHMARK(derivatives<EulerBall, ByDual>);
BENCHMARK(equations<EulerBall>);
BENCHMARK(derivatives<EulerBall, ByEigen>);
BENCHMARK(derivatives<EulerBall, ByBoost>);

}  // namespace

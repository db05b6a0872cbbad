// Systems with so many velocities that their differentiating numbers are taken in parts: the same terms as by
// hand, whatever the functions hold.

#include <gtest/gtest.h>

#include <cmath>

#include "core/mechanics/expect_terms.hpp"
#include "hybrid_sphere/mechanics/by_hand.hpp"
#include "hybrid_sphere/mechanics/solve.hpp"
#include "hybrid_sphere/mechanics/system.hpp"

namespace hybrid_sphere::mechanics::many_velocities_test {
namespace {

/// Links of equal length with equal masses at the joints: M_ij = w_ij cos(q_i - q_j) / n^2.
double weight(int n, int i, int j) { return static_cast<double>(n - std::max(i, j)) / (n * n); }

/// M as a user's function computes it: a matrix of fixed size of its own.
template <int n>
struct Mass {
  template <class T, class Q>
  auto operator()(const T&, const Q& q) const {
    using Number = std::decay_t<decltype(q[0])>;
    using std::cos;
    Eigen::Matrix<Number, n, n> mass;
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < n; ++j) mass(i, j) = weight(n, i, j) * cos(q[i] - q[j]);
    }
    return mass;
  }
};

const auto potential = [](const auto& t, const auto& q) { return t * q.squaredNorm() / 8; };

/// h_i = -sum over j of w_ij sin(q_i - q_j) v_j^2 - dV/dq_i
template <int n>
std::shared_ptr<const EquationsOfMotion> chain_by_hand() {
  return equations_by_hand(n, n, [](double t, const Vector& q, const Vector& v, MotionTerms& terms) {
    terms.mass = Mass<n>()(t, q);
    terms.rate = v;
    terms.momentum = terms.mass * v;
    terms.lagrangian = v.dot(terms.momentum) / 2 - potential(t, q);
    terms.force = -t * q / 4;
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < n; ++j) terms.force[i] -= weight(n, i, j) * std::sin(q[i] - q[j]) * v[j] * v[j];
    }
  });
}

/// L as a sum, which holds no matrix.
template <int n>
std::shared_ptr<const EquationsOfMotion> chain_as_sum() {
  return automatic_equations<n>([](const auto& t, const auto& q, const auto& v) {
    using T = std::decay_t<decltype(q[0] + v[0])>;
    using std::cos;
    T sum = -potential(t, q);
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < n; ++j) sum += weight(n, i, j) / 2 * cos(q[i] - q[j]) * v[i] * v[j];
    }
    return sum;
  });
}

TEST(ManyVelocities, HaveTheEquationsOfTheirMassMatrix) {
  expect_equal(*automatic_equations<25>(with_mass_matrix(Mass<25>(), potential)), *chain_by_hand<25>());
  expect_equal(*automatic_equations<64>(with_mass_matrix(Mass<64>(), potential)), *chain_by_hand<64>());
}

TEST(ManyVelocities, HaveTheEquationsOfTheirLagrangian) {
  expect_equal(*chain_as_sum<11>(), *chain_by_hand<11>());
  expect_equal(*chain_as_sum<25>(), *chain_by_hand<25>());
}

TEST(ManyVelocities, MayHaveAMatrixInTheirLagrangian) {
  constexpr int n = 12;
  expect_equal(*automatic_equations<n>([](const auto& t, const auto& q, const auto& v) {
    using T = std::decay_t<decltype(q[0] + v[0])>;
    const auto mass = Mass<n>()(t, q);
    return T(v.dot(mass * v) / 2 - potential(t, q));
  }),
               *chain_by_hand<n>());
}

TEST(ManyVelocities, HaveTheEquationsOfTheirQuasiVelocities) {
  constexpr int n = 25;
  // q' = (1 + a_i) v with constant a_i: L of q' is that of v with M scaled from both sides.
  const auto share = [](int i) { return 1 + 0.03 * i; };
  const auto rate = [=](const auto& /*q*/, const auto& v) {
    auto scaled = v;
    for (int i = 0; i < n; ++i) scaled[i] = share(i) * v[i];
    return scaled;
  };
  const auto lagrangian = [](const auto&, const auto& q, const auto& v) {
    return v.squaredNorm() / 2 - q.squaredNorm() / 2;
  };
  const auto quasi = automatic_equations<n, n>(rate, lagrangian);
  const auto expected =
      equations_by_hand(n, n, [=](double, const Vector& q, const Vector& v, MotionTerms& terms) {
        terms.lagrangian = lagrangian(0, q, v);
        terms.mass.setIdentity();
        terms.momentum = v;
        for (int i = 0; i < n; ++i) {
          terms.rate[i] = share(i) * v[i];
          terms.force[i] = -share(i) * q[i];
        }
      });
  expect_equal(*quasi, *expected);
}

/// f = v.v t + q.v - 1 and the product of the first and the last velocity.
template <int n>
void expect_constraint() {
  const auto function = [](const auto& t, const auto& q, const auto& v) {
    using T = std::decay_t<decltype(v[0])>;
    return Eigen::Matrix<T, 2, 1>(v.squaredNorm() * t + q.dot(v) - 1, v[0] * v[n - 1]);
  };
  const auto f = automatic_constraint<n, n>("f", function);
  RandomVectors random;
  const double t = 0.7;
  const Vector q = random(n), v = random(n), rate = random(n);
  ConstraintTerms terms;
  f->evaluate(t, q, v, rate, terms);
  Matrix gradient = Matrix::Zero(2, n);
  gradient.row(0) = 2 * t * v + q;
  gradient(1, 0) = v[n - 1];
  gradient(1, n - 1) = v[0];
  const double size = 64;  // of the sums
  expect_equal(terms.value, function(t, q, v), size, "value");
  expect_equal(terms.gradient, gradient, size, "gradient");
  expect_equal(terms.gamma, Eigen::Vector2d(-v.squaredNorm() - rate.dot(v), 0), size, "gamma");
  Vector value;
  f->evaluate(t, q, v, value, terms.gradient);
  EXPECT_EQ(value, terms.value);
  expect_equal(terms.gradient, gradient, size, "gradient alone");
  Matrix curvature = Matrix::Zero(n, n);
  f->add_curvature(t, q, v, Eigen::Vector2d(3, 5), curvature);
  Matrix expected = 6 * t * Matrix::Identity(n, n);
  expected(0, n - 1) = expected(n - 1, 0) = 5;
  expect_equal(curvature, expected, size, "curvature");
}

TEST(ManyVelocities, HaveTheTermsOfTheirConstraints) {
  expect_constraint<12>();
  expect_constraint<25>();
}

// Conserved on the constraint, which is linear and homogeneous: the energy, after the impulse.
TEST(ManyVelocities, AreSolved) {
  constexpr int n = 25;
  std::array<std::string, n> names;
  for (std::size_t i = 0; i < n; ++i) names[i] = "q" + std::to_string(i);
  System<n> chain(names, [](const auto&, const auto& q, const auto& v) {
    return v.squaredNorm() / 2 - q.squaredNorm() / 2;
  });
  chain.constrain(
      "tie", [](const auto&, const auto& q, const auto& v) { return v[0] + q[0] * v[n - 1]; }, from(0.5));
  const Solution solution = solve(chain, {0, Vector::LinSpaced(n, 0.1, 1), Vector::Ones(n)}, 2);
  ASSERT_EQ(solution.status().stop, Stop::reached_end) << solution.status().message;
  ASSERT_EQ(solution.switches().size(), 1U);
  EXPECT_NEAR(solution.at(2).energy, solution.switches()[0].energy_after, 1e-8);
  EXPECT_NEAR(solution.at(2).q[1], solution.at(0).q[1] * std::cos(2) + std::sin(2), 1e-8);
}

}  // namespace
}  // namespace hybrid_sphere::mechanics::many_velocities_test

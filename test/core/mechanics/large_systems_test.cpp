// Eight velocities, sixteen coordinates: stage 2 against the whole linear system in long double, stage 3 by
// what it keeps and against the same motion in other coordinates.

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <cfloat>
#include <cmath>

#include "core/mechanics/expect_terms.hpp"
#include "core/mechanics/particle.hpp"
#include "core/mechanics/plane_chain.hpp"
#include "core/mechanics/singular_values.hpp"
#include "core/mechanics/systems_by_hand.hpp"
#include "support/elimination.hpp"

namespace hybrid_sphere::mechanics::large_systems_test {
namespace {

using hybrid_sphere::testing::condition_number, hybrid_sphere::testing::impulse_of,
    hybrid_sphere::testing::solve_by_elimination;
using testing::accurate, testing::blade, testing::cone, testing::coupling, testing::link_length,
    testing::links, testing::plane_chain;

using Real = long double;
using RealVector = Eigen::Matrix<Real, Eigen::Dynamic, 1>;
using RealMatrix = Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic>;

constexpr int blades[] = {3, 7};
constexpr double tie_rate = 0.3;
const auto tie = [](auto, const auto&, const auto& v) { return v[2] - 2 * v[5] - tie_rate; };

RealMatrix mass_of(const Vector& q) {
  RealMatrix mass(links, links);
  for (int i = 0; i < links; ++i) {
    for (int j = 0; j < links; ++j) {
      mass(i, j) = static_cast<Real>(coupling(i, j)) * std::cos(static_cast<Real>(q[i]) - q[j]);
    }
  }
  return mass;
}

/// C of both blades, and of the tie.
RealMatrix linear_rows(const Vector& q) {
  RealMatrix gradient = RealMatrix::Zero(3, links);
  for (Index b = 0; b < 2; ++b) {
    const int k = blades[b];
    for (int i = 0; i <= k; ++i) {
      gradient(b, i) = static_cast<Real>(link_length(i)) * std::cos(static_cast<Real>(q[i]) - q[k]);
    }
  }
  gradient(2, 2) = 1;
  gradient(2, 5) = -2;
  return gradient;
}

/// The cone is v.S v.
RealMatrix cone_form() {
  RealVector diagonal(links);
  diagonal << 1, 1, 1, 0, 0, -1, -1, -1;
  return diagonal.asDiagonal();
}

struct Expected {
  RealVector velocity;
  RealVector multipliers;
  double condition;  // of the linear system
};

/// K v - C^T Lambda = M v1, C v = u, all unknowns at once by Gauss' elimination.
Expected whole_system(const RealMatrix& hessian, const RealMatrix& gradient, const RealVector& momentum,
                      const RealVector& u) {
  const Index g = gradient.rows();
  RealMatrix whole(links + g, links + g);
  whole << hessian, -gradient.transpose(), gradient, RealMatrix::Zero(g, g);
  RealVector right(links + g);
  right << momentum, u;
  const RealVector unknowns = solve_by_elimination(whole, right);
  return {unknowns.head(links), unknowns.tail(g), condition_number(whole.cast<double>())};
}

Expected expected_of_linear(const Vector& q, const Vector& v1) {
  RealVector u = RealVector::Zero(3);
  u[2] = static_cast<Real>(tie_rate);
  const RealMatrix mass = mass_of(q);
  return whole_system(mass, linear_rows(q), mass * v1.cast<Real>(), u);
}

/// A basis of the velocities for which both blades are at rest across: each free link moves by itself, and
/// the two links of the blades follow. `rows` is zero beyond a blade's own link.
RealMatrix kernel_of(const RealMatrix& rows) {
  const int first = blades[0], second = blades[1];
  RealMatrix kernel = RealMatrix::Zero(links, links - 2);
  Index column = 0;
  for (Index i = 0; i < links; ++i) {
    if (i == first || i == second) continue;
    kernel(i, column) = 1;
    kernel(first, column) = -rows(0, i) / rows(0, first);
    kernel(second, column) = -(rows(1, i) + rows(1, first) * kernel(first, column)) / rows(1, second);
    ++column;
  }
  return kernel;
}

/// True if all pivots of a symmetric matrix are positive.
bool is_positive_definite(RealMatrix a) {
  for (Index k = 0; k < a.rows(); ++k) {
    if (!(a(k, k) > 0)) return false;
    for (Index i = k + 1; i < a.rows(); ++i) {
      const Real factor = a(i, k) / a(k, k);
      for (Index j = k + 1; j < a.cols(); ++j) a(i, j) -= factor * a(k, j);
    }
  }
  return true;
}

/// With the multiplier of the cone given, (M - 2 lambda S) v - C^T Lambda = M v1 on both blades is linear. As
/// long as M - 2 lambda S is positive definite on the blades' kernel, v.S v grows with lambda: its root is
/// the nearest velocity of all, found by bisection.
Expected expected_of_cone(const Vector& q, const Vector& v1) {
  const RealMatrix mass = mass_of(q), form = cone_form(), rows = linear_rows(q).topRows(2);
  const RealMatrix kernel = kernel_of(rows);
  const auto hessian = [&](Real lambda) -> RealMatrix { return mass - 2 * lambda * form; };
  const auto velocity = [&](Real lambda) {
    return whole_system(hessian(lambda), rows, mass * v1.cast<Real>(), RealVector::Zero(2)).velocity;
  };
  const auto too_low = [&](Real lambda) {
    const RealMatrix reduced = kernel.transpose().lazyProduct(hessian(lambda)).lazyProduct(kernel);
    if (!is_positive_definite(reduced)) return lambda < 0;
    const RealVector v = velocity(lambda);
    return v.dot(form * v) < 0;
  };
  Real low = -100, high = 100;  // beyond what keeps it definite: M is of order 1
  for (int i = 0; i < 100; ++i) (too_low((low + high) / 2) ? low : high) = (low + high) / 2;
  Expected expected;
  expected.velocity = velocity(low);
  RealMatrix gradient(3, links);
  gradient << rows, 2 * (form * expected.velocity).transpose();
  const Expected at_cone = whole_system(hessian(low), rows, mass * v1.cast<Real>(), RealVector::Zero(2));
  expected.multipliers.resize(3);
  expected.multipliers << at_cone.multipliers, low;
  expected.condition = whole_system(hessian(low), gradient, expected.velocity, RealVector::Zero(3)).condition;
  return expected;
}

class ChainImpulse : public ::testing::TestWithParam<bool> {};

// The errors of M and C, and those of a backward stable solution, are roundings of each of the 11 unknowns,
// enlarged by the condition number.
TEST_P(ChainImpulse, OfThreeConstraintsIsThatOfTheWholeSystem) {
  const bool linear = GetParam();
  System<links> chain = plane_chain(1);
  chain.constrain("blade 3", blade(blades[0]), always()).constrain("blade 7", blade(blades[1]), always());
  linear ? chain.constrain("third", tie, always()) : chain.constrain("third", cone, always());
  RandomVectors random;
  for (int i = 0; i < 20; ++i) {
    SCOPED_TRACE(::testing::Message() << "case " << i);
    const Vector q = random(links);
    const Vector v1 = random(links);
    const Expected expected = linear ? expected_of_linear(q, v1) : expected_of_cone(q, v1);
    const Impulse impulse = impulse_of(chain, q, v1);
    const double size = v1.norm() + static_cast<double>(expected.multipliers.norm());
    const double allowed = (links + 3) * DBL_EPSILON * expected.condition * size;
    EXPECT_LE(static_cast<double>((impulse.velocity.cast<Real>() - expected.velocity).norm()), allowed);
    EXPECT_LE(static_cast<double>((impulse.multipliers.cast<Real>() - expected.multipliers).norm()), allowed);
    EXPECT_EQ(impulse.rank, 3);
    if (linear) {
      EXPECT_EQ(impulse.iterations, 1);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(LinearAndNot, ChainImpulse, ::testing::Bool(),
                         [](const auto& info) { return info.param ? "Linear" : "Nonlinear"; });

const Vector& start_angles() {
  static const Vector q = testing::vector({0.3, -0.2, 0.5, 0.9, 0.1, -0.6, 0.4, 0.2});
  return q;
}
const Vector& start_rates() {
  static const Vector v = testing::vector({0.5, 0.4, -0.3, 0.7, 0.2, -0.6, 0.3, 0.1});
  return v;
}

// With accuracy a no velocity is off by more than a of that which holds all kinetic energy T alone, and no
// coordinate by more than a of the way it goes at it in a turning time, speed/acceleration. The momentum of
// the one is at most 2 T divided by it, and so is the force on the other: 4 T a for each of the eight.
TEST(Chain, KeepsItsEnergyUnderThreeConstraints) {
  System<links> chain = plane_chain(1);
  chain.constrain("blade 3", blade(3), from(0.5))
      .constrain("blade 7", blade(7), from(0.5))
      .constrain("cone", cone, from(0.75));
  for (const double accuracy : {1e-5, 1e-9, 1e-12}) {
    const Solution solution = solve(chain, {0, start_angles(), start_rates()}, 3, accurate(accuracy));
    ASSERT_EQ(solution.status().stop, Stop::reached_end) << solution.status().message;
    ASSERT_EQ(solution.switches().size(), 2u);
    const double first = solution.at(0).energy;
    double kinetic = 0, drift = 0;
    for (int i = 0; i <= 60; ++i) {
      const double t = 0.05 * i;
      const State state = solution.at(t);
      double expected = first;
      for (const Switch& change : solution.switches()) {
        if (t >= change.time) expected = change.energy_after;
      }
      kinetic = std::max(kinetic, state.kinetic_energy);
      drift = std::max(drift, std::abs(state.energy - expected));
    }
    for (const Switch& change : solution.switches()) {
      // Carnot: homogeneous constraints take energy.
      EXPECT_LT(change.energy_after, change.energy_before);
    }
    EXPECT_LE(drift, 4 * links * kinetic * accuracy) << "accuracy " << accuracy;
  }
}

// f counts as 0 at 8 + n roundings of its terms; it is evaluated here with at most as many.
TEST(Chain, StaysOnThreeConstraints) {
  System<links> chain = plane_chain(1);
  chain.constrain("blade 3", blade(blades[0]), from(0)).constrain("blade 7", blade(blades[1]), from(0));
  chain.constrain("cone", cone, from(0));
  const Solution solution = solve(chain, {0, start_angles(), start_rates()}, 3, accurate(1e-6));
  ASSERT_EQ(solution.status().stop, Stop::reached_end) << solution.status().message;
  for (int i = 0; i <= 100; ++i) {
    const State state = solution.at(0.03 * i);
    const RealVector v = state.v.cast<Real>();
    RealMatrix gradient = linear_rows(state.q);
    gradient.row(2) = (cone_form() * v).transpose();
    const RealVector value = gradient * v;
    for (Index b = 0; b < 3; ++b) {
      const Real terms = gradient.row(b).cwiseAbs().dot(v.cwiseAbs().transpose());
      EXPECT_LE(static_cast<double>(std::abs(value[b]) / terms), 2 * (8 + links) * DBL_EPSILON)
          << "function " << b << " at t = " << state.time;
    }
  }
}

/// The chain in the directions of its links, (cos a_i, sin a_i), which their rates turn.
System<links, 2 * links> chain_of_directions(double gravity) {
  System<links, 2 * links>::CoordinateNames coordinates;
  System<links, 2 * links>::VelocityNames velocities;
  for (std::size_t i = 0; i < links; ++i) {
    coordinates[2 * i] = "cos" + std::to_string(i);
    coordinates[2 * i + 1] = "sin" + std::to_string(i);
    velocities[i] = "w" + std::to_string(i);
  }
  const auto rate = [](const auto& q, const auto& v) {
    using T = std::decay_t<decltype(q[0] * v[0])>;
    Eigen::Matrix<T, 2 * links, 1> result;
    for (int i = 0; i < links; ++i) {
      result[2 * i] = -q[2 * i + 1] * v[i];
      result[2 * i + 1] = q[2 * i] * v[i];
    }
    return result;
  };
  const auto lagrangian = [=](auto, const auto& q, const auto& v) {
    return testing::chain_lagrangian([&](int i) { return q[2 * i]; }, [&](int i) { return q[2 * i + 1]; }, v,
                                     gravity);
  };
  const auto no_forces = [](auto, const auto&, const auto&) {
    return Eigen::Matrix<double, links, 1>::Zero().eval();
  };
  System<links, 2 * links> chain(coordinates, velocities, rate, lagrangian, no_forces);
  chain.normalize = [](Vector& q) {
    for (Index i = 0; i < links; ++i) q.segment<2>(2 * i).normalize();
  };
  return chain;
}

auto blade_of_directions(int k) {
  return [=](auto, const auto& q, const auto& v) {
    return testing::velocity_across(
        k, [&](int i, int j) { return q[2 * i] * q[2 * j] + q[2 * i + 1] * q[2 * j + 1]; }, v);
  };
}

Vector directions(const Vector& angles) {
  Vector q(2 * angles.size());
  for (Index i = 0; i < angles.size(); ++i) {
    q.segment<2>(2 * i) << std::cos(angles[i]), std::sin(angles[i]);
  }
  return q;
}

/// Both motions, off the true one by the accuracy times scales of order 1 and by what errors on the way grow
/// to, which a disturbed motion tells.
TEST(Chain, MovesAlikeInSixteenCoordinates) {
  constexpr double accuracy = 1e-9, duration = 2, disturbance = 0x1p-20;
  System<links> angles = plane_chain(1);
  System<links, 2 * links> turning = chain_of_directions(1);
  angles.constrain("blade 3", blade(3), from(0.5)).constrain("cone", cone, from(1));
  turning.constrain("blade 3", blade_of_directions(3), from(0.5)).constrain("cone", cone, from(1));
  const Initial start{0, start_angles(), start_rates()};
  const Solution a = solve(angles, start, duration, accurate(accuracy));
  const Solution b = solve(turning, {0, directions(start.q), start.v}, duration, accurate(accuracy));
  const Solution disturbed =
      solve(angles, {0, start.q, start.v.array() + disturbance}, duration, accurate(accuracy));
  ASSERT_EQ(b.status().stop, Stop::reached_end) << b.status().message;
  ASSERT_EQ(b.switches().size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(a.switches()[i].time, b.switches()[i].time);
    EXPECT_EQ(a.switches()[i].rank, b.switches()[i].rank);
  }
  double growth = 1, speed = 0;
  for (int i = 0; i <= 40; ++i) {
    const double t = duration / 40 * i;
    const State here = a.at(t), there = b.at(t), other = disturbed.at(t);
    growth =
        std::max({growth, (other.q - here.q).norm() / disturbance, (other.v - here.v).norm() / disturbance});
    speed = std::max(speed, here.v.norm());
    const double allowed = 2 * accuracy * growth * std::max(1.0, speed) * links;
    EXPECT_LE((there.q - directions(here.q)).norm(), allowed) << "t = " << t;
    EXPECT_LE((there.v - here.v).norm(), allowed) << "t = " << t;
    EXPECT_LE((there.multipliers - here.multipliers).norm(), allowed * growth) << "t = " << t;
    for (Index k = 0; k < links; ++k) {
      EXPECT_NEAR(there.q.segment<2>(2 * k).norm(), 1, 2 * DBL_EPSILON) << "t = " << t;
    }
  }
}

}  // namespace
}  // namespace hybrid_sphere::mechanics::large_systems_test

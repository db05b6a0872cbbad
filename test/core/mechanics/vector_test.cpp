// Vectors refuse a component that they do not have, wherever a user names one, and take their numbers in
// braces.

#include "hybrid_sphere/mechanics/vector.hpp"

#include <gtest/gtest.h>

#include <string>
#include <utility>

#include "core/mechanics/particle.hpp"
#include "hybrid_sphere/mechanics/by_hand.hpp"
#include "hybrid_sphere/mechanics/solve.hpp"
#include "hybrid_sphere/mechanics/system.hpp"

namespace hybrid_sphere::mechanics::vector_test {
namespace {

using testing::vector;

template <class Call>
std::string refusal_of(Call call) {
  try {
    call();
  } catch (const std::out_of_range& error) {
    return error.what();
  }
  return "not refused";
}

const Initial start{0, {0, 0}, {1, 0.5}};
const auto lagrangian = [](auto, const auto&, const auto& v) { return v.squaredNorm() / 2; };
const char* const third_of_two = "component [2] of a vector of 2; allowed: 0 to 1";

template <class Forces>
std::string refusal_of_forces(Forces forces) {
  const System<2> system({"x", "y"}, lagrangian, forces);
  return refusal_of([&] { solve(system, start, 1); });
}

TEST(Components, ThatForcesDoNotHaveAreRefused) {
  EXPECT_EQ(refusal_of_forces([](double, const auto&, const auto& v) { return Eigen::Vector2d(v[2], 0); }),
            third_of_two);
  EXPECT_EQ(refusal_of_forces([](double, const auto& q, const auto&) { return Eigen::Vector2d(q(2), 0); }),
            third_of_two);
  EXPECT_EQ(refusal_of_forces([](double, const auto&, const auto& v) { return Eigen::Vector2d(v[-1], 0); }),
            "component [-1] of a vector of 2; allowed: 0 to 1");
}

TEST(Components, ThatALagrangianDoesNotHaveAreRefused) {
  const System<2> system({"x", "y"},
                         [](auto, const auto& q, const auto& v) { return v.squaredNorm() / 2 - q[2]; });
  EXPECT_EQ(refusal_of([&] { solve(system, start, 1); }), third_of_two);
  const auto one = [](auto, const auto&) { return Eigen::Matrix2d(Eigen::Matrix2d::Identity()); };
  const System<2> of_matrix({"x", "y"}, with_mass_matrix(one, [](auto, const auto& q) { return q[2]; }));
  EXPECT_EQ(refusal_of([&] { solve(of_matrix, start, 1); }), third_of_two);
}

TEST(Components, ThatARateDoesNotHaveAreRefused) {
  const auto rate = [](const auto&, const auto& v) {
    return Eigen::Matrix<std::decay_t<decltype(v[0])>, 2, 1>(v[0], v[2]);
  };
  const System<2> system({"x", "y"}, {"a", "b"}, rate, lagrangian);
  EXPECT_EQ(refusal_of([&] { solve(system, start, 1); }), third_of_two);
}

TEST(Components, ThatConstraintsAndGuardsDoNotHaveAreRefused) {
  const auto level = [](auto, const auto&, const auto& v) { return v[1]; };
  System<2> constrained({"x", "y"}, lagrangian);
  constrained.constrain(
      "c", [](auto, const auto& q, const auto& v) { return v[0] - q[2] * v[1]; }, from(0.5));
  EXPECT_EQ(refusal_of([&] { solve(constrained, start, 1); }), third_of_two);
  System<2> guarded({"x", "y"}, lagrangian);
  guarded.constrain("c", level, while_positive([](auto, const auto& q) { return q[3] - 1; }));
  EXPECT_EQ(refusal_of([&] { solve(guarded, start, 1); }), "component [3] of a vector of 2; allowed: 0 to 1");
}

TEST(Components, ThatTermsByHandDoNotHaveAreRefused) {
  const System<1> system(
      {"x"}, {"x_dot"},
      equations_by_hand(1, 1, [](double, const Vector&, const Vector& v, MotionTerms& terms) {
        terms.lagrangian = v[0] * v[0] / 2;
        terms.rate = terms.momentum = v;
        terms.mass.setOnes();
        terms.force[1] = 0;
      }));
  EXPECT_EQ(refusal_of([&] {
              solve(system, {0, {0}, {1}}, 1);
            }),
            "component [1] of a vector of 1; allowed: 0 to 0");
}

TEST(Components, ThatASolutionDoesNotHaveAreRefused) {
  const Solution solution = solve(testing::particle(), start, 1);
  EXPECT_EQ(refusal_of([&] { return solution.at(1).q[2]; }), third_of_two);
  EXPECT_EQ(refusal_of([&] { return solution.at(1).multipliers[0]; }),
            "component [0] of a vector of 0; allowed: none");
}

TEST(Components, InBracesAreAVector) {
  const Vector q = {1, 2.5, -3};
  EXPECT_EQ(q, Eigen::Vector3d(1, 2.5, -3));
  Initial initial{0.5, {1}, {2, 3}};
  EXPECT_EQ(initial.q, vector({1}));
  EXPECT_EQ(initial.v, vector({2, 3}));
  initial.q = {4, 5};
  EXPECT_EQ(initial.q, vector({4, 5}));
  initial = {1, {}, Vector::Ones(2)};
  EXPECT_EQ(initial.q.size(), 0);
  EXPECT_EQ(solve(testing::particle(), {0, {1, 2}, {3, 4}}, 1).at(1).q, vector({4, 6}));
  EXPECT_EQ(refusal_of([] { CheckedVector<double, 2>{1, 2, 3}; }), third_of_two);
}

// What Eigen's vectors can do these can.
TEST(Vector, IsOneOfEigen) {
  const Eigen::VectorXd plain = Eigen::VectorXd::LinSpaced(3, 1, 3);
  Vector a = plain;
  const Vector b(2 * a);
  EXPECT_EQ(a.dot(b), 28);
  a << 4, 5, 6;
  EXPECT_EQ(a.head<2>(), Eigen::Vector2d(4, 5));
  a = plain;
  EXPECT_EQ(a, plain);
  a[1] = 7;
  a(2) = 8;
  EXPECT_EQ(a(1, 0), 7);
  EXPECT_EQ(a(Eigen::last), 8);
  const Vector moved = std::move(a);
  EXPECT_EQ(moved.size(), 3);
  EXPECT_EQ(Vector(2).size(), 2);
}

}  // namespace
}  // namespace hybrid_sphere::mechanics::vector_test

// Terms written by hand that have wrong sizes, are left unset or are not symmetric are refused by name.

#include <gtest/gtest.h>

#include <cmath>

#include "core/mechanics/particle.hpp"
#include "hybrid_sphere/mechanics/by_hand.hpp"
#include "hybrid_sphere/mechanics/solve.hpp"
#include "hybrid_sphere/mechanics/system.hpp"

namespace hybrid_sphere::mechanics::bad_terms_test {
namespace {

using testing::vector;

void fill_free(const Vector& v, MotionTerms& terms) {
  terms.lagrangian = v.dot(v) / 2;
  terms.rate = v;
  terms.momentum = v;
  terms.mass = Matrix::Identity(v.size(), v.size());
  terms.force = Vector::Zero(v.size());
}

template <class Change>
System<3> body(Change change) {
  return {{"x", "y", "z"},
          {"x_dot", "y_dot", "z_dot"},
          equations_by_hand(3, 3, [change](double, const Vector&, const Vector& v, MotionTerms& terms) {
            fill_free(v, terms);
            change(terms);
          })};
}

const Initial start{0, vector({0, 0, 0}), vector({1, 0, 0})};

std::string refusal_of(const Model& model) {
  try {
    return "not refused: " + std::string(to_string(solve(model, start, 1).status().stop));
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
}

TEST(TermsByHand, OfWrongSizesAreRefused) {
  EXPECT_EQ(refusal_of(body([](MotionTerms& terms) { terms.mass = Matrix::Identity(2, 2); })),
            "the equations' mass has 2 x 2 components; the model has 3 x 3");
  EXPECT_EQ(refusal_of(body([](MotionTerms& terms) { terms.force = Vector::Zero(2); })),
            "the equations' force has 2 components; the model has 3");
  EXPECT_EQ(refusal_of(body([](MotionTerms& terms) { terms.momentum = Vector::Zero(4); })),
            "the equations' momentum has 4 components; the model has 3");
  EXPECT_EQ(refusal_of(body([](MotionTerms& terms) { terms.rate = Vector::Zero(1); })),
            "the equations' rate has 1 components; the model has 3");
}

TEST(TermsByHand, ThatAreNotSymmetricAreRefused) {
  EXPECT_EQ(refusal_of(body([](MotionTerms& terms) { terms.mass(0, 1) = 0.5; })),
            "the equations' mass is not symmetric: components (2, 1) and (1, 2) are 0 and 0.5");
}

TEST(TermsByHand, OfConstraintsOfWrongSizesAreRefused) {
  System<3> wrong = body([](MotionTerms&) {});
  wrong.constrain(
      "short",
      constraint_by_hand(1,
                         [](double, const Vector&, const Vector& v, const Vector&, ConstraintTerms& terms) {
                           terms.value = v.head(1);
                           terms.gradient = Matrix::Ones(1, 2);
                           terms.gamma = Vector::Zero(1);
                         }),
      from(0.5));
  EXPECT_EQ(refusal_of(wrong), "constraint short's gradient has 1 x 2 components; the model has 1 x 3");
}

/// A mass of 1, with another number off the diagonal, that is said to have blocks.
class Blocks final : public EquationsOfMotion {
 public:
  explicit Blocks(Index block) : block_(block) {}
  Index coordinates() const override { return 3; }
  Index velocities() const override { return 3; }
  Index mass_block() const override { return block_; }
  void evaluate(double, const Vector&, const Vector& v, MotionTerms& terms) const override {
    fill_free(v, terms);
    terms.mass(0, 2) = terms.mass(2, 0) = 0.5;
  }
  void momentum(double t, const Vector& q, const Vector& v, Vector& p, Matrix& mass) const override {
    MotionTerms terms;
    evaluate(t, q, v, terms);
    p = terms.momentum;
    mass = terms.mass;
  }

 private:
  Index block_;
};

TEST(TermsByHand, OutsideOfTheirBlocksAreRefused) {
  const auto model = [](Index block) {
    return System<3>({"x", "y", "z"}, {"x_dot", "y_dot", "z_dot"}, std::make_shared<Blocks>(block));
  };
  EXPECT_EQ(refusal_of(model(1)),
            "the equations' mass has the component (3, 1) = 0.5 outside of its blocks of 1; allowed: 0");
  EXPECT_EQ(refusal_of(model(2)),
            "the equations' mass_block() = 2 is refused; allowed: a divisor of the number of velocities, 3");
  EXPECT_EQ(refusal_of(model(3)), "not refused: reached_end");
}

/// The x velocity is 0; says that it depends on y alone.
class Misleading final : public ConstraintFunction {
 public:
  Index size() const override { return 1; }
  bool depends_on(Index s) const override { return s == 1; }
  void evaluate(double, const Vector&, const Vector& v, const Vector&,
                ConstraintTerms& terms) const override {
    evaluate(0, v, v, terms.value, terms.gradient);
    terms.gamma = Vector::Zero(1);
  }
  void evaluate(double, const Vector&, const Vector& v, Vector& value, Matrix& gradient) const override {
    value = v.head(1);
    gradient = Matrix::Identity(1, 3);
  }
  void add_curvature(double, const Vector&, const Vector&, const Vector&, Matrix&) const override {}
};

TEST(TermsByHand, OfConstraintsOnOtherVelocitiesAreRefused) {
  System<3> wrong = body([](MotionTerms&) {});
  wrong.constrain("ahead", std::shared_ptr<const ConstraintFunction>(std::make_shared<Misleading>()),
                  from(0.5));
  EXPECT_EQ(refusal_of(wrong),
            "constraint ahead's gradient is not 0 in column 1, but depends_on(0) is false");
}

TEST(TermsByHand, ThatAreLeftUnsetEndTheMotion) {
  const System<3> unset(
      {"x", "y", "z"}, {"x_dot", "y_dot", "z_dot"},
      equations_by_hand(3, 3, [](double, const Vector&, const Vector& v, MotionTerms& terms) {
        terms.lagrangian = 0;
        terms.rate = v;
        terms.momentum = v;
        terms.mass.setIdentity();
      }));
  const Solution solution = solve(unset, start, 1);
  EXPECT_EQ(solution.status().stop, Stop::not_finite) << solution.status().message;
  EXPECT_EQ(solution.status().time, 0);
}

// 1/t and log(t) have no value at the time 0, which the motion never comes to.
TEST(TermsByHand, MayHaveNoValueAtTheTimeZero) {
  const auto forced = [](auto force) {
    return System<1>(
        {"x"}, {"x_dot"},
        equations_by_hand(1, 1, [force](double t, const Vector&, const Vector& v, MotionTerms& terms) {
          fill_free(v, terms);
          terms.force[0] = force(t);
        }));
  };
  const Initial late{1, vector({0}), vector({1})};
  const Solution inverse = solve(forced([](double t) { return 1 / t; }), late, 1);
  ASSERT_EQ(inverse.status().stop, Stop::reached_end) << inverse.status().message;
  EXPECT_NEAR(inverse.at(2).v[0], 1 + std::log(2), 1e-9);  // v = 1 + log t
  const Solution logarithm = solve(forced([](double t) { return std::log(t); }), late, 1);
  ASSERT_EQ(logarithm.status().stop, Stop::reached_end) << logarithm.status().message;
  EXPECT_NEAR(logarithm.at(2).v[0], 2 * std::log(2), 1e-9);  // v = 1 + t log t - t + 1
}

// What the equations cannot tell at all is a status, not an exception.
TEST(TermsByHand, OfWhichTheRateIsNotFiniteEndTheMotion) {
  const System<1> lost(
      {"x"}, {"x_dot"},
      equations_by_hand(1, 1, [](double t, const Vector&, const Vector& v, MotionTerms& terms) {
        fill_free(v, terms);
        if (t < 1) terms.rate[0] = std::log(-1.0);
      }));
  const Solution solution = solve(lost, {1, vector({0}), vector({1})}, 1);
  EXPECT_EQ(solution.status().stop, Stop::not_finite) << solution.status().message;
}

TEST(Duration, ThatTheClockCannotTellIsRefused) {
  const System<3> free = body([](MotionTerms&) {});
  EXPECT_THROW(solve(free, {1e9, start.q, start.v}, 1e-9), std::invalid_argument);
}

}  // namespace
}  // namespace hybrid_sphere::mechanics::bad_terms_test

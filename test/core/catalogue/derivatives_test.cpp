// Each entry twice: differentiated automatically, and with derivatives by hand.

#include <gtest/gtest.h>

#include <random>

#include "core/catalogue/variations.hpp"

namespace hybrid_sphere::mechanics::catalogue::testing::derivatives_test {
namespace {

constexpr double unit = 0x1p-53;  // rounding of one operation, relative

double largest(const Eigen::MatrixXd& matrix) {
  return matrix.size() == 0 ? 0 : matrix.cwiseAbs().maxCoeff();
}

class Derivatives : public ::testing::TestWithParam<Variation> {
 protected:
  Derivatives()
      : example_(entry(GetParam().entry).build(values_of(GetParam()))),
        automatic_(example_.model),
        by_hand_(example_.by_hand) {}

  // Coordinates up to 2, velocities up to 4, on the manifold where there is one.
  void draw() {
    std::uniform_real_distribution<double> uniform(-1, 1);
    const auto any = [&] { return uniform(generator_); };
    t_ = 1 + any();
    q_ = 2 * Vector::NullaryExpr(automatic_.equations->coordinates(), any);
    v_ = 4 * Vector::NullaryExpr(automatic_.equations->velocities(), any);
    multipliers_ = 3 * Vector::NullaryExpr(automatic_.multipliers(), any);
    if (automatic_.normalize) automatic_.normalize(q_);
    by_hand_.equations->evaluate(t_, q_, v_, terms_);
  }

  // How large the parts can be that a sum adds up: each v, and each derivative by q or t, whose factors are
  // arguments of sin, cos and exp no faster than `fastest`.
  double speed() const { return fastest * (1 + largest(v_) + largest(terms_.rate)); }

  static constexpr double fastest = 8;  // exp(6 t) is the fastest of all variations
  static constexpr double few = 32;     // units; some tens of operations, their roundings largely cancel
  Example example_;
  const Model& automatic_;
  const Model& by_hand_;
  std::mt19937 generator_{20051};
  double t_ = 0;
  Vector q_, v_, multipliers_;
  MotionTerms terms_;
};

TEST_P(Derivatives, TheMotionAgreeWithThoseByHand) {
  ASSERT_EQ(automatic_.coordinates, by_hand_.coordinates);
  ASSERT_EQ(automatic_.velocities, by_hand_.velocities);
  for (int i = 0; i < 200; ++i) {
    draw();
    MotionTerms automatic;
    automatic_.equations->evaluate(t_, q_, v_, automatic);
    const double mass = static_cast<double>(v_.size()) * largest(terms_.mass);
    const double momentum = mass * speed();
    const double energy =
        momentum * speed() + std::abs(terms_.lagrangian) + largest(terms_.force) * largest(q_);
    EXPECT_LE(largest(automatic.mass - terms_.mass), few * unit * mass);
    EXPECT_LE(largest(automatic.momentum - terms_.momentum), few * unit * momentum);
    EXPECT_LE(largest(automatic.force - terms_.force),
              few * unit * (momentum * speed() + largest(terms_.force)));
    EXPECT_LE(std::abs(automatic.lagrangian - terms_.lagrangian), few * unit * energy);
    EXPECT_LE(largest(automatic.rate - terms_.rate), few * unit * largest(v_) * (1 + largest(q_)));
  }
}

TEST_P(Derivatives, TheConstraintsAgreeWithThoseByHand) {
  ASSERT_EQ(automatic_.constraints.size(), by_hand_.constraints.size());
  for (int i = 0; i < 200; ++i) {
    draw();
    for (std::size_t k = 0; k < automatic_.constraints.size(); ++k) {
      const ConstraintFunction& function = *automatic_.constraints[k].function;
      const ConstraintFunction& hand = *by_hand_.constraints[k].function;
      EXPECT_EQ(automatic_.constraints[k].name, by_hand_.constraints[k].name);
      ASSERT_EQ(function.size(), hand.size());
      ConstraintTerms terms, expected;
      function.evaluate(t_, q_, v_, terms_.rate, terms);
      hand.evaluate(t_, q_, v_, terms_.rate, expected);
      const double gradient = 1 + largest(expected.gradient);
      const double value = gradient * speed();
      EXPECT_LE(largest(terms.gradient - expected.gradient), few * unit * gradient);
      EXPECT_LE(largest(terms.value - expected.value), few * unit * value);
      EXPECT_LE(largest(terms.gamma - expected.gamma), few * unit * value * speed());
    }
  }
}

TEST_P(Derivatives, TheCurvatureAgreesWithThatByHand) {
  for (int i = 0; i < 200; ++i) {
    draw();
    for (std::size_t k = 0; k < automatic_.constraints.size(); ++k) {
      const ConstraintFunction& function = *automatic_.constraints[k].function;
      const Vector multipliers = multipliers_.segment(automatic_.multiplier_of(k), function.size());
      Matrix sum = Matrix::Identity(v_.size(), v_.size());
      Matrix expected = sum;
      function.add_curvature(t_, q_, v_, multipliers, sum);
      by_hand_.constraints[k].function->add_curvature(t_, q_, v_, multipliers, expected);
      EXPECT_LE(largest(sum - expected), few * unit * (1 + largest(expected)));
    }
  }
}

TEST_P(Derivatives, ThePartsAloneAreThoseOfTheWhole) {
  draw();
  for (const Model* model : {&automatic_, &by_hand_}) {
    MotionTerms terms;
    model->equations->evaluate(t_, q_, v_, terms);
    Vector momentum, rate;
    Matrix mass;
    model->equations->momentum(t_, q_, v_, momentum, mass);
    model->equations->rate(q_, v_, rate);
    EXPECT_LE(largest(mass - terms.mass), few * unit * largest(mass));
    EXPECT_LE(largest(momentum - terms.momentum), few * unit * largest(mass) * speed());
    EXPECT_LE(largest(rate - terms.rate), few * unit * largest(rate));
    for (const Constraint& constraint : model->constraints) {
      ConstraintTerms whole;
      constraint.function->evaluate(t_, q_, v_, terms.rate, whole);
      Vector value;
      Matrix gradient;
      constraint.function->evaluate(t_, q_, v_, value, gradient);
      EXPECT_LE(largest(gradient - whole.gradient), few * unit * (1 + largest(gradient)));
      EXPECT_LE(largest(value - whole.value), few * unit * (1 + largest(gradient)) * speed());
    }
  }
}

INSTANTIATE_TEST_SUITE_P(AllEntries, Derivatives, ::testing::ValuesIn(variations()),
                         [](const auto& info) { return info.param.name; });

}  // namespace
}  // namespace hybrid_sphere::mechanics::catalogue::testing::derivatives_test

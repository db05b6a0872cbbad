#include "mechanics/contact_reactions.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace hybrid_sphere::mechanics {
namespace {

double within(std::mt19937& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}

/// Contacts of one rigid body with planes: three rows each, of six velocities; more than two are redundant.
ContactEquations any_contacts(std::mt19937& random, Index contacts, double mu) {
  Matrix rows(3 * contacts, 6);
  for (Index i = 0; i < contacts; ++i) {
    const Eigen::Vector3d arm(within(random, -1, 1), within(random, -1, 1), -1);
    for (Index k = 0; k < 3; ++k) {
      // Along the normal z first, then along x and y.
      const Eigen::Vector3d direction = Eigen::Vector3d::Unit((k + 2) % 3);
      const Index row = k == 0 ? i : contacts + 2 * i + k - 1;
      rows.row(row) << direction.transpose(), arm.cross(direction).transpose();
    }
  }
  const Vector mobility = Vector{1, 1, 1, 2.5, 2.5, 2.5};
  Vector acceleration(6);
  for (Index i = 0; i < 6; ++i) acceleration[i] = within(random, -2, 2);
  acceleration[2] -= 3;
  ContactEquations equations;
  equations.effect = rows * mobility.asDiagonal() * rows.transpose();
  equations.free = rows * acceleration;
  equations.contacts = contacts;
  for (Index i = 0; i < contacts; ++i) equations.cones.push_back({contacts + 2 * i, 2, i, mu, 0});
  return equations;
}

/// @param tolerance  of numbers of the size 1
void expect_lawful(const ContactEquations& equations, const ContactReactions& found, double tolerance) {
  for (Index i = 0; i < equations.contacts; ++i) {
    EXPECT_GE(found.reactions[i], -tolerance);
    EXPECT_GE(found.accelerations[i], -tolerance);
    EXPECT_NEAR(found.reactions[i] * found.accelerations[i], 0, tolerance);
  }
  for (std::size_t k = 0; k < equations.cones.size(); ++k) {
    const ContactEquations::Cone& cone = equations.cones[k];
    const Vector lambda = found.reactions.segment(cone.first, cone.size);
    const Vector a = found.accelerations.segment(cone.first, cone.size);
    const double limit = cone.coefficient * found.reactions[cone.contact] + cone.limit;
    EXPECT_LE(lambda.norm(), limit + tolerance);
    if (found.slips[Index(k)] > tolerance) {
      EXPECT_LT((lambda + limit * a / a.norm()).norm(), tolerance / found.slips[Index(k)]);
    } else {
      EXPECT_LT(a.norm(), 2 * tolerance);
    }
  }
}

}  // namespace

TEST(ContactReactions, KeepCoulombsConeWhereContactsAreRedundant) {
  std::mt19937 random(1);
  for (int i = 0; i < 400; ++i) {
    const Index contacts = 1 + i % 4;
    const double mu = within(random, 0, 0.8);
    SCOPED_TRACE(::testing::Message() << "case " << i << ", contacts " << contacts << ", mu " << mu);
    const ContactEquations equations = any_contacts(random, contacts, mu);
    const std::optional<ContactReactions> found = solve_contacts(equations);
    ASSERT_TRUE(found);
    expect_lawful(equations, *found, 1e-9);
  }
}

TEST(ContactReactions, SlideAgainstTheAcceleration) {
  // One contact that is pressed by 1, and a push of 1 across: it slides where mu < 1.
  ContactEquations equations;
  equations.effect = Matrix::Identity(3, 3);
  equations.free = Vector{-1, 0.6, 0.8};
  equations.contacts = 1;
  equations.cones = {{1, 2, 0, 0.25, 0}};
  const std::optional<ContactReactions> found = solve_contacts(equations);
  ASSERT_TRUE(found);
  EXPECT_LT((found->reactions - Vector{1, -0.15, -0.2}).norm(), 1e-14);
  EXPECT_NEAR(found->slips[0], 0.75, 1e-14);
}

}  // namespace hybrid_sphere::mechanics

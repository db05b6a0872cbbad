#include "motion/edge_slide.hpp"

#include <gtest/gtest.h>

#include <cfloat>

namespace hybrid_sphere::testing::edge_slide_test {
namespace {

constexpr double unit = DBL_EPSILON;

const Vector2d first(-1, 0.5);
const Vector2d second(1, 0.25);
const Vector2d normal(1, 0);  // into the first

// k^2/R^2 = 2/5: kappa = 2/7.
Dynamics dynamics_of(const Vector2d& force) {
  scene::Forces forces;
  forces.wrench.force = force;
  return {Sphere({1, 1, std::sqrt(0.4)}), forces};
}

TEST(EdgeSlide, GivesEachGroundTheShareThatKeepsTheSphereOnTheEdge) {
  const Dynamics dynamics = dynamics_of({0, 0});
  EdgeSlide slide(dynamics, first, second, normal, {0, 3}, {0.05, 0.1}, NormalSpin(2));
  // 0.05 + 2/7 (1 - 2 alpha) = 0, and v_y = 0.1 + 2/7 (0.25 + 0.25 alpha).
  EXPECT_NEAR(slide.share(0), 0.5875, 4 * unit);
  const MotionState now = slide.at(2);
  EXPECT_EQ(now.center.velocity.x(), 0);
  EXPECT_NEAR(now.center.velocity.y(), 0.1 + 2.0 / 7 * (0.25 + 0.25 * 0.5875), 4 * unit);
  EXPECT_NEAR(now.contact_velocity.x(), 1 - 2 * 0.5875, 4 * unit);
  EXPECT_EQ(now.center.position.x(), 0);
  EXPECT_NEAR(now.center.position.y(), 3 + 2 * now.center.velocity.y(), 4 * unit * 4);
  EXPECT_EQ(slide.end(), never);
  EXPECT_TRUE(slide.steady());
}

TEST(EdgeSlide, EndsWhereOneGroundHasItAlone) {
  for (const double push : {0.07, -0.07}) {
    const Dynamics dynamics = dynamics_of({push, 0.2});
    const Vector2d p_c(0.05, 0.1);
    EdgeSlide slide(dynamics, first, second, normal, {0, 3}, p_c, NormalSpin(2));
    const double end = slide.end_before(1e9);
    ASSERT_LT(end, never);
    EXPECT_EQ(slide.end_before(0.9 * end), never);
    // A force into A makes it stay there.
    EXPECT_EQ(slide.leaves_into_first(), push > 0);
    EXPECT_NEAR(slide.share(end), push > 0 ? 1 : 0, 8 * unit);
    const MotionState now = slide.at(end);
    const Vector2d u = push > 0 ? first : second;
    EXPECT_LE((now.contact_velocity - u).norm(), 8 * unit * 2);
    EXPECT_LE((now.center.velocity - (p_c + end * dynamics.rolling() + dynamics.kappa * u)).norm(),
              16 * unit);
    EXPECT_EQ(now.center.position.x(), 0);
    EXPECT_FALSE(slide.steady());
  }
}

TEST(EdgeSlide, KeepsTheConservedVelocityOnItsWay) {
  const Dynamics dynamics = dynamics_of({0.05, 0.2});
  const Vector2d slanted = Vector2d(3, 4).normalized();
  const Vector2d p_c(0.05, 0.1);
  EdgeSlide slide(dynamics, -2 * slanted, 2 * slanted, slanted, {1, 2}, p_c, NormalSpin(0));
  for (const double time : {0.0, 0.3, 1.0}) {
    const MotionState now = slide.at(time);
    const Vector2d nu(now.angular_velocity.y(), -now.angular_velocity.x());  // R = 1
    const Vector2d conserved = (1 - dynamics.kappa) * now.center.velocity + dynamics.kappa * nu;
    EXPECT_LE((conserved - p_c - time * dynamics.rolling()).norm(), 8 * unit);
    EXPECT_NEAR(now.center.velocity.dot(slanted), 0, 4 * unit);
    EXPECT_LE(now.center.acceleration.norm(), slide.acceleration_bound(0, 1));
  }
  const Curve curve = slide.curve();
  ASSERT_EQ(curve.form, CurveForm::parabola);
  EXPECT_EQ(curve.acceleration, slide.at(0).center.acceleration);
}

}  // namespace
}  // namespace hybrid_sphere::testing::edge_slide_test

// Velocities after a reset obey the laws of impact: a contact pushes and does not pull, and friction stays
// within its limit.
#include <gtest/gtest.h>

#include <cmath>

#include "hybrid_sphere/mechanics/event.hpp"
#include "hybrid_sphere/mechanics/solve.hpp"
#include "hybrid_sphere/mechanics/system.hpp"

namespace hybrid_sphere::mechanics::reset_test {
namespace {

constexpr double gravity = 9.81;
constexpr double mu = 0.3;

/// At t = 1 the velocities become these.
template <class System>
void reset_to(System& system, const Vector& velocities) {
  system.event(
      "kick", [](double t, const Vector&, const Vector&) { return t - 1; }, Crossing::either,
      [velocities](double, const Vector&, const Vector&) { return velocities; });
}

class BallOnAFloor : public ::testing::TestWithParam<double> {
 protected:
  Solution kicked(double speed, double duration) const {
    System<1> ball({"z"},
                   [](auto, const auto& q, const auto& v) { return v[0] * v[0] / 2 - gravity * q[0]; });
    ball.unilateral(
        "floor", [](auto, const auto& q) { return q[0]; }, GetParam());
    reset_to(ball, {speed});
    return solve(ball, {0, {0.0}, {0.0}}, duration);
  }
};

TEST_P(BallOnAFloor, LeavesItIfKickedUpwards) {
  const Solution motion = kicked(3, 1.3);
  ASSERT_EQ(motion.switches().size(), 1u);
  EXPECT_EQ(motion.switches()[0].released, ActiveSet{0});
  EXPECT_EQ(motion.switches()[0].multipliers[0], 0);
  EXPECT_NEAR(motion.at(1.3).q[0], 3 * 0.3 - gravity * 0.09 / 2, 1e-12);
}

TEST_P(BallOnAFloor, BouncesIfKickedDownwards) {
  const double e = GetParam();
  const Solution motion = kicked(-3, 1.1);
  ASSERT_GE(motion.switches().size(), 1u);
  EXPECT_NEAR(motion.switches()[0].multipliers[0], 3 * (1 + e), 1e-12);
  EXPECT_NEAR(motion.switches()[0].v_after[0], 3 * e, 1e-12);
  EXPECT_NEAR(motion.at(1.1).q[0], e > 0 ? 3 * e * 0.1 - gravity * 0.01 / 2 : 0, 1e-12);
}

INSTANTIATE_TEST_SUITE_P(OfEachRestitution, BallOnAFloor, ::testing::Values(0.0, 0.5));

TEST(BlockHeldByFriction, SlidesIfKicked) {
  System<1> block({"x"}, [](auto, const auto&, const auto& v) { return v[0] * v[0] / 2; });
  block.friction(
      "friction", [](auto, const auto&, const auto& v) { return v[0]; }, mu,
      [](auto, const auto&, const auto&) { return gravity; });
  reset_to(block, {2.0});
  const Solution motion = solve(block, {0, {0.0}, {0.0}}, 5);
  EXPECT_NEAR(motion.at(5).q[0], 4 / (2 * mu * gravity), 1e-9);
}

/// The block flies as long as its normal velocity allows; the impact takes mu times the normal impulse.
class BlockOnAFloor : public ::testing::TestWithParam<double> {};

TEST_P(BlockOnAFloor, SlidesWithinItsConeIfKicked) {
  const double up = GetParam();
  System<2> block({"x", "z"},
                  [](auto, const auto& q, const auto& v) { return v.squaredNorm() / 2 - gravity * q[1]; });
  block.unilateral("floor", [](auto, const auto& q) { return q[1]; });
  block.friction(
      "friction", [](auto, const auto&, const auto& v) { return v[0]; }, mu, "floor");
  reset_to(block, {2.0, up});
  const Solution motion = solve(block, {0, {0.0, 0.0}, {0.0, 0.0}}, 5);
  const double flight = up > 0 ? 2 * 2 * up / gravity : 0;
  const double landed = 2 - mu * std::abs(up);
  EXPECT_NEAR(motion.at(5).q[0], flight + landed * landed / (2 * mu * gravity), 1e-9);
}

INSTANTIATE_TEST_SUITE_P(UpwardsAlongAndDownwards, BlockOnAFloor, ::testing::Values(1.0, 0.0, -1.0));

}  // namespace
}  // namespace hybrid_sphere::mechanics::reset_test

#include "ground/edge_events.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "motion/linear_motion.hpp"

namespace hybrid_sphere::testing::edge_events_test {
namespace {

/// From the origin over an oblique edge, which no rounded time meets exactly.
class OverAnEdge {
 public:
  explicit OverAnEdge(double speed) : edge_events_(ground()) {
    edge_events_.begin(Vector2d::Zero(), speed * Vector2d(1, 0.3), {});
    instant = edge_events_.next_instant();
    edge_events_.pass_instant();
    doubt = edge_events_.doubt();
  }

  double instant;
  double doubt;

 private:
  static std::shared_ptr<const Ground> ground() {
    scene::Surface surface;
    surface.regions.push_back({"oblique", scene::HalfPlane{Vector2d(7.1, 0.7), Vector2d(1, 0.9)}, {}});
    return std::make_shared<const Ground>(surface);
  }

  EdgeEvents edge_events_;
};

TEST(EdgeEvents, TellsInSecondsWhenAnEdgeIsCrossedAndWithWhichError) {
  const OverAnEdge slow(1);
  EXPECT_NEAR(slow.instant, (7.1 + 0.9 * 0.7) / 1.27, slow.doubt);
  EXPECT_GT(slow.doubt, 0);
  EXPECT_LT(slow.doubt, 1e-13);
  for (const int exponent : {-30, 17, 34}) {
    const OverAnEdge path(std::ldexp(1.0, exponent));
    EXPECT_EQ(path.instant, std::ldexp(slow.instant, -exponent));
    EXPECT_EQ(path.doubt, std::ldexp(slow.doubt, -exponent));
  }
}

/// Where a path under a force along (1, 1) leaves a region in which it begins, at the origin [s].
/// @param across  velocity along -y [m/s]
double leaves(const scene::Shape& shape, double across) {
  scene::Forces forces;
  forces.wrench.force = {2, 2};
  const Dynamics dynamics(Sphere({1, 0.5, 0.25}), forces);
  const Vector2d velocity(0, -across);
  LinearMotion motion =
      LinearMotion::free(dynamics, {0, 0}, {velocity, Vector3d::Zero()}, velocity, NormalSpin(0));
  scene::Surface surface;
  surface.regions.push_back({"region", shape, {}});
  EdgeEvents events(std::make_shared<const Ground>(surface));
  events.begin(motion, 1, 1, {});
  EXPECT_EQ(events.forward_region(no_region), 0) << across;
  while (!events.crosses_next() && events.next_instant() < 1e6) events.extend();
  return events.crosses_next() ? events.next_instant() : never;
}

// When such a side is met rounding does not tell; not while the path is far from it.
TEST(EdgeEvents, ASideAlongTheForceNeitherHidesTheOthersNorIsMetBeforeItsTime) {
  const scene::HalfPlane half_plane{{-5, 1}, {1, -1}};
  const scene::Polygon square{{{0, -2}, {3, 1}, {1, 3}, {-2, 0}}, false};
  for (const double across : {1e-9, 1e-12, 1e-17, 1e-49, 1e-100}) {
    EXPECT_GT(leaves(half_plane, across), 1e6) << across;
    EXPECT_NEAR(leaves(square, across), std::sqrt(2.0), 1e-9) << across;
  }
}

}  // namespace
}  // namespace hybrid_sphere::testing::edge_events_test

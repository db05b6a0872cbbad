#include "hybrid_sphere/ground/itinerary.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

namespace hybrid_sphere::testing {
namespace {

/// From the origin over an oblique edge, which no rounded time meets exactly.
class OverAnEdge {
 public:
  explicit OverAnEdge(double speed) : itinerary_(ground()) {
    itinerary_.begin(Vector2d::Zero(), speed * Vector2d(1, 0.3), {});
    instant = itinerary_.next_instant();
    itinerary_.pass_instant();
    doubt = itinerary_.doubt();
  }

  double instant;
  double doubt;

 private:
  static std::shared_ptr<const Ground> ground() {
    scene::Surface surface;
    surface.regions.push_back({"oblique", scene::HalfPlane{Vector2d(7.1, 0.7), Vector2d(1, 0.9)}, {}});
    return std::make_shared<const Ground>(surface);
  }

  Itinerary itinerary_;
};

TEST(Itinerary, TellsInSecondsWhenAnEdgeIsCrossedAndWithWhichError) {
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

}  // namespace
}  // namespace hybrid_sphere::testing

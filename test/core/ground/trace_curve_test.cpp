// Where curved paths meet edges, beside dense sampling and bisection in long double.

#include "ground/trace_curve.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "motion/linear_motion.hpp"
#include "support/place.hpp"

namespace hybrid_sphere::testing::trace_curve_test {
namespace {

using scene::Law;

constexpr double until = 6;

struct Case {
  LinearMotion motion;
  scene::Shape shape;
};

class Cases {
 public:
  explicit Cases(unsigned seed) : random_(seed) {}

  double number(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }
  Vector2d vector(double size) { return {number(-size, size), number(-size, size)}; }

  scene::Shape shape(int kind) {
    if (kind == 0) return scene::HalfPlane{vector(2), vector(1)};
    if (kind == 1) return scene::Circle{vector(2), number(0.5, 3), false};
    const Vector2d center = vector(2);
    std::vector<Vector2d> corners;
    for (int i = 0; i < 7; ++i) {
      const double angle = 2 * M_PI * i / 7;
      corners.push_back(center + number(0.5, 3) * Vector2d(std::cos(angle), std::sin(angle)));
    }
    return scene::Polygon{corners, false};
  }

  /// @param drag   [N s/m]
  /// @param rate   of the turntable [rad/s]
  /// @param force  greatest component [N]
  LinearMotion motion(double drag, double rate, double force) {
    scene::Forces forces;
    forces.wrench.force = vector(force);
    forces.drag.translational = drag;
    const Dynamics dynamics(Sphere({1, 0.5, 0.25}), forces);
    scene::Material ground(Law::rough);
    ground.turntable_rate = rate;
    return LinearMotion::rolling(dynamics, ground, vector(3), vector(2), NormalSpin(0));
  }

 private:
  std::mt19937 random_;
};

// Times at which the sampled path changes its side, by bisection.
std::vector<double> changes_of_side(LinearMotion& motion, const scene::Shape& shape) {
  const scene::Surface surface{Law::smooth, {{"region", shape, Law::rough}}};
  const auto side = [&](double t) { return region_at(surface, motion.center(t).position); };
  std::vector<double> times;
  constexpr int samples = 6000;
  for (int i = 0; i < samples; ++i) {
    double low = until * i / samples;
    double high = until * (i + 1) / samples;
    const int before = side(low);
    if (side(high) == before) continue;
    for (int k = 0; k < 45; ++k) {
      const double middle = (low + high) / 2;
      (side(middle) == before ? low : high) = middle;
    }
    times.push_back(high);
  }
  return times;
}

// Candidates may be more than the changes of side, but every change is among them, and every other one is a
// place on the edge, too.
void check(Case& c) {
  const CurvedPath path(c.motion, c.motion.curve(), 0, until);
  StartLines lines;
  Candidates candidates;
  find_candidates(path, c.shape, nullptr, nullptr, lines, candidates);
  for (const double time : changes_of_side(c.motion, c.shape)) {
    double distance = HUGE_VAL;
    for (const Candidate& candidate : candidates)
      distance = std::min(distance, std::abs(candidate.time - time) - candidate.error);
    EXPECT_LE(distance, 1e-13 * until);  // what 45 halvings leave of a thousandth of a second
  }
  for (const Candidate& candidate : candidates) {
    const PointState there = c.motion.center(std::clamp(candidate.time, 0.0, until));
    EXPECT_LE(distance_to_edge(c.shape, there.position), 1e-12 + 2 * candidate.error * there.velocity.norm());
  }
}

void check_all(double drag, double rate, double force, CurveForm form) {
  Cases cases(7);
  for (int i = 0; i < 60; ++i) {
    Case c{cases.motion(drag, rate, force), cases.shape(i % 3)};
    ASSERT_EQ(c.motion.curve().form, form);
    check(c);
  }
}

TEST(TraceCurve, AParabolaMeetsEdgesWhereItChangesItsSide) { check_all(0, 0, 1, CurveForm::parabola); }

TEST(TraceCurve, AnArcMeetsEdgesWhereItChangesItsSide) { check_all(0, 3, 0, CurveForm::arc); }

// The orbit's centre lies so far away that its rounding is larger than the map.
TEST(TraceCurve, AnArcMeetsEdgesWhereItChangesItsSideHoweverSlowlyTheGroundTurns) {
  for (const double rate : {1e-3, -1e-4, 1e-6, -1e-9, 1e-12, 1e-15, -1e-20, 1e-30, 1e-60}) {
    SCOPED_TRACE(rate);
    check_all(0, rate, 0, CurveForm::arc);
    Cases cases(8);
    for (int i = 0; i < 60; ++i) {
      Case c{cases.motion(0, rate, 0), cases.shape(i % 3)};
      const CurvedPath path(c.motion, c.motion.curve(), 0, until);
      StartLines lines;
      Candidates candidates;
      find_candidates(path, c.shape, nullptr, nullptr, lines, candidates);
      for (const Candidate& candidate : candidates) EXPECT_LE(candidate.error, 1e-10);
    }
  }
}

// Nor is it where the orbit is a few times as large as the map: to the rounding of the map's own coordinates.
TEST(TraceCurve, AnArcMeetsEdgesAsExactlyAsTheMapIsGiven) {
  const Dynamics dynamics(Sphere({1, 0.5, 0.25}), scene::Forces());
  scene::Material ground(Law::rough);
  ground.turntable_rate = 0.5;
  const double rate = ground.turntable_rate / (1 + 4);  // of the orbit, for a gyration radius of R/2
  for (const double arm : {20.0, 100.0, 1000.0}) {
    LinearMotion motion =
        LinearMotion::rolling(dynamics, ground, {1, -1}, {rate * arm * 0.6, rate * arm * 0.8}, NormalSpin(0));
    ASSERT_EQ(motion.curve().form, CurveForm::arc);
    const CurvedPath path(motion, motion.curve(), 0, 1);
    StartLines lines;
    Candidates candidates;
    find_candidates(path, scene::HalfPlane{{1.5, 0}, {1, 0}}, nullptr, nullptr, lines, candidates);
    ASSERT_FALSE(candidates.empty()) << arm;
    const double speed = rate * arm;
    for (const Candidate& candidate : candidates) EXPECT_LE(candidate.error * speed, 64 * DBL_EPSILON) << arm;
  }
}

// A velocity along an oblique edge is off it by rounding: the way away from it and back is none.
TEST(TraceCurve, AnArcDoesNotComeBackToItsContactFromWithinRounding) {
  const Dynamics dynamics(Sphere({1, 0.5, 0.25}), scene::Forces());
  scene::Material ground(Law::rough);
  ground.turntable_rate = 0.03125;  // a large orbit
  for (int k = -60; k <= -20; ++k) {
    const double across = std::ldexp(1, k);
    LinearMotion motion = LinearMotion::rolling(dynamics, ground, {3.59765625, 2.59765625},
                                                {-0.25 - across, -0.25 + across}, NormalSpin(0));
    const CurvedPath path(motion, motion.curve(), 0, 1);
    const Contact contact{0, {EdgePiece::Kind::line, 0}, false};
    StartLines lines;
    Candidates candidates;
    find_candidates(path, scene::HalfPlane{{2, 1}, {-3, 3}}, &contact, &contact + 1, lines, candidates);
    for (const Candidate& candidate : candidates)
      EXPECT_GT(candidate.time * across, 0x1p-53) << k;  // the excursion is a quarter of that, times sqrt(2)
  }
}

TEST(TraceCurve, ACycloidMeetsEdgesWhereItChangesItsSide) { check_all(0, 6, 1, CurveForm::general); }

TEST(TraceCurve, ADampedSpiralMeetsEdgesWhereItChangesItsSide) { check_all(0.25, 9, 0, CurveForm::general); }

// The apex of the parabola x = -t^2/2 + t - 1/2 + depth lies at t = 1.
TEST(TraceCurve, AParabolaCutsTheEdgeTwiceJustBehindIt) {
  for (const double depth : {0x1p-20, 0x1p-30, 0x1p-40}) {
    scene::Forces forces;
    forces.wrench.force = {-1, 0};
    const Dynamics dynamics(Sphere({1, 0.5, 0.25}), forces);
    LinearMotion motion = LinearMotion::free(dynamics, {-0.5 + depth, 0}, {{1, 0.25}, Vector3d::Zero()},
                                             {1, 0.25}, NormalSpin(0));
    const CurvedPath path(motion, motion.curve(), 0, 4);
    StartLines lines;
    Candidates candidates;
    find_candidates(path, scene::HalfPlane{{0, 0}, {1, 0}}, nullptr, nullptr, lines, candidates);
    ASSERT_EQ(candidates.size(), 2U);
    const double apart = std::abs(candidates[1].time - candidates[0].time);
    EXPECT_NEAR(apart, 2 * std::sqrt(2 * depth), 1e-4 * std::sqrt(depth));
  }
}

// What dies at once does not come away from the edge, on whichever side of it rounding has put the place.
TEST(TraceCurve, AnEdgeIsNotLeftByAMotionThatEndsWithinRoundingOfIt) {
  const Dynamics dynamics(Sphere({1, 0.5, 0.25}), scene::Forces());
  const scene::Shape triangle = scene::Polygon{{{2, 1}, {5, 4}, {2, 3}}, false};
  const Contact contact{0, {EdgePiece::Kind::line, 0}, false};
  for (const double off : {-0x1p-51, 0.0, 0x1p-51}) {
    for (const double duration : {1e-17, 1e-16, 1e-6}) {
      LinearMotion motion =
          LinearMotion::free(dynamics, {3.59765625, 2.59765625 + off}, {{-0.25, 0.25}, Vector3d::Zero()},
                             {-0.25, 0.25}, NormalSpin(0));
      const CurvedPath path(motion, motion.curve(), 0, duration);
      StartLines lines;
      Candidates candidates;
      EXPECT_EQ(find_candidates(path, triangle, &contact, &contact + 1, lines, candidates).on_edge,
                duration < 1e-6)
          << off << ", " << duration;
    }
  }
}

// A way away from an edge and back that is little more than rounding is seen as a whole or not at all.
TEST(TraceCurve, AnEdgeIsMetAgainByAPathThatSoonTurnsRound) {
  scene::Forces forces;
  forces.wrench.force = {-1, 0};
  forces.drag.translational = 0.25;
  const Dynamics dynamics(Sphere({1, 0.5, 0.25}), forces);
  const Contact contact{0, {EdgePiece::Kind::line, 0}, false};
  for (int k = -120; k <= -40; ++k) {
    const double across = std::exp2(0.25 * k);
    LinearMotion motion = LinearMotion::free(dynamics, {3, 1}, {{across, 0.25}, Vector3d::Zero()},
                                             {across, 0.25}, NormalSpin(0));
    ASSERT_EQ(motion.curve().form, CurveForm::general);
    const double back = 2 * across;
    for (const double followed : {1.5, 2.0, 8.0}) {
      const CurvedPath path(motion, motion.curve(), 0, followed * back);
      StartLines lines;
      Candidates candidates;
      const EdgeInterval interval =
          find_candidates(path, scene::HalfPlane{{3, 0}, {1, 0}}, &contact, &contact + 1, lines, candidates);
      const bool is_seen = std::any_of(candidates.begin(), candidates.end(), [&](const Candidate& candidate) {
        return std::abs(candidate.time - back) <= 0x1p-4 * back + candidate.error;
      });
      EXPECT_TRUE(is_seen || interval.until >= back) << across << ", " << followed;
    }
  }
}

// A half-plane and a triangle end at one line, on which the sphere is thrown back. Their own functions of it
// have other roundings.
TEST(TraceCurve, AnEdgeOfTwoRegionsIsLeftByBothAtOnceOrByNeither) {
  const scene::Shape half_plane = scene::HalfPlane{{2, 1}, {-3, 3}};
  const scene::Shape triangle = scene::Polygon{{{-98, -99}, {5, 4}, {2, 3}}, false};
  const Contact contacts[] = {{0, {EdgePiece::Kind::line, 0}, false}, {1, {EdgePiece::Kind::line, 0}, false}};
  scene::Forces forces;
  forces.wrench.force = {1, -0.25};
  const Dynamics dynamics(Sphere({1, 0.5, 0.25}), forces);
  int told_apart = 0;
  for (int i = 0; i < 64; ++i) {
    const double across = std::ldexp(1 + i % 2 / 2.0, -12 - i / 2);
    LinearMotion motion = LinearMotion::free(dynamics, {3.59765625, 2.59765625},
                                             {{-0.25 - across, -0.25 + across}, Vector3d::Zero()},
                                             {-0.25, -0.25}, NormalSpin(0));
    const CurvedPath path(motion, motion.curve(), 0, 1);
    const auto times = [&](StartLines& lines, const scene::Shape& shape, const Contact& contact) {
      Candidates candidates;
      find_candidates(path, shape, &contact, &contact + 1, lines, candidates);
      std::vector<std::pair<double, double>> found;
      for (const Candidate& candidate : candidates)
        if (candidate.piece.kind == EdgePiece::Kind::line && candidate.piece.index == 0)
          found.push_back({candidate.time, candidate.error});
      return found;
    };
    StartLines lines;
    EXPECT_EQ(times(lines, half_plane, contacts[0]), times(lines, triangle, contacts[1])) << across;
    StartLines own;
    StartLines other;
    told_apart += times(own, half_plane, contacts[0]) != times(other, triangle, contacts[1]);
  }
  EXPECT_GT(told_apart, 0);  // it is the sharing that makes them the same
}

}  // namespace
}  // namespace hybrid_sphere::testing::trace_curve_test

// trace() against locate(), which knows nothing of paths: on a grid of integers a path passes exactly at
// positions that binary64 holds, so that both must agree at every sample that is no crossing itself.

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "ground/crossing.hpp"
#include "ground/hundred_digit_time.hpp"
#include "support/random_scenes.hpp"

namespace hybrid_sphere::testing::trace_property_test {
namespace {

struct Traced {
  Side start = Side::outside;
  std::vector<Crossing> crossings;
  EdgePiece here;
};

Traced traced(const Path& path, const scene::Shape& shape, const EdgePiece* contact = nullptr) {
  Traced result;
  result.start = trace(path, 0, shape, contact, result.crossings, result.here);
  return result;
}

Side side_at(const Traced& traced, double time) {
  Side side = traced.start;
  for (const Crossing& crossing : traced.crossings) {
    if (crossing.time < time) side = crossing.after;
  }
  return side;
}

Path random_path() { return {random_grid_point(), random_direction()}; }

// Up to 1, in steps of a millionth: exact in nothing.
double off_grid() { return integer(-1000000, 1000000) * 1e-6; }

// Samples have 16 fractional bits, exact in time and place. Crossings have denominators below 2^9, or are
// roots. Touches that are no crossings, at corners and tangents, have denominators of at most |v|^2 = 32: a
// step leads off them.
double sample(double time) {
  const double on_grid = std::floor(0x1p16 * time) * 0x1p-16;
  return 32 * on_grid == std::floor(32 * on_grid) ? on_grid + 0x1p-16 : on_grid;
}

double distance_to_a_crossing(const Traced& traced, double time) {
  double distance = time;
  for (const Crossing& crossing : traced.crossings)
    distance = std::min(distance, std::abs(crossing.time - time));
  return distance;
}

std::vector<double> sample_times(const Traced& traced) {
  std::vector<double> times;
  for (int i = 1; i <= 160; ++i) times.push_back(sample(i / 8.0));
  double before = 0;
  for (const Crossing& crossing : traced.crossings) {
    times.push_back(sample((before + crossing.time) / 2));
    before = crossing.time;
  }
  times.push_back(sample(before + 1));
  return times;
}

RC_GTEST_PROP(TracedPath, IsOnTheSideOnWhichItsPointsLie, ()) {
  const Path path = random_path();
  const scene::Shape shape = random_shape();
  RC_LOG() << shape << " from " << path.start.transpose() << " along " << path.velocity.transpose() << "\n";
  const Traced result = traced(path, shape);
  for (const double time : sample_times(result)) {
    if (distance_to_a_crossing(result, time) < 0x1p-15) continue;
    const Vector2d point = path.start + time * path.velocity;
    if (side_at(result, time) != locate(shape, point)) RC_LOG() << "at time " << time << "\n";
    RC_ASSERT(side_at(result, time) == locate(shape, point));
  }
}

RC_GTEST_PROP(TracedPath, CrossesInOrderAndNoMoreThanTheBound, ()) {
  const Path path = random_path();
  const scene::Shape shape = random_shape();
  RC_LOG() << shape << " from " << path.start.transpose() << " along " << path.velocity.transpose() << "\n";
  const Traced result = traced(path, shape);
  RC_ASSERT(result.crossings.size() <= max_crossings(shape));
  double before = 0;
  for (const Crossing& crossing : result.crossings) {
    RC_ASSERT(crossing.time > before);
    before = crossing.time;
  }
}

RC_GTEST_PROP(TracedPath, HasTimesWithinTheirBounds, ()) {
  // Off the grid: nothing is exact here but the reference.
  Path path = random_path();
  path.start += Vector2d(off_grid(), off_grid());
  path.velocity += Vector2d(off_grid(), off_grid()) * 1e-3;
  const scene::Shape shape = random_shape();
  for (const Crossing& crossing : traced(path, shape).crossings) {
    const exact::Real error =
        abs(exact::Real(hundred_digit_time(path, shape, crossing.piece) - crossing.time));
    RC_ASSERT(error <= exact::Real(crossing.error));
    // What detail::quotient lets pass, and a root's own rounding next to a tangent.
    RC_ASSERT(crossing.error <= 1e-9 * crossing.time);
  }
}

RC_GTEST_PROP(TracedCircle, HasTimesThatAreRoundedOnce, ()) {
  Path path = random_path();
  path.start += Vector2d(off_grid(), off_grid());
  const scene::Shape shape = scene::Circle{random_grid_point(), integer(1, 8) / 4.0, false};
  for (const Crossing& crossing : traced(path, shape).crossings) {
    const exact::Real error =
        abs(exact::Real(hundred_digit_time(path, shape, crossing.piece) - crossing.time));
    // Half an ulp, and what Newton's last step leaves next to the start.
    RC_ASSERT(error <= exact::Real(0x1p-52 * crossing.time + 0x1p-90));
  }
}

TEST(TracedCircle, HasExactTimesWhereTheyAreShortNumbers) {
  for (const double height : {3.0, 4.0, -3.0}) {
    const double half_chord = 7 - std::abs(height);
    const Traced result = traced({{-8, height}, {0.5, 0}}, scene::Circle{{0, 0}, 5, false});
    ASSERT_EQ(result.crossings.size(), 2U);
    EXPECT_EQ(result.crossings[0].time, (8 - half_chord) / 0.5);
    EXPECT_EQ(result.crossings[1].time, (8 + half_chord) / 0.5);
  }
}

RC_GTEST_PROP(TracedPath, RunBackwardsCrossesTheSameEdges, ()) {
  const Path path = random_path();
  const scene::Shape shape = random_shape();
  const Traced there = traced(path, shape);
  if (!there.crossings.empty()) RC_PRE(there.crossings.back().time < 32);
  const Path back_path{path.start + 32 * path.velocity, -path.velocity};
  const Traced back = traced(back_path, shape);
  std::vector<double> times;
  for (const Crossing& crossing : back.crossings) {
    if (crossing.time < 32) times.push_back(32 - crossing.time);
  }
  // A start on an edge is a crossing of the way back only.
  if (!times.empty() && times.back() < 1e-9) times.pop_back();
  RC_ASSERT(times.size() == there.crossings.size());
  for (std::size_t i = 0; i < times.size(); ++i) {
    RC_ASSERT(std::abs(times[times.size() - 1 - i] - there.crossings[i].time) < 1e-9);
  }
}

RC_GTEST_PROP(TracedPath, ThatRestsIsWhereItsPointLies, ()) {
  const Path path{random_grid_point(), Vector2d::Zero()};
  const scene::Shape shape = random_shape();
  const Traced result = traced(path, shape);
  RC_ASSERT(result.start == locate(shape, path.start));
  RC_ASSERT(result.crossings.empty());
}

RC_GTEST_PROP(ComparedCrossings, AreInTheOrderOfTheirExactTimes, ()) {
  const Path path = random_path();
  const scene::Shape a = random_shape();
  const scene::Shape b = integer(0, 1) == 0 ? a : random_shape();
  for (const Crossing& p : traced(path, a).crossings) {
    for (const Crossing& q : traced(path, b).crossings) {
      const int order = compare(path, a, p, b, q);
      RC_ASSERT(order == -compare(path, b, q, a, p));
      const exact::Real gap = hundred_digit_time(path, a, p.piece) - hundred_digit_time(path, b, q.piece);
      const int expected = abs(gap) < exact::Real(1e-60) ? 0 : exact::sign(gap);
      RC_ASSERT(order == expected);
    }
  }
}

// After an event the rounded position is a little off the edge; the contact says that it is on it.
RC_GTEST_PROP(ContactWithAnEdge, LeadsToTheSideThatTheNewVelocityPointsInto, ()) {
  Path path = random_path();
  path.start += Vector2d(off_grid(), off_grid());
  const scene::Shape shape = random_shape();
  const Traced before = traced(path, shape);
  RC_PRE(!before.crossings.empty());
  const Crossing& crossing = before.crossings.front();
  RC_PRE(crossing.after != Side::edge);
  RC_PRE(crossing.piece.kind != EdgePiece::Kind::vertex);
  if (before.crossings.size() > 1) RC_PRE(before.crossings[1].time > crossing.time + 1e-6);
  const Vector2d place = path.start + crossing.time * path.velocity;

  const Traced on = traced({place, path.velocity}, shape, &crossing.piece);
  RC_ASSERT(on.start == crossing.after);
  RC_ASSERT(on.crossings.size() + 1 == before.crossings.size());
  for (std::size_t i = 0; i < on.crossings.size(); ++i) {
    RC_ASSERT(std::abs(on.crossings[i].time + crossing.time - before.crossings[i + 1].time) < 1e-6);
  }
  const Traced back = traced({place, -path.velocity}, shape, &crossing.piece);
  RC_ASSERT(back.start == before.start);
}

TEST(TracedSliver, OfAnUlpIsEnteredAndLeft) {
  const double right = std::nextafter(1.0, 2.0);
  const scene::Shape sliver = scene::Polygon{{{1, -1}, {right, -1}, {right, 1}, {1, 1}}, false};
  for (const double speed : {1.0, 0.3, 0.999}) {
    const Traced result = traced({{-1, 0.1}, {speed, 0.01}}, sliver);
    ASSERT_EQ(result.crossings.size(), 2U);
    EXPECT_EQ(result.start, Side::outside);
    EXPECT_EQ(result.crossings[0].after, Side::inside);
    EXPECT_EQ(result.crossings[1].after, Side::outside);
    EXPECT_EQ(compare({{-1, 0.1}, {speed, 0.01}}, sliver, result.crossings[0], sliver, result.crossings[1]),
              -1);
  }
}

TEST(TracedCircle, IsCutByAChordOfAnUlpAndNotByItsTangent) {
  const scene::Shape circle = scene::Circle{{0, 0}, 1, false};
  EXPECT_EQ(traced({{-2, std::nextafter(1.0, 0.0)}, {1, 0}}, circle).crossings.size(), 2U);
  EXPECT_EQ(traced({{-2, 1}, {1, 0}}, circle).crossings.size(), 0U);
  EXPECT_EQ(traced({{-2, std::nextafter(1.0, 2.0)}, {1, 0}}, circle).crossings.size(), 0U);
}

// Its velocity is that of a tangent, and so is its place on the circle, to their rounding.
TEST(TracedCircle, IsNotEnteredFromItByWhatRoundingTells) {
  const scene::Shape circle = scene::Circle{{1, 0}, 3, false};
  const EdgePiece contact{EdgePiece::Kind::circle_first, 0};
  for (const double angle : {-1.5, 0.1, 1.0, 2.0, 3.0}) {
    const Vector2d normal(std::cos(angle), std::sin(angle));
    for (const double inwards : {-1e-16, 0.0, 1e-16, 1e-12}) {
      const Path path{Vector2d(1, 0) + 3 * normal, Vector2d(-normal.y(), normal.x()) - inwards * normal};
      std::vector<Crossing> crossings;
      EdgePiece along;
      const Side side = trace(path, 0, circle, &contact, crossings, along);
      EXPECT_EQ(side, inwards < 1e-12 ? Side::outside : Side::inside) << angle << ", " << inwards;
      EXPECT_EQ(crossings.size(), inwards < 1e-12 ? 0U : 1U);
    }
  }
}

// Sides of different lengths on one oblique line, and the same with a corner one ulp beside it.
TEST(Crossing, OfTwoSidesOnOneLineIsAtOneInstant) {
  const Path path{{5.3, 10}, {0.1, -1}};
  const scene::Shape first = scene::Polygon{{{0, 0}, {12, 4}, {20, -9}}, false};
  const auto time_beside = [&](const Vector2d& corner) {
    const scene::Shape second = scene::Polygon{{{3, 1}, corner, {4, -7}}, false};
    const Crossing a = traced(path, first).crossings.at(0);
    const Crossing b = traced(path, second).crossings.at(0);
    EXPECT_EQ(a.piece.kind, EdgePiece::Kind::line);
    EXPECT_EQ(compare(path, first, a, second, b), -compare(path, second, b, first, a));
    return compare(path, second, b, first, a);
  };
  EXPECT_EQ(time_beside({9, 3}), 0);
  EXPECT_EQ(time_beside({9, std::nextafter(3.0, 4.0)}), -1);
  EXPECT_EQ(time_beside({9, std::nextafter(3.0, 2.0)}), 1);
}

}  // namespace
}  // namespace hybrid_sphere::testing::trace_property_test

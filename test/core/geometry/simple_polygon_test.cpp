#include "geometry/simple_polygon.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>

#include "geometry/exact.hpp"

namespace hybrid_sphere::testing::simple_polygon_test {
namespace {

using Eigen::Vector2d;
using geometry::fault_of_polygon;
using geometry::is_counter_clockwise;
using Corners = std::vector<Vector2d>;

// Twice the area, by the shoelace formula: exact for small integers.
double doubled_area(const Corners& corners) {
  double sum = 0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vector2d& a = corners[i];
    const Vector2d& b = corners[(i + 1) % corners.size()];
    sum += a.x() * b.y() - a.y() * b.x();
  }
  return sum;
}

bool on_segment(const Vector2d& a, const Vector2d& b, const Vector2d& p) {
  return exact::orientation(a, b, p) == 0 && (p - a).dot(p - b) <= 0;
}

bool segments_meet(const Vector2d& a, const Vector2d& b, const Vector2d& c, const Vector2d& d) {
  if (on_segment(a, b, c) || on_segment(a, b, d) || on_segment(c, d, a) || on_segment(c, d, b)) return true;
  return exact::orientation(a, b, c) != exact::orientation(a, b, d) &&
         exact::orientation(c, d, a) != exact::orientation(c, d, b) && exact::orientation(a, b, c) != 0 &&
         exact::orientation(a, b, d) != 0 && exact::orientation(c, d, a) != 0 &&
         exact::orientation(c, d, b) != 0;
}

// By the definition: sides meet only where they follow each other, and there in one point only.
bool is_simple(const Corners& corners) {
  const std::size_t n = corners.size();
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = i + 1; j < n; ++j) {
      const Vector2d& a = corners[i];
      const Vector2d& b = corners[(i + 1) % n];
      const Vector2d& c = corners[j];
      const Vector2d& d = corners[(j + 1) % n];
      if (a == b || c == d) return false;
      if (j == i + 1 || (i == 0 && j == n - 1)) {
        const Vector2d& far_first = j == i + 1 ? a : b;
        const Vector2d& far_second = j == i + 1 ? d : c;
        if (on_segment(c, d, far_first) || on_segment(a, b, far_second)) return false;
      } else if (segments_meet(a, b, c, d)) {
        return false;
      }
    }
  }
  return true;
}

TEST(SimplePolygon, IsWhatTheDefinitionSaysOnSmallGrids) {
  std::mt19937_64 engine(7);
  std::uniform_int_distribution<int> coordinate(0, 4);
  int simple = 0;
  for (int round = 0; round < 20000; ++round) {
    Corners corners(static_cast<std::size_t>(3 + round % 4));
    for (Vector2d& corner : corners) corner = Vector2d(coordinate(engine), coordinate(engine));
    const bool expected = is_simple(corners);
    simple += expected;
    ASSERT_EQ(!fault_of_polygon(corners).has_value(), expected) << "round " << round;
    if (!expected) continue;
    ASSERT_EQ(is_counter_clockwise(corners), doubled_area(corners) > 0) << "round " << round;
  }
  EXPECT_GT(simple, 1000);
}

TEST(SimplePolygon, KeepsItsVerdictWhereverItBeginsAndWhicheverWayItRuns) {
  const Corners good{{0, 0}, {4, 0}, {4, 4}, {2, 1}, {0, 4}};
  const Corners bad{{0, 0}, {4, 0}, {4, 4}, {2, 0}, {0, 4}};
  for (std::size_t shift = 0; shift < good.size(); ++shift) {
    for (const bool reversed : {false, true}) {
      Corners a = good;
      Corners b = bad;
      for (Corners* corners : {&a, &b}) {
        std::rotate(corners->begin(), corners->begin() + static_cast<std::ptrdiff_t>(shift), corners->end());
        if (reversed) std::reverse(corners->begin(), corners->end());
      }
      EXPECT_FALSE(fault_of_polygon(a).has_value());
      EXPECT_TRUE(fault_of_polygon(b).has_value());
      EXPECT_EQ(is_counter_clockwise(a), !reversed);
    }
  }
}

TEST(SimplePolygon, MayHaveCornersInTheMiddleOfAStraightSide) {
  EXPECT_FALSE(fault_of_polygon({{0, 0}, {1, 0}, {2, 0}, {2, 2}, {1, 2}, {0, 2}}).has_value());
}

TEST(SimplePolygon, TellsAnUlpOfOverlapFromAnUlpOfGap) {
  const double up = std::nextafter(1.0, 2.0);
  const double down = std::nextafter(1.0, 0.0);
  const auto notch = [](double depth) { return Corners{{0, 1}, {4, 1}, {4, 4}, {2, depth}, {0, 4}}; };
  EXPECT_FALSE(fault_of_polygon(notch(up)).has_value());
  EXPECT_EQ(fault_of_polygon(notch(1.0)), "sides 0 and 3 meet");
  EXPECT_EQ(fault_of_polygon(notch(down)), "sides 0 and 3 meet");
}

// A closed line under a random roofline with a fringe below it: sides along the axes, slanting ones, corners
// in the middle of sides; on a grid, so that what touches touches exactly.
Corners fringed(std::mt19937_64& engine, int teeth) {
  std::uniform_int_distribution<int> height(1, 6);
  std::uniform_int_distribution<int> depth(-6, -1);
  Corners corners;
  for (int i = 0; i <= teeth; ++i) corners.emplace_back(i, depth(engine));
  for (int i = teeth; i >= 0; --i) {
    corners.emplace_back(i, height(engine));
    if (i > 0 && i % 3 == 0) corners.emplace_back(i - 1, corners.back().y());
  }
  for (std::size_t i = 1; i < corners.size();) {
    if (corners[i] == corners[i - 1]) {
      corners.erase(corners.begin() + static_cast<std::ptrdiff_t>(i));
    } else {
      ++i;
    }
  }
  return corners;
}

Corners turned(Corners corners, double angle) {
  for (Vector2d& p : corners) {
    p = Vector2d(std::cos(angle) * p.x() - std::sin(angle) * p.y(),
                 std::sin(angle) * p.x() + std::cos(angle) * p.y());
  }
  return corners;
}

bool named_sides_meet(const Corners& corners, const std::string& fault) {
  std::size_t i = 0;
  std::size_t j = 0;
  if (std::sscanf(fault.c_str(), "sides %zu and %zu meet", &i, &j) != 2) return false;
  const std::size_t n = corners.size();
  return i + 1 < j && (i > 0 || j + 1 < n) &&
         segments_meet(corners[i], corners[(i + 1) % n], corners[j], corners[(j + 1) % n]);
}

TEST(SimplePolygon, OfManyCornersIsWhatTheDefinitionSaysOnGrids) {
  std::mt19937_64 engine(8);
  std::uniform_int_distribution<int> coordinate(-6, 6);
  int simple = 0;
  int meeting = 0;
  for (int round = 0; round < 4000; ++round) {
    Corners corners = fringed(engine, 8 + round % 12);
    ASSERT_GT(corners.size(), 16U);
    std::uniform_int_distribution<std::size_t> corner(0, corners.size() - 1);
    for (int moved = round % 4; moved > 0; --moved) {
      corners[corner(engine)] += Vector2d(coordinate(engine), coordinate(engine)) / 2;
    }
    if (round % 5 == 0) {
      for (Vector2d& p : corners) p = Vector2d(p.y(), p.x());
    }
    const bool expected = is_simple(corners);
    const auto fault = fault_of_polygon(corners);
    ASSERT_EQ(!fault.has_value(), expected) << "round " << round << ": " << fault.value_or("accepted");
    simple += expected;
    if (!fault || fault->rfind("sides", 0) != 0) continue;
    ++meeting;
    ASSERT_TRUE(named_sides_meet(corners, *fault)) << "round " << round << ": " << *fault;
  }
  EXPECT_GT(simple, 1000);
  EXPECT_GT(meeting, 1000);
}

TEST(SimplePolygon, OfManyCornersIsWhatTheDefinitionSaysOffTheGrid) {
  std::mt19937_64 engine(9);
  std::uniform_real_distribution<double> shift(-6, 6);
  int simple = 0;
  for (int round = 0; round < 2000; ++round) {
    Corners corners = turned(fringed(engine, 8 + round % 12), 0.1 * round);
    std::uniform_int_distribution<std::size_t> corner(0, corners.size() - 1);
    for (int moved = round % 4; moved > 0; --moved) {
      corners[corner(engine)] += Vector2d(shift(engine), shift(engine));
    }
    const bool expected = is_simple(corners);
    simple += expected;
    ASSERT_EQ(!fault_of_polygon(corners).has_value(), expected) << "round " << round;
  }
  EXPECT_GT(simple, 500);
  EXPECT_LT(simple, 1500);
}

// Every side overlaps every other one in x, turned also in y: a look at all pairs takes seconds.
TEST(SimplePolygon, MayBeACombOfManyLongTeeth) {
  Corners comb;
  for (int i = 0; i < 10000; ++i) {
    for (const Vector2d& p : Corners{{0, 0}, {100, 1}, {100, 2}, {0, 3}}) {
      comb.push_back(p + Vector2d(0, 4 * i));
    }
  }
  comb.emplace_back(-10, 40000);
  comb.emplace_back(-10, -1);
  for (const double angle : {0.0, 0.7}) {
    Corners corners = turned(comb, angle);
    EXPECT_FALSE(fault_of_polygon(corners).has_value());
    // The tip of one tooth, moved into the next one.
    corners[20002] += turned({{0, 3}}, angle)[0];
    const auto fault = fault_of_polygon(corners);
    ASSERT_TRUE(fault.has_value());
    EXPECT_TRUE(named_sides_meet(corners, *fault)) << *fault;
  }
}

TEST(SimplePolygon, OfManyCornersIsAccepted) {
  Corners star;
  for (int i = 0; i < 2000; ++i) {
    const double angle = 2 * M_PI * i / 2000;
    star.push_back((i % 2 == 0 ? 1.0 : 2.0) * Vector2d(std::cos(angle), std::sin(angle)));
  }
  EXPECT_FALSE(fault_of_polygon(star).has_value());
  std::swap(star[500], star[1500]);
  EXPECT_TRUE(fault_of_polygon(star).has_value());
}

}  // namespace
}  // namespace hybrid_sphere::testing::simple_polygon_test

#include "geometry/certified_root.hpp"

#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace hybrid_sphere::geometry::certified_root_test {
namespace {

// A polynomial by its roots, in a form in which it has no rounding that matters, and what its use has cost.
class Polynomial {
 public:
  explicit Polynomial(std::vector<double> roots) : roots_(std::move(roots)) {}

  Jet operator()(double t) const {
    ++looks_;
    double value = 1;
    double slope = 0;
    for (const double root : roots_) {
      slope = slope * (t - root) + value;
      value *= t - root;
    }
    const double n = static_cast<double>(roots_.size());
    return {value, slope, 2 * n * DBL_EPSILON * std::abs(value)};
  }

  /// |g''| <= n (n - 1) (greatest distance to a root)^(n - 2)
  double curvature(double from, double until) const {
    double reach = 0;
    for (const double root : roots_) reach = std::max({reach, std::abs(from - root), std::abs(until - root)});
    const double n = static_cast<double>(roots_.size());
    return n * (n - 1) * std::pow(reach, n - 2);
  }

  int looks() const { return looks_; }

 private:
  std::vector<double> roots_;
  mutable int looks_ = 0;
};

std::vector<Root> roots_of(const Polynomial& g, double low, double high) {
  std::vector<Root> roots;
  certified_roots([&](double t) { return g(t); },
                  [&](double from, double until) { return g.curvature(from, until); }, low, high,
                  [&](const Root& root) {
                    roots.push_back(root);
                    return true;
                  });
  return roots;
}

TEST(CertifiedRoots, AreAllRootsInOrderEachWithinItsError) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> anywhere(0.01, 0.99);
  for (int round = 0; round < 300; ++round) {
    std::vector<double> expected;
    for (int i = 0; i < 1 + round % 5; ++i) expected.push_back(anywhere(random));
    std::sort(expected.begin(), expected.end());
    const std::vector<Root> found = roots_of(Polynomial(expected), 0, 1);
    ASSERT_EQ(found.size(), expected.size());
    for (std::size_t i = 0; i < found.size(); ++i)
      EXPECT_NEAR(found[i].time, expected[i], found[i].error + DBL_EPSILON);
  }
}

TEST(CertifiedRoots, AreTwoHoweverCloseTheyLie) {
  for (int exponent = 4; exponent <= 48; ++exponent) {
    const double gap = std::ldexp(1.0, -exponent);
    const Polynomial g({0.3, 0.3 + gap});
    const std::vector<Root> found = roots_of(g, 0, 1);
    ASSERT_EQ(found.size(), 2U) << "a gap of 2^-" << exponent;
    EXPECT_NEAR(found[0].time, 0.3, gap / 4);
    EXPECT_NEAR(found[1].time - found[0].time, gap, gap / 4);
    EXPECT_LT(g.looks(), 40 * exponent + 200);
  }
}

// A double root, of which rounding does not tell whether it is two, one or none.
TEST(CertifiedRoots, AreFoundWhereTheFunctionTouchesZero) {
  const auto touch = [](double t) -> Jet {
    const double d = t - 0.3;
    return {d * d, 2 * d, 1e-16};
  };
  std::vector<Root> found;
  certified_roots(
      touch, [](double, double) { return 2.0; }, 0, 1,
      [&](const Root& root) {
        found.push_back(root);
        return true;
      });
  ASSERT_FALSE(found.empty());
  for (const Root& root : found) EXPECT_NEAR(root.time, 0.3, 4e-8);  // 1e-8 is the square root of the noise
}

TEST(CertifiedRoots, AreNoneWhereTheFunctionStaysAboveItsNoise) {
  int looks = 0;
  const auto above = [&looks](double t) -> Jet {
    ++looks;
    const double d = t - 0.3;
    return {d * d + 1e-12, 2 * d, 1e-16};
  };
  certified_roots(
      above, [](double, double) { return 2.0; }, 0, 1,
      [](const Root&) {
        ADD_FAILURE();
        return true;
      });
  EXPECT_LT(looks, 400);
}

// sin(w t) beside a count of its changes of sign on a fine grid.
TEST(CertifiedRoots, AreAsManyAsAFineGridShows) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> anywhere(0, 1);
  for (int round = 0; round < 50; ++round) {
    const double rate = 100 * anywhere(random);
    const double phase = 7 * anywhere(random);
    const double level = 2 * anywhere(random) - 1;
    const auto g = [&](double t) -> Jet {
      return {std::sin(rate * t + phase) - level, rate * std::cos(rate * t + phase), 1e-14};
    };
    int changes = 0;
    constexpr int steps = 200000;
    for (int i = 0; i < steps; ++i)
      changes += (g(1.0 * i / steps).value < 0) != (g((i + 1.0) / steps).value < 0) ? 1 : 0;
    int found = 0;
    double last = -1;
    certified_roots(
        g, [&](double, double) { return rate * rate; }, 0, 1,
        [&](const Root& root) {
          EXPECT_GT(root.time, last);
          last = root.time;
          ++found;
          return true;
        });
    EXPECT_EQ(found, changes) << rate << " " << phase << " " << level;
  }
}

TEST(CertifiedRoots, StopWhenTheyAreToldTo) {
  int told = 0;
  const Polynomial g({0.2, 0.4, 0.6});
  certified_roots([&](double t) { return g(t); }, [&](double a, double b) { return g.curvature(a, b); }, 0, 1,
                  [&](const Root&) { return ++told < 2; });
  EXPECT_EQ(told, 2);
}

// A path along the edge: nothing can be told, and that must be cheap.
TEST(CertifiedRoots, OfAFunctionThatIsZeroAreToldOnceAtTheCostOfALook) {
  int looks = 0;
  int told = 0;
  const auto zero = [&looks](double) -> Jet {
    ++looks;
    return {0, 0, 1e-16};
  };
  certified_roots(
      zero, [](double, double) { return 0.0; }, 0, 1,
      [&](const Root& root) {
        EXPECT_GE(root.error, 0.5);
        ++told;
        return true;
      });
  EXPECT_EQ(told, 1);
  EXPECT_LE(looks, 4);
}

TEST(CertifiedRoots, ScaleWithTime) {
  for (const double unit : {0x1p-60, 0x1p60}) {
    const Polynomial g({0.3, 0.7});
    const auto scaled = [&](double t) -> Jet {
      const Jet jet = g(t / unit);
      return {jet.value, jet.slope / unit, jet.noise};
    };
    std::vector<double> times;
    certified_roots(
        scaled, [&](double, double) { return 2 / unit / unit; }, 0, unit,
        [&](const Root& root) {
          times.push_back(root.time / unit);
          return true;
        });
    ASSERT_EQ(times.size(), 2U);
    EXPECT_NEAR(times[0], 0.3, 1e-15);
    EXPECT_NEAR(times[1], 0.7, 1e-15);
  }
}

// As the way on a line is next to its beginning, where the place has a rounding of its own.
TEST(RefinedRoot, IsFoundAtTheBeginningOfALongIntervalWhereTheFunctionIsFlatToRounding) {
  constexpr double place = 4;
  constexpr double speed = 0.5;
  for (const double root : {1e-100, 1e-20, 2e-16, 1e-8}) {
    for (const double end : {1.0, 40.0, 1e9}) {
      const auto height = [&](double t) {
        const double value = place + speed * (t - root) - place;
        return Jet{value - (t <= root ? 1e-300 : 0), speed, 2 * DBL_EPSILON * place};
      };
      const Root found = refined_root(height, 0.0, end, height(0).value, height(end).value);
      const double rounding = 2 * DBL_EPSILON * (place / speed + root);
      EXPECT_NEAR(found.time, root, rounding) << root << " of " << end;
      EXPECT_LE(found.error, 2 * rounding) << root << " of " << end;
    }
  }
}

TEST(RefinedRoot, OfASmoothFunctionTakesFewEvaluations) {
  const double root = std::cbrt(2.0);
  for (const double end : {1.5, 2.0, 4.0}) {
    int evaluations = 0;
    const auto cubic = [&](double t) {
      ++evaluations;
      return Jet{t * t * t - 2, 3 * t * t, 8 * DBL_EPSILON};
    };
    const Root found = refined_root(cubic, 1.0, end, -1, end * end * end - 2);
    EXPECT_NEAR(found.time, root, found.error);
    EXPECT_LE(found.error, 4 * DBL_EPSILON);
    EXPECT_LE(evaluations, 7) << end;
  }
}

}  // namespace
}  // namespace hybrid_sphere::geometry::certified_root_test

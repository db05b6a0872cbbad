// Contacts that are closed without a force: their reactions are round-off, and cost next to nothing.
#include <gtest/gtest.h>

#include <array>
#include <cfloat>
#include <cmath>
#include <string>
#include <vector>

#include "hybrid_sphere/mechanics/solve.hpp"
#include "hybrid_sphere/mechanics/system.hpp"
#include "mechanics/guard_search.hpp"

namespace hybrid_sphere::mechanics::closed_contact_test {
namespace {

// A step takes 13 evaluations; reactions are sampled at three places with their rates, and checked at the
// end.
constexpr double per_step = 30;

/// Pendulums of unit mass and length, of small amplitude, whose bobs touch at rest.
template <int N>
System<N> cradle() {
  std::array<std::string, std::size_t(N)> names;
  for (int i = 0; i < N; ++i) names[std::size_t(i)] = "x" + std::to_string(i);
  System<N> bobs(names, [](auto, const auto& q, const auto& v) {
    auto lagrangian = 0 * v[0];
    for (int i = 0; i < N; ++i) lagrangian += (v[i] * v[i] - q[i] * q[i]) / 2;
    return lagrangian;
  });
  for (int i = 0; i + 1 < N; ++i) {
    bobs.unilateral(
        "contact " + std::to_string(i), [i](const auto&, const auto& q) { return q[i + 1] - q[i]; }, 1);
  }
  return bobs;
}

TEST(ClosedContact, WithoutAForceCostsFewEvaluations) {
  System<2> pair({"a", "b"}, [](const auto&, const auto&, const auto& v) { return v.squaredNorm() / 2; });
  pair.unilateral("contact", [](const auto&, const auto& q) { return q[1] - q[0]; });
  for (const double duration : {1.0, 1000.0}) {
    const Solution motion = solve(pair, {0, {0, 0}, {1, 1}}, duration);
    ASSERT_EQ(motion.status().stop, Stop::reached_end) << motion.status().message;
    EXPECT_EQ(motion.at(duration).active, ActiveSet{0});
    EXPECT_LE(double(motion.evaluations()), per_step * double(motion.steps()));
  }
}

TEST(ClosedContact, OfBobsThatSwingTogetherCostsFewEvaluations) {
  const Solution motion = solve(cradle<5>(), {0, {0, 0, 0, 0, 0}, {1, 1, 1, 1, 1}}, 20);
  ASSERT_EQ(motion.status().stop, Stop::reached_end) << motion.status().message;
  EXPECT_EQ(motion.at(20).active.size(), 4U);
  EXPECT_LE(double(motion.evaluations()), per_step * double(motion.steps()));
}

// The bobs at rest swing together after the first blow, and the first one alone.
TEST(ClosedContact, OfNewtonsCradleCostsFewEvaluations) {
  const Solution motion = solve(cradle<5>(), {0, {-1, 0, 0, 0, 0}, {0, 0, 0, 0, 0}}, 8);
  ASSERT_EQ(motion.status().stop, Stop::reached_end) << motion.status().message;
  ASSERT_EQ(motion.switches().size(), 3U);
  EXPECT_NEAR(motion.switches()[0].time, M_PI / 2, 1e-9);
  EXPECT_LE(motion.evaluations(), 2000U);
}

// From t = 0.3 on a force grows from 0, which pulls the bodies apart or presses them together.
TEST(ClosedContact, OpensWhenAForcePullsAndStaysWhenItPresses) {
  for (const double sign : {-1.0, 1.0}) {
    System<2> pair(
        {"a", "b"}, [](const auto&, const auto&, const auto& v) { return v.squaredNorm() / 2; },
        [sign](const double t, const auto&, const auto&) {
          const double late = std::max(0.0, t - 0.3);
          return Eigen::Vector2d(0, -sign * late * late);
        });
    pair.unilateral("contact", [](const auto&, const auto& q) { return q[1] - q[0]; });
    const Solution motion = solve(pair, {0, {0, 0}, {1, 1}}, 1);
    ASSERT_EQ(motion.status().stop, Stop::reached_end) << motion.status().message;
    EXPECT_EQ(motion.at(1).active.empty(), sign < 0);
    const double together = std::pow(0.7, 4) / 12;  // way of one body alone, pulled by the force
    EXPECT_NEAR(motion.at(1).q[1] - motion.at(1).q[0], sign < 0 ? together : 0, 1e-9);
  }
}

constexpr double r = 0.5;      // radius of the disks
constexpr double width = 2.6;  // of their box

/// Disks in a box; each gap has a friction.
template <int N>
System<3 * N> disks_in_a_box(double restitution, double mu) {
  std::array<std::string, std::size_t(3 * N)> names;
  for (std::size_t i = 0; i < names.size(); ++i) names[i] = "q" + std::to_string(i);
  System<3 * N> disks(names, [](auto, const auto& q, const auto& v) {
    auto lagrangian = 0 * v[0];
    for (int i = 0; i < N; ++i) {
      const auto& u = v[3 * i];
      const auto& w = v[3 * i + 1];
      const auto& spin = v[3 * i + 2];
      lagrangian += (u * u + w * w + r * r / 2 * spin * spin) / 2 - 9.81 * q[3 * i + 1];
    }
    return lagrangian;
  });
  const auto add = [&](const std::string& name, const auto& gap, const auto& slip) {
    disks.unilateral(name, gap, restitution).friction("grip of " + name, slip, mu, name);
  };
  for (int i = 0; i < N; ++i) {
    const int x = 3 * i, z = x + 1, spin = x + 2;
    add(
        "floor " + std::to_string(i), [z](const auto&, const auto& q) { return q[z] - r; },
        [=](auto, const auto&, const auto& v) { return v[x] + r * v[spin]; });
    add(
        "left " + std::to_string(i), [x](const auto&, const auto& q) { return q[x] - r; },
        [=](auto, const auto&, const auto& v) { return v[z] - r * v[spin]; });
    add(
        "right " + std::to_string(i), [x](const auto&, const auto& q) { return width - q[x] - r; },
        [=](auto, const auto&, const auto& v) { return v[z] + r * v[spin]; });
    for (int j = 0; j < i; ++j) {
      const auto distance = [=](const auto& q) {
        using std::sqrt;
        const auto dx = q[x] - q[3 * j];
        const auto dz = q[z] - q[3 * j + 1];
        return sqrt(dx * dx + dz * dz);
      };
      add(
          "pair " + std::to_string(i) + " " + std::to_string(j),
          [=](const auto&, const auto& q) { return distance(q) - 2 * r; },
          [=](auto, const auto& q, const auto& v) {
            const auto across =
                (v[z] - v[3 * j + 1]) * (q[x] - q[3 * j]) - (v[x] - v[3 * j]) * (q[z] - q[3 * j + 1]);
            return across / distance(q) - r * (v[spin] + v[3 * j + 2]);
          });
    }
  }
  return disks;
}

TEST(ClosedContact, OfDisksThatComeToRestInABoxCostsFewEvaluations) {
  for (const auto& [restitution, mu] : {std::pair{0.3, 0.3}, std::pair{0.0, 0.0}}) {
    SCOPED_TRACE(::testing::Message() << "restitution " << restitution << ", mu " << mu);
    const Initial start{
        0, {0.58, 0.6, 0, 2.03, 0.61, 0, 0.6, 1.67, 0, 2.05, 1.68, 0}, Vector(Vector::Zero(12))};
    Options options;
    options.max_switches = 5000;
    const Solution motion = solve(disks_in_a_box<4>(restitution, mu), start, 3, options);
    ASSERT_EQ(motion.status().stop, Stop::reached_end) << motion.status().message;
    // The instant of each guard that changes is found by up to 15 steps of 13 evaluations; at a switch up to
    // four guards change.
    EXPECT_LE(double(motion.evaluations()),
              per_step * double(motion.steps()) + 4 * 15 * 13 * double(motion.switches().size()));
  }
}

struct Searched {
  int samples = 0;
  std::vector<double> places;
};

template <class Value>
Searched search(const Value& value, double roundoff) {
  Searched searched;
  const auto sample = [&](double x) {
    ++searched.samples;
    constexpr double h = 1e-6;
    const double at_x = std::abs(value(x)) <= roundoff ? DBL_MIN : value(x);
    return GuardSample{x, at_x, (value(x + h) - value(x - h)) / (2 * h), roundoff};
  };
  search_guard(sample, sample(0), sample(1), searched.places);
  return searched;
}

TEST(GuardSearch, DoesNotSearchWhereValuesAreRoundoff) {
  const auto noise = [](double x) { return 1e-16 * std::sin(1e9 * x); };
  const Searched searched = search(noise, 1e-15);
  EXPECT_EQ(searched.samples, 3);
  EXPECT_TRUE(searched.places.empty());
  EXPECT_GT(search(noise, 0).samples, 100);
}

// Round-off at one end, or at both, hides no change of sign between them.
TEST(GuardSearch, FindsChangesBesideRoundoff) {
  constexpr double roundoff = 1e-12;
  const auto late = [](double x) { return x < 0.9 ? 0.0 : -(x - 0.9); };
  EXPECT_FALSE(search(late, roundoff).places.empty());
  const auto early = [](double x) { return x * (0.1 - x); };
  EXPECT_FALSE(search(early, roundoff).places.empty());
  const auto between = [](double x) { return -1e-3 * x * (1 - x); };
  EXPECT_FALSE(search(between, roundoff).places.empty());
}

}  // namespace
}  // namespace hybrid_sphere::mechanics::closed_contact_test

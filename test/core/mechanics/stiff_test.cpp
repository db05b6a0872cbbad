// Dampers much faster than the motion: a step is as long as the motion allows, not the damper.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/mechanics/particle.hpp"
#include "hybrid_sphere/mechanics/plant.hpp"

namespace hybrid_sphere::mechanics::stiff_test {
namespace {

using testing::accurate;

constexpr double rate = 1e6;  // of the dampers [1/s]
constexpr double duration = 10;

/// x' follows cos t: x'' = -r (x' - cos t).
System<1> follower(double r = rate) {
  return {{"x"},
          [](auto, const auto&, const auto& v) { return v[0] * v[0] / 2; },
          [r](auto t, const auto&, const auto& v) {
            using std::cos;
            return -r * (v[0] - cos(t));
          }};
}

/// Its motion from rest at x = 0.
struct Followed {
  static constexpr double share = rate * rate / (rate * rate + 1);
  static double v(double t) { return share * (std::cos(t) + std::sin(t) / rate - std::exp(-rate * t)); }
  static double x(double t) {
    return share * (std::sin(t) + (1 - std::cos(t)) / rate + std::expm1(-rate * t) / rate);
  }
};

/// With explicit steps alone there would be some two million.
void expect_cheap(const Solution& solution) {
  EXPECT_EQ(solution.status().stop, Stop::reached_end) << solution.status().message;
  EXPECT_LE(solution.steps(), 400u);
  EXPECT_LE(solution.evaluations(), 8000u);
}

const std::vector<double>& instants() {
  static const std::vector<double> all = {0, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3, 0.1, 1.7, 3.3, 9.99, duration};
  return all;
}

TEST(StiffDamper, FollowsASlowMotion) {
  for (const double accuracy : {1e-3, 1e-6, 1e-9, 1e-12}) {
    SCOPED_TRACE(accuracy);
    const Solution solution = solve(follower(), {0, {0.0}, {0.0}}, duration, accurate(accuracy));
    expect_cheap(solution);
    for (const double t : instants()) {
      EXPECT_NEAR(solution.at(t).v[0], Followed::v(t), accuracy) << t;
      EXPECT_NEAR(solution.at(t).q[0], Followed::x(t), accuracy) << t;
    }
  }
}

// x'' = -(1 + rate) x' - rate x decays with both 1 and the rate.
TEST(StiffDamper, MayBeAsFastAsItLikes) {
  for (const double r : {1e4, 1e9, 1e12}) {
    SCOPED_TRACE(r);
    const Solution solution = solve(follower(r), {0, {0.0}, {0.0}}, duration);
    expect_cheap(solution);
    // Without what decays, and 1/r^2.
    EXPECT_NEAR(solution.at(duration).v[0], std::cos(duration) + std::sin(duration) / r, 1e-9 + 1 / (r * r));
    EXPECT_NEAR(solution.at(duration).q[0], std::sin(duration) - std::cos(duration) / r, 1e-9 + 3 / (r * r));
  }
}

TEST(StiffDamper, LetsASpringGoBackSlowly) {
  const System<1> system(
      {"x"}, [](auto, const auto& q, const auto& v) { return (v[0] * v[0] - rate * q[0] * q[0]) / 2; },
      [](auto, const auto&, const auto& v) { return -(1 + rate) * v[0]; });
  for (const double accuracy : {1e-3, 1e-6, 1e-9, 1e-12}) {
    SCOPED_TRACE(accuracy);
    const Solution solution = solve(system, {0, {1.0}, {0.0}}, duration, accurate(accuracy));
    expect_cheap(solution);
    for (const double t : instants()) {
      const double slow = std::exp(-t);
      const double fast = std::exp(-rate * t);
      EXPECT_NEAR(solution.at(t).q[0], (rate * slow - fast) / (rate - 1), accuracy) << t;
      EXPECT_NEAR(solution.at(t).v[0], rate * (fast - slow) / (rate - 1), accuracy) << t;
    }
  }
}

// Two unit masses, tied by a damper, of which a spring holds one: what oscillates is hardly damped, by
// k^2/(16 c) = 1/4 of a millionth, and all else by 2 rate.
TEST(StiffDamper, LetsTheRestOscillate) {
  const double k = 2;
  const System<2> system(
      {"x", "y"}, [k](auto, const auto& q, const auto& v) { return (v.squaredNorm() - k * q[0] * q[0]) / 2; },
      [](auto, const auto&, const auto& v) {
        auto force = v;
        force[0] = -rate * (v[0] - v[1]);
        force[1] = -force[0];
        return force;
      });
  const Solution solution = solve(system, {0, {1.0, 1.0}, {0.0, 0.0}}, duration);
  expect_cheap(solution);
  for (const double t : instants()) {
    EXPECT_NEAR(solution.at(t).q[0], std::cos(t), 3 / rate) << t;
    EXPECT_NEAR(solution.at(t).q[1], std::cos(t), 3 / rate) << t;
  }
}

/// A sleigh that a viscous drive turns at the angular velocity 1.
System<3> sleigh(double r = rate) {
  System<3> system(
      {"x", "y", "angle"}, [](auto, const auto&, const auto& v) { return v.squaredNorm() / 2; },
      [r](auto, const auto&, const auto& v) {
        auto force = v;
        force[0] = force[1] = 0;
        force[2] = -r * (v[2] - 1);
        return force;
      });
  system.constrain(
      "blade",
      [](auto, const auto& q, const auto& v) {
        using std::cos, std::sin;
        return v[0] * sin(q[2]) - v[1] * cos(q[2]);
      },
      always());
  return system;
}

// From the speed 1 without turning: a circle, behind by the angle 1/rate, which is lost before the sleigh has
// come far.
TEST(StiffDamper, KeepsAConstraint) {
  for (const double accuracy : {1e-6, 1e-9}) {
    SCOPED_TRACE(accuracy);
    const Solution solution =
        solve(sleigh(), {0, {0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}}, duration, accurate(accuracy));
    expect_cheap(solution);
    for (const double t : {1e-3, 0.1, 1.7, 3.3, 9.99, duration}) {
      const State state = solution.at(t);
      const double behind = 1 / rate;
      EXPECT_NEAR(state.q[0], std::sin(t - behind) + behind, accuracy) << t;
      EXPECT_NEAR(state.q[1], 1 - std::cos(t - behind), accuracy) << t;
      EXPECT_NEAR(state.v[2], 1, accuracy) << t;
      EXPECT_NEAR(state.multipliers[0], -1, 2 * accuracy) << t;
      EXPECT_LE(state.residual, 1e-14) << t;
    }
  }
}

// Whether the fast part of the motion is passed by explicit or by implicit steps depends on the rate. Once it
// is over, the scale of errors is that of the motion that is left.
TEST(StiffDamper, LeavesNoLooserBoundBehind) {
  for (const double r : {1e4, 3e4, 1e5, 2e5, 3e5, 5e5, 7e5, 1e6, 1.3e6, 2e6, 3e6, 5e6, 1e7, 1e8}) {
    for (const double accuracy : {1e-6, 1e-9}) {
      const Solution solution =
          solve(sleigh(r), {0, {0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}}, duration, accurate(accuracy));
      expect_cheap(solution);
      const double behind = 1 / r;
      const double bound = accuracy + behind * behind;  // of what is left out of the circle below
      for (const double t : {1.7, 3.3, 9.99, duration}) {
        const State state = solution.at(t);
        EXPECT_NEAR(state.q[0], std::sin(t - behind) + behind, bound) << r << ", accuracy " << accuracy;
        EXPECT_NEAR(state.q[1], 1 - std::cos(t - behind), bound) << r << ", accuracy " << accuracy;
      }
    }
  }
}

/// The follower, with another mass that goes along y, also at its driven speed 1, but where sin t > 1/2.
System<2> stopped_by_a_guard() {
  System<2> system(
      {"x", "y"}, [](auto, const auto&, const auto& v) { return v.squaredNorm() / 2; },
      [](auto t, const auto&, const auto& v) {
        using std::cos;
        auto force = v;
        force[0] = -rate * (v[0] - cos(t));
        force[1] = -rate * (v[1] - 1);
        return force;
      });
  system.constrain(
      "brake", [](auto, const auto&, const auto& v) { return v[1]; },
      while_positive([](auto, const auto& q) { return q[0] - 0.5; }));
  return system;
}

const Initial at_rest{0, {0.0, 0.0}, {0.0, 0.0}};

TEST(StiffDamper, SwitchesWhereAGuardChanges) {
  for (const double accuracy : {1e-6, 1e-9}) {
    SCOPED_TRACE(accuracy);
    const Solution solution = solve(stopped_by_a_guard(), at_rest, duration, accurate(accuracy));
    ASSERT_EQ(solution.status().stop, Stop::reached_end) << solution.status().message;
    ASSERT_EQ(solution.switches().size(), 4u);
    for (const Switch& change : solution.switches()) {
      EXPECT_NEAR(Followed::x(change.time), 0.5, accuracy) << change.time;
    }
    // Each release leaves y behind by what its speed needs to come up.
    const auto& changes = solution.switches();
    const double gone = changes[0].time + (changes[2].time - changes[1].time) + (duration - changes[3].time);
    EXPECT_NEAR(solution.at(duration).q[1], gone - 3 / rate, 4 * accuracy);
    EXPECT_LE(solution.steps(), 5 * 400u);
    EXPECT_LE(solution.evaluations(), 5 * 8000u);
  }
}

TEST(StiffDamper, IsTheSameInAnyPeriods) {
  const Solution solution = solve(stopped_by_a_guard(), at_rest, duration);
  for (const int periods : {7, 1000}) {
    Plant plant(stopped_by_a_guard(), at_rest, {}, duration);
    std::vector<Switch> switches;
    for (int i = 1; i <= periods; ++i) {
      plant.advance(duration * i / periods, [&](const Switch& change) { switches.push_back(change); });
      // A step of solve() is cut at its end.
      const State expected = solution.at(plant.time());
      const double tolerance = i < periods - periods / 10 ? 0 : 1e-9;
      EXPECT_NEAR(plant.state().q[0], expected.q[0], tolerance) << plant.time();
      EXPECT_NEAR(plant.state().v[1], expected.v[1], tolerance) << plant.time();
    }
    ASSERT_EQ(switches.size(), solution.switches().size());
    for (std::size_t i = 0; i < switches.size(); ++i) {
      EXPECT_EQ(switches[i].time, solution.switches()[i].time);
    }
    EXPECT_LE(plant.steps(), solution.steps() + 5);
  }
}

TEST(StiffDamper, GoesOnAlikeFromASavedState) {
  Plant plant(stopped_by_a_guard(), at_rest, {}, duration);
  plant.advance(1.7);
  const Plant::Snapshot saved = plant.save();
  std::vector<State> ends;
  for (int i = 0; i < 2; ++i) {
    plant.restore(saved);
    plant.advance(8);
    ends.push_back(plant.state());
  }
  EXPECT_EQ(ends[0].q, ends[1].q);
  EXPECT_EQ(ends[0].v, ends[1].v);
  EXPECT_NEAR(ends[0].q[0], Followed::x(8), 1e-9);
  EXPECT_LE(plant.evaluations(), 40000u);
}

// Of a system whose damper goes at t = 5: what follows is an oscillation of no damping at all.
TEST(StiffDamper, MayEnd) {
  const System<1> system(
      {"x"}, [](auto, const auto& q, const auto& v) { return (v[0] * v[0] - q[0] * q[0]) / 2; },
      [](auto t, const auto&, const auto& v) {
        using std::exp;
        return -rate / (1 + exp(40 * (t - 5))) * (v[0] - 1);
      });
  const Solution solution = solve(system, {0, {0.0}, {1.0}}, 20);
  EXPECT_LE(solution.steps(), 1000u);
  EXPECT_LE(solution.evaluations(), 20000u);
  const Solution finer = solve(system, {0, {0.0}, {1.0}}, 20, accurate(1e-13));
  EXPECT_NEAR(solution.at(20).q[0], finer.at(20).q[0], 1e-8);
  const auto energy = [&](double t) { return solution.at(t).energy; };
  EXPECT_NEAR(energy(20), energy(9), 1e-8 * energy(9));
}

// Van der Pol's oscillator creeps, jumps, and creeps again.
TEST(StiffDamper, ComesAgain) {
  const double mu = 1e4;
  const System<1> oscillator(
      {"x"}, [](auto, const auto& q, const auto& v) { return (v[0] * v[0] - q[0] * q[0]) / 2; },
      [mu](auto, const auto& q, const auto& v) { return mu * (1 - q[0] * q[0]) * v[0]; });
  const Initial start{0, {2.0}, {0.0}};
  const Solution fine = solve(oscillator, start, 2 * mu, accurate(1e-12));
  for (const double accuracy : {1e-6, 1e-9}) {
    SCOPED_TRACE(accuracy);
    const Solution solution = solve(oscillator, start, 2 * mu, accurate(accuracy));
    EXPECT_EQ(solution.status().stop, Stop::reached_end) << solution.status().message;
    EXPECT_LE(solution.steps(), 2000u);
    EXPECT_LE(solution.evaluations(), 60000u);
    for (const double part : {0.3, 0.7, 1.0, 1.5, 1.8, 2.0}) {
      EXPECT_NEAR(solution.at(part * mu).q[0], fine.at(part * mu).q[0], 4 * accuracy) << part;
    }
  }
}

}  // namespace
}  // namespace hybrid_sphere::mechanics::stiff_test

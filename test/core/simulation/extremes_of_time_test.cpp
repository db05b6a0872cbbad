// A million switches, long times and every output rate: time stays as good as the clock that counts it.

#include <gtest/gtest.h>

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <cstring>

#include "support/extremes.hpp"
#include "support/recorded.hpp"

namespace hybrid_sphere::testing::extremes_of_time_test {
namespace {

#ifdef __SANITIZE_ADDRESS__
constexpr int many = 10'000;
constexpr int outputs = 10'000;
#else
constexpr int many = 1'000'000;
constexpr int outputs = 100'000;
#endif

scene::Scene paper() {
  scene::Scene scene{};
  scene.sphere = {2, 0.25, 0.25 * std::sqrt(0.4)};
  scene.initial_state.position = {-1, 0.5};
  scene.initial_state.velocity = {2, -0.75};
  scene.initial_state.angular_velocity = {4, 5, -2};
  scene.surface.regions = {{"half", scene::HalfPlane{{0, 0}, {1, 0}}, scene::Law::rough}};
  return scene;
}

// Half an ulp for the time that is reported and one for the edge, which lies at a rounded multiple of the
// spacing. Nothing adds up: each segment has a time that is right to a few ulp of itself, and their sum is
// kept in two numbers.
void expect_all_switches(double spacing) {
  const Strips strips = run_over_strips(many, spacing);
  ASSERT_EQ(strips.failure, "");
  EXPECT_EQ(strips.switches, many);
  EXPECT_LE(strips.time_error, strips.time_floor) << "times in s";
  EXPECT_LE(strips.state_error, 4 * 0x1p-53) << "relative to the way";
}

TEST(ExtremesOfTime, AMillionSwitchesAMillimetreApartAreAllReportedAtTheirTimes) {
  expect_all_switches(1e-3);
}

TEST(ExtremesOfTime, AMillionSwitchesAMetreApartAreAllReportedAtTheirTimes) { expect_all_switches(1); }

TEST(ExtremesOfTime, AMillionSwitchesAKilometreApartAreAllReportedAtTheirTimes) { expect_all_switches(1000); }

// Binary64 counts seconds in steps of 1.2e-10 s at 1e6 s.
TEST(ExtremesOfTime, ASwitchAfterAMillionSecondsIsRightToTheNanosecond) {
  const Strips strips = run_over_strips(1000, 1000);
  EXPECT_EQ(strips.switches, 1000);
  EXPECT_LE(strips.time_error, 1e-9);
}

// In steps of 1.2e-7 s at 1e9 s: the time that is reported is the one next to the switch's.
TEST(ExtremesOfTime, ASwitchAfterAThousandMillionSecondsIsRightToTheClock) {
  const Strips strips = run_over_strips(1000, 1e6);
  EXPECT_EQ(strips.switches, 1000);
  EXPECT_LE(strips.time_error, 6e-8);
}

using Wide = boost::multiprecision::cpp_bin_float_50;

Wide moment_of(const Switch& event) { return Wide(event.time) + Wide(event.time_remainder); }

Switch first_switch(const scene::Scene& scene, double until) {
  std::vector<Switch> events;
  Simulation simulation(scene);
  simulation.advance_to(until, [&events](const Switch& event) { events.push_back(event); });
  return events.empty() ? Switch() : events.front();
}

// The scene time_1e9: one segment of 1e9 s. The rest is a double next to 6e-8 s, and was found with numbers
// of twice binary64's length: 2^-50 of an ulp of 1e9 s is 1e-22 s.
TEST(ExtremesOfTime, TheMomentOfASwitchIsRightFarBelowTheNanosecondAfterAThousandMillionSeconds) {
  scene::Scene scene = paper();
  scene.initial_state.position = {-2, 0.5};
  scene.initial_state.velocity = {2e-9, -7.5e-10};
  const Wide straight = Wide(2) / Wide(2e-9);
  const Switch event = first_switch(scene, 2e9);
  EXPECT_LE(abs(moment_of(event) - straight), 1e-21) << event.time << " + " << event.time_remainder;
  EXPECT_NE(event.time_remainder, 0);

  // Oblique, over a side of a polygon whose direction is itself a rounded difference.
  const Vector2d a(0.1, -1.3);
  const Vector2d b(0.7, 4.1);
  scene.surface.regions = {{"field", scene::Polygon{{a, {9.3, 0.2}, b}}, scene::Law::rough}};
  const auto across = [&](const Vector2d& from, double x, double y) {
    return (Wide(b.y()) - a.y()) * (Wide(x) - from.x()) - (Wide(b.x()) - a.x()) * (Wide(y) - from.y());
  };
  const Wide oblique = across({-2, 0.5}, a.x(), a.y()) / across({0, 0}, 2e-9, -7.5e-10);
  EXPECT_LE(abs(moment_of(first_switch(scene, 2e9)) - oblique), 1e-21);
}

// A segment that begins at a switch knows when that was: at 1 m/s nothing is lost on the strips either, but
// an ulp of the way for each edge, which lies at a rounded multiple of the spacing.
TEST(ExtremesOfTime, TheMomentOfASwitchDoesNotLoseTheRestOfTheSegmentsBefore) {
  const Strips strips = run_over_strips(1000, 1e6);
  EXPECT_EQ(strips.switches, 1000);
  EXPECT_LE(strips.moment_error, 1e-12);
}

bool same_bits(const State& a, const State& b) {
  const auto same = [](const auto& x, const auto& y) { return std::memcmp(&x, &y, sizeof x) == 0; };
  return same(a.position, b.position) && same(a.orientation, b.orientation) && same(a.slip, b.slip) &&
         same(a.twist.velocity, b.twist.velocity) &&
         same(a.twist.angular_velocity, b.twist.angular_velocity) && a.mode == b.mode && a.region == b.region;
}

/// States at i/compared, looked at `rate` times a second: rate is a multiple of compared, and quotients are
/// rounded correctly, so that the common times are the same numbers.
std::vector<RecordedState> states(const scene::Scene& scene, double rate, double compared, double until) {
  std::vector<RecordedState> found;
  Simulation simulation(scene);
  const auto every = static_cast<std::int64_t>(rate / compared);
  for (std::int64_t i = 0; static_cast<double>(i) / rate <= until; ++i) {
    simulation.advance_to(static_cast<double>(i) / rate, {[](const Switch&) {}});
    const State& state = simulation.state();
    if (i % every == 0) found.emplace_back(simulation);
    EXPECT_TRUE(state.position.allFinite());
  }
  return found;
}

void expect_same(const scene::Scene& scene, double rate, double compared, double until) {
  const auto coarse = states(scene, compared, compared, until);
  const auto fine = states(scene, rate, compared, until);
  ASSERT_EQ(coarse.size(), fine.size());
  ASSERT_GT(coarse.size(), 1U);
  for (std::size_t i = 0; i < coarse.size(); ++i) {
    EXPECT_TRUE(same_bits(coarse[i], fine[i]))
        << rate << " Hz and " << compared << " Hz at " << coarse[i].time;
    EXPECT_EQ(coarse[i].name, fine[i].name);
  }
}

/// One scene for each way in which a motion is computed.
std::vector<scene::Scene> motions() {
  std::vector<scene::Scene> scenes(6, paper());
  scenes[1].forces.gravity = {0.5, 0.25, -9.81};
  scenes[2].forces.drag.translational = 3;
  scenes[3].surface.regions[0].material.law = scene::Law::coulomb;
  scenes[3].surface.regions[0].material.friction = 0.05;
  scenes[4].forces.drag.quadratic = 2;
  scenes[5] = scenes[3];
  scenes[5].forces.drag.translational = 0.5;
  return scenes;
}

TEST(OutputsAtAMegahertz, AreThoseAtAKilohertzBitForBit) {
  for (scene::Scene scene : motions()) {
    scene.initial_state.position.x() = -0.02;  // the switch is at 0.01 s
    expect_same(scene, 1e6, 1e3, outputs / 1e6 / 4);
  }
}

TEST(OutputsAtAKilohertz, AreThoseAtOneHertzBitForBit) {
  for (const scene::Scene& scene : motions()) expect_same(scene, 1e3, 1, outputs / 1e3 / 4);
}

// One output every thousand seconds; the integrated and the rolling motion that turn all the time are
// followed to the same bits as well.
TEST(OutputsAtAMillihertz, AreThoseAtOneHertzBitForBit) {
  for (const scene::Scene& scene : motions()) {
    if (scene.forces.gravity.x() == 0) expect_same(scene, 1, 0.001, 2000);
  }
}

// A piece of the path is a revolution or two, though the cells of the index are a metre wide.
TEST(ExtremesOfTime, AFastTurntableAmongManyRegionsIsSearchedByTheRevolution) {
  scene::Scene scene{};
  scene.sphere = {1, 0.25, 0.125};  // kappa = 1/5
  scene.initial_state.velocity = {1e-9, 0};
  scene.initial_state.angular_velocity = {0, 4e-9, 0};  // rolls
  scene::Material turntable(scene::Law::rough);
  turntable.turntable_rate = 1e9;
  scene.surface.base = turntable;
  turntable.spin_friction = 1e-3;  // another ground, of the same motion
  for (int i = 0; i < 50; ++i) {
    const Vector2d corner(i - 25, 0);
    scene.surface.regions.push_back(
        {"cell " + std::to_string(i),
         scene::Polygon{{corner, corner + Vector2d(1, 0), corner + Vector2d(1, 1), corner + Vector2d(0, 1)}},
         turntable});
  }
  Simulation simulation(scene);
  simulation.advance_to(1e-6, {});  // 200 radians about a place 5e-18 m away
  EXPECT_NEAR(simulation.state().twist.velocity.norm(), 1e-9, 1e-20);
  EXPECT_LE(simulation.state().position.norm(), 2e-17);
}

// Quadratic drag changes such a speed in 1e30 s: steps of a fixed length are not taken so far ahead.
TEST(ExtremesOfTime, AMotionThatHardlyChangesIsFollowedByStepsOfAFixedLengthAsFarAsItIsAskedFor) {
  using Method = scene::Solver::Method;
  for (const Method method : {Method::euler, Method::rk4, Method::lie_midpoint, Method::rkmk4}) {
    scene::Scene scene{};
    scene.sphere = {0.25, 0.875, 0.25};
    scene.surface.base = scene::Law::rough;
    scene.initial_state.velocity = {3e-31, 0};
    scene.initial_state.angular_velocity = {0, 3e-31 / 0.875, 0};
    scene.forces.drag.quadratic = 0.5;
    scene.solver.method = method;
    scene.solver.step = 1e-3;
    Simulation simulation(scene);
    EXPECT_NO_THROW(simulation.advance_to(4, {}));
    EXPECT_LE(simulation.evaluations(), 100'000U);
    EXPECT_NEAR(simulation.state().position.x(), 1.2e-30, 1e-40);
  }
}

}  // namespace
}  // namespace hybrid_sphere::testing::extremes_of_time_test

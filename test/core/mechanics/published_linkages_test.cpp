// Published linkages: benchmarks A01 to A05 of the IFToMM library and Andrews' squeezer of the test set for
// initial value problems. Sources: docs/reliability.md, "Published problems".
#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include <array>
#include <cmath>
#include <string>

#include "core/mechanics/particle.hpp"
#include "hybrid_sphere/mechanics/multibody_system.hpp"

namespace hybrid_sphere::mechanics::published_linkages_test {
namespace {

using Eigen::AngleAxisd;
using Eigen::Isometry3d;
using Eigen::Vector3d;
using testing::accurate;

constexpr double gravity = 9.81;
const Vector3d down(0, -gravity, 0);
const Vector3d out_of_plane(0, 0, 1);

YAML::Node reference(const std::string& problem) {
  return YAML::LoadFile(std::string(TEST_DATA_DIR) + "/mechanics/published_references.json")[problem];
}

// A01: a mass on a rod is released from the level. With k = sin(45 deg) its angle from below is
// 2 asin(k sn(K - w t)); sn is 1/sqrt(1 + k') at an eighth of the period 4 K/w.
TEST(PublishedLinkages, A01SimplePendulum) {
  const double k = std::sqrt(0.5), period = 4 * std::comp_ellint_1(k) / std::sqrt(gravity);
  const double s = k / std::sqrt(1 + k);
  const std::array<double, 8> eighths = {k, s, 0, -s, -k, -s, 0, s};  // sin(angle/2)
  for (const double accuracy : {1e-6, 1e-9, 1e-12}) {
    MultibodySystem system(down);
    system.point_mass("mass", 1, {-1, 0, 0}).rod("rod", "world", "mass", {0, 0, 0}, {-1, 0, 0});
    const Solution motion = solve(system, system.initial(), 10, accurate(accuracy));
    ASSERT_EQ(motion.status().stop, Stop::reached_end) << motion.status().message;
    for (std::size_t i = 0; double(i) * period / 8 <= 10; ++i) {
      const double angle = 2 * std::asin(eighths[i % 8]);
      const Vector3d place = system.pose(motion.at(double(i) * period / 8).q, "mass").translation();
      EXPECT_LE((place - Vector3d(-std::sin(angle), -std::cos(angle), 0)).norm(), accuracy) << i;
    }
  }
}

/// A02: N windows of a four-bar mechanism, all bars of 1 m and 1 kg, upright, with a velocity of the top.
MultibodySystem four_bars(int windows) {
  constexpr double I = 1.0 / 12, thin = 1e-3;  // nothing turns about the bars' lines
  MultibodySystem system(down);
  const auto numbered = [](const char* name, int i) { return name + std::to_string(i); };
  for (int i = 0; i <= windows; ++i) {
    const std::string bar = numbered("upright", i);
    system.body(bar, 1, {I, thin, I}, Vector3d(i, 0.5, 0))
        .hinge(numbered("base", i), "world", bar, {double(i), 0, 0}, out_of_plane);
  }
  for (int i = 0; i < windows; ++i) {
    const std::string bar = numbered("top", i);
    system.body(bar, 1, {thin, I, I}, Vector3d(i + 0.5, 1, 0))
        .hinge(numbered("left", i), numbered("upright", i), bar, {double(i), 1, 0}, out_of_plane)
        .hinge(numbered("right", i), numbered("upright", i + 1), bar, {double(i + 1), 1, 0}, out_of_plane);
  }
  return system;
}

// As long as all windows are parallelograms, all uprights turn by one angle a: 3/2 a'^2 + 7/2 g cos(a) stays.
// The published motion passes the level, at t = 0.7144 s, and lasts for 10 s; this one ends just before it.
TEST(PublishedLinkages, A02FourBarsUpToTheirFirstSingularPosition) {
  const MultibodySystem system = four_bars(2);
  const Initial start = system.initial({{"upright0", {{0.5, 0, 0}, {0, 0, -1}}}});
  const System<1> reduced({"a"}, [](auto, const auto& q, const auto& v) {
    using std::cos;
    return 1.5 * v[0] * v[0] - 3.5 * gravity * cos(q[0]);
  });
  const State last = solve(reduced, {0, {0.0}, {1.0}}, 0.7, accurate(1e-13)).at(0.7);
  for (const double accuracy : {1e-6, 1e-9}) {
    const Solution motion = solve(system, start, 0.7, accurate(accuracy));
    ASSERT_EQ(motion.status().stop, Stop::reached_end) << motion.status().message;
    const Vector3d tip = system.pose(motion.at(0.7).q, "upright0") * Vector3d(0, 0.5, 0);
    EXPECT_LE((tip - Vector3d(std::sin(last.q[0]), std::cos(last.q[0]), 0)).norm(), 4 * accuracy);
  }
}

/// A bar in the plane whose axes are turned by an angle from the x axis.
struct Bar {
  double mass, inertia;
  Vector3d center;
};

Vector3d along(double angle) { return {std::cos(angle), std::sin(angle), 0}; }
Vector3d across(double angle) { return {std::sin(angle), -std::cos(angle), 0}; }

/// A03: Andrews' squeezer at its published start.
struct Squeezer {
  static constexpr double beta = -0.0617138900142764496358948458001, gamma = 0.455279819163070380255912382449,
                          phi = 0.222668390165885884674473185609, delta = 0.487364979543842550225598953530,
                          omega = -phi, epsilon = 1.23054744454982119249735015568;
  const Vector3d A{-0.06934, -0.00227, 0}, B{-0.03635, 0.03273, 0}, C{0.014, 0.072, 0};
  const Vector3d F = 0.007 * along(beta), E = F - 0.028 * along(beta);
  const Vector3d D = B + 0.02 * along(gamma) + 0.018 * across(gamma);
  const Vector3d G = A + 0.04 * along(delta), H = A + 0.04 * across(epsilon);

  MultibodySystem system() const {
    const Bar bars[] = {
        {0.04325, 2.194e-6, 0.00092 * along(beta)},
        {0.00365, 4.410e-7, F - 0.0115 * along(beta)},
        {0.02373, 5.255e-6, B + 0.01874 * across(gamma) + 0.01043 * along(gamma)},
        {0.00706, 5.667e-7, G + (0.02 - 0.01421) * across(phi + delta)},
        {0.07050, 1.169e-5, A + 0.02308 * along(delta) - 0.00916 * across(delta)},
        {0.00706, 5.667e-7, H + (0.02 - 0.01421) * along(omega + epsilon)},
        {0.05498, 1.912e-5, A + 0.01228 * across(epsilon) - 0.00449 * along(epsilon)},
    };
    MultibodySystem system(Vector3d(0, 0, 0));
    int number = 0;
    for (const Bar& bar : bars) {
      const double I = bar.inertia;
      system.body(std::to_string(++number), bar.mass, {I, I, I}, bar.center);
    }
    system.hinge("O", "world", "1", {0, 0, 0}, out_of_plane)
        .hinge("F", "1", "2", F, out_of_plane)
        .hinge("E3", "2", "3", E, out_of_plane)
        .hinge("B", "world", "3", B, out_of_plane)
        .hinge("E4", "2", "4", E, out_of_plane)
        .hinge("G", "4", "5", G, out_of_plane)
        .hinge("A5", "world", "5", A, out_of_plane)
        .hinge("E6", "2", "6", E, out_of_plane)
        .hinge("H", "6", "7", H, out_of_plane)
        .hinge("A7", "world", "7", A, out_of_plane)
        .spring("spring", "world", "3", C, D, 4530, 0.07785)
        .apply("1", Wrench{{0, 0, 0}, {0, 0, 0.033}});
    return system;
  }
};

// Its coordinates out of the plane are 0, and have no size to which round-off could be compared.
TEST(PublishedLinkages, A03StartIsPutOntoTheHingesAlsoIfItIsExact) {
  const MultibodySystem system = Squeezer().system();
  Options options = accurate(1e-13);
  options.project_positions = true;
  for (const double digit : {0.0, 1e-8, 1e-6, 1e-4}) {
    Initial start = system.initial();
    if (digit > 0) start.q = Vector((start.q / digit).array().round() * digit);
    const Solution motion = solve(system, start, 0, options);
    const Vector q = motion.at(0).q;
    for (const char* bar : {"3", "4", "6"}) {  // all hinged to bar 2 at the same point
      const Vector3d E = Squeezer().E;
      const auto in_the_world = [&](const std::string& name) -> Vector3d {
        return system.pose(q, name) * (system.pose(system.initial().q, name).inverse() * E);
      };
      EXPECT_LE((in_the_world(bar) - in_the_world("2")).norm(), 1e-16) << digit << ", bar " << bar;
    }
    // 49 coordinates, each rounded by half a digit at most; the metric of M moves those of light bars by
    // more.
    EXPECT_LE(motion.projection().q.norm(), std::max(7 * digit, 1e-16)) << digit;
  }
}

TEST(PublishedLinkages, A03AndrewsSqueezer) {
  using S = Squeezer;
  constexpr double accuracy = 1e-6;
  const MultibodySystem system = Squeezer().system();
  const Solution motion = solve(system, system.initial(), 0.03, accurate(accuracy));
  ASSERT_EQ(motion.status().stop, Stop::reached_end) << motion.status().message;
  const State last = motion.at(0.03);
  // The published angles at t = 0.03 s less those at the start, by which the bars have turned.
  const double beta = 15.81077119629904, theta = -15.75637105984298, gamma = 0.04082224013073101,
               phi = -0.5347301163226948, delta = 0.5244099658805304, omega = 0.5347301163226948,
               epsilon = 1.048080741042263;
  const std::array<double, 7> turned = {beta - S::beta,      beta + theta - S::beta,
                                        gamma - S::gamma,    phi + delta - S::phi - S::delta,
                                        delta - S::delta,    omega + epsilon - S::omega - S::epsilon,
                                        epsilon - S::epsilon};
  for (std::size_t i = 0; i < turned.size(); ++i) {
    const std::string bar = std::to_string(i + 1);
    const Eigen::Matrix3d R = system.pose(last.q, bar).linear();
    const double error = std::remainder(std::atan2(R(1, 0), R(0, 0)) - turned[i], 2 * M_PI);
    EXPECT_LE(std::abs(error), accuracy * (beta - S::beta)) << bar;
  }
  const double speed = 1139.920302151208;  // of beta [rad/s]
  EXPECT_NEAR(system.twist(last.q, last.v, "1").angular_velocity.z(), speed, 10 * accuracy * speed);
}

/// A04: five bars in a closed chain of six hinges, of which each is at right angles to both neighbours.
MultibodySystem bricard() {
  const std::array<Vector3d, 6> P = {Vector3d(0, 0, 0),  Vector3d(1, 0, 0),  Vector3d(1, -1, 0),
                                     Vector3d(1, -1, 1), Vector3d(0, -1, 1), Vector3d(0, 0, 1)};
  const std::array<Vector3d, 6> axes = {Vector3d::UnitY(), Vector3d::UnitZ(), Vector3d::UnitX(),
                                        Vector3d::UnitY(), Vector3d::UnitZ(), Vector3d::UnitX()};
  MultibodySystem system(down);
  std::string previous = "world";
  for (std::size_t i = 0; i < 5; ++i) {
    const Vector3d along = P[i + 1] - P[i];
    Isometry3d placement = Isometry3d::Identity();
    placement.linear() << along, axes[i], along.cross(axes[i]);
    placement.translation() = (P[i] + P[i + 1]) / 2;
    const std::string bar = "bar" + std::to_string(i);
    system.body(bar, 1, {0.02 / 12, 1.01 / 12, 1.01 / 12}, placement)
        .hinge("hinge" + std::to_string(i), previous, bar, P[i], axes[i]);
    previous = bar;
  }
  system.hinge("closure", previous, "world", P[5], axes[5]);
  return system;
}

// The steps are as long as the accuracy allows, although a hinge is redundant: off the constraints, where
// stages of a step are, its rows do not depend on the others.
TEST(PublishedLinkages, A04Bricard) {
  constexpr double accuracy = 1e-6;
  const MultibodySystem system = bricard();
  const Solution motion = solve(system, system.initial(), 10, accurate(accuracy));
  ASSERT_EQ(motion.status().stop, Stop::reached_end) << motion.status().message;
  EXPECT_LE(motion.steps(), 200u);
  const YAML::Node known = reference("bricard")[0];
  const Vector3d place(known["P3"][0].as<double>(), known["P3"][1].as<double>(), known["P3"][2].as<double>());
  const State state = motion.at(known["time"].as<double>());
  EXPECT_LE((system.pose(state.q, "bar2") * Vector3d(0.5, 0, 0) - place).norm(), 4 * accuracy);
  for (const double t : {0.1, 5.0, 10.0}) {
    EXPECT_NEAR(motion.at(t).energy, motion.at(0).energy, 10 * accuracy) << t;
  }
}

/// A05: a flyball governor whose rods are held by springs with dampers, which are stiff.
MultibodySystem governor() {
  constexpr double angle = M_PI / 6, width = 0.01, mass = 0.3, arm = 0.05, height = 0.5, J = 3 * 0.02 / 12;
  constexpr double I = mass * (1 + width * width) / 12, I_along = mass * width * width / 6;
  MultibodySystem system;
  system.body("shaft", mass, {I, I, I_along}, Vector3d(0, 0, 0.5))
      .body("slider", 3, {J, J, J}, Vector3d(0, 0, height))
      .hinge("bearing", "world", "shaft", {0, 0, 0}, {0, 0, 1})
      .slider("guide", "shaft", "slider", {0, 0, height}, {0, 0, 1});
  for (const double side : {1.0, -1.0}) {
    const std::string rod = side > 0 ? "right" : "left";
    const Vector3d top(side * arm, 0, 1), line(side * std::cos(angle), 0, -std::sin(angle));
    const Vector3d middle = top + line / 2, at_slider(side * arm, 0, height);
    Isometry3d placement(AngleAxisd(side > 0 ? angle : M_PI - angle, Vector3d::UnitY()));
    placement.pretranslate(middle);
    system.body(rod, mass, {I_along, I, I}, placement)
        .point_mass(rod + " ball", 5, top + line)
        .hinge(rod + " hinge", "shaft", rod, top, {0, 1, 0})
        .ball(rod + " tip", rod, rod + " ball", top + line)
        .spring(rod + " spring", "slider", rod, at_slider, middle, 8e5, 0.5)
        .damper(rod + " damper", "slider", rod, at_slider, middle, 4e4);
  }
  return system;
}

// The published motion lasts for 10 s; this one for 0.5 s.
TEST(PublishedLinkages, A05FlyballGovernor) {
  constexpr double accuracy = 1e-6;
  const MultibodySystem system = governor();
  const Initial start =
      system.initial({{"shaft", {{0, 0, 0}, {0, 0, 2 * M_PI}}}, {"slider", {{0, 0, 0}, {0, 0, 2 * M_PI}}}});
  const Solution motion = solve(system, start, 0.5, accurate(accuracy));
  ASSERT_EQ(motion.status().stop, Stop::reached_end) << motion.status().message;
  const YAML::Node known = reference("governor")[0];
  const State state = motion.at(known["time"].as<double>());
  EXPECT_NEAR(system.pose(state.q, "slider").translation().z(), known["height"].as<double>(), accuracy);
}

}  // namespace
}  // namespace hybrid_sphere::mechanics::published_linkages_test

// Published problems with contacts, impacts and friction. Sources: docs/reliability.md, "Published problems".
#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include <cmath>
#include <string>
#include <vector>

#include "core/mechanics/particle.hpp"
#include "hybrid_sphere/mechanics/multibody_system.hpp"

namespace hybrid_sphere::mechanics::published_contacts_test {
namespace {

using Eigen::AngleAxisd;
using Eigen::Isometry3d;
using Eigen::Vector3d;
using testing::accurate;

constexpr double gravity = 9.81;

/// Glocker's woodpecker: height and angle of the sleeve, angle of the bird. The first contact is that of the
/// beak, the others are those of the lower and of the upper edge of the sleeve.
struct Toy {
  static constexpr double m = 0.0003, J = 5e-9, bird = 0.0045, J_bird = 7e-7, stiffness = 0.0056, mu = 0.3;
  static constexpr double pole = 0.0025, hole = 0.0031, half = 0.0058, arm = 0.010, to_bird = 0.015,
                          beak = 0.02, reach = 0.0201;
  static System<3> system();
};

System<3> Toy::system() {
  System<3> toy({"y", "sleeve", "bird"}, [](auto, const auto& q, const auto& v) {
    const auto twist = q[1] - q[2];
    const auto kinetic = (bird + m) * v[0] * v[0] + (J + bird * arm * arm) * v[1] * v[1] +
                         (J_bird + bird * to_bird * to_bird) * v[2] * v[2] +
                         2 * bird * (arm * v[0] * v[1] + to_bird * v[0] * v[2] + arm * to_bird * v[1] * v[2]);
    const auto potential = stiffness * twist * twist / 2 +
                           gravity * ((bird + m) * q[0] + bird * arm * q[1] + bird * to_bird * q[2]);
    return kinetic / 2 - potential;
  });
  toy.unilateral(
      "beak", [](const auto&, const auto& q) { return (arm + to_bird - reach - pole) - beak * q[2]; }, 0.5);
  toy.unilateral(
      "lower", [](const auto&, const auto& q) { return (hole - pole) + half * q[1]; }, 0);
  toy.unilateral(
      "upper", [](const auto&, const auto& q) { return (hole - pole) - half * q[1]; }, 0);
  const auto along_pole = [](auto, const auto&, const auto& v) { return v[0] + hole * v[1]; };
  toy.friction(
      "beak slips",
      [](auto, const auto&, const auto& v) { return v[0] + arm * v[1] + (to_bird - reach) * v[2]; }, mu,
      "beak");
  toy.friction("lower slips", along_pole, mu, "lower");
  toy.friction("upper slips", along_pole, mu, "upper");
  return toy;
}

// The published state is on a limit cycle, with the lower edge on the pole. The motion returns to it within 1
// %: laws of impact with friction differ, and Poisson's hypothesis is not the only one.
TEST(PublishedContacts, WoodpeckerReturnsToItsCycle) {
  const double sleeve = -0.0006 / 0.0058, bird = -0.2788, fall = -0.3411, swing = -7.4583;
  const Solution motion = solve(Toy::system(), {0, {0, sleeve, bird}, {fall, 0, swing}}, 0.2);
  ASSERT_EQ(motion.status().stop, Stop::reached_end) << motion.status().message;
  double before = 0.135, after = 0.16;  // the bird swings down between these
  for (int i = 0; i < 50; ++i) {
    const double middle = (before + after) / 2;
    (motion.at(middle).q[2] > bird ? before : after) = middle;
  }
  const State again = motion.at(after);
  EXPECT_NEAR(again.q[1], sleeve, 1e-12);
  EXPECT_NEAR(again.v[0], fall, 0.01 * std::abs(fall));
  EXPECT_NEAR(again.v[2], swing, 0.01 * std::abs(swing));
}

// After some cycles each one is as the one before.
TEST(PublishedContacts, WoodpeckerHasALimitCycle) {
  std::vector<double> periods, falls;
  for (const double accuracy : {1e-7, 1e-9}) {
    const Solution motion = solve(Toy::system(), {0, {0, -0.0006 / 0.0058, -0.2788}, {-0.3411, 0, -7.4583}},
                                  12, accurate(accuracy));
    ASSERT_EQ(motion.status().stop, Stop::reached_end) << motion.status().message;
    std::vector<const Switch*> sticks;  // the lower edge of the sleeve comes to rest
    for (const Switch& change : motion.switches()) {
      if (change.applied == ActiveSet{4}) sticks.push_back(&change);
    }
    ASSERT_GT(sticks.size(), 80u);
    for (std::size_t i = sticks.size() - 2; i < sticks.size(); ++i) {
      periods.push_back(sticks[i]->time - sticks[i - 1]->time);
      falls.push_back(sticks[i]->q[0] - sticks[i - 1]->q[0]);
    }
  }
  // Errors of the accuracies relative to 12 s and to a fall of 1.6 m.
  for (std::size_t i = 1; i < periods.size(); ++i) {
    EXPECT_NEAR(periods[i], periods[0], 12 * 1e-7) << i;
    EXPECT_NEAR(falls[i], falls[0], 1.6 * 1e-7) << i;
  }
}

/// Housner's block: a slender rectangle with the diagonal 2 R rocks without slipping and without bouncing.
struct Block {
  double slenderness;  // angle of the diagonal to the vertical
  static constexpr double R = 1;

  System<3> system() const {
    const double b = R * std::sin(slenderness), h = R * std::cos(slenderness);
    System<3> block({"x", "z", "angle"}, [](auto, const auto& q, const auto& v) {
      return (v[0] * v[0] + v[1] * v[1] + R * R / 3 * v[2] * v[2]) / 2 - gravity * q[1];
    });
    for (const double side : {-1.0, 1.0}) {
      const std::string name = side < 0 ? "left" : "right";
      const auto gap = [=](const auto&, const auto& q) {
        using std::cos;
        using std::sin;
        return q[1] - h * cos(q[2]) + side * b * sin(q[2]);
      };
      const auto slip = [=](auto, const auto& q, const auto& v) {
        using std::cos;
        using std::sin;
        return v[0] + (h * cos(q[2]) - side * b * sin(q[2])) * v[2];
      };
      block.unilateral(name, gap, 0).friction("grip of " + name, slip, 5, name);
    }
    return block;
  }
  Solution motion(double angle, double duration) const {
    const double height = R * std::cos(slenderness - angle);
    return solve(system(), {0, {0, height, angle}, {0, 0, 0}}, duration);
  }
};

// An impact leaves 1 - 3/2 sin^2 of the angular velocity (Housner 1963).
TEST(PublishedContacts, RockingBlockLosesHousnersPartAtAnImpact) {
  for (const double slenderness : {0.1, 0.2, 0.3, 0.5}) {
    const Solution motion = Block{slenderness}.motion(slenderness / 4, 2.5);
    ASSERT_EQ(motion.status().stop, Stop::reached_end) << motion.status().message;
    ASSERT_GE(motion.switches().size(), 4u);
    const double s = std::sin(slenderness);
    for (std::size_t i = 0; i < 4; ++i) {
      const Switch& impact = motion.switches()[i];
      EXPECT_NEAR(impact.v_after[2] / impact.v_before[2], 1 - 1.5 * s * s, 1e-9) << slenderness << ", " << i;
    }
  }
}

// The time to the first impact is a quarter of the period, acosh(1/(1 - a/s))/p with p^2 = 3 g/(4 R) for
// small angles a and s. The next term of sin(s - a) slows it by up to s^2/6.
TEST(PublishedContacts, RockingBlockHasHousnersPeriod) {
  for (const double slenderness : {0.01, 0.03, 0.1}) {
    for (const double part : {0.1, 0.4, 0.8}) {
      const Solution motion = Block{slenderness}.motion(part * slenderness, 1);
      ASSERT_GE(motion.switches().size(), 1u);
      const double p = std::sqrt(3 * gravity / (4 * Block::R)), quarter = std::acosh(1 / (1 - part)) / p;
      EXPECT_NEAR(motion.switches()[0].time, quarter, slenderness * slenderness / 6 * quarter);
    }
  }
}

// A coin of one degree from upright spins about the vertical and begins to roll.
TEST(PublishedContacts, RollingCoin) {
  constexpr double r = 0.01;
  Isometry3d placement(AngleAxisd(M_PI / 180, Vector3d::UnitY()));
  const Vector3d axle = placement.linear().col(0), up = r * placement.linear().col(2), spin(0, 0, 10 * M_PI);
  placement.pretranslate(up);
  MultibodySystem system;
  system.body("coin", 1, {0.5 * r * r, 0.25 * r * r, 0.25 * r * r}, placement)
      .rolling("ground", "coin", ContactShape::disk(r, axle));
  const YAML::Node known =
      YAML::LoadFile(std::string(TEST_DATA_DIR) + "/mechanics/published_references.json")["rolling_coin"];
  const Vector3d place(known["contact"][0].as<double>(), known["contact"][1].as<double>(), 0);
  for (const double accuracy : {1e-6, 1e-9}) {
    const Solution motion =
        solve(system, system.initial({{"coin", {spin.cross(up), spin}}}), 0.5, accurate(accuracy));
    ASSERT_EQ(motion.status().stop, Stop::reached_end) << motion.status().message;
    const Isometry3d pose = system.pose(motion.at(0.5).q, "coin");
    const Vector3d now = pose.linear().col(0);
    const Vector3d contact = pose.translation() - r * now.cross(Vector3d::UnitZ().cross(now)).normalized();
    EXPECT_NEAR(std::acos(now.z()), known["axle_angle"].as<double>(), 10 * accuracy);
    EXPECT_LE((contact - place).norm(), r * 10 * accuracy);
  }
}

/// SimBenchmark's rolling test: balls on a box on rough ground that is pushed away under them.
struct PushedBox {
  int balls_in_a_row;
  int feet;
  static constexpr double M = 10, m = 1, r = 0.5, of_ground = 0.4, of_balls = 0.8;

  int balls() const { return balls_in_a_row * balls_in_a_row; }
  double friction_of_ground() const { return of_ground * (M + balls() * m) * gravity; }
  double force_on_ball(double F) const { return (F - friction_of_ground()) / M / (3.5 / m + balls() / M); }

  MultibodySystem system(const Vector3d& force) const {
    constexpr double I = 0.4 * m * r * r, foot = 0.1, edge = 9.9;
    MultibodySystem box;
    box.body("box", M, {M * 401 / 12, M * 401 / 12, M * 800 / 12}, Vector3d(0, 0, 0.5))
        .apply("box", Wrench{force, {0, 0, 0}});
    for (int i = 0; i < feet; ++i) {
      const double angle = 2 * M_PI * i / feet;
      const std::string name = "foot" + std::to_string(i);
      const Vector3d center(edge * std::cos(angle), edge * std::sin(angle), foot);
      box.contact(name, "box", ContactShape::sphere(foot, center))
          .friction("rub of " + name, name, of_ground);
    }
    for (int i = 0; i < balls(); ++i) {
      const int row = i / balls_in_a_row, column = i % balls_in_a_row;
      const double x = 2 * column - (balls_in_a_row - 1), y = 2 * row - (balls_in_a_row - 1);
      const std::string ball = "ball" + std::to_string(i), touch = "touch" + std::to_string(i);
      box.body(ball, m, {I, I, I}, Vector3d(x, y, 1.5))
          .contact(touch, ball, ContactShape::sphere(r), 0, {{0, 0, 1}, {0, 0, 1}, "box"})
          .friction("grip of " + touch, touch, of_balls);
    }
    return box;
  }
};

// The force f on a ball gives it f/m and its surface 7/2 f/m, the acceleration of the box, which is
// (F - friction of the ground - n f)/M. The published box has 25 balls and F = 150 N; here F exceeds the
// friction of the ground by as much, 12.66 N.
TEST(PublishedContacts, BallsRollOnAPushedBox) {
  for (const PushedBox& box : {PushedBox{1, 3}, PushedBox{1, 4}, PushedBox{2, 3}}) {
    const double F = box.friction_of_ground() + 12.66, f = box.force_on_ball(F);
    for (const Vector3d& direction : {Vector3d(0, 1, 0), Vector3d(0.5, std::sqrt(0.75), 0)}) {
      const MultibodySystem system = box.system(F * direction);
      const Solution motion = solve(system, system.initial(), 4, accurate(1e-6));
      ASSERT_EQ(motion.status().stop, Stop::reached_end) << motion.status().message;
      const State last = motion.at(4);
      const Vector3d of_box = 4 * (12.66 - box.balls() * f) / PushedBox::M * direction;
      EXPECT_LE((system.twist(last.q, last.v, "box").velocity - of_box).norm(), 1e-6 * of_box.norm());
      for (int i = 0; i < box.balls(); ++i) {
        const Vector3d velocity = system.twist(last.q, last.v, "ball" + std::to_string(i)).velocity;
        EXPECT_LE((velocity - 4 * f / PushedBox::m * direction).norm(), 1e-6 * of_box.norm()) << i;
      }
    }
  }
}

}  // namespace
}  // namespace hybrid_sphere::mechanics::published_contacts_test

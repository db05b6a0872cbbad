// Bodies that roll, skate and land on planes, against known motions.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <string>

#include "catalogue/catalogue.hpp"
#include "core/mechanics/particle.hpp"
#include "hybrid_sphere/mechanics/multibody_system.hpp"

namespace hybrid_sphere::mechanics::multibody_contact_test {
namespace {

using Eigen::AngleAxisd;
using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr double gravity = 9.81;

class MultibodyContact : public ::testing::TestWithParam<double> {
 protected:
  Solution motion_of(const Model& model, const Initial& start, double duration) const {
    return solve(model, start, duration, testing::accurate(GetParam()));
  }
  /// The error of q and v relative to the scale of motion; a few of it where the scale is an estimate.
  double tolerance(double scale) const { return 4 * GetParam() * scale; }
};

INSTANTIATE_TEST_SUITE_P(Accuracies, MultibodyContact, ::testing::Values(1e-6, 1e-9, 1e-12));

// A solid sphere rolls down a slope with 5/7 of what it would slide with; friction takes 2/7 of its weight's
// component.
TEST_P(MultibodyContact, SphereRollsDownASlope) {
  constexpr double m = 2, r = 0.3, slope = 0.4;
  const Vector3d normal(std::sin(slope), 0, std::cos(slope)), down(std::cos(slope), 0, -std::sin(slope));
  constexpr double I = 0.4 * m * r * r;
  const Vector3d foot(0.2, 0.1, 0.5);
  MultibodySystem system;
  system.body("ball", m, {I, I, I}, Vector3d(foot + r * normal))
      .rolling("slope", "ball", ContactShape::sphere(r), always(), {foot, normal});
  const Solution motion = motion_of(system, system.initial(), 2);
  ASSERT_EQ(motion.status().stop, Stop::reached_end) << motion.status().message;
  const double a = 5.0 / 7 * gravity * std::sin(slope);
  const State last = motion.at(2);
  const Isometry3d pose = system.pose(last.q, "ball");
  EXPECT_LE((pose.translation() - foot - r * normal - 2 * a * down).norm(), tolerance(2 * a));
  const Vector3d axis = normal.cross(down);
  EXPECT_LE((pose.linear() - AngleAxisd(2 * a / r, axis).toRotationMatrix()).norm(), tolerance(2 * a / r));
  const Vector3d force = m * (a * down + gravity * Vector3d::UnitZ());
  EXPECT_LE((last.multipliers - force).norm(), 1e-12);
  EXPECT_LT(last.residual, 1e-13);
}

// A thin disk on a circle: tilted, and steady where
//   W sin(c) (-C w3 + A W cos(c)) = m r (r w3 W sin(c) + g cos(c))
// with the angle c of its axle to the vertical, its turning w3 about it and the precession W (moments about
// the centre of mass: the force at the contact is m (r w3 W e + g z), e the level direction of the axle).
TEST_P(MultibodyContact, DiskRollsOnACircle) {
  constexpr double m = 1.5, r = 0.4, A = 0.25 * m * r * r, C = 2 * A, c = 1.2, W = 2;
  const double S = std::sin(c), K = std::cos(c);
  const double w3 = K * (A * W * W * S - m * gravity * r) / (W * S * (C + m * r * r));
  Isometry3d placement(AngleAxisd(c, Vector3d::UnitY()));  // the axle is the body's z
  const Vector3d axle = placement.linear().col(2);
  const Vector3d up = (Vector3d::UnitZ() - K * axle) / S;
  placement.pretranslate(r * up);
  const Vector3d w = w3 * axle + W * S * up;
  MultibodySystem system;
  system.body("disk", m, {A, A, C}, placement).rolling("ground", "disk", ContactShape::disk(r, 3 * axle));
  const Solution motion = motion_of(system, system.initial({{"disk", {w.cross(r * up), w}}}), 3);
  ASSERT_EQ(motion.status().stop, Stop::reached_end) << motion.status().message;
  const Vector3d middle = placement.translation() + Vector3d::UnitZ().cross(w.cross(r * up)) / W;
  for (int i = 0; i <= 6; ++i) {
    const State state = motion.at(i / 2.0);
    const Eigen::Matrix3d turn = AngleAxisd(W * state.time, Vector3d::UnitZ()).toRotationMatrix();
    const Isometry3d pose = system.pose(state.q, "disk");
    // It is stable only in part: an error grows by exp(rate t), here by less than ten.
    EXPECT_LE((pose.linear().col(2) - turn * axle).norm(), tolerance(40)) << state.time;
    EXPECT_LE((pose.translation() - middle - turn * (placement.translation() - middle)).norm(),
              tolerance(40));
    const Vector3d out = turn * Vector3d(axle.x(), axle.y(), 0) / S;
    const Vector3d force = m * (r * w3 * W * out + gravity * Vector3d::UnitZ());
    EXPECT_LE((state.multipliers - force).norm(), tolerance(400 * force.norm()));
  }
}

/// An entry of the catalogue with its numbers as a rule, but for those that are set.
struct Classical {
  explicit Classical(const std::string& name, const std::map<std::string, double>& set = {})
      : values(with(catalogue::Values(catalogue::entry(name).parameters), set)),
        example(catalogue::entry(name).build(values)) {}
  static catalogue::Values with(catalogue::Values values, const std::map<std::string, double>& set) {
    for (const auto& [name, value] : set) values.set(name, value);
    return values;
  }
  catalogue::Values values;
  catalogue::Example example;
};

Isometry3d upright(double theta, const Vector3d& center) {
  return Eigen::Translation3d(center) * AngleAxisd(theta, Vector3d::UnitZ());
}

// The upright disk of the catalogue is a wheel in a fork that a plane keeps upright: with the height of the
// wheel on the ground one function too many. It slips, and suddenly rolls.
TEST_P(MultibodyContact, WheelInAForkIsTheUprightDisk) {
  const Classical disk("rolling_disk", {{"J", 0.2}});
  const double m = disk.values["m"], R = disk.values["R"], I = disk.values["I"], J = disk.values["J"];
  const Vector& q = disk.example.initial.q;
  const Vector& v = disk.example.initial.v;
  const Isometry3d placement = upright(q[2], {q[0], q[1], R});
  const Vector3d left = placement.linear().col(1);
  MultibodySystem system;
  system.body("wheel", m / 4, {0.75 * J, I, 0.75 * J}, placement)
      .body("fork", 3 * m / 4, {0.25 * J, 0.25 * J, 0.25 * J}, placement)
      .planar("upright", "world", "fork", placement.translation(), {0, 0, 1})
      .hinge("hub", "fork", "wheel", placement.translation(), left)
      .rolling("rolling", "wheel", ContactShape::disk(R, left), from(disk.values["t_switch"]));
  const Vector3d velocity(v[0], v[1], 0), yaw(0, 0, v[2]);
  const Initial start = system.initial({{"fork", {velocity, yaw}}, {"wheel", {velocity, yaw + v[3] * left}}});
  const Solution motion = motion_of(system, start, 2);
  ASSERT_EQ(motion.status().stop, Stop::reached_end) << motion.status().message;
  ASSERT_EQ(motion.switches().size(), 1u);
  for (const double t : {0.25, 0.5, 1.0, 2.0}) {
    const State state = motion.at(t);
    const catalogue::Known known = *disk.example.known(t);
    const Isometry3d fork = system.pose(state.q, "fork");
    EXPECT_LE((fork.translation().head<2>() - known.q.head<2>()).norm(), tolerance(4)) << t;
    EXPECT_LE((fork.linear() - upright(known.q[2], {0, 0, 0}).linear()).norm(), tolerance(4)) << t;
    const Vector3d spin =
        system.twist(state.q, state.v, "wheel").angular_velocity - Vector3d(0, 0, known.v[2]);
    EXPECT_LE((spin - known.v[3] * fork.linear().col(1)).norm(), tolerance(40)) << t;
  }
}

TEST_P(MultibodyContact, BladeMakesChaplyginsSleigh) {
  const Classical sleigh("chaplygin_sleigh");
  const double a = sleigh.values["a"];
  const Vector& q = sleigh.example.initial.q;
  const Vector& v = sleigh.example.initial.v;
  const Isometry3d blade = upright(q[2], {q[0], q[1], 0});
  const Isometry3d placement = blade * Eigen::Translation3d(a, 0, 0.1);
  MultibodySystem system;
  system.body("sleigh", sleigh.values["m"], {0.5, 0.5, sleigh.values["I"]}, placement)
      .planar("ice", "world", "sleigh", blade.translation(), {0, 0, 1})
      .blade("blade", "sleigh", blade.translation(), blade.linear().col(0), from(sleigh.values["t_switch"]));
  const Vector3d w(0, 0, v[2]);
  const Vector3d center = Vector3d(v[0], v[1], 0) + w.cross(placement.translation() - blade.translation());
  const Solution motion = motion_of(system, system.initial({{"sleigh", {center, w}}}), 4);
  ASSERT_EQ(motion.status().stop, Stop::reached_end) << motion.status().message;
  ASSERT_EQ(motion.switches().size(), 1u);
  const Vector3d on_body(-a, 0, -0.1);
  for (const double t : {0.25, 0.5, 2.0, 4.0}) {
    const State state = motion.at(t);
    const catalogue::Known known = *sleigh.example.known(t);
    const Isometry3d pose = system.pose(state.q, "sleigh");
    EXPECT_LE((pose * on_body - Vector3d(known.q[0], known.q[1], 0)).norm(), tolerance(6)) << t;
    EXPECT_LE((pose.linear() - upright(known.q[2], {0, 0, 0}).linear()).norm(), tolerance(6)) << t;
    const Vector3d point = system.velocity(state.q, state.v, "sleigh", on_body);
    EXPECT_LE((point - Vector3d(known.v[0], known.v[1], 0)).norm(), tolerance(10)) << t;
    EXPECT_NEAR(state.multipliers[3], (*known.multipliers)[0], tolerance(100)) << t;
  }
}

// It falls by h, keeps e of its speed at each bounce, and comes to rest after all of them.
TEST_P(MultibodyContact, SphereBounces) {
  constexpr double r = 0.2, h = 0.5, e = 0.6;
  MultibodySystem system;
  system.body("ball", 1, {0.016, 0.016, 0.016}, Vector3d(0, 0, r + h))
      .contact("ground", "ball", ContactShape::sphere(r), e);
  const Solution motion = motion_of(system, system.initial(), 3);
  ASSERT_EQ(motion.status().stop, Stop::reached_end) << motion.status().message;
  double time = std::sqrt(2 * h / gravity), speed = gravity * time;
  for (std::size_t i = 0; i < 8; ++i) {
    const Switch& bounce = motion.switches().at(i);
    EXPECT_NEAR(bounce.time, time, tolerance(1)) << i;
    EXPECT_NEAR(bounce.v_after[2], e * speed, tolerance(4)) << i;
    speed *= e;
    time += 2 * speed / gravity;
  }
  const State last = motion.at(3);
  EXPECT_EQ(last.active, ActiveSet{0});
  EXPECT_NEAR(last.q[2], r, 1e-15);
  EXPECT_NEAR(last.multipliers[0], gravity, 1e-12);
}

// A ball is thrown along the ground with backspin: the blow takes 7/2 mu of its fall from the slip, then
// friction 7/2 mu g; it rolls with 5/7 of its velocity less 2/7 of that of its spin.
TEST_P(MultibodyContact, SphereLandsSlidesAndRolls) {
  constexpr double m = 0.5, r = 0.2, h = 0.3, mu = 0.15, v0 = 4, spin = -6, I = 0.4 * m * r * r;
  MultibodySystem system;
  system.body("ball", m, {I, I, I}, Vector3d(0, 0, r + h))
      .contact("ground", "ball", ContactShape::sphere(r))
      .friction("grip", "ground", mu);
  const Solution motion = motion_of(system, system.initial({{"ball", {{v0, 0, 0}, {0, spin, 0}}}}), 3);
  ASSERT_EQ(motion.status().stop, Stop::reached_end) << motion.status().message;
  ASSERT_EQ(motion.switches().size(), 2u);
  const double fall = std::sqrt(2 * gravity * h);
  const Switch& landing = motion.switches()[0];
  EXPECT_NEAR(landing.time, fall / gravity, tolerance(1));
  EXPECT_NEAR(landing.v_after[0], v0 - mu * fall, tolerance(4));
  EXPECT_NEAR(landing.multipliers[0], m * fall, tolerance(4));
  EXPECT_NEAR(landing.multipliers[1], -mu * m * fall, tolerance(4));
  EXPECT_EQ(landing.sliding, (Slides{{1, 1}}));
  const double slip = v0 - r * spin - 3.5 * mu * fall;
  EXPECT_NEAR(motion.switches()[1].time - landing.time, slip / (3.5 * mu * gravity), tolerance(8));
  const State last = motion.at(3);
  EXPECT_NEAR(last.v[0], 5.0 / 7 * v0 + 2.0 / 7 * r * spin, tolerance(4));
  EXPECT_NEAR(r * last.v[4], last.v[0], 1e-14);
  EXPECT_EQ(last.active, (ActiveSet{0, 1}));
}

// A tilted hoop without friction falls until its edge, r sin(c) below the centre, meets the ground; the blow
// there turns it: with the arm r cos(c) it is m s / (1 + m (r cos(c))^2 / A).
TEST_P(MultibodyContact, DiskLandsOnItsEdge) {
  constexpr double m = 2, r = 0.4, c = 1.0, A = 0.5 * m * r * r, h = 0.2;
  const Isometry3d placement =
      Eigen::Translation3d(1, 2, r * std::sin(c) + h) * AngleAxisd(c, Vector3d::UnitY());
  MultibodySystem system;
  system.body("hoop", m, {A, A, 2 * A}, placement)
      .contact("ground", "hoop", ContactShape::disk(r, placement.linear().col(2)));
  const Solution motion = motion_of(system, system.initial(), 0.25);
  ASSERT_GE(motion.switches().size(), 1u);
  const Switch& landing = motion.switches()[0];
  const double speed = std::sqrt(2 * gravity * h);
  EXPECT_NEAR(landing.time, speed / gravity, tolerance(1));
  const double arm = r * std::cos(c);
  const double blow = m * speed / (1 + m * arm * arm / A);
  EXPECT_NEAR(landing.multipliers[0], blow, tolerance(10));
  EXPECT_NEAR(landing.v_after[2], -speed + blow / m, tolerance(10));
  EXPECT_NEAR(std::abs(landing.v_after[4]), blow * arm / A, tolerance(10));
  const double gap = landing.v_after[2] + arm * std::abs(landing.v_after[4]);
  EXPECT_NEAR(gap, 0, 1e-14);
}

}  // namespace
}  // namespace hybrid_sphere::mechanics::multibody_contact_test

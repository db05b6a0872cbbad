// What is particular to the catalogue's spheres and carriage; tests of every entry are elsewhere.

#include "catalogue/sphere_systems.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "catalogue/quaternion.hpp"
#include "catalogue/sphere_formulas.hpp"
#include "core/catalogue/own_references.hpp"
#include "mechanics/decompositions/linear_equations.hpp"

namespace hybrid_sphere::mechanics::catalogue::testing::sphere_systems_test {
namespace {

constexpr double unit = 0x1p-53;  // rounding of one operation, relative

Values values_of(const Entry& entry, const std::map<std::string, double>& numbers) {
  Values values(entry.parameters);
  for (const auto& [name, value] : numbers) values.set(name, value);
  return values;
}

Example example_of(const Entry& entry, const std::map<std::string, double>& numbers = {}) {
  return entry.build(values_of(entry, numbers));
}

double largest(const Eigen::MatrixXd& matrix) {
  return matrix.size() == 0 ? 0 : matrix.cwiseAbs().maxCoeff();
}

Quaterniond orientation_of(const Vector3d& angles) {
  return Quaterniond(Eigen::AngleAxisd(angles[0], Vector3d::UnitZ()) *
                     Eigen::AngleAxisd(angles[1], Vector3d::UnitX()) *
                     Eigen::AngleAxisd(angles[2], Vector3d::UnitZ()));
}

/// Angle of the turn between two orientations.
double angle_between(const Quaterniond& a, const Quaterniond& b) {
  return 2 * (a * b.conjugate()).vec().norm();
}

// An orientation off by delta makes angles off by delta/sin(theta), and rates by abs(omega)
// delta/sin(theta)^2. delta: steps of the product integral are off by a few units each, at random; 64 units
// for all of them.
TEST(TurntableBall, IsKnownToTheConditioningOfItsAnglesNearThePole) {
  const ReferenceSystem system = own_reference("turntable_ball_near_pole", "turntable_ball");
  double nearest = 1;
  for (const ReferenceState& state : system.states) {
    const std::optional<Known> known = system.example.known(state.time);
    ASSERT_TRUE(known) << "t = " << state.time;
    const double sine = std::sin(state.q[3]);
    nearest = std::min(nearest, sine);
    const double speed = euler::spin(state.q, state.v).norm();
    EXPECT_LE(largest(known->q - state.q), 64 * unit / sine) << "t = " << state.time;
    EXPECT_LE(largest(known->v - state.v), 64 * unit * speed / (sine * sine)) << "t = " << state.time;
    EXPECT_LE(largest(*known->multipliers - state.multipliers), 64 * unit) << "t = " << state.time;
  }
  EXPECT_LT(nearest, 0.02);  // an output is that near
}

// Some tens of operations on numbers up to the scale.
TEST(ChaplyginCarriage, IsKnownToRounding) {
  const ReferenceSystem system = own_reference("chaplygin_carriage", "chaplygin_carriage");
  for (const ReferenceState& state : system.states) {
    const std::optional<Known> known = system.example.known(state.time);
    ASSERT_TRUE(known) << "t = " << state.time;
    EXPECT_LE(largest(known->q - state.q), 64 * unit * largest(state.q)) << "t = " << state.time;
    EXPECT_LE(largest(known->v - state.v), 64 * unit * largest(state.v)) << "t = " << state.time;
    EXPECT_LE(largest(*known->multipliers - state.multipliers), 64 * unit * 10) << "t = " << state.time;
  }
}

// (20) with (22), five linear equations for the velocities after the impulse and P: what (23) should have
// been.
TEST(PaperSphere, HasTheVelocitiesThatTheEquationsOfTheImpulseGive) {
  const Entry entry = paper_sphere();
  const Values values(entry.parameters);
  const Example example = entry.build(values);
  const double m = values["m"], R = values["R"], J = m * values["k"] * values["k"];
  const Velocities before = {example.initial.v.head<2>(), euler::spin(example.initial.q, example.initial.v)};
  Matrix equations(6, 6);  // of xd, yd, w1, w2, P_x, P_y
  Vector right(6);
  equations << m, 0, 0, 0, -1, 0,  //
      0, m, 0, 0, 0, -1,           //
      0, 0, J, 0, 0, -R,           //
      0, 0, 0, J, R, 0,            //
      1, 0, 0, -R, 0, 0,           //
      0, 1, R, 0, 0, 0;
  right << m * before.center, J * before.spin.head<2>(), 0, 0;
  const Vector after = solve_linear_equations(equations, right);

  const double t_edge = 2;
  const std::optional<Known> known = example.known(t_edge);
  ASSERT_TRUE(known);
  const Vector3d spin = euler::spin(known->q, known->v);
  // A condition number below 1000, and that of the angles below 4.
  EXPECT_LE(largest(known->v.head<2>() - after.head<2>()), 1000 * unit);
  EXPECT_LE(largest(spin.head<2>() - after.segment<2>(2)), 1000 * unit);
  EXPECT_NEAR(spin.z(), before.spin.z(), 64 * unit);
  EXPECT_EQ(known->q[0], 0);  // on the edge
}

TEST(PaperSphere, IsThrownBackByStrongBackspin) {
  // At psi = pi/2 theta_dot is w2; k^2 w2 = -0.75, -R xd = -0.25.
  const Example example = example_of(paper_sphere(), {{"theta_dot", -30}});
  const std::optional<Known> before = example.known(1.5), after = example.known(3);
  ASSERT_TRUE(before && after);
  EXPECT_GT(before->v[0], 0);
  EXPECT_LT(after->v[0], 0);
  EXPECT_NEAR(after->q[0], after->v[0], 4 * unit);  // one second off the edge x = 0
}

TEST(PaperSphere, GoesOnFreelyWhereItNeverReachesTheEdge) {
  const Example example = example_of(paper_sphere(), {{"x_dot", -1}});
  const std::optional<Known> known = example.known(4);
  ASSERT_TRUE(known);
  EXPECT_EQ(known->q[0], -6);
  EXPECT_EQ(known->v[1], -0.375);
}

TEST(PaperSphere, IsNotKnownFromTheRoughSide) {
  for (const Entry& entry : {paper_sphere(), paper_sphere_quasi()}) {
    EXPECT_FALSE(example_of(entry, {{"x", 0.25}}).known) << entry.name;
  }
}

// 0.1 + 0.2 is above 0.3 in binary64: by rounding, and not by a place.
TEST(PaperSphere, StartsOnTheEdgeWhereItIsThereToRounding) {
  const double edge = 0.3, x = 0.1 + 0.2;
  ASSERT_GT(x, edge);
  for (const Entry& entry : {paper_sphere(), paper_sphere_quasi()}) {
    const Example rolling = example_of(entry, {{"edge", edge}, {"x", x}});
    ASSERT_TRUE(rolling.known && rolling.known(0)) << entry.name;
    EXPECT_EQ(rolling.known(0)->v, example_of(entry, {{"edge", edge}, {"x", edge}}).known(0)->v);
    EXPECT_NE(rolling.known(0)->v, rolling.initial.v) << entry.name << " rolls from the start";
    const Example leaving = example_of(entry, {{"edge", edge}, {"x", x}, {"x_dot", -1}});
    ASSERT_TRUE(leaving.known && leaving.known(1)) << entry.name;
    EXPECT_EQ(leaving.known(1)->v.head(2), leaving.initial.v.head(2)) << entry.name << " never rolls";
  }
}

TEST(PaperSphere, IsNotKnownBehindThePole) {
  // About a level axis, down from theta = 1 at 1 rad/s.
  const Example example =
      example_of(paper_sphere(), {{"theta", 1}, {"psi_dot", 0}, {"theta_dot", -1}, {"phi_dot", 0}});
  EXPECT_TRUE(example.known(0.875));
  EXPECT_FALSE(example.known(1.125));
  EXPECT_FALSE(example_of(paper_sphere(), {{"theta", 0}}).known(1));
}

TEST(PaperSphere, HasOneOrientationInAnglesAndInQuaternions) {
  for (const double backspin : {1.5, -30.0}) {
    const Example in_angles = example_of(paper_sphere(), {{"theta_dot", backspin}});
    const Quaterniond start = orientation_of(in_angles.initial.q.tail<3>());
    const Example in_quaternions = example_of(
        paper_sphere_quasi(),
        {{"qw", start.w()}, {"qx", start.x()}, {"qy", start.y()}, {"qz", start.z()}, {"w2", backspin}});
    int known = 0;
    for (double t = 0; t <= 4; t += 0.125) {
      const std::optional<Known> a = in_angles.known(t), b = in_quaternions.known(t);
      ASSERT_TRUE(b) << "t = " << t;
      if (!a) continue;
      ++known;
      // 120 rad at most, each of them off by a few units of its own.
      EXPECT_LE(angle_between(orientation_of(a->q.tail<3>()), orientation(b->q)), 1000 * unit) << "t = " << t;
      EXPECT_LE(largest(a->q.head<2>() - b->q.head<2>()), 16 * unit) << "t = " << t;
      EXPECT_LE(largest(euler::spin(a->q, a->v) - b->v.tail<3>()), 64 * unit * 30) << "t = " << t;
    }
    EXPECT_EQ(known, 33);
  }
}

TEST(PaperSphere, TurnsItsAnglesWithoutJumps) {
  const Example example = example_of(paper_sphere());
  Vector last = example.known(0)->q;
  for (int i = 1; i <= 4000; ++i) {
    const Known now = *example.known(i * 1e-3);
    // Rates stay below 10 rad/s, sin(theta) being above 0.5.
    ASSERT_LE(largest(now.q - last), 1e-2) << "t = " << i * 1e-3;
    last = now.q;
  }
}

TEST(ChaplyginBall, IsTheSphereWhereItsMomentsAreEqual) {
  // On smooth ground for 2 s, until the edge.
  const double m = 2, k = 0.25 * std::sqrt(0.4), J = m * k * k;
  const Example sphere = example_of(paper_sphere_quasi());
  const Example ball = example_of(chaplygin_ball(), {{"m", m},
                                                     {"R", 0.25},
                                                     {"A", J},
                                                     {"B", J},
                                                     {"C", J},
                                                     {"t_switch", 2},
                                                     {"x", -2},
                                                     {"y", 0.5},
                                                     {"qw", 1},
                                                     {"qy", 0},
                                                     {"x_dot", 1},
                                                     {"w1", 4},
                                                     {"y_dot", -0.375},
                                                     {"w2", 1.5},
                                                     {"w3", -2}});
  for (double t = 0; t <= 4; t += 0.25) {
    const std::optional<Known> a = sphere.known(t), b = ball.known(t);
    ASSERT_TRUE(a && b) << "t = " << t;
    const Quaterniond q = orientation(a->q);
    // k once out of A/m; angles up to 20 rad.
    EXPECT_LE(largest(b->q - a->q), 64 * unit * 20) << "t = " << t;
    EXPECT_LE(largest(b->v.head<2>() - a->v.head<2>()), 64 * unit) << "t = " << t;
    EXPECT_LE(largest(q * Vector3d(b->v.tail<3>()) - a->v.tail<3>()), 64 * unit * 20) << "t = " << t;
  }
}

TEST(ChaplyginBall, GoesOnSpinningInPlaceAboutAVerticalPrincipalAxis) {
  const std::map<std::string, double> at_rest = {{"x_dot", 0}, {"y_dot", 0}, {"w1", 0}, {"w2", 0},
                                                 {"w3", 0},    {"qy", 0},    {"qw", 1}};
  auto upright = at_rest;
  upright["w3"] = 7;
  const std::optional<Known> known = example_of(chaplygin_ball(), upright).known(3);
  ASSERT_TRUE(known);
  EXPECT_EQ(known->q[0], 0.2);
  EXPECT_EQ(known->v[4], 7);
  EXPECT_NEAR(known->q[2], std::cos(10.5), 64 * unit);
  auto tilted = at_rest;
  tilted["w2"] = 7;
  EXPECT_FALSE(example_of(chaplygin_ball(), tilted).known);
}

// The reference knows no impulse law: it conserves K. The terms by hand have to find its impulse ideal.
TEST(ChaplyginBall, HasAReferenceWhoseImpulseIsIdeal) {
  const ReferenceSystem system = own_reference("chaplygin_ball", "chaplygin_ball");
  const Model& model = system.example.by_hand;
  const ReferenceImpulse& impulse = system.impulse;
  Vector p_before, p_after, f;
  Matrix mass, C;
  model.equations->momentum(system.t_switch, impulse.q, impulse.v_before, p_before, mass);
  model.equations->momentum(system.t_switch, impulse.q, impulse.v_after, p_after, mass);
  model.constraints[0].function->evaluate(system.t_switch, impulse.q, impulse.v_after, f, C);
  EXPECT_LE(largest(p_after - p_before - C.transpose() * impulse.multipliers), 16 * unit);
  EXPECT_LE(largest(f), 16 * unit);
  EXPECT_GT(largest(impulse.multipliers), 0.1);
}

/// The message of the refusal; empty if there is none.
std::string refusal(const Entry& entry, const std::map<std::string, double>& numbers) {
  try {
    example_of(entry, numbers);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

TEST(SphereSystems, RefuseBodiesThatDoNotExist) {
  for (const Entry& entry : {paper_sphere(), paper_sphere_quasi(), turntable_ball()}) {
    EXPECT_NE(refusal(entry, {{"R", 1}, {"k", 0.82}}).find("k = 0.82"), std::string::npos) << entry.name;
    EXPECT_EQ(refusal(entry, {{"R", 1}, {"k", 0.81}}), "") << entry.name;
  }
  const Entry ball = chaplygin_ball();
  EXPECT_NE(refusal(ball, {{"A", 0.3}, {"B", 0.1}, {"C", 0.1}}).find("A = 0.3 is refused"),
            std::string::npos);
  EXPECT_NE(refusal(ball, {{"A", 0.3}, {"B", 0.3}, {"C", 0.3}}).find("2 m R^2 = 0.75"), std::string::npos);
  EXPECT_NE(refusal(ball, {{"qw", 0}, {"qy", 0}}).find("qw, qx, qy, qz"), std::string::npos);
  EXPECT_NE(refusal(chaplygin_carriage(), {{"I_w", 0.07}}).find("I_w = 0.07"), std::string::npos);
}

TEST(SphereSystems, TakeAnOrientationOfAnyLength) {
  const Example example = example_of(chaplygin_ball(), {{"qw", 0.25}, {"qy", 0.25}});
  EXPECT_NEAR(example.initial.q[2], std::sqrt(0.5), 2 * unit);
  EXPECT_NEAR(example.initial.q.tail<4>().norm(), 1, 2 * unit);
}

}  // namespace
}  // namespace hybrid_sphere::mechanics::catalogue::testing::sphere_systems_test

// Options::project_positions: published, rounded start positions are put onto the constraints.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "hybrid_sphere/mechanics/multibody_system.hpp"
#include "hybrid_sphere/mechanics/plant.hpp"
#include "hybrid_sphere/mechanics/solve.hpp"
#include "hybrid_sphere/mechanics/system.hpp"

namespace hybrid_sphere::mechanics::project_positions_test {
namespace {

constexpr double crank = 0.1, coupler = 0.35, rocker = 0.25, ground = 0.3;  // lengths [m]

/// Moments about the pivots and so on: a mass matrix that depends on the angles.
Model four_bar() {
  System<3> model({"a", "b", "c"}, [](auto, const auto& q, const auto& v) {
    using std::cos;
    return 0.002 * v[0] * v[0] + 0.01 * v[1] * v[1] + 0.006 * v[2] * v[2] +
           0.008 * v[0] * v[1] * cos(q[0] - q[1]);
  });
  model.holonomic(
      "loop",
      [](auto, const auto& q) {
        using T = std::decay_t<decltype(q[0])>;
        using std::cos, std::sin;
        return Eigen::Matrix<T, 2, 1>(crank * cos(q[0]) + coupler * cos(q[1]) - rocker * cos(q[2]) - ground,
                                      crank * sin(q[0]) + coupler * sin(q[1]) - rocker * sin(q[2]));
      },
      always());
  return model;
}

/// Angles of the coupler and the rocker that close the loop, from the cosine rule.
Vector closed(double a) {
  const double x = ground - crank * std::cos(a), y = -crank * std::sin(a);
  const double diagonal = std::hypot(x, y), direction = std::atan2(y, x);
  const double at_coupler =
      std::acos((coupler * coupler + diagonal * diagonal - rocker * rocker) / (2 * coupler * diagonal));
  const double b = direction + at_coupler;
  const double c = std::atan2(crank * std::sin(a) + coupler * std::sin(b),
                              crank * std::cos(a) + coupler * std::cos(b) - ground);
  return {a, b, c};
}

Vector rounded(const Vector& exact) {
  Vector result = exact;
  for (Index i = 0; i < result.size(); ++i) result[i] = std::round(exact[i] * 1e4) / 1e4;
  return result;
}

Vector loop(const Vector& q) {
  Vector value;
  four_bar().constraints[0].function->position(0, q, value);
  return value;
}

Options projecting() {
  Options options;
  options.project_positions = true;
  return options;
}

template <class Call>
std::string refusal(Call call) {
  try {
    call();
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

TEST(ProjectPositions, OfAFourBarLinkageWithFourDigits) {
  const Model model = four_bar();
  for (int i = 0; i < 12; ++i) {
    const Vector start = rounded(closed(0.5 * i + 0.1));
    const Initial initial{0, start, {0, 0, 0}};
    const std::string message = refusal([&] { solve(model, initial, 1); });
    EXPECT_NE(message.find("project_positions"), std::string::npos) << message;
    const Solution motion = solve(model, initial, 1, projecting());
    EXPECT_EQ(motion.status().stop, Stop::reached_end) << motion.status().message;
    const Vector q = motion.at(0).q;
    EXPECT_LE(loop(q).norm(), 1e-15) << i;
    // Half a unit of the last digit of each angle, in the metric of M: factors up to 4 between the angles.
    EXPECT_LE(motion.projection().q.norm(), 4 * 1e-4) << i;
    EXPECT_GT(motion.projection().q.norm(), 0) << i;
    EXPECT_EQ((q - start - motion.projection().q).norm(), 0) << i;
  }
}

// M w = C^T lambda: w is orthogonal, in the metric of M, to the motion that the linkage is left.
TEST(ProjectPositions, MovesByTheLeastDistanceInTheMetricOfM) {
  const Model model = four_bar();
  const Solution motion = solve(model, {0, rounded(closed(0.7)), {0, 0, 0}}, 1, projecting());
  const Vector q = motion.at(0).q;
  Vector momentum, value;
  Matrix mass, gradient;
  model.equations->momentum(0, q, Vector::Zero(3), momentum, mass);
  model.constraints[0].function->evaluate(0, q, Vector::Zero(3), value, gradient);
  const Eigen::Vector3d one = gradient.row(0), other = gradient.row(1);
  const Eigen::Vector3d tangent = one.cross(other).normalized();
  const Eigen::Vector3d w = motion.projection().q;
  // Quadratic convergence: what the last step has left is the square of 1e-4.
  EXPECT_LE(std::abs(tangent.dot(mass * w)), 1e-7 * (mass * w).norm());
}

TEST(ProjectPositions, LeavesPositionsOnTheConstraintsInPlace) {
  const Vector start = closed(0.7);
  const Solution motion = solve(four_bar(), {0, start, {0, 0, 0}}, 1, projecting());
  EXPECT_LE(motion.projection().q.norm(), 1e-15);
  const Solution without = solve(four_bar(), {0, start, {0, 0, 0}}, 1);
  EXPECT_EQ(without.projection().q.norm(), 0);
  EXPECT_EQ(without.projection().v.norm(), 0);
}

TEST(ProjectPositions, LeavesVelocitiesToProjectInitial) {
  const Model model = four_bar();
  const Initial moving{0, rounded(closed(0.7)), {1, 0, 0}};
  EXPECT_NE(refusal([&] { solve(model, moving, 1, projecting()); }).find("velocities"), std::string::npos);
  Options both = projecting();
  both.project_initial = true;
  const Solution motion = solve(model, moving, 1, both);
  EXPECT_EQ((motion.at(0).v - moving.v - motion.projection().v).norm(), 0);
  EXPECT_GT(motion.projection().v.norm(), 0.01);
}

TEST(ProjectPositions, OfAPlantIsReported) {
  Plant plant(four_bar(), {0, rounded(closed(0.7)), {0, 0, 0}}, projecting());
  EXPECT_LE(loop(plant.state().q).norm(), 1e-15);
  EXPECT_GT(plant.projection().q.norm(), 0);
}

TEST(ProjectPositions, RefusesALoopThatCannotClose) {
  System<1> model({"x"}, [](auto, const auto&, const auto& v) { return v[0] * v[0] / 2; });
  model.holonomic(
      "never", [](auto, const auto& q) { return q[0] * q[0] + 1; }, always());
  const std::string message = refusal([&] { solve(model, {0, {1.0}, {0.0}}, 1, projecting()); });
  EXPECT_NE(message.find("cannot be put onto the constraints never"), std::string::npos) << message;
}

// What is left of x = 1e-4 is round-off of that, not of the result, 0.
TEST(ProjectPositions, OntoTheOrigin) {
  System<2> model({"x", "a"}, [](auto, const auto&, const auto& v) { return v.squaredNorm() / 2; });
  model.holonomic(
      "guide",
      [](auto, const auto& q) {
        using std::cos, std::sin;
        return q[0] * cos(q[1]) + 0.3 * sin(q[0]);
      },
      always());
  const Solution motion = solve(model, {0, {1e-4, 0.7}, {0, 0}}, 1, projecting());
  EXPECT_EQ(motion.status().stop, Stop::reached_end);
  EXPECT_NEAR(motion.at(0).q[0], 0, 1e-20);
}

// Two constraints that say the same contradict each other by the round-off of the data.
TEST(ProjectPositions, OfRedundantConstraints) {
  System<2> model({"x", "y"}, [](auto, const auto&, const auto& v) { return v.squaredNorm() / 2; });
  model.holonomic(
      "circle", [](auto, const auto& q) { return q.squaredNorm() - 1; }, always());
  model.holonomic(
      "rod",
      [](auto, const auto& q) {
        using std::sqrt;
        return sqrt(q.squaredNorm()) - 1;
      },
      always());
  const Solution motion = solve(model, {0, {0.7071, 0.7071}, {0, 0}}, 1, projecting());
  EXPECT_NEAR(motion.at(0).q[0], std::sqrt(0.5), 1e-15);
  EXPECT_NEAR(motion.at(0).q[1], std::sqrt(0.5), 1e-15);
}

// A contact whose gap is negative, or that is said to hold, is closed; another one stays open.
TEST(ProjectPositions, OfContactsThatOverlapOrHold) {
  System<1> model({"z"}, [](auto, const auto& q, const auto& v) { return v[0] * v[0] / 2 - 9.81 * q[0]; });
  model.unilateral("floor", [](auto, const auto& q) { return q[0] - 0.5; });
  EXPECT_NE(refusal([&] { solve(model, {0, {0.4999}, {0.0}}, 1); }), "");
  const Solution overlap = solve(model, {0, {0.4999}, {0.0}}, 1, projecting());
  EXPECT_EQ(overlap.at(0).q[0], 0.5);
  EXPECT_EQ(overlap.at(1).q[0], 0.5);
  EXPECT_EQ(solve(model, {0, {0.5001}, {0.0}}, 0, projecting()).at(0).q[0], 0.5001);
  EXPECT_EQ(solve(model, {0, {0.5001}, {0.0}, ActiveSet{0}}, 0, projecting()).at(0).q[0], 0.5);
}

// A quaternion with four digits, and the distance of a ball joint.
TEST(ProjectPositions, OfARigidBody) {
  MultibodySystem system;
  Eigen::Isometry3d placement = Eigen::Isometry3d::Identity();
  placement.linear() = Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  placement.translation() = placement.linear() * Eigen::Vector3d(0, 0, -0.4);
  system.body("bob", 2, {0.1, 0.1, 0.05}, placement).ball("pivot", "world", "bob", {0, 0, 0});
  Initial initial = system.initial();
  initial.q = rounded(initial.q);
  EXPECT_NE(refusal([&] { solve(system, initial, 1); }), "");
  const Solution motion = solve(system, initial, 1, projecting());
  const Vector q = motion.at(0).q;
  EXPECT_LE((system.pose(q, "bob") * Eigen::Vector3d(0, 0, 0.4)).norm(), 1e-15);
  EXPECT_NEAR(q.tail(4).norm(), 1, 1e-15);
  EXPECT_LE(motion.projection().q.norm(), 2e-4);
}

}  // namespace
}  // namespace hybrid_sphere::mechanics::project_positions_test

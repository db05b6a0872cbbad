// What is drawn of the catalogue moves as the system does: what rolls does not slip.

#include <gtest/gtest.h>

#include <set>

#include "hybrid_sphere/mechanics/solve.hpp"
#include "ros/system/catalogue_system.hpp"

namespace hybrid_sphere::ros_interface::catalogue_bodies_test {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

TEST(CatalogueBodies, EverySystemHasAsManyPosesAsBodiesWithFramesOfTheirOwn) {
  std::set<std::string> frames;
  for (const mechanics::catalogue::Entry& entry : mechanics::catalogue::entries()) {
    SCOPED_TRACE(entry.name);
    const CatalogueSystem system(entry);
    mechanics::State state;
    state.q = system.initial().q;
    ASSERT_FALSE(system.bodies().empty());
    const std::vector<Isometry3d> poses = system.poses(state);
    ASSERT_EQ(poses.size(), system.bodies().size());
    EXPECT_EQ(poses[0].translation().x(), state.q[0]);
    for (const Body& body : system.bodies()) {
      EXPECT_TRUE(frames.insert(body.frame).second) << body.frame;
      EXPECT_GT(body.size.minCoeff(), 0);
    }
  }
}

/// Velocity of the material point that is lowest, by the difference of two poses.
/// @param radius  of what rolls, whose centre the pose has [m]
Vector3d velocity_of_contact(const Isometry3d& before, const Isometry3d& now, const Isometry3d& after,
                             double radius, double step) {
  const Vector3d point = now.inverse() * (now.translation() - radius * Vector3d::UnitZ());
  return (after * point - before * point) / (2 * step);
}

TEST(CatalogueBodies, WhatRollsDoesNotSlip) {
  constexpr double step = 1e-5;  // a difference of second order, and 1e-9/step of the accuracy
  constexpr double tolerance = 1e-3;
  for (const std::string name :
       {"rolling_disk", "chaplygin_carriage", "paper_sphere", "paper_sphere_quasi", "chaplygin_ball"}) {
    SCOPED_TRACE(name);
    const mechanics::catalogue::Entry& entry = mechanics::catalogue::entry(name);
    const CatalogueSystem system(entry);
    const mechanics::Solution motion =
        mechanics::solve(system.model(system.initial_input()), system.initial(), entry.duration);
    const double time = 0.9 * entry.duration;
    ASSERT_EQ(motion.at(time).stage, 3);
    const auto before = system.poses(motion.at(time - step)), now = system.poses(motion.at(time)),
               after = system.poses(motion.at(time + step));
    for (std::size_t i = now.size() > 1 ? 1 : 0; i < now.size(); ++i) {  // the carriage's first is its body
      const double radius = system.bodies()[i].size.x() / 2;
      EXPECT_NEAR(now[i].translation().z(), radius, 1e-12);
      EXPECT_LT(velocity_of_contact(before[i], now[i], after[i], radius, step).norm(), tolerance);
      EXPECT_GT((after[i].translation() - before[i].translation()).norm() / (2 * step), 10 * tolerance);
    }
  }
}

}  // namespace
}  // namespace hybrid_sphere::ros_interface::catalogue_bodies_test

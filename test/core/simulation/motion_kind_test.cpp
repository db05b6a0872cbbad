// Which motion every ground has under every force: the table of docs/theory.md 4.7.
#include "simulation/motion_kind.hpp"

#include <gtest/gtest.h>

#include "simulation/segment.hpp"

namespace hybrid_sphere::motion_kind_test {
namespace {

using scene::Law;
using scene::Material;
using Kind = MotionKind;

const Sphere solid({1, 0.25, 0.15});

Material resisting(Material material) {
  material.rolling_resistance = 0.05;
  return material;
}

Material belt(Material material) {
  material.belt = {0.5, 0.25};
  return material;
}

Material turning(Material material) {
  material.turntable_rate = 2;
  return material;
}

Material coulomb() {
  Material material(Law::coulomb);
  material.friction = 0.1;
  return material;
}

/// Forces of the columns of the table.
enum Force { none, slope, drag, spring, quadratic };

Dynamics under(Force force) {
  scene::Forces forces;
  if (force == slope) forces.gravity.x() = 0.5;
  if (force == drag) forces.drag.translational = forces.drag.rotational = 0.1;
  if (force == spring) forces.spring.stiffness = 1;
  if (force == quadratic) forces.drag.quadratic = 0.1;
  return Dynamics(solid, forces);
}

struct Row {
  const char* name;
  ContactMode mode;
  Material material;
  Kind kinds[5];  // under none, slope, drag, spring, quadratic
};

const Row table[] = {
    {"smooth",
     ContactMode::free,
     Law::smooth,
     {Kind::uniform, Kind::linear, Kind::linear, Kind::linear, Kind::integrated}},
    {"rough",
     ContactMode::rolling,
     Law::rough,
     {Kind::uniform, Kind::linear, Kind::linear, Kind::linear, Kind::integrated}},
    {"belt",
     ContactMode::rolling,
     belt(Law::rough),
     {Kind::uniform, Kind::linear, Kind::linear, Kind::linear, Kind::integrated}},
    {"turntable",
     ContactMode::rolling,
     turning(Law::rough),
     {Kind::linear, Kind::linear, Kind::linear, Kind::linear, Kind::integrated}},
    {"resisting belt",
     ContactMode::rolling,
     resisting(belt(Law::rough)),
     {Kind::dry_friction, Kind::dry_friction, Kind::integrated, Kind::integrated, Kind::integrated}},
    {"resisting turntable",
     ContactMode::rolling,
     resisting(turning(Law::rubber)),
     {Kind::integrated, Kind::integrated, Kind::integrated, Kind::integrated, Kind::integrated}},
    {"carried by a belt",
     ContactMode::sticking,
     resisting(belt(Law::rubber)),
     {Kind::uniform, Kind::uniform, Kind::uniform, Kind::sticking, Kind::uniform}},
    {"carried by a turntable",
     ContactMode::sticking,
     resisting(turning(Law::rough)),
     {Kind::sticking, Kind::sticking, Kind::sticking, Kind::sticking, Kind::sticking}},
    {"sliding",
     ContactMode::sliding,
     belt(coulomb()),
     {Kind::dry_friction, Kind::dry_friction, Kind::integrated, Kind::integrated, Kind::integrated}},
    {"sliding on a turntable",
     ContactMode::sliding,
     turning(coulomb()),
     {Kind::integrated, Kind::integrated, Kind::integrated, Kind::integrated, Kind::integrated}},
    {"rolling on coulomb ground",
     ContactMode::rolling,
     coulomb(),
     {Kind::uniform, Kind::linear, Kind::linear, Kind::linear, Kind::integrated}},
    {"resisting coulomb ground",
     ContactMode::rolling,
     resisting(coulomb()),
     {Kind::dry_friction, Kind::integrated, Kind::integrated, Kind::integrated, Kind::integrated}},
};

TEST(MotionKind, IsThatOfTheTableOfGrounds) {
  for (const Row& row : table) {
    for (const Force force : {none, slope, drag, spring, quadratic}) {
      // A spin of 0 about the normal has no drag.
      EXPECT_EQ(motion_kind(under(force), row.mode, row.material, 0), row.kinds[force])
          << row.name << ", force " << force;
    }
  }
}

TEST(MotionKind, IsTheOneThatASegmentHas) {
  for (const Row& row : table) {
    for (const Force force : {none, slope, drag, spring, quadratic}) {
      for (const double omega_3 : {0.0, 3.0}) {
        Segment segment(under(force), scene::Solver());
        const Vector2d u = ground_velocity(row.material, {1, 2});
        const Vector2d velocity = row.mode == ContactMode::sticking ? u : Vector2d(u + Vector2d(1, 0.5));
        const Vector2d sigma = row.mode == ContactMode::rolling ? u : velocity;
        const Twist twist{velocity, {0, 0, omega_3}};
        segment.begin(row.mode, row.material, {{1, 2}, Quaterniond::Identity(), twist, sigma});
        const Kind kind = motion_kind(under(force), row.mode, row.material, omega_3);
        EXPECT_EQ(segment.uniform(), kind == Kind::uniform) << row.name << ", force " << force;
        EXPECT_EQ(segment.has_integrated(), kind == Kind::integrated || kind == Kind::sticking)
            << row.name << ", force " << force;
      }
    }
  }
}

TEST(MotionKind, OfASpinThatFrictionUsesUpIsNotUniform) {
  Material material(Law::rough);
  material.spin_friction = 0.1;
  EXPECT_EQ(motion_kind(under(none), ContactMode::rolling, material, 0), Kind::uniform);
  EXPECT_EQ(motion_kind(under(none), ContactMode::rolling, material, 1), Kind::linear);
}

TEST(MotionKind, OnCoulombGroundWithoutFrictionIsThatOfSmoothGround) {
  EXPECT_EQ(contact_modes_on(under(none), Material(Law::coulomb)),
            std::vector<ContactMode>{ContactMode::free});
}

}  // namespace
}  // namespace hybrid_sphere::motion_kind_test

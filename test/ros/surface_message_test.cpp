#include "ros/conversions/surface_message.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

namespace hybrid_sphere::ros_interface::surface_message_test {
namespace {

scene::Material material(scene::Law law, double friction, double rolling_resistance, double spin_friction,
                         const Vector2d& belt, double turntable_rate, const Vector2d& turntable_center) {
  scene::Material material(law);
  material.friction = friction;
  material.rolling_resistance = rolling_resistance;
  material.spin_friction = spin_friction;
  material.belt = belt;
  material.turntable_rate = turntable_rate;
  material.turntable_center = turntable_center;
  return material;
}

scene::Surface every_shape() {
  using scene::Law;
  const std::vector<Vector2d> concave{{0, 0}, {4, 0}, {1, 1}, {0, 4}};
  return {material(Law::coulomb, 0.1, 0, 1. / 7, {0, 0}, -3, {4, 0.1}),
          {{"edge", scene::HalfPlane{{0.1, -3}, {-2, 0.3}}, Law::smooth},
           {"disc", scene::Circle{{1e6, 0.2}, 1. / 3, false}, Law::rough},
           {"sea", scene::Circle{{-1, 0.2}, 1e-9, true},
            material(Law::rough, 0, 0.01, 0.02, {0.1, 0.2}, 0, {0, 0})},
           {"yard", scene::Polygon{concave, false}, material(Law::rubber, 0, 0.03, 0, {0.3, 0}, 0, {0, 0})},
           {"rest", scene::Polygon{concave, true}, material(Law::coulomb, 0, 0, 0, {0, 0}, 0, {0, 0})}},
          scene::Livelock::stop};
}

scene::Surface read(const SurfaceMap& message, const PlanarTransform& to_world = {}) {
  return surface_from_message(message, to_world, scene::Forces{});
}

void expect_equal(const scene::Material& a, const scene::Material& b) {
  EXPECT_EQ(a.law, b.law);
  EXPECT_EQ(a.friction, b.friction);
  EXPECT_EQ(a.rolling_resistance, b.rolling_resistance);
  EXPECT_EQ(a.spin_friction, b.spin_friction);
  EXPECT_EQ(a.belt, b.belt);
  EXPECT_EQ(a.turntable_rate, b.turntable_rate);
  EXPECT_EQ(a.turntable_center, b.turntable_center);
}
void expect_equal(const scene::HalfPlane& a, const scene::HalfPlane& b) {
  EXPECT_EQ(a.point, b.point);
  EXPECT_EQ(a.normal, b.normal);
}
void expect_equal(const scene::Circle& a, const scene::Circle& b) {
  EXPECT_EQ(a.center, b.center);
  EXPECT_EQ(a.radius, b.radius);
  EXPECT_EQ(a.outside, b.outside);
}
void expect_equal(const scene::Polygon& a, const scene::Polygon& b) {
  EXPECT_EQ(a.vertices, b.vertices);
  EXPECT_EQ(a.outside, b.outside);
}

TEST(SurfaceMessage, AndSurfaceAreInverses) {
  const scene::Surface surface = every_shape();
  const scene::Surface again = read(message_from_surface(surface));
  expect_equal(again.base, surface.base);
  EXPECT_EQ(again.livelock, surface.livelock);
  ASSERT_EQ(again.regions.size(), surface.regions.size());
  for (std::size_t i = 0; i < surface.regions.size(); ++i) {
    EXPECT_EQ(again.regions[i].name, surface.regions[i].name);
    expect_equal(again.regions[i].material, surface.regions[i].material);
    std::visit(
        [&](const auto& shape) {
          expect_equal(shape, std::get<std::decay_t<decltype(shape)>>(again.regions[i].shape));
        },
        surface.regions[i].shape);
  }
}

TEST(SurfaceMessage, FieldsOfOtherShapesAreIgnored) {
  SurfaceMap message = message_from_surface(every_shape());
  message.regions[0].radius = -1;   // of a half-plane
  message.regions[1].normal.z = 5;  // of a circle
  message.regions[3].radius = std::nan("");
  message.regions[3].turntable_center.x = 3;  // without a rate
  message.base.radius = 7;
  EXPECT_NO_THROW(read(message));
}

// A quarter turn to the left, and a shift.
TEST(SurfaceMessage, OfAnotherFrameLiesWhereThatFrameLies) {
  const PlanarTransform to_world(0, 1, {10, 20});
  const scene::Surface there = every_shape();
  const scene::Surface surface = read(message_from_surface(there), to_world);
  ASSERT_EQ(surface.regions.size(), there.regions.size());
  const auto& edge = std::get<scene::HalfPlane>(surface.regions[0].shape);
  EXPECT_EQ(edge.point, Vector2d(10 + 3, 20 + 0.1));
  EXPECT_EQ(edge.normal, Vector2d(-0.3, -2));
  const auto& disc = std::get<scene::Circle>(surface.regions[1].shape);
  EXPECT_EQ(disc.center, Vector2d(10 - 0.2, 20 + 1e6));
  EXPECT_EQ(disc.radius, 1. / 3);
  EXPECT_EQ(surface.regions[2].material.belt, Vector2d(-0.2, 0.1));
  EXPECT_EQ(std::get<scene::Polygon>(surface.regions[3].shape).vertices[1], Vector2d(10, 24));
  EXPECT_EQ(surface.base.turntable_rate, there.base.turntable_rate);
  EXPECT_EQ(surface.base.turntable_center, Vector2d(10 - 0.1, 20 + 4));
}

TEST(PlanarTransform, IsOneOfAFrameOnTheGroundWithAVerticalAxis) {
  Eigen::Isometry3d frame = Eigen::Isometry3d::Identity();
  frame.translation() = Vector3d(1, 2, 0);
  EXPECT_FALSE(PlanarTransform::from(frame, "frame").turns());
  EXPECT_EQ(PlanarTransform::from(frame, "frame").point({3, 4}), Vector2d(4, 6));
  frame.linear() = Eigen::AngleAxisd(0.5, Vector3d::UnitZ()).toRotationMatrix();
  const Vector2d there = PlanarTransform::from(frame, "frame").point({1, 0});
  EXPECT_LT((there - Vector2d(1 + std::cos(0.5), 2 + std::sin(0.5))).norm(), 1e-15);
  frame.translation().z() = 0.001;
  EXPECT_THROW(PlanarTransform::from(frame, "frame"), scene::SceneError);
  frame.translation().z() = 0;
  frame.linear() = Eigen::AngleAxisd(0.001, Vector3d::UnitX()).toRotationMatrix();
  EXPECT_THROW(PlanarTransform::from(frame, "frame"), scene::SceneError);
  frame.linear() = Eigen::AngleAxisd(M_PI, Vector3d::UnitX()).toRotationMatrix();
  EXPECT_THROW(PlanarTransform::from(frame, "frame"), scene::SceneError) << "upside down";
}

TEST(SurfaceMessage, IsRefusedWithThePathOfTheField) {
  const std::vector<std::pair<std::string, std::function<void(SurfaceMap&)>>> cases{
      {"map.livelock: 2", [](SurfaceMap& map) { map.livelock = 2; }},
      {"map.base.shape: 2", [](SurfaceMap& map) { map.base.shape = SurfaceRegion::CIRCLE; }},
      {"map.base.name: \"ice\"", [](SurfaceMap& map) { map.base.name = "ice"; }},
      {"map.base.law: 200", [](SurfaceMap& map) { map.base.law = 200; }},
      {"map.base.friction: -0.1", [](SurfaceMap& map) { map.base.friction = -0.1; }},
      {"map.base.turntable", [](SurfaceMap& map) { map.base.belt.y = 1; }},
      {"map.base.turntable_center.z: 1", [](SurfaceMap& map) { map.base.turntable_center.z = 1; }},
      {"map.regions[1].shape: 0 (EVERYWHERE)", [](SurfaceMap& map) { map.regions[1].shape = 0; }},
      {"map.regions[1].shape: 77", [](SurfaceMap& map) { map.regions[1].shape = 77; }},
      {"map.regions[1].friction: 0.3", [](SurfaceMap& map) { map.regions[1].friction = 0.3; }},
      {"map.regions[1].rolling_resistance: nan",
       [](SurfaceMap& map) { map.regions[1].rolling_resistance = std::nan(""); }},
      {"map.regions[2].belt.z: 0.1", [](SurfaceMap& map) { map.regions[2].belt.z = 0.1; }},
      {"map.regions[2].belt[0]: inf", [](SurfaceMap& map) { map.regions[2].belt.x = HUGE_VAL; }},
      {"map.regions[1].turntable.rate: nan",
       [](SurfaceMap& map) { map.regions[1].turntable_rate = std::nan(""); }},
      {"map.regions[0].rolling_resistance: 0.1",
       [](SurfaceMap& map) { map.regions[0].rolling_resistance = 0.1; }},
      {"map.regions[3].spin_friction: 0.1", [](SurfaceMap& map) { map.regions[3].spin_friction = 0.1; }},
      {"map.regions[0].normal.z: 1", [](SurfaceMap& map) { map.regions[0].normal.z = 1; }},
      {"map.regions[0].outside: true", [](SurfaceMap& map) { map.regions[0].outside = 1; }},
      {"map.regions[0].points: 0 points", [](SurfaceMap& map) { map.regions[0].points.clear(); }},
      {"map.regions[3].points[2].z: 0.5", [](SurfaceMap& map) { map.regions[3].points[2].z = 0.5; }},
      {"map.regions[3].polygon: ",
       [](SurfaceMap& map) { map.regions[3].points[1] = map.regions[3].points[0]; }},
      {"map.regions[4].name: \"edge\"", [](SurfaceMap& map) { map.regions[4].name = "edge"; }},
  };
  for (const auto& [path, spoil] : cases) {
    SurfaceMap message = message_from_surface(every_shape());
    spoil(message);
    try {
      read(message);
      ADD_FAILURE() << "taken: " << path;
    } catch (const scene::SceneError& error) {
      EXPECT_EQ(std::string(error.what()).find(path), 0U) << error.what();
      EXPECT_NE(std::string(error.what()).find(" is refused; allowed: "), std::string::npos) << error.what();
    }
  }
}

TEST(SurfaceMessage, FrictionWithoutANormalForceIsRefused) {
  scene::Forces weightless;
  weightless.gravity.setZero();
  SurfaceMap message;
  message.base.law = SurfaceRegion::ROUGH;
  EXPECT_NO_THROW(surface_from_message(message, {}, weightless));
  message.base.law = SurfaceRegion::COULOMB;
  message.base.friction = 0.2;
  try {
    surface_from_message(message, {}, weightless);
    ADD_FAILURE() << "taken";
  } catch (const scene::SceneError& error) {
    EXPECT_EQ(std::string(error.what()).find("map.base.law: \"coulomb\" is refused"), 0U) << error.what();
  }
}

/// What a call refuses.
std::string refusal(const SurfaceMap& message) {
  try {
    read(message);
  } catch (const scene::SceneError& error) {
    return error.what();
  }
  return {};
}

TEST(SurfaceMessage, RefusesMoreRegionsOrPointsThanItsSizes) {
  SurfaceMap message = message_from_surface(scene::Surface{});
  message.regions.resize(max_map_regions + 1);
  EXPECT_EQ(refusal(message), "map.regions: 1048577 regions is refused; allowed: up to 1048576");
  message.regions.resize(2);
  message.regions[0].points.resize(max_map_points);
  message.regions[1].points.resize(1);
  EXPECT_EQ(refusal(message),
            "map.regions: 4194305 points in all regions is refused; allowed: up to 4194304");
}

}  // namespace
}  // namespace hybrid_sphere::ros_interface::surface_message_test

#include "hybrid_sphere/ros/surface_message.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

namespace hybrid_sphere::ros_interface {
namespace {

scene::Surface every_shape() {
  const std::vector<Vector2d> concave{{0, 0}, {4, 0}, {1, 1}, {0, 4}};
  return {scene::Law::rough,
          {{"edge", scene::HalfPlane{{0.1, -3}, {-2, 0.3}}, scene::Law::smooth},
           {"disc", scene::Circle{{1e6, 0.2}, 1. / 3, false}, scene::Law::rough},
           {"sea", scene::Circle{{-1, 0.2}, 1e-9, true}, scene::Law::smooth},
           {"yard", scene::Polygon{concave, false}, scene::Law::rough},
           {"rest", scene::Polygon{concave, true}, scene::Law::smooth}}};
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
  const scene::Surface again = surface_from_message(message_from_surface(surface), "world");
  EXPECT_EQ(again.base, surface.base);
  ASSERT_EQ(again.regions.size(), surface.regions.size());
  for (std::size_t i = 0; i < surface.regions.size(); ++i) {
    EXPECT_EQ(again.regions[i].name, surface.regions[i].name);
    EXPECT_EQ(again.regions[i].law, surface.regions[i].law);
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
  EXPECT_NO_THROW(surface_from_message(message, "world"));
}

TEST(SurfaceMessage, ItsFrameIsTheWorldsOrEmpty) {
  SurfaceMap message = message_from_surface(every_shape());
  message.header.frame_id = "world";
  EXPECT_NO_THROW(surface_from_message(message, "world"));
  EXPECT_THROW(surface_from_message(message, "map"), scene::SceneError);
}

TEST(SurfaceMessage, IsRefusedWithThePathOfTheField) {
  const std::vector<std::pair<std::string, std::function<void(SurfaceMap&)>>> cases{
      {"map.livelock: 1 (STOP", [](SurfaceMap& map) { map.livelock = SurfaceMap::STOP; }},
      {"map.base.shape: 2", [](SurfaceMap& map) { map.base.shape = SurfaceRegion::CIRCLE; }},
      {"map.base.name: \"ice\"", [](SurfaceMap& map) { map.base.name = "ice"; }},
      {"map.base.law: 200", [](SurfaceMap& map) { map.base.law = 200; }},
      {"map.base.belt.y: 1", [](SurfaceMap& map) { map.base.belt.y = 1; }},
      {"map.regions[1].shape: 0 (EVERYWHERE)", [](SurfaceMap& map) { map.regions[1].shape = 0; }},
      {"map.regions[1].shape: 77", [](SurfaceMap& map) { map.regions[1].shape = 77; }},
      {"map.regions[2].law: 2 (RUBBER", [](SurfaceMap& map) { map.regions[2].law = SurfaceRegion::RUBBER; }},
      {"map.regions[2].law: 3 (COULOMB",
       [](SurfaceMap& map) { map.regions[2].law = SurfaceRegion::COULOMB; }},
      {"map.regions[2].friction: 0.3", [](SurfaceMap& map) { map.regions[2].friction = 0.3; }},
      {"map.regions[2].turntable_rate: 3", [](SurfaceMap& map) { map.regions[2].turntable_rate = 3; }},
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
      surface_from_message(message, "world");
      ADD_FAILURE() << "taken: " << path;
    } catch (const scene::SceneError& error) {
      EXPECT_EQ(std::string(error.what()).find(path), 0U) << error.what();
      EXPECT_NE(std::string(error.what()).find(" is refused; allowed: "), std::string::npos) << error.what();
    }
  }
}

}  // namespace
}  // namespace hybrid_sphere::ros_interface

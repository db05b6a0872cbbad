// The names and arrows that are drawn on a map.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <set>
#include <string>
#include <utility>

#include "ground/ground.hpp"
#include "ros/markers/ground_motion.hpp"
#include "ros/markers/surface_markers.hpp"
#include "sphere/dynamics.hpp"

namespace hybrid_sphere::ros_interface::map_names_test {
namespace {

scene::Surface surface_of(scene::Shape shape) {
  return {scene::Law::smooth, {{"region", std::move(shape), scene::Law::rough}}};
}

TEST(RegionNames, OneStandsForManyRegionsOfOneGround) {
  scene::Surface surface;
  for (int i = 0; i < 20; ++i) {
    const scene::Circle disc{{3. * (i % 5), 3 * std::floor(i / 5.)}, i == 7 ? 1.4 : 1, false};
    surface.regions.push_back({"disc_" + std::to_string(i), disc, scene::Law::rough});
  }
  surface.regions.push_back({"felt", scene::Circle{{-5, 0}, 1, false}, scene::Law::coulomb});
  surface.regions.back().material.friction = 0.25;
  const ViewSquare view = view_around(surface, {Vector2d(0, 0)}, 0.1);
  std::map<RegionId, std::string> texts;
  for (const RegionName& name : region_names(Ground(surface), view)) texts[name.region] = name.text;
  EXPECT_EQ(texts, (std::map<RegionId, std::string>{
                       {base_region, "base: smooth"}, {7, "rough, 20 regions"}, {20, "felt: coulomb 0.25"}}));
}

TEST(RegionNames, CountAlsoTheRegionsThatAreTooManyToHaveAPlace) {
  scene::Surface surface;
  for (int i = 0; i < 2500; ++i) {
    const scene::Circle disc{{3. * (i % 50), 3 * std::floor(i / 50.)}, 1, false};
    surface.regions.push_back({"disc_" + std::to_string(i), disc, scene::Law::rough});
  }
  const ViewSquare view = view_around(surface, {Vector2d(0, 0)}, 0.1);
  std::set<std::string> texts;
  for (const RegionName& name : region_names(Ground(surface), view)) texts.insert(name.text);
  EXPECT_EQ(texts, (std::set<std::string>{"base: smooth", "rough, 2500 regions"}));
}

TEST(RegionNames, OfManyRegionsStandOnAnotherWhereTheRoomiestIsTaken) {
  scene::Surface surface;
  const std::string long_name(60, 'x');
  surface.regions.push_back({long_name, scene::Circle{{0, 0}, 2, false}, scene::Law::coulomb});
  for (int i = 0; i < 10; ++i) {
    const scene::Circle disc{{2.5 + i, i == 0 ? 0. : 4.}, i == 0 ? 0.22 : 0.2, false};
    surface.regions.push_back({"disc_" + std::to_string(i), disc, scene::Law::rough});
  }
  const ViewSquare view = view_around(surface, {Vector2d(-9, 0)}, 0.1);
  std::map<std::string, RegionId> regions;
  for (const RegionName& name : region_names(Ground(surface), view)) regions[name.text] = name.region;
  ASSERT_EQ(regions.count(long_name + ": coulomb 0"), 1U);
  ASSERT_EQ(regions.count("rough, 10 regions"), 1U);
  EXPECT_GT(regions["rough, 10 regions"], 1);
}

TEST(RegionNames, AreAsWideAsTheirLetters) {
  const RegionName latin{0, Vector2d(0, 0), 1, "grad"};
  const RegionName greek{0, Vector2d(0, 0), 1, "\u03c6\u03b1\u03c2\u03c3"};
  EXPECT_EQ(latin.half(), greek.half());
}

TEST(RegionNames, StandWhereTheirGroundIsOnTopAndNoneLiesOverAnother) {
  std::mt19937 engine(3);
  std::uniform_real_distribution<double> place(-5, 5);
  std::uniform_real_distribution<double> size(0.05, 1);
  for (int map = 0; map < 20; ++map) {
    scene::Surface surface;
    for (int i = 0; i < 40; ++i) {
      const scene::Circle disc{{place(engine), place(engine)}, size(engine), false};
      surface.regions.push_back({"disc_" + std::to_string(i), disc, scene::Law::coulomb});
      surface.regions.back().material.friction = 0.01 * i;
    }
    const Ground ground(surface);
    const std::vector<RegionName> names = region_names(ground, view_around(surface, {Vector2d(0, 0)}, 0.1));
    EXPECT_GT(names.size(), 10U);
    for (std::size_t i = 0; i < names.size(); ++i) {
      EXPECT_EQ(ground.top_region(names[i].middle), names[i].region);
      for (std::size_t j = 0; j < i; ++j) {
        const Vector2d apart = (names[i].middle - names[j].middle).cwiseAbs();
        const Vector2d reach = names[i].half() + names[j].half();
        EXPECT_TRUE(apart.x() >= reach.x() || apart.y() >= reach.y())
            << names[i].text << " over " << names[j].text;
      }
    }
  }
}

TEST(RegionNames, StayWhenTheSquareMovesAndGrows) {
  scene::Surface surface = surface_of(scene::HalfPlane{{0, 0}, {1, 0}});
  surface.regions.push_back({"disc", scene::Circle{{2, 1}, 0.9, false}, scene::Law::smooth});
  surface.regions.push_back({"far", scene::Circle{{12, 1}, 0.9, false}, scene::Law::rubber});
  const Ground ground(surface);
  Picture picture = picture_around({0, 0}, 10);
  surface_markers(ground, {{0, 0}, 5}, 0.1, "map", &picture);
  const std::vector<RegionName> before = picture.names;
  ASSERT_EQ(before.size(), 4U);  // the small disc beyond the picture has its name, too
  picture = picture_around({6, 1}, 10);
  picture.names = before;
  surface_markers(ground, {{6, 1}, 20}, 0.1, "map", &picture);
  ASSERT_GE(picture.names.size(), before.size());
  for (std::size_t i = 0; i < before.size(); ++i) {
    EXPECT_EQ(picture.names[i].middle, before[i].middle);
    EXPECT_EQ(picture.names[i].size, before[i].size);
    EXPECT_EQ(picture.names[i].text, before[i].text);
  }
}

TEST(RegionNames, AreWrittenAgainWhereTheCameraGoes) {
  const Ground ground(surface_of(scene::HalfPlane{{0, 0}, {1, 0}}));
  Picture picture = picture_around({0, 0}, 10);
  surface_markers(ground, {{0, 0}, 15}, 0.1, "map", &picture);
  ASSERT_EQ(picture.names.size(), 2U);
  const std::vector<RegionName> names = std::move(picture.names);
  picture = picture_around({30, 0}, 10);
  picture.names = names;
  surface_markers(ground, {{15, 0}, 30}, 0.1, "map", &picture);
  ASSERT_EQ(picture.names.size(), 3U);
  EXPECT_EQ(picture.names[2].text, "region: rough");
  EXPECT_TRUE(picture.square.contains(picture.names[2].middle + picture.names[2].half()));
  EXPECT_TRUE(picture.square.contains(picture.names[2].middle - picture.names[2].half()));
}

TEST(GroundMotion, ArrowsPointAlongTheVelocityOfTheGround) {
  scene::Surface surface = surface_of(scene::HalfPlane{{0, 0}, {1, 0}});
  surface.regions[0].material.belt = {0, -0.2};
  surface.regions.push_back({"table", scene::Circle{{-3, 0}, 2, false}, scene::Law::rough});
  surface.regions[1].material.turntable_rate = 3;
  surface.regions[1].material.turntable_center = {-3, 0};
  const Ground ground(surface);
  const ViewSquare view = view_around(surface, {Vector2d(0, 0)}, 0.1);
  const std::vector<Vector2d> lines = motion_arrows(ground, view, region_names(ground, view));
  std::set<RegionId> seen;
  ASSERT_EQ(lines.size() % 6, 0U);
  for (std::size_t i = 0; i < lines.size(); i += 6) {
    const Vector2d middle = 0.5 * (lines[i] + lines[i + 1]);
    const RegionId region = ground.top_region(middle);
    seen.insert(region);
    const Vector2d along = (lines[i + 1] - lines[i]).normalized();
    const Vector2d wanted = ground_velocity(ground.material(region), middle).normalized();
    EXPECT_NEAR((along - wanted).norm(), 0, 1e-12)
        << middle.transpose();  // of lengths of 0.01 to 1 in places up to 10
  }
  EXPECT_EQ(seen, (std::set<RegionId>{0, 1}));
}

TEST(GroundMotion, NoArrowRunsUnderAName) {
  scene::Surface surface = surface_of(scene::HalfPlane{{0, 0}, {1, 0}});
  surface.regions[0].material.belt = {0.1, -0.2};
  surface.base = scene::Law::rough;
  surface.base.belt = {-1, 0};
  const Ground ground(surface);
  const ViewSquare view = view_around(surface, {Vector2d(0, 0)}, 0.1);
  const std::vector<RegionName> names = region_names(ground, view);
  ASSERT_EQ(names.size(), 2U);
  for (const Vector2d& end : motion_arrows(ground, view, names)) {
    for (const RegionName& name : names)
      EXPECT_FALSE(((end - name.middle).cwiseAbs().array() < name.half().array()).all()) << name.text;
  }
}

TEST(GroundMotion, ANarrowBeltUnderItsNameHasAnArrow) {
  scene::Surface surface = surface_of(scene::Polygon{{{0, 0.1}, {6, 0.1}, {6, 0.4}, {0, 0.4}}, false});
  surface.regions[0].material.belt = {-2, 0};
  const Ground ground(surface);
  const ViewSquare view{{0, 0}, 20};
  const std::vector<RegionName> names = {{0, {3, 0.25}, 0.5, "region: rough"}};
  const std::vector<Vector2d> lines = motion_arrows(ground, view, names, 5);
  ASSERT_FALSE(lines.empty());
  EXPECT_EQ(ground.top_region(0.5 * (lines[0] + lines[1])), 0);
}

TEST(GroundMotion, ArrowsStayWhenTheSquareGrows) {
  scene::Surface surface = surface_of(scene::HalfPlane{{0, 0}, {1, 0}});
  surface.regions[0].material.belt = {1, 0};
  const Ground ground(surface);
  const std::vector<Vector2d> small = motion_arrows(ground, {{0.3, 0.1}, 5}, {}, 6);
  const std::vector<Vector2d> large = motion_arrows(ground, {{1.7, -0.4}, 12}, {}, 6);
  ASSERT_FALSE(small.empty());
  EXPECT_GT(large.size(), small.size());
  for (const Vector2d& end : small) {
    const auto is_there = [&end](const Vector2d& other) { return (other - end).norm() < 1e-12; };
    EXPECT_TRUE(std::any_of(large.begin(), large.end(), is_there)) << end.transpose();
  }
}

TEST(GroundMotion, GroundAtRestHasNoArrows) {
  const scene::Surface surface = surface_of(scene::HalfPlane{{0, 0}, {1, 0}});
  const Ground ground(surface);
  const ViewSquare view = view_around(surface, {Vector2d(0, 0)}, 0.1);
  EXPECT_TRUE(motion_arrows(ground, view, region_names(ground, view)).empty());
}

}  // namespace
}  // namespace hybrid_sphere::ros_interface::map_names_test

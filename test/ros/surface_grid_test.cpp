#include "ros/conversions/surface_grid.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <string>

#include "ground/ground.hpp"
#include "scene/read_tree.hpp"
#include "scene/tree.hpp"
#include "scene/yaml.hpp"
#include "support/temporary_file.hpp"

namespace hybrid_sphere::ros_interface::surface_grid_test {
namespace {

/// 4 x 3 cells of 0.5 m, from (-1, 2) on; rows from below.
nav_msgs::OccupancyGrid some_grid() {
  nav_msgs::OccupancyGrid grid;
  grid.header.frame_id = "world";
  grid.info.width = 4;
  grid.info.height = 3;
  grid.info.resolution = 0.5F;
  grid.info.origin.position.x = -1;
  grid.info.origin.position.y = 2;
  grid.info.origin.orientation.w = 1;
  grid.data = {0,   100, 65, -1,  //
               64,  65,  90, 0,   //
               100, 0,   -1, 0};
  return grid;
}

/// Of four in a row, in cells from the origin.
Vector2d middle_of_cell(std::size_t i) {
  const std::size_t row = i / 4;
  return {static_cast<double>(i - 4 * row) + 0.5, static_cast<double>(row) + 0.5};
}

scene::Surface under() {
  scene::Surface surface;
  surface.base = scene::Law::rubber;
  surface.livelock = scene::Livelock::stop;
  surface.regions = {{"old", scene::Circle{{0, 0}, 9, false}, scene::Law::smooth}};
  return surface;
}

scene::Surface read(const nav_msgs::OccupancyGrid& grid, double threshold = 65) {
  return surface_from_grid(grid, {}, threshold, under());
}

TEST(SurfaceGrid, OccupiedCellsAreRoughGroundOverTheBase) {
  const nav_msgs::OccupancyGrid grid = some_grid();
  const Ground ground(read(grid));
  EXPECT_EQ(ground.law(base_region), scene::Law::rubber);
  EXPECT_EQ(ground.surface().livelock, scene::Livelock::stop);
  for (std::size_t i = 0; i < grid.data.size(); ++i) {
    const Vector2d middle = Vector2d(-1, 2) + 0.5 * middle_of_cell(i);
    EXPECT_EQ(ground.law(ground.top_region(middle)),
              grid.data[i] >= 65 ? scene::Law::rough : scene::Law::rubber)
        << "cell " << i;
  }
  EXPECT_EQ(ground.top_region({5, 5}), base_region);
}

TEST(SurfaceGrid, NeighbouringCellsAreMerged) {
  nav_msgs::OccupancyGrid grid = some_grid();
  grid.data.assign(12, 100);
  const scene::Surface surface = read(grid);
  ASSERT_EQ(surface.regions.size(), 1U);
  EXPECT_EQ(surface.regions[0].name, "grid_0");
}

TEST(SurfaceGrid, TheThresholdIsThatOfTheParameter) {
  nav_msgs::OccupancyGrid grid = some_grid();
  EXPECT_EQ(read(grid, 100).regions.size(), 2U);
  grid.data.assign(12, 99);
  EXPECT_TRUE(read(grid, 100).regions.empty());
  EXPECT_EQ(read(grid, 1).regions.size(), 1U);
}

TEST(SurfaceGrid, WithoutOrientationIsTaken) {
  nav_msgs::OccupancyGrid grid = some_grid();
  grid.info.origin.orientation.w = 0;
  EXPECT_NO_THROW(read(grid));
}

/// What map_server 1.17 makes of an image of one channel with occupied_thresh 0.65 and free_thresh 0.196.
std::int8_t occupancy_of(unsigned level, bool negates, const std::string& mode) {
  double grey = level;
  if (negates) grey = 255 - grey;
  const double occupancy = (255 - grey) / 255.0;
  if (occupancy > 0.65) return 100;
  if (occupancy < 0.196) return 0;
  if (mode == "trinary") return -1;
  return static_cast<std::int8_t>(1 + 98 * (occupancy - 0.196) / (0.65 - 0.196));
}

// A file of map_server is the same ground by surface.image.map and by the topic.
TEST(SurfaceGrid, IsTheGroundOfItsFile) {
  constexpr std::uint32_t width = 20;
  constexpr std::uint32_t height = 13;
  std::mt19937 draw(7);
  for (const char* mode : {"trinary", "scale"}) {
    for (const double yaw : {0.0, 0.7, -2.5}) {
      const bool negates = yaw > 0;
      const testing::TemporaryFile image("grid.pgm");
      const testing::TemporaryFile map("grid.yaml");
      nav_msgs::OccupancyGrid grid = some_grid();
      grid.info.width = width;
      grid.info.height = height;
      grid.info.origin.orientation.z = std::sin(yaw / 2);
      grid.info.origin.orientation.w = std::cos(yaw / 2);
      grid.data.assign(std::size_t{width} * height, 0);
      std::string pixels = "P2 20 13 255";
      for (std::uint32_t row = height; row-- > 0;) {  // an image begins with its uppermost row
        for (std::uint32_t x = 0; x < width; ++x) {
          const auto level = static_cast<unsigned>(draw() % 256);
          pixels += " " + std::to_string(level);
          grid.data[row * width + x] = occupancy_of(level, negates, mode);
        }
      }
      image.fill(pixels);
      map.fill("{image: " + image.path() + ", resolution: 0.5, origin: [-1, 2, " + std::to_string(yaw) +
               "], negate: " + (negates ? "1" : "0") +
               ", occupied_thresh: 0.65, free_thresh: 0.196, mode: " + mode + "}");
      const scene::Surface by_topic = read(grid);
      const scene::Surface by_file =
          scene::read_surface(scene::tree_from_yaml("image: {map: " + map.path() + "}"));
      ASSERT_EQ(by_file.regions.size(), by_topic.regions.size()) << mode << yaw;
      for (std::size_t i = 0; i < by_file.regions.size(); ++i) {
        const auto& corners = std::get<scene::Polygon>(by_file.regions[i].shape).vertices;
        const auto& expected = std::get<scene::Polygon>(by_topic.regions[i].shape).vertices;
        ASSERT_EQ(corners.size(), expected.size()) << mode << yaw << i;
        // Sine and cosine of a quaternion are within 4 round-offs of those of the angle, 12 m from the
        // origin.
        for (std::size_t k = 0; k < corners.size(); ++k)
          EXPECT_LE((corners[k] - expected[k]).norm(), 12 * 4 * 0x1p-52) << mode << yaw << i;
      }
    }
  }
}

// Beside an inner corner of cells, turned, there is no gap: each place on a side belongs to one of the cells.
TEST(SurfaceGrid, WhoseOriginIsTurnedHasNoGapsBetweenItsCells) {
  nav_msgs::OccupancyGrid grid = some_grid();
  grid.data = {100, 100, 100, 0,  //
               100, 0,   100, 0,  //
               100, 100, 100, 100};
  const double angle = 0.6;
  grid.info.origin.orientation.z = std::sin(angle / 2);
  grid.info.origin.orientation.w = std::cos(angle / 2);
  const PlanarTransform to_world(std::cos(0.3), std::sin(0.3), {5, -7});
  const Ground ground(surface_from_grid(grid, to_world, 65, under()));
  const auto placed = [&](const Vector2d& cells) {
    const Vector2d there = Vector2d(-1, 2) + Eigen::Rotation2Dd(angle) * Vector2d(0.5 * cells);
    return Vector2d(Eigen::Rotation2Dd(0.3) * there + Vector2d(5, -7));
  };
  for (std::size_t i = 0; i < grid.data.size(); ++i) {
    EXPECT_EQ(ground.law(ground.top_region(placed(middle_of_cell(i)))),
              grid.data[i] == 100 ? scene::Law::rough : scene::Law::rubber)
        << "cell " << i;
  }
  for (double x = 0.01; x < 3; x += 0.01) {  // along the sides between the rows
    const bool over_hole = x > 1 && x < 2;
    for (const double y : {1.0, 2.0}) {
      const RegionId region = ground.top_region(placed({x, y}));
      if (over_hole) continue;
      EXPECT_EQ(ground.law(region), scene::Law::rough) << x << ", " << y;
    }
  }
}

TEST(SurfaceGrid, IsRefusedWithThePath) {
  using Spoil = std::function<void(nav_msgs::OccupancyGrid&)>;
  const std::vector<std::pair<std::string, Spoil>> cases{
      {"surface_grid.info", [](auto& grid) { grid.info.width = 0, grid.data.clear(); }},
      {"surface_grid.info.resolution: 0", [](auto& grid) { grid.info.resolution = 0; }},
      {"surface_grid.info.resolution: -1", [](auto& grid) { grid.info.resolution = -1; }},
      {"surface_grid.info.resolution: nan", [](auto& grid) { grid.info.resolution = std::nanf(""); }},
      {"surface_grid.info.origin", [](auto& grid) { grid.info.origin.position.x = HUGE_VAL; }},
      {"surface_grid.info.origin.position[2]: 1", [](auto& grid) { grid.info.origin.position.z = 1; }},
      {"surface_grid.info.origin.orientation: [0, 0, 0.1, 0.9]",
       [](auto& grid) { grid.info.origin.orientation.z = 0.1, grid.info.origin.orientation.w = 0.9; }},
      {"surface_grid.info.origin.orientation: [0, 0, 0, 5]",
       [](auto& grid) { grid.info.origin.orientation.w = 5; }},
      {"surface_grid.info.origin.orientation: ",
       [](auto& grid) { grid.info.origin.orientation.w = std::nan(""); }},
      {"surface_grid.info.origin.orientation: ",
       [](auto& grid) { grid.info.origin.orientation.x = std::nan(""); }},
      {"surface_grid.data: 11 values is refused; allowed: 12, width times height",
       [](auto& grid) { grid.data.pop_back(); }},
      {"surface_grid.info: a map of 4294967295 x 3 cells with 12 values",
       [](auto& grid) { grid.info.width = 0xffffffff; }},
      {"surface_grid.data[3]: -2 is refused", [](auto& grid) { grid.data[3] = -2; }},
      {"surface_grid.data[3]: 101 is refused", [](auto& grid) { grid.data[3] = 101; }},
  };
  for (const auto& [words, spoil] : cases) {
    nav_msgs::OccupancyGrid grid = some_grid();
    spoil(grid);
    try {
      read(grid);
      ADD_FAILURE() << "taken: " << words;
    } catch (const scene::SceneError& error) {
      EXPECT_EQ(std::string(error.what()).find(words), 0U) << error.what();
    }
  }
}

TEST(SurfaceGrid, RefusesMoreCellsThanItsSizeBeforeItLooksAtThem) {
  nav_msgs::OccupancyGrid grid = some_grid();
  grid.info.width = 1 << 13;
  grid.info.height = 1 << 12;
  grid.data.assign(std::size_t{1} << 25U, 101);  // no occupancy
  try {
    read(grid);
    FAIL() << "it is taken";
  } catch (const scene::SceneError& error) {
    EXPECT_NE(std::string(error.what()).find("up to 16777216 cells"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace hybrid_sphere::ros_interface::surface_grid_test

// The page itself: its size, its data, and that nothing of a scene is taken for markup.

#include "html/page.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <sstream>

#include "support/page.hpp"

namespace hybrid_sphere::testing::page_test {
namespace {

constexpr std::size_t max_size = 2'000'000;

scene::Scene plain_scene() {
  scene::Scene scene{};
  scene.sphere = {1, 0.1, 0.1 * std::sqrt(0.4)};
  return scene;
}

struct Page {
  std::string text;
  std::vector<std::string> left_out;
};

Page write(const scene::Scene& scene, const html::Recording& recording, const html::PageText& text = {}) {
  std::ostringstream out;
  std::vector<std::string> left_out = html::write_page(scene, recording, text, out);
  return {out.str(), left_out};
}

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t number = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++number;
  return number;
}

TEST(Pages, NamesAndTitlesAreNoMarkup) {
  const std::string evil = "</script><b>&{{three}}";
  scene::Scene scene = plain_scene();
  scene.surface.regions.push_back({evil, scene::Circle{{1, 0}, 0.5}, scene::Law::rough});
  html::Recording recording;
  State state;
  state.region = evil;
  recording.add(state);
  const Page empty = write(plain_scene(), html::Recording());
  const Page page = write(scene, recording, {evil, evil});
  EXPECT_EQ(page.text.find(evil), std::string::npos);
  EXPECT_EQ(count(page.text, "</script>"), count(empty.text, "</script>"));
  const YAML::Node data = data_of(page.text);
  EXPECT_EQ(data["title"].as<std::string>(), evil);
  EXPECT_EQ(data["ended"].as<std::string>(), evil);
  EXPECT_EQ(data["names"][2][0].as<std::string>(), evil);
}

TEST(Pages, NeedNothingElseAndCarryTheLicence) {
  const Page page = write(plain_scene(), html::Recording());
  EXPECT_NE(page.text.find("default-src 'none'"), std::string::npos);
  EXPECT_EQ(page.text.find("<script src"), std::string::npos);
  EXPECT_NE(page.text.find("three.js authors"), std::string::npos);
  EXPECT_NE(page.text.find("THE SOFTWARE IS PROVIDED \"AS IS\""), std::string::npos);
  EXPECT_EQ(page.text.rfind("<!DOCTYPE html>", 0), 0U);
}

TEST(Pages, OfARunWithoutStatesAreWhole) {
  const Page page = write(plain_scene(), html::Recording(), {"none", ""});
  const YAML::Node data = data_of(page.text);
  EXPECT_EQ(data["states"]["time"].as<std::string>(), "");
  EXPECT_TRUE(page.left_out.empty());
}

TEST(Pages, HaveTheStatesAndSwitchesToBinary32) {
  scene::Scene scene = plain_scene();
  html::Recording recording;
  std::vector<double> xs;
  for (int i = 0; i <= 100; ++i) {
    State state;
    state.time = 1e6 + 0.1 * i;
    state.position = {1e10 + 0.01 * i, -3e9};
    state.orientation = Eigen::AngleAxisd(0.1 * i, Vector3d::UnitX());
    state.twist.velocity = {1e100, 0};
    state.mode = Mode::rolling;
    state.region = "base";
    recording.add(state);
    xs.push_back(state.position.x());
  }
  Switch event;
  event.time = 1e6 + 0.05;
  event.position = {1e10, -3e9};
  event.impulse = {0.25, -2};
  event.energy_before = 3;
  event.energy_after = 1;
  event.cause = Cause::grip_lost;
  recording.add(event);
  const YAML::Node data = data_of(write(scene, recording).text);
  const auto times = numbers_of<double>(data["states"]["time"].as<std::string>());
  EXPECT_EQ(times[100], 1e6 + 0.1 * 100);
  const std::vector<double> positions = floats_of(data["states"]["position"]);
  for (std::size_t i = 0; i < xs.size(); ++i) {
    // An ulp of 1e10 in binary64, and half one of 1 in binary32.
    EXPECT_NEAR(positions[2 * i] + data["origin"][0].as<double>(), xs[i], 2e-6 + 6e-8);
  }
  EXPECT_NEAR(floats_of(data["states"]["velocity"])[0], 1e100, 1e93);
  EXPECT_EQ(floats_of(data["switches"]["impulse"]), (std::vector<double>{0.25, -2, 0}));
  EXPECT_EQ(floats_of(data["switches"]["lost"]), (std::vector<double>{2}));
  EXPECT_EQ(bytes_of(data["switches"]["cause"].as<std::string>())[0], 3);
}

TEST(Pages, AreBelowTwoMegabytesWhateverIsOnThem) {
  scene::Scene scene = plain_scene();
  const std::string long_name(88, '<');
  for (int i = 0; i < 100'000; ++i) {
    scene::Material material(scene::Law::rough);
    material.belt = {0.001 * i, 1};
    scene.surface.regions.push_back(
        {long_name + std::to_string(i), scene::Circle{{0.1 * (i % 300), 0.1 * i / 300}, 0.05}, material});
  }
  html::Recording recording;
  Switch event;
  for (std::size_t i = 0; i < 100'000; ++i) {
    State state;
    state.time = static_cast<double>(i);
    state.position = {std::sin(state.time), 1e-3 * state.time};
    state.region = scene.surface.regions[i].name;
    recording.add(state);
    event.time = state.time;
    event.to_region = state.region;
    recording.add(event);
  }
  const Page page = write(scene, recording, {std::string(1000, '&'), std::string(1000, '<')});
  EXPECT_LT(page.text.size(), max_size);
  EXPECT_EQ(page.left_out.size(), data_of(page.text)["leftOut"].size());
  ASSERT_GE(page.left_out.size(), 3U);
  EXPECT_EQ(page.left_out[0], "of 100000 outputs the page has 10001, evenly chosen");
  EXPECT_EQ(
      page.left_out[1],
      "of 100000 switches the page has the first 2000, up to t = 1999 s; after that the motion between two "
      "outputs is smoothed");
}

TEST(Pages, WithStatesThatAreNotFiniteAreStillJson) {
  html::Recording recording;
  State state;
  state.position = {HUGE_VAL, std::numeric_limits<double>::quiet_NaN()};
  recording.add(state);
  const YAML::Node data = data_of(write(plain_scene(), recording).text);
  EXPECT_EQ(floats_of(data["states"]["position"]), (std::vector<double>{0, 0}));
}

}  // namespace
}  // namespace hybrid_sphere::testing::page_test

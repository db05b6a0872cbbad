#include "ros/node/parameters.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "scene/yaml.hpp"

namespace hybrid_sphere::ros_interface::parameters_test {
namespace {

using scene::SceneError;
using scene::Tree;
using XmlRpc::XmlRpcValue;

XmlRpcValue sphere() {
  XmlRpcValue sphere;
  sphere["mass"] = 2;  // an integer on the parameter server
  sphere["radius"] = 0.25;
  sphere["body"] = "solid";
  return sphere;
}

/// Message of the refusal; empty when the parameters are taken.
std::string refusal(const XmlRpcValue& parameters) {
  try {
    read_configuration(tree_from_parameters(parameters));
  } catch (const SceneError& error) {
    return error.what();
  }
  return "";
}

std::string refusal(const std::string& key, const XmlRpcValue& value) {
  XmlRpcValue parameters;
  parameters["sphere"] = sphere();
  parameters[key] = value;
  return refusal(parameters);
}

TEST(Parameters, AreTheSceneThatTheYamlFileIs) {
  XmlRpcValue region;
  region["name"] = "disc";
  region["law"] = "rough";
  region["circle"]["center"][0] = 1;
  region["circle"]["center"][1] = -2.5;
  region["circle"]["radius"] = 3;
  region["outside"] = true;
  XmlRpcValue parameters;
  parameters["sphere"] = sphere();
  parameters["surface"]["regions"][0] = region;
  const Tree yaml = scene::tree_from_yaml(
      "{sphere: {mass: 2, radius: 0.25, body: solid}, surface: {regions: "
      "[{name: disc, law: rough, circle: {center: [1, -2.5], radius: 3}, outside: true}]}}");
  const scene::Scene a = read_configuration(tree_from_parameters(parameters)).scene;
  const scene::Scene b = read_configuration(yaml).scene;
  EXPECT_EQ(a.sphere.mass, b.sphere.mass);
  EXPECT_EQ(a.sphere.gyration_radius, b.sphere.gyration_radius);
  ASSERT_EQ(a.surface.regions.size(), 1U);
  const auto& circle_a = std::get<scene::Circle>(a.surface.regions[0].shape);
  const auto& circle_b = std::get<scene::Circle>(b.surface.regions[0].shape);
  EXPECT_EQ(circle_a.center, circle_b.center);
  EXPECT_EQ(circle_a.radius, circle_b.radius);
  EXPECT_TRUE(circle_a.outside);
}

TEST(Parameters, OfTheNodeHaveDefaults) {
  XmlRpcValue parameters;
  parameters["sphere"] = sphere();
  const NodeParameters node = read_configuration(tree_from_parameters(parameters)).node;
  EXPECT_EQ(node.adjustable.rate, 100);
  EXPECT_EQ(node.command_timeout, 0.5);
  EXPECT_EQ(node.kick, 1);
  EXPECT_EQ(node.grid_threshold, 65);
  EXPECT_EQ(node.scene_directory, "");
  EXPECT_EQ(node.frames.world, "world");
  EXPECT_EQ(node.frames.sphere, "sphere");
}

TEST(Parameters, OfTheNodeAreTakenOutOfTheScene) {
  XmlRpcValue parameters;
  parameters["sphere"] = sphere();
  parameters["rate"] = "1e3";  // text to the parameter server: YAML 1.1 wants a dot
  parameters["command_timeout"] = 0;
  parameters["kick"] = 0;
  parameters["grid_threshold"] = 50;
  parameters["scene_directory"] = "/somewhere";
  parameters["world_frame"] = "/map";  // as launch files of ROS's older tf have it
  parameters["sphere_frame"] = "robot/ball";
  const NodeParameters node = read_configuration(tree_from_parameters(parameters)).node;
  EXPECT_EQ(node.adjustable.rate, 1000);
  EXPECT_EQ(node.command_timeout, 0);
  EXPECT_EQ(node.kick, 0);
  EXPECT_EQ(node.grid_threshold, 50);
  EXPECT_EQ(node.scene_directory, "/somewhere");
  EXPECT_EQ(node.frames.world, "map");
  EXPECT_EQ(node.frames.sphere, "robot/ball");
}

TEST(Parameters, AreRefusedWithPathValueAndRange) {
  EXPECT_EQ(refusal("rate", -5), "rate: -5 is refused; allowed: a number from 0.001 to 1e+06 [Hz]");
  EXPECT_EQ(refusal("rate", 0).find("rate: 0 is refused"), 0U);
  EXPECT_EQ(refusal("rate", 2e6).find("rate: 2e+06 is refused"), 0U);
  EXPECT_EQ(refusal("rate", true).find("rate: true is refused"), 0U);
  EXPECT_EQ(refusal("command_timeout", -0.5),
            "command_timeout: -0.5 is refused; allowed: a number from 0 to 1e+09 [s]");
  EXPECT_EQ(refusal("command_timeout", std::nan("")).find("command_timeout: nan is refused"), 0U);
  EXPECT_EQ(refusal("kick", -1), "kick: -1 is refused; allowed: a number from 0 to 1000 [m/s]");
  EXPECT_EQ(refusal("kick", 1001).find("kick: 1001 is refused"), 0U);
  EXPECT_EQ(refusal("grid_threshold", 0),
            "grid_threshold: 0 is refused; allowed: a number from 1 to 100 [%]");
  EXPECT_EQ(refusal("grid_threshold", 101).find("grid_threshold: 101 is refused"), 0U);
  EXPECT_EQ(refusal("scene_directory", 3).find("scene_directory: 3 is refused"), 0U);
  EXPECT_EQ(
      refusal("raet", 5).find("raet: an unknown key is refused (did you mean rate?); allowed: sphere, "), 0U);
  for (const char* own : {"solver", "rate", "real_time_factor", "paused", "scene_directory", "kick"}) {
    EXPECT_NE((refusal("raet", 5) + ",").find(std::string(", ") + own + ","), std::string::npos) << own;
  }
  for (const char* frame : {"", "/", "//map", "a b", "a\n"}) {
    EXPECT_EQ(refusal("world_frame", frame).find("world_frame: \""), 0U) << frame;
    EXPECT_EQ(refusal("sphere_frame", frame).find("sphere_frame: \""), 0U) << frame;
  }
  EXPECT_EQ(refusal("sphere_frame", std::string(101, 'a')).find("sphere_frame: "), 0U);
  EXPECT_EQ(refusal("sphere_frame", 3).find("sphere_frame: 3 is refused"), 0U);
  EXPECT_EQ(refusal("sphere_frame", "world"),
            "sphere_frame: \"world\" is refused; allowed: a name other than world_frame's");
  EXPECT_EQ(refusal(XmlRpcValue("text")).find("scene: \"text\" is refused"), 0U);
}

TEST(Parameters, ThatAskForAClosedFormWhereThereIsNoneAreRefused) {
  XmlRpcValue parameters;
  parameters["sphere"] = sphere();
  parameters["drag"]["quadratic"] = 0.1;
  EXPECT_EQ(refusal(parameters), "");
  parameters["solver"]["method"] = "exact";
  EXPECT_EQ(refusal(parameters),
            "solver.method: exact is refused; allowed: auto, as quadratic drag (ground \"base\") has no "
            "closed form");
}

TEST(Parameters, OfOtherTypesAreRefusedWithTheirPath) {
  std::tm date{};
  const char bytes[] = "abc";
  XmlRpcValue state;
  state["position"][0] = 0;
  state["position"][1] = XmlRpcValue(&date);
  EXPECT_EQ(refusal("initial_state", state).find("initial_state.position[1]: a date is refused"), 0U);
  EXPECT_EQ(
      refusal("solver", XmlRpcValue(const_cast<char*>(bytes), 3)).find("solver: binary data is refused"), 0U);
}

TEST(Parameters, NestedTooDeeplyAreRefused) {
  XmlRpcValue nested = 1;
  for (int i = 0; i < 40; ++i) {
    XmlRpcValue list;
    list[0] = nested;
    nested = list;
  }
  EXPECT_NE(refusal("surface", nested).find("nested deeper"), std::string::npos);
}

TEST(Parameters, OfTheClockAreWords) {
  XmlRpcValue parameters;
  parameters["sphere"] = sphere();
  const auto mode = [&] { return read_configuration(tree_from_parameters(parameters)).node.clock; };
  EXPECT_EQ(mode(), ClockMode::own);
  parameters["publish_clock"] = true;
  EXPECT_EQ(mode(), ClockMode::lead);
  parameters["clock"] = "lead";
  EXPECT_EQ(mode(), ClockMode::lead);
  parameters["clock"] = "follow";
  EXPECT_EQ(refusal(parameters), "publish_clock: true is refused; allowed: false where clock is not lead");
  parameters["publish_clock"] = false;
  EXPECT_EQ(mode(), ClockMode::follow);
  parameters["real_time_factor"] = 2;
  EXPECT_EQ(refusal(parameters), "real_time_factor: 2 is refused; allowed: 1 with clock: follow");
  EXPECT_EQ(refusal("clock", "lag"), "clock: \"lag\" is refused; allowed: own, lead, follow");
}

}  // namespace
}  // namespace hybrid_sphere::ros_interface::parameters_test

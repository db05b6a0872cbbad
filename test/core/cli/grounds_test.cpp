// `simulate` on every ground: what it explains, measures, reports and refuses.

#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "support/command_line.hpp"
#include "support/temporary_file.hpp"

namespace hybrid_sphere::testing::grounds_test {
namespace {

const std::string config_directory = std::string(TEST_DATA_DIR) + "/../../config";

std::string config(const std::string& name) { return config_directory + "/" + name + ".yaml"; }

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

double number(const std::string& text) { return std::strtod(text.c_str(), nullptr); }

const std::string solid = "sphere: {mass: 1, radius: 0.1, body: solid}\n";

/// What `simulate` says of a scene given as text.
CommandResult run(const std::string& scene, std::vector<std::string> arguments) {
  const TemporaryFile file("ground.yaml");
  file.fill(solid + scene);
  arguments.insert(arguments.begin(), file.path());
  return simulate(arguments);
}

// Two belts that run against each other along x = 0; the sphere comes to their edge at t = 0.64.
const std::string opposing_belts =
    "initial_state: {position: [-1, 0.5], velocity: [1, 0], angular_velocity: [0, 10, 0]}\n"
    "surface:\n"
    "  livelock: {livelock}\n"
    "  base: {law: rough}\n"
    "  regions:\n"
    "    - {name: right, half_plane: {point: [0, 0], normal: [1, 0]}, law: rough, belt: [-9, 0.5]}\n"
    "    - {name: left, polygon: [[-0.5, -5], [0, -5], [0, 5], [-0.5, 5]], law: rough, belt: [9, 0.25]}\n";

std::string with_livelock(const std::string& word) {
  std::string scene = opposing_belts;
  return scene.replace(scene.find("{livelock}"), 10, word);
}

TEST(Grounds, SaysWhereALivelockBecomesASlideAlongAnEdge) {
  const CommandResult result = run(with_livelock("slide"), {"--times", "2", "--states", "-"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_TRUE(contains(result.err, "simulate: livelock at t = ")) << result.err;
  EXPECT_TRUE(contains(result.err, "x = 0 m, y = ")) << result.err;
  EXPECT_TRUE(contains(result.err, "\"left\" and \"right\" throw the sphere at each other")) << result.err;
  EXPECT_TRUE(contains(result.out, ",3,edge_sliding,")) << result.out;
  EXPECT_EQ(run(with_livelock("slide"), {"--times", "2", "--states", "-", "--quiet"}).err, "");
}

TEST(Grounds, WritesEverythingUpToTheInstantAtWhichTheComputationEnds) {
  const TemporaryFile states("states.csv");
  const CommandResult result =
      run(with_livelock("stop"), {"--rate", "10", "--states", states.path(), "--switches", "-"});
  EXPECT_EQ(result.exit_code, 4);
  EXPECT_TRUE(contains(result.err, "livelock at t = 0.64 s, x = 0 m, y = 0.51 m")) << result.err;
  EXPECT_TRUE(contains(result.err, "surface.livelock is stop")) << result.err;
  // It rolls at 1 m/s to x = -1/2; there v = p_c + kappa u = 1 + 2/7 9 m/s, and the edge is 1/2 m ahead.
  const double end = 0.5 + 0.5 / (1 + 18.0 / 7);
  const std::vector<std::string> rows = split(states.text(), '\n');
  ASSERT_EQ(rows.size(), 1U + std::size_t(1 + std::floor(10 * end)));
  EXPECT_EQ(number(split(rows.back(), ',')[0]), std::floor(10 * end) / 10);
  const std::vector<std::string> switches = split(result.out, '\n');
  // Put on the base, onto the left belt, and then to and fro until a belt comes again.
  ASSERT_EQ(switches.size(), 1U + 4U) << result.out;
  EXPECT_NEAR(number(split(switches.back(), ',')[1]), end, 8e-16);  // four roundings of numbers below 1
}

TEST(Grounds, CountsTheRightHandSidesOfAnIntegratedMotion) {
  const std::string scene = "initial_state: {velocity: [1, 0]}\n";
  const std::vector<std::string> timing{"--times", "1", "--timing", "--quiet"};
  const YAML::Node exact = YAML::Load(run(scene + "drag: {translational: 0.1}\n", timing).out);
  const YAML::Node integrated =
      YAML::Load(run(scene + "drag: {quadratic: 0.1}\nsolver: {accuracy: 1e-6}\n", timing).out);
  EXPECT_EQ(exact["rhs_evaluations"].as<int>(), 0);
  EXPECT_LT(exact["estimated_error"].as<double>(), 1e-14);
  EXPECT_GE(integrated["rhs_evaluations"].as<int>(), 13);  // stages of one step
  EXPECT_GT(integrated["estimated_error"].as<double>(), exact["estimated_error"].as<double>());
  EXPECT_LE(integrated["estimated_error"].as<double>(), 1e-6);
}

TEST(Grounds, TellsTimeAndErrorOfARunThatCannotGoOn) {
  const CommandResult result = run(with_livelock("stop"), {"--rate", "10", "--timing"});
  EXPECT_EQ(result.exit_code, 4);
  const YAML::Node timing = YAML::Load(result.out);
  EXPECT_DOUBLE_EQ(timing["simulated_s"].as<double>(), 0.64);
  EXPECT_EQ(timing["outputs"].as<int>(), 7);
  EXPECT_GT(timing["estimated_error"].as<double>(), 0);
}

TEST(Grounds, WarnsOfAFixedStepThatIsTooLongForTheOrientation) {
  const std::string scene =
      "initial_state: {velocity: [1, 0], angular_velocity: [0, 0, 3]}\n"
      "surface: {base: {law: rough, turntable: {rate: 2, center: [1, 0]}}}\n";
  for (const std::string method : {"euler", "rk4", "lie_midpoint", "rkmk4"}) {
    const CommandResult result = run(scene, {"--times", "1", "--method", method, "--step", "0.05"});
    EXPECT_TRUE(contains(result.err, "warning: the estimated error ")) << method << ": " << result.err;
  }
}

TEST(Grounds, WarnsWhereAnIntegrationCannotBeAsAccurateAsAskedFor) {
  const CommandResult result =
      run("initial_state: {velocity: [1, 0]}\ndrag: {quadratic: 0.1}\nsolver: {method: arkode_erk3, "
          "accuracy: 1e-14}\n",
          {"--times", "1", "--switches", "-"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_TRUE(contains(result.err, "warning: the estimated error ")) << result.err;
}

TEST(Grounds, RefusesTheMethodExactWhereThereIsNoClosedForm) {
  const std::string scene =
      "surface: {regions: [{name: table, circle: {center: [9, 9], radius: 1}, law: coulomb, friction: 0.1,\n"
      "  turntable: {rate: 1, center: [9, 9]}}]}\n";
  const CommandResult result = run(scene, {"--method", "exact"});
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_TRUE(contains(result.err,
                       "solver.method: exact is refused; allowed: auto, as dry friction on a "
                       "turntable (ground \"table\") has no closed form"))
      << result.err;
  EXPECT_EQ(run(scene, {"--quiet"}).exit_code, 0);
  EXPECT_EQ(run("solver: {method: exact}\ndrag: {quadratic: 1}\n", {}).exit_code, 3);
}

TEST(Grounds, ReadsAnImageBesideTheSceneFromAnyWorkingDirectory) {
  const std::filesystem::path here = std::filesystem::current_path();
  const std::string scene = std::filesystem::canonical(config("ice_patches")).string();
  std::filesystem::current_path("/");
  const CommandResult from_root = simulate({scene.substr(1), "--quiet"});
  std::filesystem::current_path(std::filesystem::path(scene).parent_path());
  const CommandResult from_beside = simulate({"ice_patches.yaml", "--quiet"});
  std::filesystem::current_path(here);
  EXPECT_EQ(from_root.exit_code, 0) << from_root.err;
  EXPECT_EQ(from_beside.exit_code, 0) << from_beside.err;
  EXPECT_EQ(from_root.out, from_beside.out);
}

struct Explained {
  friend std::ostream& operator<<(std::ostream& out, const Explained& about) { return out << about.name; }
  const char* name;
  const char* scene;
  std::vector<const char*> said;
};

class Explanation : public ::testing::TestWithParam<Explained> {};

TEST_P(Explanation, NamesTheMotionsAndHowEdgesAreFound) {
  const CommandResult result = run(GetParam().scene, {"--explain", "--quiet"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  for (const char* part : GetParam().said)
    EXPECT_TRUE(contains(result.out, part)) << part << "\n" << result.out;
}

INSTANTIATE_TEST_SUITE_P(
    Every, Explanation,
    ::testing::Values(
        Explained{"SpinFriction",
                  "surface: {base: {law: rough, spin_friction: 0.1}}\n",
                  {"rough, spin friction 0.1: base", "the spin changes, in closed form", "exact signs"}},
        Explained{"Belt",
                  "surface: {base: {law: rubber, belt: [1, 2]}}\n",
                  {"rubber, belt [1, 2] m/s: base", "the couple that stops the spin"}},
        Explained{"Turntable",
                  "surface: {base: {law: rough, turntable: {rate: 2, center: [0, 1]}}}\n",
                  {"turntable 2 rad/s about [0, 1] m", "a circle at constant rate", "half-angle formulas"}},
        Explained{"TwoGroundsOfDifferentVelocities",
                  "surface: {base: {law: rough, belt: [1, 2]}, regions: [{name: still, law: rough,\n"
                  "  circle: {center: [0, 0], radius: 1}}]}\n",
                  {"of 2 kinds", "livelocks, where grounds throw the sphere at each other endlessly"}},
        Explained{
            "TiltedTurntable",
            "surface: {base: {law: rough, turntable: {rate: 2, center: [0, 1]}}}\ngravity: [1, 0, -9]\n",
            {"exponentials in time (phi functions)", "certified search"}},
        Explained{"LevelFriction",
                  "surface: {base: {law: coulomb, friction: 0.2}}\n",
                  {"sliding: polynomials in time (a parabola); until the slip ends",
                   "|lambda| never exceeds mu N", "the normal force: N = 9.81 N"}},
        Explained{"SteepFriction",
                  "surface: {base: {law: coulomb, friction: 0.02}}\ngravity: [1, 0, -9.81]\n",
                  {"dry friction in closed form (hodograph)", "never: |lambda| would exceed mu N"}},
        Explained{"FrictionBesideASpring",
                  "surface: {base: {law: coulomb, friction: 0.02}}\nspring: {stiffness: 1}\n",
                  {"sliding: integrated: no closed form for dry friction with a spring",
                   "rolling: exponentials in time",
                   "Method: exact where there is a closed form, else dopri87, chosen by auto"}},
        Explained{"RollingResistance",
                  "surface: {base: {law: rough, rolling_resistance: 0.02}}\n",
                  {"rolling: polynomials in time (a parabola); until it comes to rest",
                   "held by rolling resistance: both velocities are constant"}},
        Explained{
            "CarriedByATurntable",
            "surface: {base: {law: rough, rolling_resistance: 0.02, turntable: {rate: 1, center: [0, 0]}}}\n",
            {"carried along by the ground, in closed form",
             "no closed form for dry friction on a turntable"}},
        Explained{"QuadraticDrag",
                  "drag: {quadratic: 0.1}\n",
                  {"no closed form for quadratic drag", "forces: quadratic drag",
                   "the Prince-Dormand method of order 8(7)"}},
        Explained{"FrictionOfNone",
                  "surface: {base: {law: coulomb, friction: 0}}\n",
                  {"coulomb, friction 0: base", "stage 1, free"}}),
    [](const auto& info) { return std::string(info.param.name); });

std::vector<std::string> config_scenes() {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(config_directory)) {
    if (entry.path().extension() == ".yaml") names.push_back(entry.path().stem().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

class ConfigScene : public ::testing::TestWithParam<std::string> {};

TEST_P(ConfigScene, RunsForTenSecondsAndSwitches) {
  const CommandResult result = simulate({config(GetParam()), "--duration", "10", "--timing"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_FALSE(contains(result.err, "warning")) << result.err;
  const YAML::Node timing = YAML::Load(result.out);
  EXPECT_EQ(timing["simulated_s"].as<double>(), 10);
  EXPECT_GE(timing["switches"].as<int>(), 1);
}

INSTANTIATE_TEST_SUITE_P(Every, ConfigScene, ::testing::ValuesIn(config_scenes()),
                         [](const auto& info) { return info.param; });

TEST(ConfigScenes, AreThoseOfTheDocumentation) {
  EXPECT_EQ(config_scenes(),
            (std::vector<std::string>{"archipelago", "bounce_back", "bowling", "checkerboard", "conveyor",
                                      "ice_patches", "incline", "paper", "rolling_to_rest", "turntable"}));
}

}  // namespace
}  // namespace hybrid_sphere::testing::grounds_test

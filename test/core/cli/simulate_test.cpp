// `simulate` from its command line to its tables.

#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "hybrid_sphere/simulation/simulation.hpp"
#include "scene/read_tree.hpp"
#include "scene/yaml.hpp"
#include "support/command_line.hpp"
#include "support/temporary_file.hpp"

namespace hybrid_sphere::testing::simulate_test {
namespace {

// Switches at t = 1 exactly, thrown back; the states are not short numbers.
const std::string scene_path = std::string(TEST_DATA_DIR) + "/oracle/o05_bounce_back.yaml";

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

double number(const std::string& text) { return std::strtod(text.c_str(), nullptr); }

std::size_t significant_digits(const std::string& text) {
  std::string digits;
  for (const char c : text.substr(0, text.find('e'))) {
    if (c >= '0' && c <= '9') digits += c;
  }
  return digits.size() - std::min(digits.find_first_not_of('0'), digits.size());
}

TEST(Simulate, WritesStatesWithTheColumnsOfTheContract) {
  const CommandResult result = simulate({scene_path, "--times", "0.5,1,1.5", "--states", "-", "--quiet"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_EQ(result.err, "");
  const std::vector<std::string> lines = split(result.out, '\n');
  ASSERT_EQ(lines.size(), 4U);
  EXPECT_EQ(lines[0], "t,x,y,qx,qy,qz,qw,vx,vy,wx,wy,wz,stage,mode,region");
  for (std::size_t i = 1; i < lines.size(); ++i) EXPECT_EQ(split(lines[i], ',').size(), 15U);
  EXPECT_EQ(lines[1].rfind("0.5,-0.5,0.125,", 0), 0U) << lines[1];
  EXPECT_TRUE(contains(lines[1], ",1,0.25,1,-40,0.5,1,free,base")) << lines[1];
}

TEST(Simulate, WritesSwitchesWithTheColumnsOfTheContract) {
  const CommandResult result = simulate({scene_path, "--duration", "2", "--switches", "-", "--quiet"});
  EXPECT_EQ(result.exit_code, 0);
  const std::vector<std::string> lines = split(result.out, '\n');
  ASSERT_EQ(lines.size(), 3U);
  EXPECT_EQ(lines[0],
            "index,t,kind,from_region,to_region,x,y,Px,Py,Lx,Ly,Lz,vx1,vy1,wx1,wy1,wz1,vx2,vy2,wx2,wy2,wz2,"
            "energy1,energy2");
  EXPECT_EQ(lines[1].rfind("0,1,applied,base,half,0,0.25,", 0), 0U) << lines[1];
  EXPECT_EQ(lines[2].rfind("1,1,released,half,base,0,0.25,0,0,0,0,0,", 0), 0U) << lines[2];
  EXPECT_EQ(split(lines[1], ',').size(), 24U);
}

TEST(Simulate, GoesOnToTheEndOfTheDurationAfterTheLastOutput) {
  const CommandResult result =
      simulate({scene_path, "--duration", "1.5", "--rate", "0.8", "--switches", "-", "--timing"});
  EXPECT_EQ(split(result.out, '\n').size(), 3U)
      << result.out;  // the switches are at t = 1, the last output at 1.25
  EXPECT_TRUE(contains(result.err, "\"simulated_s\": 1.5,")) << result.err;
  EXPECT_TRUE(contains(result.err, "\"switches\": 2,")) << result.err;
}

TEST(Simulate, SeesSwitchesBehindTheLastOutput) {
  const CommandResult result =
      simulate({scene_path, "--duration", "1.5", "--rate", "0.5", "--switches", "-", "--quiet"});
  EXPECT_EQ(split(result.out, '\n').size(), 3U) << result.out;
}

TEST(Simulate, LeavesATableAloneOnStandardOutput) {
  const CommandResult result =
      simulate({scene_path, "--times", "1", "--states", "-", "--explain", "--timing"});
  EXPECT_EQ(split(result.out, '\n').size(), 2U) << result.out;
  EXPECT_TRUE(contains(result.err, "The scene requires"));
  EXPECT_TRUE(contains(result.err, "\"outputs\": 1,"));
}

TEST(Simulate, RefusesToWriteTwoTablesToOneFileOrOverTheScene) {
  const TemporaryFile file("one.csv");
  const std::size_t slash = file.path().rfind('/');
  const std::string again = file.path().substr(0, slash) + "/." + file.path().substr(slash);
  CommandResult result = simulate({scene_path, "--states", file.path(), "--switches", again});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_TRUE(contains(result.err, "--switches: \"" + again + "\" is refused")) << result.err;

  const TemporaryFile scene("scene.yaml");
  const std::string text = "sphere: {mass: 1, radius: 1, body: solid}\n";
  scene.fill(text);
  for (const char* option : {"--states", "--switches"}) {
    result = simulate({scene.path(), option, scene.path()});
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_TRUE(contains(result.err, std::string(option) + ": ")) << result.err;
  }
  EXPECT_EQ(simulate({scene.path(), "--quiet"}).exit_code, 0) << "the scene is still there";
}

TEST(Simulate, WritesNumbersThatGiveBackEveryBit) {
  const std::vector<std::string> rows =
      split(simulate({scene_path, "--times", "0.3,1.7", "--states", "-", "--quiet"}).out, '\n');
  ASSERT_EQ(rows.size(), 3U);
  Simulation simulation(scene::read_scene(scene::tree_from_yaml_file(scene_path)));
  for (std::size_t i = 1; i < rows.size(); ++i) {
    const std::vector<std::string> row = split(rows[i], ',');
    simulation.advance_to(number(row[0]), {});
    const State& state = simulation.state();
    const double expected[] = {state.time,
                               state.position.x(),
                               state.position.y(),
                               state.orientation.x(),
                               state.orientation.y(),
                               state.orientation.z(),
                               state.orientation.w(),
                               state.twist.velocity.x(),
                               state.twist.velocity.y(),
                               state.twist.angular_velocity.x(),
                               state.twist.angular_velocity.y(),
                               state.twist.angular_velocity.z()};
    for (std::size_t k = 0; k < 12; ++k) {
      EXPECT_EQ(number(row[k]), expected[k]) << row[k];
      EXPECT_LE(significant_digits(row[k]), 17U) << row[k];
    }
  }
}

TEST(Simulate, HasTheStateAfterTheSwitchAtItsInstant) {
  const std::vector<std::string> rows =
      split(simulate({scene_path, "--times", "1", "--states", "-", "--quiet"}).out, '\n');
  ASSERT_EQ(rows.size(), 2U);
  EXPECT_NEAR(number(split(rows[1], ',')[7]), -11.0 / 7, 1e-14);
}

TEST(Simulate, GivesOutputsFromZeroToTheDurationBothIncluded) {
  const std::vector<std::string> rows = split(
      simulate({scene_path, "--duration", "0.5", "--rate", "10", "--states", "-", "--quiet"}).out, '\n');
  ASSERT_EQ(rows.size(), 7U);
  for (std::size_t i = 0; i < 6; ++i)
    EXPECT_EQ(number(split(rows[i + 1], ',')[0]), static_cast<double>(i) / 10);
}

TEST(Simulate, GivesAThousandAndOneOutputsUnlessAskedForOthers) {
  const std::vector<std::string> rows = split(simulate({scene_path, "--states", "-", "--quiet"}).out, '\n');
  ASSERT_EQ(rows.size(), 1U + 1001U);
  EXPECT_EQ(rows.back().rfind("10,", 0), 0U);
}

TEST(Simulate, WritesTheSwitchesWhenNothingElseIsAskedFor) {
  const CommandResult result = simulate({scene_path});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_EQ(result.out.rfind("index,t,kind,", 0), 0U);
  EXPECT_TRUE(contains(result.err, "1001 outputs up to t = 10 s, 2 switches")) << result.err;
}

TEST(Simulate, WritesBothTablesToFiles) {
  const TemporaryFile states("states.csv");
  const TemporaryFile switches("switches.csv");
  const CommandResult result = simulate(
      {scene_path, "--times", "0,2", "--states", states.path(), "--switches", switches.path(), "--quiet"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_EQ(result.out, "");
  EXPECT_EQ(states.text(), simulate({scene_path, "--times", "0,2", "--states", "-", "--quiet"}).out);
  EXPECT_EQ(switches.text(), simulate({scene_path, "--times", "0,2", "--switches", "-", "--quiet"}).out);
}

TEST(Simulate, IsTheSameAtAnyRate) {
  const auto last = [](const char* rate) {
    return split(simulate({scene_path, "--duration", "3", "--rate", rate, "--states", "-", "--quiet"}).out,
                 '\n')
        .back();
  };
  EXPECT_EQ(last("1"), last("1000"));
}

TEST(Simulate, QuotesNamesWithCommasAndQuotes) {
  const TemporaryFile scene("names.yaml");
  scene.fill(
      "sphere: {mass: 1, radius: 1, body: solid}\n"
      "surface: {regions: [{name: 'a, \"b\"', circle: {center: [0, 0], radius: 1}, law: rough}]}\n");
  const CommandResult result = simulate({scene.path(), "--times", "0", "--states", "-", "--quiet"});
  EXPECT_TRUE(contains(result.out, ",3,resting,\"a, \"\"b\"\"\"\n")) << result.out;
}

TEST(Simulate, ExplainsWhatTheSceneRequiresAndWhatNot) {
  const CommandResult result = simulate({scene_path, "--explain", "--quiet"});
  EXPECT_EQ(result.exit_code, 0);
  for (const char* part :
       {"The scene requires", "It does not require", "1 region", "stage 1", "stage 2", "stage 3",
        "Method: exact, chosen by auto", "2e-16 of the angle", "relative error is 1e-09"}) {
    EXPECT_TRUE(contains(result.out, part)) << part << " is not in\n" << result.out;
  }
}

TEST(Simulate, ExplainsThatAnExactMethodWasAskedFor) {
  const CommandResult result = simulate({scene_path, "--explain", "--method", "exact", "--accuracy", "1e-6"});
  EXPECT_TRUE(contains(result.out, "Method: exact, as requested")) << result.out;
  EXPECT_TRUE(contains(result.out, "relative error is 1e-06")) << result.out;
}

TEST(Simulate, ExplainsThatWithoutRoughGroundNothingSwitches) {
  const TemporaryFile scene("smooth.yaml");
  scene.fill("sphere: {mass: 1, radius: 1, body: solid}\n");
  const CommandResult result = simulate({scene.path(), "--explain"});
  EXPECT_TRUE(contains(result.out, "All ground is smooth")) << result.out;
  EXPECT_FALSE(contains(result.out, "stage 2")) << result.out;
}

TEST(Simulate, PrintsItsTimingAsOneLineOfJson) {
  const CommandResult result =
      simulate({scene_path, "--duration", "2", "--rate", "50", "--timing", "--quiet"});
  ASSERT_EQ(std::count(result.out.begin(), result.out.end(), '\n'), 1);
  const YAML::Node timing = YAML::Load(result.out);  // JSON is YAML
  EXPECT_EQ(timing.size(), 8U);
  EXPECT_EQ(timing["simulated_s"].as<double>(), 2);
  EXPECT_EQ(timing["outputs"].as<int>(), 101);
  EXPECT_EQ(timing["switches"].as<int>(), 2);
  EXPECT_EQ(timing["rhs_evaluations"].as<int>(), 0);
  const double wall = timing["wall_s"].as<double>();
  EXPECT_GT(wall, 0);
  EXPECT_NEAR(timing["real_time_factor"].as<double>() * wall / 2, 1, 1e-7);  // nine digits are printed
  EXPECT_NEAR(timing["ns_per_output"].as<double>() * 101 / (1e9 * wall), 1, 1e-7);
  EXPECT_GT(timing["estimated_error"].as<double>(), 0);
  EXPECT_LT(timing["estimated_error"].as<double>(), 1e-12);
}

TEST(Simulate, SaysNothingWhenQuiet) {
  const CommandResult result = simulate({scene_path, "--quiet", "--switches", "-"});
  EXPECT_EQ(result.err, "");
}

TEST(Simulate, ExitsWith3WhenTheSceneIsRefused) {
  for (const char* name : {"region_circle_radius_negative", "file_unclosed_bracket", "no_such_file"}) {
    const std::string path = std::string(TEST_DATA_DIR) + "/bad_scenes/" + name + ".yaml";
    const TemporaryFile states("untouched.csv");
    const CommandResult result = simulate({path, "--states", states.path()});
    EXPECT_EQ(result.exit_code, 3) << name;
    EXPECT_EQ(result.out, "") << name;
    EXPECT_FALSE(result.err.empty()) << name;
    EXPECT_FALSE(std::filesystem::exists(states.path())) << name;
  }
}

TEST(Simulate, SaysWhichKeyItRefuses) {
  const CommandResult result =
      simulate({std::string(TEST_DATA_DIR) + "/bad_scenes/region_circle_radius_negative.yaml"});
  EXPECT_TRUE(contains(result.err, "surface.regions[1].circle.radius: -0.5 is refused; allowed: "))
      << result.err;
}

TEST(Simulate, ExitsWith4WhenAPathCannotBeWritten) {
  for (const char* option : {"--states", "--switches"}) {
    const CommandResult result = simulate({scene_path, option, "/no/such/folder/table.csv"});
    EXPECT_EQ(result.exit_code, 4) << option;
    EXPECT_TRUE(
        contains(result.err, "\"/no/such/folder/table.csv\" cannot be written: No such file or directory"))
        << result.err;
  }
}

TEST(Simulate, ExitsWith4WhenTheDiskIsFull) {
  ASSERT_TRUE(std::filesystem::exists("/dev/full"));
  for (const char* option : {"--states", "--switches"}) {
    const CommandResult result = simulate({scene_path, option, "/dev/full"});
    EXPECT_EQ(result.exit_code, 4) << option;
    EXPECT_TRUE(contains(result.err, "\"/dev/full\" cannot be written: No space left on device"))
        << result.err;
    EXPECT_TRUE(contains(result.err, "t = ")) << "not said when: " << result.err;
  }
}

TEST(Simulate, ExitsWith4WhenStandardOutputFails) {
  std::ostringstream out;
  std::ostringstream err;
  out.setstate(std::ios::badbit);
  cli::Options options;
  options.scene = scene_path;
  options.switches = "-";
  EXPECT_EQ(cli::run(options, out, err), 4);
  EXPECT_TRUE(contains(err.str(), "standard output cannot be written")) << err.str();
}

TEST(Simulate, PrintsItsHelp) {
  const CommandResult result = simulate({"--help"});
  EXPECT_EQ(result.exit_code, 0);
  for (const char* option : {"SCENE", "--duration", "--rate", "--times", "--states", "--switches", "--method",
                             "--accuracy", "--explain", "--timing", "--quiet"}) {
    EXPECT_TRUE(contains(result.out, option)) << option;
  }
}

struct Refusal {
  friend std::ostream& operator<<(std::ostream& out, const Refusal& refusal) { return out << refusal.name; }
  const char* name;
  std::vector<std::string> arguments;
  const char* said;
};

class RefusedCommandLine : public ::testing::TestWithParam<Refusal> {};

TEST_P(RefusedCommandLine, ExitsWith2AndSaysWhy) {
  std::vector<std::string> arguments{scene_path};
  if (GetParam().arguments.empty()) arguments.clear();
  arguments.insert(arguments.end(), GetParam().arguments.begin(), GetParam().arguments.end());
  const CommandResult result = simulate(arguments);
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_EQ(result.out, "");
  EXPECT_TRUE(contains(result.err, GetParam().said)) << result.err;
}

INSTANTIATE_TEST_SUITE_P(
    Every, RefusedCommandLine,
    ::testing::Values(
        Refusal{"NoScene", {}, "simulate: SCENE is required\n"},
        Refusal{"TwoScenes", {"other.yaml"}, "other.yaml"},
        Refusal{"UnknownOption", {"--speed", "3"}, "--speed"},
        Refusal{"NegativeDuration",
                {"--duration", "-1"},
                "--duration: \"-1\" is refused; allowed: a number from 0"},
        Refusal{"DurationThatIsNoNumber", {"--duration", "long"}, "--duration: \"long\" is refused"},
        Refusal{"DurationNan", {"--duration", "nan"}, "--duration: \"nan\" is refused"},
        Refusal{"InfiniteDuration", {"--duration", "inf"}, "--duration: \"inf\" is refused"},
        Refusal{"DurationWithUnit", {"--duration", "10s"}, "--duration: \"10s\" is refused"},
        Refusal{"RateWithoutValue", {"--rate"}, "simulate: --rate: a value is required\n"},
        Refusal{"RateTwice",
                {"--rate", "1", "--rate", "2"},
                "simulate: --rate is given more than once; allowed: once\n"},
        Refusal{"ZeroRate", {"--rate", "0"}, "--rate: \"0\" is refused"},
        Refusal{"NegativeRate", {"--rate", "-5"}, "--rate: \"-5\" is refused"},
        Refusal{"TooManyOutputs", {"--duration", "1e12", "--rate", "1e9"}, "at most 1e10 outputs"},
        Refusal{"NegativeTime", {"--times", "-1,2"}, "--times: \"-1\" is refused"},
        Refusal{
            "DescendingTimes", {"--times", "1,3,2"}, "--times: \"2\" is refused; allowed: ascending times"},
        Refusal{"EmptyTime", {"--times", "1,,2"}, "--times: \"\" is refused"},
        Refusal{"NoTimes", {"--times", ""}, "--times: \"\" is refused"},
        Refusal{"NoMethod", {"--method", ""}, "method: \"\" is refused"},
        Refusal{"NoAccuracy", {"--accuracy", ""}, "accuracy: \"\" is refused"},
        Refusal{"TimesBesideDuration", {"--times", "1", "--duration", "2"}, "--times"},
        Refusal{"TimesBesideRate", {"--times", "1", "--rate", "2"}, "--times"},
        Refusal{"UnknownMethod",
                {"--method", "magic"},
                "method: \"magic\" is refused; allowed: auto, exact, euler, rk4"},
        Refusal{"AccuracyZero", {"--accuracy", "0"}, "accuracy: \"0\" is refused; allowed: a number from"},
        Refusal{"AccuracyText", {"--accuracy", "high"}, "accuracy: \"high\" is refused"},
        Refusal{"StepZero", {"--step", "0"}, "step: \"0\" is refused; allowed: a number from 1e-09 to 1e+06"},
        Refusal{"BothTablesToStandardOutput",
                {"--states", "-", "--switches", "-"},
                "is refused; allowed: a file"}),
    [](const auto& info) { return std::string(info.param.name); });

}  // namespace
}  // namespace hybrid_sphere::testing::simulate_test

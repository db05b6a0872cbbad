// What `three_stage` refuses, with its exit codes.

#include <gtest/gtest.h>

#include <filesystem>

#include "support/temporary_file.hpp"
#include "support/three_stage_line.hpp"

namespace hybrid_sphere::testing::three_stage_refusals_test {
namespace {

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

struct Refusal {
  friend std::ostream& operator<<(std::ostream& out, const Refusal& refusal) { return out << refusal.name; }
  const char* name;
  int exit_code;
  std::vector<std::string> arguments;
  const char* said;
};

class ThreeStageRefusals : public ::testing::TestWithParam<Refusal> {};

TEST_P(ThreeStageRefusals, WithItsExitCodeAndTheReason) {
  const CommandResult result = three_stage(GetParam().arguments);
  EXPECT_EQ(result.exit_code, GetParam().exit_code) << result.err;
  EXPECT_EQ(result.out, "");
  EXPECT_TRUE(contains(result.err, GetParam().said)) << result.err;
}

Refusal of_run(const char* name, int exit_code, const std::vector<std::string>& arguments, const char* said) {
  Refusal refusal{name, exit_code, {"run", "chaplygin_sleigh"}, said};
  refusal.arguments.insert(refusal.arguments.end(), arguments.begin(), arguments.end());
  return refusal;
}

INSTANTIATE_TEST_SUITE_P(
    Usage, ThreeStageRefusals,
    ::testing::Values(
        Refusal{"NoCommand",
                2,
                {},
                "three_stage: a command is required; allowed: list, explain NAME, run NAME\n"},
        Refusal{"UnknownCommand",
                2,
                {"fly"},
                "command: \"fly\" is refused; allowed: list, explain NAME, run NAME"},
        Refusal{"ExplainWithoutName", 2, {"explain"}, "three_stage: NAME is required\n"},
        Refusal{"RunWithoutName", 2, {"run"}, "NAME is required"},
        of_run("UnknownOption", 2, {"--speed", "3"}, "--speed"),
        of_run("NegativeDuration", 2, {"--duration", "-1"},
               "--duration: \"-1\" is refused; allowed: a number"),
        of_run("DurationNan", 2, {"--duration", "nan"}, "--duration: \"nan\" is refused"),
        of_run("ZeroRate", 2, {"--rate", "0"}, "--rate: \"0\" is refused"),
        of_run("TooManyOutputs", 2, {"--duration", "1e12", "--rate", "1e9"}, "at most 1e10 outputs"),
        of_run("DescendingTimes", 2, {"--times", "1,0"},
               "--times: \"0\" is refused; allowed: ascending times"),
        of_run("TimesBesideDuration", 2, {"--times", "1", "--duration", "2"}, "--times"),
        of_run("AccuracyTooSmall", 2, {"--accuracy", "1e-20"},
               "--accuracy: \"1e-20\" is refused; allowed: a"),
        of_run("AccuracyText", 2, {"--accuracy", "high"}, "--accuracy: \"high\" is refused"),
        of_run("NoSteps", 2, {"--most-steps", "0"},
               "--most-steps: \"0\" is refused; allowed: a number from 1 to 1e+15"),
        of_run("HalfAStep", 2, {"--most-steps", "1.5"},
               "--most-steps: \"1.5\" is refused; allowed: a whole number from 1 to 1e+15"),
        of_run("TooManySteps", 2, {"--most-steps", "1e16"}, "--most-steps: \"1e16\" is refused"),
        of_run("StepsText", 2, {"--most-steps", "many"}, "--most-steps: \"many\" is refused"),
        of_run("StepOfNoLength", 2, {"--longest-step", "0"},
               "--longest-step: \"0\" is refused; allowed: a number from 1e-100 to 1e+12"),
        of_run("StepBackwards", 2, {"--longest-step", "-1"}, "--longest-step: \"-1\" is refused"),
        of_run("StepNan", 2, {"--longest-step", "nan"}, "--longest-step: \"nan\" is refused"),
        of_run("UnknownDerivatives", 2, {"--derivatives", "numeric"},
               "--derivatives: \"numeric\" is refused; allowed: automatic, by_hand"),
        of_run("BothTablesToStandardOutput", 2, {"--states", "-", "--switches", "-"}, "allowed: a file"),
        of_run("EmptyFile", 2, {"--states", ""}, "--states: \"\" is refused"),
        Refusal{"OptionInsteadOfCommand",
                2,
                {"--rate", "3"},
                "three_stage: a command is required; allowed: list"},
        of_run("SetWithoutArgument", 2, {"--set", "m=1", "--set"},
               "three_stage: --set: a value is required\n"),
        of_run("SetWithoutValue", 2, {"--set", "m"}, "--set: \"m\" is refused; allowed: KEY=VALUE"),
        of_run("SetWithoutKey", 2, {"--set", "=1"}, "--set: \"=1\" is refused; allowed: KEY=VALUE"),
        of_run("SetTwice", 2, {"--set", "m=1", "--set", "m=2"}, "--set: \"m=2\" is refused; allowed: each")),
    [](const auto& info) { return std::string(info.param.name); });

INSTANTIATE_TEST_SUITE_P(
    Systems, ThreeStageRefusals,
    ::testing::Values(Refusal{"ExplainUnknown", 3, {"explain", "sledge"}, "there is no system \"sledge\""},
                      Refusal{"RunUnknown", 3, {"run", "sledge"}, "there is no system \"sledge\""},
                      of_run("SetUnknownKey", 3, {"--set", "mass=1"},
                             "--set: \"mass=1\" is refused; allowed: m, I, a, "),
                      of_run("SetText", 3, {"--set", "m=heavy"},
                             "--set m: \"heavy\" is refused; allowed: a number from 1e-09"),
                      of_run("SetNothing", 3, {"--set", "m="}, "--set m: \"\" is refused"),
                      of_run("SetNan", 3, {"--set", "m=nan"}, "--set m: \"nan\" is refused"),
                      of_run("SetInfinite", 3, {"--set", "x=inf"}, "--set x: \"inf\" is refused"),
                      of_run("SetOverflow", 3, {"--set", "x=1e999"}, "--set x: \"1e999\" is refused"),
                      of_run("SetOutOfRange", 3, {"--set", "m=-1"},
                             "--set m: \"-1\" is refused; allowed: a number from 1e-09"),
                      of_run("SetWithUnit", 3, {"--set", "m=2kg"}, "--set m: \"2kg\" is refused")),
    [](const auto& info) { return std::string(info.param.name); });

TEST(ThreeStageRefusal, WithoutTouchingAFile) {
  const TemporaryFile file("untouched.csv");
  file.fill("precious\n");
  three_stage({"run", "sledge", "--states", file.path()});
  three_stage({"run", "rolling_disk", "--set", "m=-1", "--states", file.path()});
  three_stage({"run", "visiting_particle", "--set", "y=0.25", "--set", "z_dot=2", "--states", file.path()});
  EXPECT_EQ(file.text(), "precious\n");
}

TEST(ThreeStageRefusal, TwoTablesInOneFile) {
  const TemporaryFile file("both.csv");
  const std::size_t slash = file.path().rfind('/');
  const std::string again = file.path().substr(0, slash) + "/." + file.path().substr(slash);
  const CommandResult result =
      three_stage({"run", "rolling_disk", "--states", file.path(), "--switches", again});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_TRUE(contains(result.err, "--switches: \"" + again + "\" is refused")) << result.err;
  EXPECT_FALSE(std::filesystem::exists(file.path()));
}

}  // namespace
}  // namespace hybrid_sphere::testing::three_stage_refusals_test

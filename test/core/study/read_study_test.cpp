// What a study file is read as, and with which words everything else is refused.

#include <gtest/gtest.h>

#include <filesystem>

#include "core/study/study_keys.hpp"
#include "study/columns.hpp"
#include "study/study.hpp"
#include "support/temporary_file.hpp"

namespace hybrid_sphere::testing::read_study_test {
namespace {

TEST(ReadStudy, TakesAStudyWithWhatItMustHave) {
  const Study study = read_study_text(Keys().yaml());
  EXPECT_EQ(study.text, Keys().yaml());
  EXPECT_EQ(study.scene_text, "");
  EXPECT_EQ(study.runs, 12U);
  EXPECT_EQ(study.seed, 0U);
  EXPECT_EQ(study.sampling, Sampling::random);
  EXPECT_EQ(study.duration, 2);
  ASSERT_EQ(study.variables.size(), 1U);
  EXPECT_EQ(study.variables[0].path, "sphere.mass");
  EXPECT_EQ(study.keep.end, std::vector<StateField>{StateField::position});
  EXPECT_TRUE(study.keep.times.empty() && study.keep.at.empty() && study.keep.entered.empty());
  EXPECT_FALSE(study.keep.switches);
  EXPECT_FALSE(study.summarize);
  EXPECT_FALSE(study.sensitivity);
  EXPECT_EQ(scene_of(study, study.scene_tree).surface.regions.size(), 2U);
}

TEST(ReadStudy, TakesEveryKey) {
  const Study study = read_study_text(
      Keys()
          .set("runs", "1000")
          .set("seed", "9007199254740991")
          .set("sample", "latin_hypercube")
          .set("chunk", "7")
          .set("vary",
               "{sphere.mass: {normal: {mean: 2, deviation: 0.1}}, 'gravity[0]': {normal: {mean: 0, "
               "deviation: "
               "2}}}")
          .set("correlate",
               "[{variables: [sphere.mass, 'gravity[0]'], covariance: [[0.01, 0.02], [0.02, 4]]}]")
          .set("summarize", "{quantiles: [0, 0.5, 1], histogram: 20}")
          .set("keep",
               "{end: [position, velocity, angular_velocity, orientation, slip, energy, stage, mode, "
               "region], at: "
               "{times: [0, 1, 2], fields: [energy]}, switches: {first: 4}, entered: [ice, base], extremes: "
               "{of: "
               "[speed, energy_lost], instants: 10}}")
          .yaml());
  EXPECT_EQ(study.seed, 9007199254740991U);
  EXPECT_EQ(study.sampling, Sampling::latin_hypercube);
  EXPECT_EQ(study.chunk, 7U);
  ASSERT_EQ(study.correlations.size(), 1U);
  EXPECT_EQ(study.correlations[0].variables, (std::vector<std::size_t>{0, 1}));
  // Of [[0.01, 0.02], [0.02, 4]]: 0.1, 0.2, and the root of 4 - 0.2^2. Roundings of 1e-16.
  const std::vector<double>& lower = study.correlations[0].lower;
  EXPECT_NEAR(lower[0], 0.1, 1e-16);
  EXPECT_NEAR(lower[2], 0.2, 1e-15);
  EXPECT_NEAR(lower[3], std::sqrt(3.96), 1e-15);
  EXPECT_EQ(study.summarize->quantiles, (std::vector<double>{0, 0.5, 1}));
  EXPECT_EQ(study.summarize->histogram, 20U);
  EXPECT_EQ(study.keep.end.size(), 9U);
  EXPECT_EQ(study.keep.times, (std::vector<double>{0, 1, 2}));
  EXPECT_EQ(study.keep.switches, 4U);
  EXPECT_EQ(study.keep.entered, (std::vector<std::string>{"ice", "base"}));
  EXPECT_EQ(study.keep.extremes, (std::vector<Extreme>{Extreme::speed, Extreme::energy_lost}));
  EXPECT_EQ(study.keep.instants, 10U);
}

TEST(ReadStudy, TakesAGridOfLevelsAndOfValues) {
  const Study study = read_study_text(
      Keys()
          .set("runs", "")
          .set("sample", "grid")
          .set("vary", "{sphere.mass: {uniform: [1, 2], levels: 5}, 'gravity[0]': {values: [0, 1, 2]}}")
          .yaml());
  EXPECT_EQ(study.runs, 15U);
  EXPECT_EQ(study.variables[0].levels, 5U);
  EXPECT_EQ(study.variables[1].levels, 3U);
}

TEST(ReadStudy, TakesOneRunOfDurationZero) {
  const Study study = read_study_text(Keys()
                                          .set("runs", "1")
                                          .set("duration", "0")
                                          .set("keep", "{at: {times: [0], fields: [position]}}")
                                          .yaml());
  EXPECT_EQ(study.runs, 1U);
  EXPECT_EQ(study.keep.times, std::vector<double>{0});
}

TEST(ReadStudy, RefusesUnknownAndMissingKeys) {
  const std::string known =
      "scene, runs, seed, sample, duration, vary, correlate, keep, summarize, sensitivity, chunk";
  expect_refused("rnus", "3", "rnus: an unknown key is refused (did you mean runs?); allowed: " + known);
  expect_refused("runs", "", "runs: is missing; allowed: a number from 1 to 1e+12");
  expect_refused("duration", "", "duration: is missing; allowed: a number from 0 to 1e+12 [s]");
  expect_refused("vary", "",
                 "vary: is missing; allowed: a map from paths of the scene's numbers to distributions");
  expect_refused(
      "keep", "",
      "keep: is missing; allowed: a map of what each run leaves: end, at, switches, entered, extremes");
  EXPECT_EQ(refusal_of("runs: 1"), "scene: is missing; allowed: a scene, or the name of its file");
  EXPECT_EQ(refusal_of(Keys().yaml() + "runs: 3\n"), "runs: a second value" + is_refused + "each key once");
  EXPECT_EQ(refusal_of("[1, 2]"), "study: [1, 2]" + is_refused + "a map of keys");
}

TEST(ReadStudy, RefusesNumbersOfRunsSeedsAndChunks) {
  expect_refused("runs", "0", "runs: 0" + is_refused + "a number from 1 to 1e+12");
  expect_refused("runs", "-5", "runs: -5" + is_refused + "a number from 1 to 1e+12");
  expect_refused("runs", "1e13", "runs: 1e+13" + is_refused + "a number from 1 to 1e+12");
  expect_refused("runs", "1.5", "runs: 1.5" + is_refused + "a whole number, a number from 1 to 1e+12");
  expect_refused("runs", "many", "runs: \"many\"" + is_refused + "a number from 1 to 1e+12");
  expect_refused("runs", ".nan", "runs: nan" + is_refused + "a number from 1 to 1e+12");
  expect_refused("seed", "9007199254740992",
                 "seed: 9007199254740992" + is_refused + "a number from 0 to 9007199254740991");
  expect_refused("seed", "-1", "seed: -1" + is_refused + "a number from 0 to 9007199254740991");
  expect_refused("chunk", "0", "chunk: 0" + is_refused + "a number from 1 to 1e+06");
  expect_refused("chunk", "2e6", "chunk: 2e+06" + is_refused + "a number from 1 to 1e+06");
  expect_refused("duration", "-1", "duration: -1" + is_refused + "a number from 0 to 1e+12 [s]");
  expect_refused("duration", "[1]", "duration: [1]" + is_refused + "a number from 0 to 1e+12 [s]");
  expect_refused("sample", "sobl", "sample: \"sobl\"" + is_refused + "random, latin_hypercube, sobol, grid");
  expect_refused("sample", "[sobol]",
                 "sample: [\"sobol\"]" + is_refused + "random, latin_hypercube, sobol, grid");
}

TEST(ReadStudy, RefusesVariables) {
  const std::string form = "a map from paths of the scene's numbers to distributions";
  expect_refused("vary", "{}", "vary: a map with 0 keys" + is_refused + form);
  expect_refused("vary", "[sphere.mass]", "vary: [\"sphere.mass\"]" + is_refused + form);
  expect_refused("vary", "{sphere.mass: {uniform: [1, 2]}, sphere.mass: {uniform: [1, 2]}}",
                 "vary.sphere.mass: the same path twice" + is_refused + "each path once");
  expect_refused("vary", "{sphere.mass: {uniform: [2, 1]}}",
                 "vary.sphere.mass.uniform: [2, 1]" + is_refused + "[low, high] with low < high");
  expect_refused(
      "vary", "{sphere.mass: {unifrom: [1, 2]}}",
      "vary.sphere.mass.unifrom: an unknown key is refused (did you mean uniform?); allowed: uniform, "
      "log_uniform, normal, truncated_normal, lognormal, triangular, values");
  expect_refused("vary", "{sphere.mas: {uniform: [1, 2]}}",
                 "vary.sphere.mas: \"sphere.mas\"" + is_refused +
                     "the path of a number in the scene; the nearest one is sphere.mass");
  expect_refused(
      "vary", "{\"a\\nb\": {}}",
      "vary.a?b: no distribution" + is_refused +
          "exactly one of uniform, log_uniform, normal, truncated_normal, lognormal, triangular, values");
}

TEST(ReadStudy, RefusesLevels) {
  const auto grid = [](const std::string& vary) {
    return Keys().set("runs", "").set("sample", "grid").set("vary", vary);
  };
  expect_refused("vary", "{sphere.mass: {uniform: [1, 2], levels: 3}}",
                 "vary.sphere.mass.levels: 3" + is_refused + "not to give this key: sample is no grid");
  expect_refused(
      grid("{sphere.mass: {uniform: [1, 2]}}"),
      "vary.sphere.mass.levels: is missing; allowed: the number of levels of a grid, a number from 1 to "
      "1e+06");
  expect_refused(grid("{sphere.mass: {values: [1, 2], levels: 2}}"),
                 "vary.sphere.mass.levels: 2" + is_refused + "not to give this key: values are the levels");
  expect_refused(grid("{sphere.mass: {uniform: [1, 2], levels: 0}}"),
                 "vary.sphere.mass.levels: 0" + is_refused + "a number from 1 to 1e+06");
  expect_refused(grid("{sphere.mass: {uniform: [1, 2], levels: 2, levels: 3}}"),
                 "vary.sphere.mass.levels: a second value" + is_refused + "each key once");
  expect_refused(grid("{sphere.mass: {uniform: [1, 2], levels: 4}}").set("runs", "5"),
                 "runs: 5" + is_refused + "4, the points of the grid, or not to give this key");
  expect_refused(
      grid("{sphere.mass: {uniform: [1, 2], levels: 1e6}, 'gravity[0]': {uniform: [1, 2], levels: 1e6}, "
           "'gravity[1]': {uniform: [1, 2], levels: 2}}"),
      "vary: a grid of 2e+12 points" + is_refused + "at most 1e12 points");
}

TEST(ReadStudy, RefusesWhatIsKept) {
  const std::string fields =
      "position, velocity, angular_velocity, orientation, slip, energy, stage, mode, region";
  expect_refused("keep", "3", "keep: 3" + is_refused + "a map of keys");
  expect_refused("keep", "{endd: [position]}",
                 "keep.endd: an unknown key is refused (did you mean end?); allowed: end, at, switches, "
                 "entered, extremes");
  expect_refused("keep", "{end: position}", "keep.end: \"position\"" + is_refused + "a list of " + fields);
  expect_refused("keep", "{end: [position, place]}", "keep.end[1]: \"place\"" + is_refused + fields);
  expect_refused("keep", "{end: [slip, slip]}", "keep.end[1]: \"slip\"" + is_refused + "each word once");
  expect_refused("keep", "{at: {fields: [slip]}}", "keep.at.times: is missing; allowed: a list of times [s]");
  expect_refused("keep", "{at: {times: [1]}}",
                 "keep.at.fields: is missing; allowed: a list of what is kept at these times");
  expect_refused("keep", "{switches: {first: 1.5}}",
                 "keep.switches.first: 1.5" + is_refused + "a whole number, a number from 0 to 10000");
  expect_refused("keep", "{switches: {first: 10001}}",
                 "keep.switches.first: 10001" + is_refused + "a number from 0 to 10000");
  expect_refused("keep", "{switches: 4}", "keep.switches: 4" + is_refused + "a map of keys");
  expect_refused("keep", "{extremes: [sped]}",
                 "keep.extremes[0]: \"sped\"" + is_refused + "speed, spin, slip, energy_lost");
  expect_refused("keep", "{extremes: {instants: 4}}",
                 "keep.extremes.of: is missing; allowed: a list of speed, spin, slip, energy_lost");
  expect_refused("keep", "{extremes: {of: [spin], instants: -1}}",
                 "keep.extremes.instants: -1" + is_refused + "a number from 0 to 10000");
}

TEST(ReadStudy, RefusesTimes) {
  const auto at = [](const std::string& times) { return "{at: {times: " + times + ", fields: [slip]}}"; };
  const std::string range = "a number from 0 to 2 [s], ascending, up to the duration";
  expect_refused("keep", at("[]"), "keep.at.times: []" + is_refused + "a list of 1 to 10000 times " + range);
  expect_refused("keep", at("1"), "keep.at.times: 1" + is_refused + "a list of 1 to 10000 times " + range);
  expect_refused("keep", at("[1, 1]"), "keep.at.times[1]: 1" + is_refused + "times in ascending order");
  expect_refused("keep", at("[1, 0.5]"), "keep.at.times[1]: 0.5" + is_refused + "times in ascending order");
  expect_refused("keep", at("[1, 2.5]"), "keep.at.times[1]: 2.5" + is_refused + range);
  expect_refused("keep", at("[-0.1]"), "keep.at.times[0]: -0.1" + is_refused + range);
}

TEST(ReadStudy, RefusesRegions) {
  expect_refused("keep", "{entered: [mat, icy]}",
                 "keep.entered[1]: \"icy\"" + is_refused +
                     "the name of a region of the scene, or base; the nearest one is \"ice\"");
  expect_refused("keep", "{entered: [3]}",
                 "keep.entered[0]: 3" + is_refused +
                     "the name of a region of the scene, or base; the nearest one is \"mat\"");
  expect_refused("keep", "{entered: [mat, mat]}",
                 "keep.entered[1]: \"mat\"" + is_refused + "each region once");
  expect_refused("keep", "{entered: mat}",
                 "keep.entered: \"mat\"" + is_refused + "a list of names of regions");
  expect_refused("keep", "{entered: []}", "keep.entered: []" + is_refused + "a list of names of regions");
}

TEST(ReadStudy, RefusesSummaries) {
  expect_refused("summarize", "{quantile: [1]}",
                 "summarize.quantile: an unknown key is refused (did you mean quantiles?); allowed: "
                 "quantiles, histogram");
  expect_refused("summarize", "{quantiles: 0.5}",
                 "summarize.quantiles: 0.5" + is_refused + "a list of up to 10000 probabilities");
  expect_refused("summarize", "{quantiles: [0.5, 1.5]}",
                 "summarize.quantiles[1]: 1.5" + is_refused + "a number from 0 to 1");
  expect_refused("summarize", "{histogram: 1e5}",
                 "summarize.histogram: 100000" + is_refused + "a number from 0 to 10000");
}

TEST(ReadStudy, RefusesSensitivity) {
  const auto sobol = [] { return Keys().set("sensitivity", "sobol"); };
  EXPECT_EQ(refusal_of(sobol().yaml()), "accepted");
  expect_refused("sensitivity", "morris", "sensitivity: \"morris\"" + is_refused + "sobol");
  expect_refused(
      sobol().set("runs", "10"),
      "runs: 10" + is_refused + "for Sobol' indices a multiple of 3, the number of variables and 2");
  expect_refused(sobol()
                     .set("runs", "")
                     .set("sample", "grid")
                     .set("vary", "{sphere.mass: {uniform: [1, 2], levels: 3}}"),
                 "sensitivity: this key together with sample: grid" + is_refused +
                     "samples that are drawn: random, latin_hypercube, sobol");
  expect_refused(
      sobol()
          .set("vary",
               "{sphere.mass: {normal: {mean: 2, deviation: 1}}, 'gravity[0]': {normal: {mean: 0, deviation: "
               "1}}}")
          .set("correlate", "[{variables: [sphere.mass, 'gravity[0]'], covariance: [[1, 0], [0, 1]]}]"),
      "sensitivity: sobol together with correlate" + is_refused +
          "independent variables: Sobol' indices of others are not defined");
}

TEST(ReadStudy, RefusesAScene) {
  const std::string rest = Keys().yaml().substr(scene.size());
  EXPECT_EQ(refusal_of("scene: 3\n" + rest), "scene: 3" + is_refused + "a scene, or the name of its file");
  EXPECT_EQ(refusal_of("scene: {sphere: {mass: -1, radius: 1, body: solid}}\n" + rest),
            "scene.sphere.mass: -1" + is_refused + "a number from 1e-60 to 1e+60 [kg]");
  EXPECT_EQ(refusal_of("scene: not_there.yaml\n" + rest),
            "scene file \"not_there.yaml\": cannot be read: No such file or directory");
  EXPECT_EQ(refusal_of("scene: /\n" + rest), "scene file \"/\": cannot be read: Is a directory");
}

TEST(ReadStudy, ReadsTheSceneOfAnotherFileBesideIt) {
  const TemporaryFile scene_file("scene.yaml");
  const TemporaryFile study_file("study.yaml");
  const std::string name = std::filesystem::path(scene_file.path()).filename().string();
  const std::string rest = Keys().yaml().substr(scene.size());
  scene_file.fill("sphere: {mass: 1, radius: 0.5, body: solid}\n");
  study_file.fill("scene: " + name + "\n" + rest);
  const Study study = read_study_file(study_file.path());
  EXPECT_EQ(study.text, study_file.text());
  EXPECT_EQ(study.scene_text, scene_file.text());
  EXPECT_EQ(study.scene_directory, std::filesystem::path(scene_file.path()).parent_path().string());
  scene_file.fill("sphere: {mass: 0, radius: 0.5, body: solid}\n");
  try {
    read_study_file(study_file.path());
    ADD_FAILURE() << "accepted";
  } catch (const scene::SceneError& error) {
    EXPECT_EQ(error.what(), "scene file \"" + scene_file.path() + "\": sphere.mass: 0" + is_refused +
                                "a number from 1e-60 to 1e+60 [kg]");
  }
}

std::string refusal_of_file(const std::string& file) {
  try {
    read_study_file(file);
  } catch (const scene::SceneError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(ReadStudy, SaysThatAStudyFileCannotBeRead) {
  EXPECT_EQ(refusal_of_file("/not/there.yaml"),
            "study file \"/not/there.yaml\": cannot be read: No such file or directory");
  EXPECT_EQ(refusal_of_file("/dev/zero").rfind("study file \"/dev/zero\": larger than the allowed ", 0), 0U);
  const TemporaryFile file("study.yaml");
  file.fill("a: [\n");
  EXPECT_EQ(refusal_of_file(file.path()).rfind("study file \"" + file.path() + "\": not YAML: ", 0), 0U);
  file.fill("");
  EXPECT_EQ(refusal_of_file(file.path()), "study file \"" + file.path() + "\": empty");
}

std::uint64_t bytes_of_run(const Study& study) {
  std::uint64_t bytes = 0;
  for (const Column& column : columns_of(study, scene_of(study, study.scene_tree)).all)
    bytes += column.bytes();
  return bytes;
}

/// A run leaves a million bytes or so.
std::string much() {
  std::string times;
  for (int i = 0; i < 10000; ++i) times += (i > 0 ? ", " : "") + std::to_string(i);
  return "{at: {times: [" + times +
         "], fields: [position, velocity, angular_velocity, orientation, slip, energy]}}";
}

TEST(ReadStudy, TakesFewerRunsTogetherWhereEachLeavesMuch) {
  EXPECT_EQ(read_study_text(Keys().set("runs", "1").yaml()).chunk, 16U);
  EXPECT_EQ(read_study_text(Keys().set("runs", "1e6").yaml()).chunk, 977U);
  EXPECT_EQ(read_study_text(Keys().set("runs", "1e12").yaml()).chunk, 4096U);
  const Study study =
      read_study_text(Keys().set("runs", "1e7").set("duration", "10000").set("keep", much()).yaml());
  EXPECT_GT(bytes_of_run(study), 1000000U);
  EXPECT_LE(study.chunk * bytes_of_run(study), 1U << 24U);
  EXPECT_GE(study.chunk, 8U);
}

TEST(ReadStudy, RefusesAChunkThatIsTooLargeForAMessage) {
  EXPECT_EQ(read_study_text(Keys().set("chunk", "1e6").yaml()).chunk, 1000000U);
  const std::string message =
      refusal_of(Keys().set("duration", "10000").set("keep", much()).set("chunk", "2000").yaml());
  EXPECT_EQ(message.rfind("chunk: 2000 is refused; allowed: up to ", 0), 0U) << message;
}

}  // namespace
}  // namespace hybrid_sphere::testing::read_study_test

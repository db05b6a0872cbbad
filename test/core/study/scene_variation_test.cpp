// A scene whose numbers are changed in place is the one that a file with
// these numbers describes.

#include "simulation/scene_variation.hpp"

#include <gtest/gtest.h>

#include <random>

#include "core/study/scene_paths.hpp"
#include "support/scene_numbers.hpp"

namespace hybrid_sphere::testing::scene_variation_test {
namespace {

/// A number and the indices that it may have.
struct Field {
  std::string path;
  int size;  // 0: no list
};

const std::vector<Field>& fields_of_rich_scene() {
  static const std::vector<Field> fields = {
      {"sphere.mass", 0},
      {"sphere.radius", 0},
      {"sphere.gyration_radius", 0},
      {"initial_state.position", 2},
      {"initial_state.velocity", 2},
      {"initial_state.angular_velocity", 3},
      {"gravity", 3},
      {"wrench.force", 2},
      {"wrench.torque", 3},
      {"drag.translational", 0},
      {"drag.rotational", 0},
      {"drag.quadratic", 0},
      {"spring.stiffness", 0},
      {"spring.center", 2},
      {"solver.accuracy", 0},
      {"solver.step", 0},
      {"surface.base.friction", 0},
      {"surface.base.rolling_resistance", 0},
      {"surface.base.spin_friction", 0},
      {"surface.base.belt", 2},
      {"surface.regions[half].rolling_resistance", 0},
      {"surface.regions[half].spin_friction", 0},
      {"surface.regions[half].belt", 2},
      {"surface.regions[half].half_plane.point", 2},
      {"surface.regions[half].half_plane.normal", 2},
      {"surface.regions[disc].friction", 0},
      {"surface.regions[disc].rolling_resistance", 0},
      {"surface.regions[disc].spin_friction", 0},
      {"surface.regions[disc].turntable.rate", 0},
      {"surface.regions[disc].turntable.center", 2},
      {"surface.regions[disc].circle.center", 2},
      {"surface.regions[disc].circle.radius", 0},
      {"surface.regions[odd.name[3]].rolling_resistance", 0},
      {"surface.regions[odd.name[3]].belt", 2},
      {"surface.regions[odd.name[3]].circle.center", 2},
      {"surface.regions[odd.name[3]].circle.radius", 0},
      {"surface.regions[reversed].rolling_resistance", 0},
      {"surface.regions[reversed].belt", 2},
  };
  return fields;
}

const std::vector<Field>& fields_of_poor_scene() {
  static const std::vector<Field> fields = {
      {"sphere.mass", 0},
      {"sphere.radius", 0},
      {"initial_state.position", 2},
      {"initial_state.velocity", 2},
      {"initial_state.angular_velocity", 3},
      {"gravity", 3},
      {"wrench.force", 2},
      {"wrench.torque", 3},
      {"drag.translational", 0},
      {"drag.rotational", 0},
      {"drag.quadratic", 0},
      {"spring.stiffness", 0},
      {"solver.accuracy", 0},
      {"solver.step", 0},
      {"surface.base.rolling_resistance", 0},
      {"surface.base.spin_friction", 0},
      {"surface.base.belt", 2},
      {"surface.regions[spun].half_plane.normal", 2},
  };
  return fields;
}

// Only the reader knows what they do.
const std::vector<Field> numbers_without_field = {
    {"initial_state.orientation", 4},
    {"surface.regions[patch].polygon[0]", 2},
    {"surface.regions[patch].polygon[3]", 2},
    {"surface.regions[reversed].polygon[1]", 2},
};

std::vector<std::string> paths_of(const std::vector<Field>& fields) {
  std::vector<std::string> paths;
  for (const Field& field : fields) {
    if (field.size == 0) paths.push_back(field.path);
    for (int i = 0; i < field.size; ++i) paths.push_back(field.path + "[" + std::to_string(i) + "]");
  }
  return paths;
}

std::vector<std::string> joined(std::vector<std::string> some, const std::vector<std::string>& others) {
  some.insert(some.end(), others.begin(), others.end());
  return some;
}

class RandomSamples {
 public:
  std::vector<std::string> some(const std::vector<std::string>& paths) {
    std::vector<std::string> drawn;
    std::sample(paths.begin(), paths.end(), std::back_inserter(drawn), 1 + random_() % 4, random_);
    return drawn;
  }

  /// Mostly within every range, now and then at its end or beyond it.
  double number() {
    const double others[] = {0, -0.0, -1, 1, 1e-70, 1e16, 1e300, -1e-9, 1e-12, 0.3, 1e9, 1e12};
    if (random_() % 5 == 0) return others[random_() % std::size(others)];
    return std::uniform_real_distribution<double>(1e-3, 0.2)(random_);
  }

  std::vector<double> numbers(std::size_t size) {
    std::vector<double> drawn(size);
    for (double& each : drawn) each = number();
    return drawn;
  }

 private:
  std::mt19937_64 random_{7};
};

/// The scene that a function gives, or where it refuses.
template <class Function>
std::pair<std::vector<std::uint64_t>, std::string> outcome_of(const Function& function) {
  try {
    return {numbers_of(function()), ""};
  } catch (const scene::SceneError& error) {
    return {{}, error.path()};
  }
}

/// @return  how many samples were accepted
int expect_same_as_read(const std::string& scene, const std::vector<std::string>& paths, int rounds) {
  RandomSamples random;
  int accepted = 0;
  for (int i = 0; i < rounds; ++i) {
    const std::vector<std::string> varied = random.some(paths);
    const Study study = study_of(scene, varied);
    SceneVariation variation = variation_of(study);
    for (int k = 0; k < 5; ++k) {  // also after others, and after one that is refused
      const std::vector<double> sample = random.numbers(varied.size());
      const auto in_place = outcome_of([&] { return variation.set(sample.data()), variation.scene(); });
      const auto read = outcome_of([&] { return scene_of(study, variation.tree_of(sample.data())); });
      EXPECT_EQ(in_place.first, read.first) << scene::to_yaml(variation.tree_of(sample.data()));
      // The first fault that is found may be another one.
      EXPECT_TRUE(varied.size() > 1 || in_place.second == read.second)
          << in_place.second << " and " << read.second;
      accepted += in_place.second.empty() ? 1 : 0;
    }
  }
  return accepted;
}

TEST(SceneVariation, IsTheSceneOfAFileWithTheSample) {
  const std::vector<std::string> paths = paths_of(fields_of_rich_scene());
  EXPECT_GT(expect_same_as_read(rich_scene, paths, 400), 800);
  EXPECT_GT(expect_same_as_read(rich_scene, joined(paths, paths_of(numbers_without_field)), 300), 400);
}

TEST(SceneVariation, IsTheSceneOfAFileWithTheSampleAlsoWhereTheSceneGivesLittle) {
  EXPECT_GT(expect_same_as_read(poor_scene, paths_of(fields_of_poor_scene()), 400), 800);
  std::string shell = poor_scene;
  shell.replace(shell.find("solid"), 5, "shell");
  EXPECT_GT(expect_same_as_read(shell, paths_of(fields_of_poor_scene()), 400), 800);
}

TEST(SceneVariation, FindsEveryNumberOfTheScene) {
  for (const std::string& path : paths_of(fields_of_rich_scene())) {
    const Study study = study_of(rich_scene, {path});
    SceneVariation variation = variation_of(study);
    const auto before = numbers_of(variation.scene());
    const double value = path == "gravity[2]" ? -0.1875 : 0.1875;
    variation.set(&value);
    const auto after = numbers_of(variation.scene());
    int changed = 0;
    for (std::size_t i = 0; i < before.size(); ++i) changed += before[i] != after[i] ? 1 : 0;
    EXPECT_EQ(changed, 1) << path;
  }
}

TEST(SceneVariation, KnowsWhenTheInitialStateAloneVaries) {
  const auto alone = [](const std::vector<std::string>& paths) {
    const Study study = study_of(rich_scene, paths);
    return variation_of(study).varies_initial_state_alone();
  };
  EXPECT_TRUE(alone({"initial_state.position[0]", "initial_state.angular_velocity[2]"}));
  EXPECT_FALSE(alone({"initial_state.position[0]", "sphere.mass"}));
  EXPECT_FALSE(alone({"initial_state.orientation[0]"}));
}

TEST(SceneVariation, TurnsRadiusAndGyrationRadiusOfABodyTogether) {
  const Study study = study_of(poor_scene, {"sphere.radius"});
  SceneVariation variation = variation_of(study);
  const double radius = 0.7;
  variation.set(&radius);
  EXPECT_EQ(variation.scene().sphere.gyration_radius, radius * std::sqrt(2. / 5));
}

TEST(SceneVariation, NormalizesAnOrientationAsAFileDoes) {
  const Study study = study_of(rich_scene, {"initial_state.orientation[0]"});
  SceneVariation variation = variation_of(study);
  const double value = 0.605;
  variation.set(&value);
  EXPECT_NEAR(variation.scene().initial_state.orientation.norm(), 1, 4e-16);
  EXPECT_GT(variation.scene().initial_state.orientation.x(), 0.6);
}

TEST(SceneVariation, VariesAnOrientationThatIsNotGiven) {
  const Study study = study_of(poor_scene, {"initial_state.orientation[2]"});
  SceneVariation variation = variation_of(study);
  const double value = 0.01;
  variation.set(&value);
  EXPECT_NEAR(variation.scene().initial_state.orientation.z(), 0.01, 1e-5);
}

TEST(SceneVariation, RefusesTheMethodExactWhereTheSceneHasNoClosedForm) {
  const std::string scene =
      "{sphere: {mass: 1, radius: 1, body: solid}, drag: {quadratic: 1}, solver: {method: exact}}";
  EXPECT_EQ(refusal(scene, "initial_state.velocity[0]").rfind("solver.method: exact is refused", 0), 0U);
}

TEST(SceneVariation, LeavesTheMethodExactToEachRunWhereTheSceneChanges) {
  const Study study =
      study_of("{sphere: {mass: 1, radius: 1, body: solid}, drag: {quadratic: 1}, solver: {method: exact}}",
               {"drag.quadratic"});
  SceneVariation variation = variation_of(study);
  const double none = 0;
  const double some = 1;
  EXPECT_NO_THROW(variation.set(&none));
  EXPECT_THROW(variation.set(&some), scene::SceneError);
}

std::vector<std::string> warnings_of(const std::string& scene, const std::string& path,
                                     const Distribution& distribution) {
  Study study = study_of(scene, {path});
  study.runs = 1000;
  study.variables[0].distribution = distribution;
  return warnings(study, variation_of(study));
}

TEST(SceneVariation, WarnsOfTheShareThatWillBeRefused) {
  EXPECT_TRUE(warnings_of(rich_scene, "sphere.mass", Uniform{0.1, 2}).empty());
  EXPECT_EQ(warnings_of(rich_scene, "surface.base.friction", Uniform{-1, 3}).at(0),
            "vary.surface.base.friction: a share of 0.25 of the samples will be refused; allowed: a number "
            "from 0 to "
            "1e+09");
  EXPECT_EQ(warnings_of(rich_scene, "gravity[2]", Uniform{-3, 1})
                .at(0)
                .rfind("vary.gravity[2]: a share of 0.25 of the samples will be refused", 0),
            0U);
  EXPECT_TRUE(warnings_of(rich_scene, "surface.base.friction", Uniform{0, 1e9}).empty());
}

TEST(SceneVariation, DoesNotWarnOfWhatHardlyEverHappens) {
  // Beyond five deviations 2.9e-7, beyond four 3.2e-5, of a thousand runs.
  EXPECT_TRUE(warnings_of(rich_scene, "surface.base.friction", Normal{0.5, 0.1}).empty());
  EXPECT_EQ(warnings_of(rich_scene, "surface.base.friction", Normal{0.4, 0.1}).size(), 1U);
}

TEST(SceneVariation, CountsValuesAtTheEndsOfARangeAsAllowed) {
  EXPECT_TRUE(warnings_of(rich_scene, "surface.base.friction", Values{{0, 1}, {0.5, 1}}).empty());
  EXPECT_EQ(warnings_of(rich_scene, "surface.base.friction", Values{{-1, 0, 1, 2}, {0.25, 0.5, 0.75, 1}})
                .at(0)
                .rfind("vary.surface.base.friction: a share of 0.25 of", 0),
            0U);
}

TEST(SceneVariation, RefusesADistributionOfWhichNothingIsAllowed) {
  EXPECT_THROW(warnings_of(rich_scene, "surface.base.friction", Uniform{-3, -1}), scene::SceneError);
  EXPECT_THROW(warnings_of(rich_scene, "sphere.mass", Uniform{1e70, 1e71}), scene::SceneError);
}

TEST(SceneVariation, DoesNotTakeARangeThatOtherVariablesMoveForFixed) {
  Study study = study_of(rich_scene, {"sphere.radius", "sphere.gyration_radius"});
  study.variables[0].distribution = Uniform{10, 20};
  study.variables[1].distribution = Uniform{3, 4};
  SceneVariation variation = variation_of(study);
  EXPECT_TRUE(warnings(study, variation).empty());
  const double sample[] = {10, 3};
  EXPECT_NO_THROW(variation.set(sample));
}

}  // namespace
}  // namespace hybrid_sphere::testing::scene_variation_test

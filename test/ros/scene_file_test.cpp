#include "ros/node/scene_file.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>

#include "ros/node/parameters.hpp"
#include "scene/tree_place.hpp"
#include "scene/yaml.hpp"

namespace hybrid_sphere::ros_interface::scene_file_test {
namespace {

namespace files = std::filesystem;
using scene::SceneError;
using scene::Tree;

/// A directory with the scenes of a package and one with those of a user.
class SceneFile : public ::testing::Test {
 protected:
  SceneFile() {
    char name[] = "/tmp/scene_file_test_XXXXXX";
    root_ = mkdtemp(name);
    files::create_directories(config_ = root_ / "config");
    files::create_directories(home_ = root_ / "home/my scenes");
    for (const files::path& file : {config_ / "paper.yaml", config_ / "bowling.yml", config_ / "floor.png",
                                    home_ / "paper.yaml", home_ / "mine.yml", home_ / "without_ending"})
      std::ofstream(file) << "sphere: {mass: 1, radius: 1, body: solid}\n";
  }
  ~SceneFile() override { files::remove_all(root_); }

  files::path find(const Tree& name) const { return find_scene_file(name, home_.string(), config_); }
  std::string refusal(const Tree& name) const {
    try {
      find(name);
    } catch (const SceneError& error) {
      return error.what();
    }
    return "";
  }

  files::path root_;
  files::path config_;
  files::path home_;
};

TEST_F(SceneFile, IsASceneOfThePackageByItsStem) {
  EXPECT_EQ(find("paper"), config_ / "paper.yaml");
  EXPECT_EQ(find("bowling"), config_ / "bowling.yml");
}

TEST_F(SceneFile, IsAPathFromTheWorkingDirectoryOn) {
  EXPECT_EQ(find("mine.yml"), home_ / "mine.yml");
  EXPECT_EQ(find("paper.yaml"), home_ / "paper.yaml");
  EXPECT_EQ(find("without_ending"), home_ / "without_ending");
  EXPECT_EQ(find("../../config/paper.yaml"), config_ / "paper.yaml");
  EXPECT_EQ(find((home_ / "mine.yml").string()), home_ / "mine.yml");
}

TEST_F(SceneFile, IsBelowTheHomeDirectoryAfterATilde) {
  const char* const home = std::getenv("HOME");
  const std::string before = home == nullptr ? "" : home;
  setenv("HOME", (root_ / "home").c_str(), 1);
  EXPECT_EQ(find("~/my scenes/mine.yml"), home_ / "mine.yml");
  setenv("HOME", before.c_str(), 1);
}

TEST_F(SceneFile, ThatIsNotThereIsRefusedWithTheScenesThatAre) {
  EXPECT_EQ(refusal("papper"), "scene_file: \"papper\" (there is no file " + (home_ / "papper").string() +
                                   "; did you mean paper?) is refused; allowed: the path of a file, or a "
                                   "scene of the package: bowling, paper");
  EXPECT_EQ(
      refusal("a/b.yaml")
          .rfind("scene_file: \"a/b.yaml\" (there is no file " + (home_ / "a/b.yaml").string() + ")", 0),
      0U);
  EXPECT_EQ(refusal("").rfind("scene_file: \"\"", 0), 0U);
  EXPECT_EQ(refusal(3.).rfind("scene_file: 3", 0), 0U);
}

TEST_F(SceneFile, HasKeysOfAScene) {
  const Tree tree = read_scene_keys(home_ / "mine.yml");
  EXPECT_EQ(*scene::at_place(tree, {std::string("scene_directory")}).as_text(), home_.string());
  std::ofstream(home_ / "rate.yaml") << "sphere: {mass: 1, radius: 1, body: solid}\nrate: 100\n";
  EXPECT_THROW(read_scene_keys(home_ / "rate.yaml"), SceneError);  // `simulate` refuses it, too
}

std::string merged_yaml(const std::string& under, const std::string& over) {
  return scene::to_yaml(merged(scene::tree_from_yaml(under), scene::tree_from_yaml(over)));
}

TEST(Parameters, AreMergedOverTheFile) {
  EXPECT_EQ(merged_yaml("{a: {b: 1, c: 2}, d: [1, 2]}", "{a: {c: 3, e: 4}, d: [5]}"),
            scene::to_yaml(scene::tree_from_yaml("{a: {b: 1, c: 3, e: 4}, d: [5]}")));
  EXPECT_EQ(merged_yaml("{a: 1}", "{b: {c: 2}}"), scene::to_yaml(scene::tree_from_yaml("{a: 1, b: {c: 2}}")));
}

TEST(Parameters, ThatCameFromAFileAreToldFromThoseSetByHand) {
  const auto left = [](const char* now, const char* written) {
    return scene::to_yaml(without(scene::tree_from_yaml(now), scene::tree_from_yaml(written)));
  };
  EXPECT_EQ(left("{a: {b: 1, c: 3}, d: [1], e: 5}", "{a: {b: 1, c: 2}, d: [1]}"),
            scene::to_yaml(scene::tree_from_yaml("{a: {c: 3}, e: 5}")));
  EXPECT_EQ(left("{a: {b: 1}}", "{a: {b: 1}}"), "{}\n");
}

TEST(Parameters, HaveTheValuesOfAFileAfterTheParameterServer) {
  const Tree tree =
      scene::tree_from_yaml("{a: [1, 2.5, x], b: {c: true, d: '12'}, e: [], f: [[1, 2], [3, 4]]}");
  EXPECT_EQ(scene::to_yaml(tree_from_parameters(parameters_from_tree(tree))), scene::to_yaml(tree));
}

TEST(Parameters, AreNumbersWhereOnlyYaml11TakesThemForText) {
  for (const char* text : {"1e-9", "1E5", "1e5", "1.5e5", ".5e5", "+.5", "-.5e-3", "12e+3"}) {
    XmlRpc::XmlRpcValue value;
    value["surface"]["name"] = text;
    const Tree tree = tree_from_parameters(value);
    EXPECT_TRUE(scene::at_place(tree, {std::string("surface"), std::string("name")}).as_number()) << text;
  }
  // What YAML 1.1 would take for a number has been in quotes.
  for (const char* text :
       {"12", "-3", "1.5", "1.5e-5", ".5", ".5e+5", "1.", "a", "", "1_0", "0x10", "1:30"}) {
    XmlRpc::XmlRpcValue value;
    value["surface"]["name"] = text;
    const Tree tree = tree_from_parameters(value);
    EXPECT_TRUE(scene::at_place(tree, {std::string("surface"), std::string("name")}).as_text()) << text;
  }
  XmlRpc::XmlRpcValue own;
  own["world_frame"] = "1e5";
  EXPECT_TRUE(scene::at_place(tree_from_parameters(own), {std::string("world_frame")}).as_text());
}

}  // namespace
}  // namespace hybrid_sphere::ros_interface::scene_file_test

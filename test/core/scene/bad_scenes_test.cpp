// Every file in data/bad_scenes is refused; its first line says with which words:
//   # expect: <path of the key>: <its value> is refused; allowed: <range>

#include <gtest/gtest.h>

#include <fstream>

#include "hybrid_sphere/scene/read_scene.hpp"
#include "support/files.hpp"

namespace hybrid_sphere::testing::bad_scenes_test {
namespace {

class BadScene : public ::testing::TestWithParam<std::string> {};

std::string message_of(const std::string& path) {
  try {
    scene::read_scene_file(path);
  } catch (const scene::SceneError& error) {
    return error.what();
  }
  return "";
}

TEST_P(BadScene, IsRefusedWithPathValueAndRange) {
  const std::string path = std::string(TEST_DATA_DIR) + "/bad_scenes/" + GetParam() + ".yaml";
  const std::string mark = "# expect: ";
  std::string first_line;
  std::ifstream file(path);
  std::getline(file, first_line);
  ASSERT_EQ(first_line.substr(0, mark.size()), mark);
  std::string expected = first_line.substr(mark.size());
  // What is wrong with a file, not with a key, comes with the file's name.
  if (GetParam().rfind("file_", 0) == 0) expected = "scene file \"" + path + "\": " + expected;

  const std::string message = message_of(path);
  ASSERT_FALSE(message.empty()) << "accepted";
  EXPECT_EQ(message.substr(0, expected.size()), expected) << "the whole message: " << message;
}

INSTANTIATE_TEST_SUITE_P(Every, BadScene, ::testing::ValuesIn(yaml_files("bad_scenes")),
                         [](const auto& info) { return as_test_name(info.param); });

}  // namespace
}  // namespace hybrid_sphere::testing::bad_scenes_test

// Files that are too much for the memory, or no files at all. Limits are checked before the memory is taken.

#include "scene/yaml.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>

#include "support/limited_memory.hpp"
#include "support/temporary_file.hpp"

namespace hybrid_sphere::testing::yaml_test {
namespace {

using scene::SceneError;
using scene::Tree;
using scene::tree_from_yaml;
using scene::tree_from_yaml_file;

std::string message_of(const std::string& text, const scene::YamlLimits& limits = {}) {
  try {
    tree_from_yaml(text, limits);
  } catch (const SceneError& error) {
    return error.what();
  }
  return "accepted";
}

std::string message_of_file(const std::string& path) {
  try {
    tree_from_yaml_file(path);
  } catch (const SceneError& error) {
    return error.what();
  }
  return "accepted";
}

std::string repeated(const std::string& text, std::size_t times) {
  std::string all;
  for (std::size_t i = 0; i < times; ++i) all += text;
  return all;
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

bool is_refused_for_its_depth(const std::string& message) {
  return contains(message, "nested deeper than 16 levels") || contains(message, "a key that is not text");
}

TEST(YamlFile, OfAHundredMegabytesIsRefusedBeforeItTakesTheMemory) {
  const TemporaryFile file("large.yaml");
  file.fill(repeated("[[[[[[[[[[[[[[[[\n", 61681), 100);  // 16 nested lists a line, 105 MB
  const long before = peak_memory_kb();
  const std::string message = message_of_file(file.path());
  const std::size_t limit = scene::YamlLimits{}.bytes;
  EXPECT_TRUE(contains(message, "larger than the allowed " + std::to_string(limit) + " bytes")) << message;
  // The text up to the limit in a string that grows by doubling, its old blocks still held by a sanitizer.
  // Parsed, it would take gigabytes.
  EXPECT_LT(peak_memory_kb() - before, static_cast<long>(4 * limit / 1024)) << "kB";
}

TEST(YamlFile, ThatNestsAsManyListsAsItHasBytesIsRefusedWithoutAStackForThem) {
  const TemporaryFile file("deep.yaml");
  constexpr std::size_t block = 1U << 20U;
  file.fill(std::string(block, '['), scene::YamlLimits{}.bytes / block);
  const std::string message = message_of_file(file.path());
  EXPECT_TRUE(is_refused_for_its_depth(message)) << message;
}

TEST(YamlText, ThatNestsInAnyOtherWayIsRefusedWithoutAStackForIt) {
  for (const char* opening : {"{", "- ", "? ", "{a: ", "[? ", "[[], "}) {
    const std::string message = message_of(repeated(opening, 1000000));
    EXPECT_TRUE(is_refused_for_its_depth(message)) << opening << ": " << message;
  }
}

TEST(YamlText, ThatOpensListsBehindBracketsInACommentIsRefusedWithoutAStackForThem) {
  const std::string message =
      message_of("a: 1 # " + std::string(500000, ']') + "\nb: " + std::string(1000000, '['));
  EXPECT_TRUE(is_refused_for_its_depth(message)) << message;
}

TEST(YamlFile, ThatNestsBlocksDeeplyIsRefused) {
  std::string text;
  for (std::size_t depth = 0; depth < 2000; ++depth) text += std::string(depth, ' ') + "a:\n";
  const std::string message = message_of(text);
  EXPECT_TRUE(contains(message, "nested deeper than 16 levels")) << message;
}

TEST(YamlFile, ThatIsADirectoryIsRefused) {
  const std::string message = message_of_file(TEST_DATA_DIR);
  EXPECT_TRUE(contains(message, std::string("scene file \"") + TEST_DATA_DIR + "\": cannot be read"))
      << message;
}

TEST(YamlFile, ThatDoesNotExistIsRefused) {
  const std::string path = std::string(TEST_DATA_DIR) + "/no_such_file.yaml";
  EXPECT_EQ(message_of_file(path), "scene file \"" + path + "\": cannot be read: No such file or directory");
}

TEST(YamlFile, ThatMayNotBeReadIsRefused) {
  const TemporaryFile file("forbidden.yaml");
  file.fill("sphere: 1\n");
  std::filesystem::permissions(file.path(), std::filesystem::perms::none);
  const uid_t me = geteuid();
  const uid_t nobody = 65534;
  if (me == 0) {  // root may read every file
    ASSERT_EQ(seteuid(nobody), 0);
  }
  const std::string message = message_of_file(file.path());
  ASSERT_EQ(seteuid(me), 0);
  EXPECT_TRUE(contains(message, "cannot be read: Permission denied")) << message;
}

std::string repeated(const std::string& text, int times) {
  std::string all;
  for (int i = 0; i < times; ++i) all += text;
  return all;
}

TEST(YamlText, ThatClosesItsBracketsOnlyInQuotesIsRefusedWithoutAStackForThem) {
  for (const char* quote : {"\"", "'"}) {
    const std::string line = repeated("[", 300) + quote + repeated("]", 300) + quote + ",\n";
    EXPECT_EQ(message_of(repeated(line, 4)), "nested deeper than 16 levels (line 1)");
  }
}

TEST(YamlText, MayHoldQuotesHashesAndBracketsWithoutEndInItsWords) {
  const std::string line = "- {name: it's#1, b: \"[\\\"\", c: '{ it''s [', d: [1, 2]}  # [ { \" '\n";
  EXPECT_EQ(message_of("a: it's a [ {\n"), "accepted");
  EXPECT_EQ(message_of(repeated(line, 300)), "accepted");
}

TEST(YamlFile, ThatIsEmptyIsRefused) {
  const TemporaryFile file("empty.yaml");
  file.fill("");
  EXPECT_EQ(message_of_file(file.path()), "scene file \"" + file.path() + "\": empty");
}

TEST(YamlText, OfExactlyTheAllowedBytesIsTaken) {
  scene::YamlLimits limits;
  limits.bytes = 6;
  EXPECT_EQ(message_of("a: 123", limits), "accepted");
  EXPECT_EQ(message_of("a: 1234", limits), "larger than the allowed 6 bytes");
}

TEST(YamlText, OfExactlyTheAllowedDepthIsTaken) {
  scene::YamlLimits limits;
  limits.depth = 3;
  EXPECT_EQ(message_of("[[[1]]]", limits), "accepted");
  EXPECT_EQ(message_of("[[[[1]]]]", limits), "nested deeper than 3 levels (line 1)");
}

TEST(YamlText, OfExactlyTheAllowedValuesIsTaken) {
  scene::YamlLimits limits;
  limits.values = 4;
  EXPECT_EQ(message_of("[1, 2, 3]", limits), "accepted");
  EXPECT_EQ(message_of("[1, 2, 3, 4]", limits), "more than 4 values (line 1)");
}

TEST(YamlText, WithAliasesOfAliasesIsRefusedBeforeTheyAreWrittenOut) {
  std::string text = "a0: &a0 [1, 1, 1, 1, 1, 1, 1, 1, 1, 1]\n";
  for (int i = 1; i < 14; ++i) {  // ten to the power of fourteen values
    const std::string alias = "*a" + std::to_string(i - 1);
    text += "a" + std::to_string(i) + ": &a" + std::to_string(i) + " [" + alias + repeated(", " + alias, 9) +
            "]\n";
  }
  scene::YamlLimits limits;
  limits.values = 10000;
  const std::string message = message_of(text, limits);
  EXPECT_TRUE(contains(message, "more than 10000 values")) << message;
}

TEST(YamlText, WithAListThatHoldsItselfIsRefused) { EXPECT_NE(message_of("a: &a [*a]\n"), "accepted"); }

TEST(YamlText, TakesPlainScalarsForNumbersAndFlagsAndQuotedOnesForText) {
  const Tree tree = tree_from_yaml("[1, -2.5e-3, .inf, true, no, word, '1', \"true\", y, ~]");
  const Tree::ListView list = *tree.as_list();
  ASSERT_EQ(list.size(), 10U);
  EXPECT_EQ(*list[0].as_number(), 1);
  EXPECT_EQ(*list[1].as_number(), -2.5e-3);
  EXPECT_TRUE(std::isinf(*list[2].as_number()));
  EXPECT_TRUE(*list[3].as_bool());
  EXPECT_FALSE(*list[4].as_bool());
  EXPECT_EQ(*list[5].as_text(), "word");
  EXPECT_EQ(*list[6].as_text(), "1");
  EXPECT_EQ(*list[7].as_text(), "true");
  EXPECT_EQ(*list[8].as_text(), "y");
  EXPECT_TRUE(list[9].is_null());
}

TEST(YamlText, KeepsTheOrderOfKeysAndTheirRepetitions) {
  const Tree tree = tree_from_yaml("b: 1\na: 2\nb: 3\n");
  const Tree::MapView map = *tree.as_map();
  ASSERT_EQ(map.size(), 3U);
  EXPECT_EQ(map[0].key, "b");
  EXPECT_EQ(map[1].key, "a");
  EXPECT_EQ(map[2].key, "b");
  EXPECT_EQ(*map[2].value.as_number(), 3);
}

TEST(YamlText, KeepsEveryBitOfANumber) {
  for (const char* text :
       {"0.1", "1.7976931348623157e308", "4.9406564584124654e-324", "-0.30000000000000004"}) {
    EXPECT_EQ(*tree_from_yaml(text).as_number(), std::strtod(text, nullptr)) << text;
  }
}

}  // namespace
}  // namespace hybrid_sphere::testing::yaml_test
